"""One verb for the response over frequency, whatever the method."""

from __future__ import annotations

import math
from typing import Any

from frahm.case import Case
from frahm.errors import check_choice, check_count
from frahm.response.curve import ResponseCurve, SpecialPoint
from frahm.slow_flow import SlowBranches, SlowFlow, pipe_scale, slow_branches, slow_flow_of
from frahm.systems import System, as_system, detuning_of, excitation_window

METHODS = ("slow-flow",)
_RESOLUTION = 1e-11


def frequency_response(
    case_or_system: Case | System | str,
    *,
    detuning: tuple[float, float] | None = None,
    frequency: tuple[float, float] | None = None,
    method: str = "slow-flow",
    form: str = "averaged",
    points: int = 2000,
) -> ResponseCurve:
    """All periodic responses over a window of the excitation frequency, with stability and special points.

    Parameters
    ----------
    case_or_system : Case, System or str
        What is excited.
    detuning : tuple of float, optional
        Window (lo, hi) in sigma = Omega - omega [rad/s].
    frequency : tuple of float, optional
        Window (lo, hi) in Omega [rad/s]; give one of the two.
    method : str
        "slow-flow": the one-harmonic theory of one mode with one cubic sink, every branch in closed form.
    form : str
        "averaged" or "paper" (doi 10.3390/app12147272).
    points : int
        Number of frequencies of the grid; special points are added exactly.

    Returns
    -------
    ResponseCurve

    Raises
    ------
    ParameterError
        If an argument is unusable, or the method does not fit the system.
    """
    system = as_system(case_or_system)
    check_choice("method", method, METHODS)
    lo, hi = excitation_window(system, detuning=detuning, frequency=frequency)
    count = check_count("points", points, at_least=2, at_most=10_000_000)
    slow = slow_flow_of(system, form)
    settings = {"method": method, "form": form, "frequency_window": (lo, hi), "points": count}
    return _curve(system, slow, slow_branches(slow, lo, hi, count), settings)


def _curve(system: System, slow: SlowFlow, found: SlowBranches, settings: dict[str, Any]) -> ResponseCurve:
    scale = pipe_scale(system)
    pipe = found.pipe_amplitude if scale == 1 else scale * found.pipe_amplitude
    special = []
    for point, branch in zip(found.points, found.point_branch, strict=True):
        Z = math.sqrt(point.n / (0.75 * slow.kappa))
        half = _RESOLUTION * point.frequency
        special.append(
            SpecialPoint(
                kind=point.kind,
                frequency=point.frequency,
                detuning=point.frequency - slow.omega,
                pipe_peak=scale * Z * point.pipe_per_relative,
                relative_peak=Z,
                branch=branch,
                interval=(point.frequency - half, point.frequency + half),
                status="located" if point.proven else "unverified",
            )
        )
    special.sort(key=lambda p: p.frequency)
    doubtful = [f"{p.kind} near detuning {p.detuning:.6g} rad/s" for p in special if p.status == "unverified"]
    return ResponseCurve(
        frequency=found.frequency,
        detuning=detuning_of(system, found.frequency),
        pipe_amplitude=pipe,
        relative_amplitude=found.relative_amplitude,
        pipe_peak=pipe,
        relative_peak=found.relative_amplitude,
        branch=found.branch,
        piece=found.piece,
        stable=found.stable,
        growth_rate=found.growth_rate,
        detached=found.detached,
        special_points=tuple(special),
        unverified=tuple(f"{text} could not be separated from its neighbours" for text in doubtful),
        settings=settings,
        system=system.name,
    )
