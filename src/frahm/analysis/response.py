"""Step `response`: every branch of periodic motion over the window of the case, with its special points."""

from __future__ import annotations

from typing import Any

from frahm.analysis.linear import is_linear, linear_response
from frahm.analysis.section import PASS, UNVERIFIED, Check, Section, Work
from frahm.response import ResponseCurve, SpecialPoint, frequency_response

_POINTS = 2000


def response(work: Work) -> Section:
    """The response over the window: exact for a linear system, by the slow flow for one mode with one cubic sink."""
    if is_linear(work.system):
        return linear_response(work)
    if isinstance(work.slow_flow, str):
        why = f"The response over frequency was not computed. {work.slow_flow}"
        return Section(unverified=(why,))
    analysis = work.case.analysis
    curve = frequency_response(
        work.system, detuning=analysis.detuning, method="slow-flow", form=analysis.form, points=_POINTS
    )
    return Section(
        results={"response": {"slow-flow": _summary(curve)}},
        data={"response": curve.to_dataset()},
        checks=(_located(curve),),
        unverified=curve.unverified,
        notes=("The slow flow keeps one harmonic: its amplitudes are approximations, tested by integration.",),
    )


def _summary(curve: ResponseCurve) -> dict[str, Any]:
    peak, frequency = curve.largest()
    stable, at = curve.largest(stable_only=True)
    reference = float(curve.frequency[0] - curve.detuning[0])
    return {
        "pipe_peak_max": peak,
        "pipe_peak_max_detuning": frequency - reference,
        "stable_pipe_peak_max": stable,
        "stable_pipe_peak_max_detuning": at - reference,
        "form": curve.settings["form"],
        "special_points": [_point(point) for point in curve.special_points],
        "branches": [_branch(branch) for branch in curve.branches],
    }


def _point(point: SpecialPoint) -> dict[str, Any]:
    return {
        "kind": point.kind,
        "detuning": point.detuning,
        "frequency": point.frequency,
        "pipe_peak": point.pipe_peak,
        "relative_peak": point.relative_peak,
        "branch": point.branch,
        "interval": list(point.interval),
        "status": point.status,
    }


def _branch(branch: Any) -> dict[str, Any]:
    return {
        "number": branch.number,
        "detached": bool(branch.detached),
        "detuning": [float(branch.detuning.min()), float(branch.detuning.max())],
        "pipe_peak_max": float(branch.pipe_peak.max()),
    }


def _located(curve: ResponseCurve) -> Check:
    points, doubtful = curve.special_points, [p for p in curve.special_points if p.status != "located"]
    name = "Special points of the slow flow are located and proven complete"
    if doubtful:
        where = ", ".join(f"{p.kind} at {p.detuning:.5g} rad/s" for p in doubtful)
        return Check(name, UNVERIFIED, f"Not separated from their neighbours: {where}.")
    return Check(name, PASS, f"All {len(points)} saddle-node and Hopf points were found by subdivision of the window.")
