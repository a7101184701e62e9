"""A response curve as plain data for the summary."""

from __future__ import annotations

from typing import Any

from frahm.response import Branch, ResponseCurve, SpecialPoint


def summary_of(curve: ResponseCurve) -> dict[str, Any]:
    """Peaks, special points and branches of a curve as plain data."""
    peak, frequency = curve.largest()
    stable, at = curve.largest(stable_only=True)
    reference = float(curve.frequency[0] - curve.detuning[0]) if curve.frequency.size else float("nan")
    return {
        "pipe_peak_max": peak,
        "pipe_peak_max_detuning": frequency - reference,
        "stable_pipe_peak_max": stable,
        "stable_pipe_peak_max_detuning": at - reference,
        "special_points": [_point(point) for point in curve.special_points],
        "branches": [_branch(branch) for branch in curve.branches],
    }


def _point(point: SpecialPoint) -> dict[str, Any]:
    return {
        "kind": point.kind,
        "detuning": point.detuning,
        "frequency": point.frequency,
        "wind_speed": point.wind_speed,
        "pipe_peak": point.pipe_peak,
        "relative_peak": point.relative_peak,
        "branch": point.branch,
        "interval": list(point.interval),
        "status": point.status,
    }


def _branch(branch: Branch) -> dict[str, Any]:
    return {
        "number": branch.number,
        "detached": bool(branch.detached),
        "asymmetric": bool(branch.asymmetric),
        "detuning": [float(branch.detuning.min()), float(branch.detuning.max())],
        "wind_speed": None if branch.wind_speed is None else [branch.wind_speed.min(), branch.wind_speed.max()],
        "pipe_peak_max": float(branch.pipe_peak.max()),
        "stable_anywhere": bool(branch.stable.any()),
    }
