"""Steps `exact_response` and `slow_flow_response`: every periodic response over the window, exactly and in theory."""

from __future__ import annotations

from frahm import readable
from frahm.analysis.curve_summary import summary_of
from frahm.analysis.linear import linear_response
from frahm.analysis.section import PASS, UNVERIFIED, Check, Section, Work
from frahm.errors import ParameterError
from frahm.harmonic_balance import is_linear
from frahm.response import ResponseCurve, SpecialPoint, frequency_response

_POINTS = 2000
_LISTED = 5  # in a sentence


def exact_response(work: Work) -> Section:
    """Every periodic response of the exact equations over the window, by harmonic balance; any system."""
    if is_linear(work.system):
        return linear_response(work)
    try:
        curve = frequency_response(work.case)
    except ParameterError as error:
        return Section(unverified=(f"The exact response over frequency was not computed. {error}",))
    settings = {"inventory": curve.settings["inventory"], "harmonics": curve.settings["harmonics"]}
    return Section(
        results={"response": {"harmonic-balance": summary_of(curve) | settings}},
        data={"response": curve.to_dataset()},
        checks=(_exactly_located(curve),),
        unverified=curve.unverified,
        notes=(curve.settings["inventory"],),
    )


def slow_flow_response(work: Work) -> Section:
    """Every branch of the slow flow of one mode with one cubic sink: the theory beside the exact response."""
    if isinstance(work.theory, str):
        both = " and no slow manifold" if isinstance(work.slow_flow, str) else ""
        return Section(notes=(f"No slow flow{both}: {work.theory}",) if work.case.absorbers else ())
    analysis = work.case.analysis
    try:
        curve = frequency_response(
            work.system, detuning=analysis.detuning, method="slow-flow", form=analysis.form, points=_POINTS
        )
    except ParameterError as error:
        return Section(notes=(f"No slow flow beside the exact response: {error}",))
    return Section(
        results={"response": {"slow-flow": summary_of(curve) | {"form": curve.settings["form"]}}},
        data={"slow_flow": curve.to_dataset()},
        checks=(_separated(curve),),
        notes=("The slow flow keeps one harmonic: its amplitudes are approximations, measured by the exact response.",),
    )


def _exactly_located(curve: ResponseCurve) -> Check:
    name = "Special points of the exact response are located"
    doubtful = [p for p in curve.special_points if p.status != "located"]
    if doubtful:
        return Check(name, UNVERIFIED, f"Seen but not located: {_places(doubtful)}.")
    branches = f"{len(curve.branches)} {'branch' if len(curve.branches) == 1 else 'branches'}"
    counted = "the number of unstable Floquet multipliers agrees on both sides of each"
    return Check(name, PASS, f"{len(curve.special_points)} special points on {branches}; {counted}.")


def _places(points: list[SpecialPoint]) -> str:
    shown = ", ".join(f"{p.kind} {_place(p)}" for p in points[:_LISTED])
    return shown + (f" and {len(points) - _LISTED} more" if len(points) > _LISTED else "")


def _place(point: SpecialPoint) -> str:
    return f"at {point.detuning:.5g} rad/s" if point.wind_speed is None else f"at {readable.speed(point.wind_speed)}"


def _separated(curve: ResponseCurve) -> Check:
    points, doubtful = curve.special_points, [p for p in curve.special_points if p.status != "located"]
    name = "Special points of the slow flow are located and proven complete"
    if doubtful:
        return Check(name, UNVERIFIED, f"Not separated from their neighbours: {_places(doubtful)}.")
    return Check(name, PASS, f"All {len(points)} saddle-node and Hopf points were found by subdivision of the window.")
