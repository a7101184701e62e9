"""One verb for the response over frequency, whatever the method."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from frahm.case import Case, load_case
from frahm.errors import ParameterError, check_choice, check_count
from frahm.loads import OperatingRange, operating_range
from frahm.response.curve import ResponseCurve, SpecialPoint
from frahm.slow_flow import SlowBranches, SlowFlow, pipe_scale, slow_branches, slow_flow_of
from frahm.systems import System, as_system, detuning_of, excitation_frequency, excitation_window

# What solves the exact equations is loaded when it is asked for: the slow flow does not wait for it.
if TYPE_CHECKING:
    from frahm.harmonic_balance import PeriodicResponse
    from frahm.harmonic_balance.found import Found

METHODS = ("harmonic-balance", "slow-flow")
_RESOLUTION = 1e-11


def frequency_response(
    case_or_system: Case | System | str,
    *,
    detuning: tuple[float, float] | None = None,
    frequency: tuple[float, float] | None = None,
    wind: tuple[float, float] | None = None,
    method: str = "harmonic-balance",
    form: str = "averaged",
    harmonics: int | str = "auto",
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
        Window (lo, hi) in Omega [rad/s].
    wind : tuple of float, optional
        Window (lo, hi) in wind speed U [m/s] of a case: shedding frequency and lift both follow it. Give one of the
        three windows; the wind is for the harmonic balance only. With none, a case is asked about its own range of
        operation, see `frahm.loads.operating_range`.
    method : str
        "harmonic-balance": the exact equations of any system. "slow-flow": the one-harmonic theory of one mode with
        one cubic sink, every branch in closed form.
    form : str
        Of the slow flow: "averaged" or "paper" (doi 10.3390/app12147272).
    harmonics : int or "auto"
        Of the harmonic balance: the highest harmonic, or as many as bring the unbalanced force below 1e-8.
    points : int
        Number of frequencies of the slow flow's grid; special points are added exactly. The harmonic balance chooses
        its points itself.

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
    if wind is not None and (detuning is not None or frequency is not None):
        raise ParameterError("detuning, frequency, wind", (detuning, frequency, wind), "at most one of the three")
    if isinstance(case_or_system, System):
        if wind is not None:
            raise ParameterError("wind", wind, "left out for a System, which knows no wind; give a case instead")
    elif detuning is None and frequency is None:
        within = operating_range(load_case(case_or_system), wind=wind)
        if within.over_wind:
            return _over_wind(system, within, method, harmonics)
        frequency = within.frequency
    lo, hi = excitation_window(system, detuning=detuning, frequency=frequency)
    count = check_count("points", points, at_least=2, at_most=10_000_000)
    if method == "harmonic-balance":
        from frahm.response.exact import exact_curve

        return exact_curve(system, lo, hi, highest_harmonic(harmonics))
    slow = slow_flow_of(system, form)
    if lo <= slow.limits[0]:
        allowed = f"above {slow.limits[0] - slow.omega:.6g} rad/s: below it the {form} form means nothing"
        raise ParameterError("detuning", lo - slow.omega, allowed)
    settings = {"method": method, "form": form, "frequency_window": (lo, hi), "points": count}
    return _curve(system, slow, slow_branches(slow, lo, hi, count), settings)


def _over_wind(system: System, within: OperatingRange, method: str, harmonics: int | str) -> ResponseCurve:
    """Response over the wind speed."""
    if method != "harmonic-balance":
        allowed = '"harmonic-balance" where the response is wanted over the wind'
        hint = "The slow flow knows one lift for all frequencies: give detuning=(lo, hi)."
        raise ParameterError("method", method, allowed, hint=hint)
    from frahm.response.exact import exact_curve

    return with_winds(exact_curve(system, *within.frequency, highest_harmonic(harmonics), within.factor), within)


def with_winds(curve: ResponseCurve, within: OperatingRange) -> ResponseCurve:
    """A curve over a range of winds, with the wind speed at every point."""
    points = tuple(replace(point, wind_speed=float(within.speed(point.frequency))) for point in curve.special_points)
    settings = {**curve.settings, "wind_window": within.wind}
    return replace(curve, wind_speed=within.speed(curve.frequency), special_points=points, settings=settings)


def periodic_responses(
    case_or_system: Case | System | str,
    *,
    detuning: float | None = None,
    frequency: float | None = None,
    harmonics: int | str = "auto",
) -> Found[PeriodicResponse]:
    """All periodic responses of the exact equations at one excitation frequency, by ascending relative amplitude.

    Parameters
    ----------
    case_or_system : Case, System or str
        What is excited.
    detuning, frequency : float
        sigma or Omega [rad/s]; give one of the two.
    harmonics : int or "auto"
        Highest harmonic, or as many as needed.

    Returns
    -------
    list of PeriodicResponse
        Responses with the period of the excitation; both of a mirrored pair are listed. Its attributes `searched` (a
        sentence) and ``unverified`` (a tuple of sentences) say how far the search went.

    Raises
    ------
    ParameterError
        For bad input, or a system this cannot be asked of.
    """
    from frahm.harmonic_balance import periodic_responses_of

    system = as_system(case_or_system)
    W = excitation_frequency(system, detuning=detuning, frequency=frequency)
    return periodic_responses_of(system, W, highest_harmonic(harmonics), every=True)


def highest_harmonic(harmonics: int | str) -> int | None:
    """The user's highest harmonic, None for "auto"."""
    if isinstance(harmonics, str):
        if harmonics != "auto":
            raise ParameterError("harmonics", harmonics, 'a whole number from 1 to 201, or "auto"')
        return None
    return check_count("harmonics", harmonics, at_least=1, at_most=201)


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
        asymmetric=(False,) * len(found.detached),
        special_points=tuple(special),
        unverified=(*found.unverified, *(f"{text} could not be separated from its neighbours" for text in doubtful)),
        settings=settings,
        system=system.name,
    )
