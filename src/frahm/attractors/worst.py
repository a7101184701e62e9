"""`worst_case`: the largest motion over a window of the excitation frequency, all attractors considered."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frahm.attractors.attractor import Attractor, AttractorSet
from frahm.attractors.finding import MOST_SAMPLES, PERIODS, attractors_from
from frahm.attractors.regions import Region, checked_region, region_for
from frahm.attractors.stroboscope import stroboscope
from frahm.case import load_case
from frahm.errors import Outcome, ParameterError, check_count, check_number
from frahm.harmonic_balance import (
    PeriodicResponse,
    begin,
    find_branches,
    is_linear,
    periodic_responses_of,
    responses_on,
)
from frahm.response import ResponseCurve
from frahm.response.exact import exact_curve
from frahm.response.wind import WindAxis, wind_axis
from frahm.systems import System, as_system, detuning_of, excitation_window, with_parameters

if TYPE_CHECKING:
    from frahm.case import Case

_SPREAD = 9  # frequencies spread over the window
_SPECIAL = 10  # special points of the response curve looked at on both sides, the largest first
_BESIDE = 1e-3  # of the window: how far beside a special point
_CLOSE = 5e-4  # of the window: frequencies nearer than this are one
_FINE = 2e-3  # of the window: how near its neighbours the worst is looked at in the end
_ROUNDS = 9

Size = Callable[[Attractor], float]


@dataclass(frozen=True, eq=False)
class WorstCase:
    """The worst over a window, and where it was looked for.

    Attributes
    ----------
    pipe_peak : float
        Largest pipe peak [m] of an attractor with a basin fraction of at least `min_basin`.
    relative_peak : float
        Largest peak of the first element [m], which another attractor at another frequency may cause.
    detuning, frequency : float
        Where the pipe peak occurs [rad/s].
    attractor : Attractor
        What causes the pipe peak.
    pipe_rms, rms_frequency : float
        Largest pipe rms [m] of an attractor that counts, and where it occurs [rad/s]; bracketed like the peaks only if
        the rms was asked for.
    relative_detuning, relative_frequency : float
        Where the relative peak occurs [rad/s].
    not_excluded : float
        Largest pipe peak [m] of an attractor whose 95 % interval of the basin fraction reaches `min_basin`.
    verified : bool
        Whether nothing speaks against it; what does is in `unverified`.
    unverified : tuple of str
        Sentences: motions that did not settle, an interruption, a worst that was not bracketed finely.
    surveys : tuple of AttractorSet
        All frequencies looked at, ascending.
    min_basin : float
    """

    pipe_peak: float
    relative_peak: float
    detuning: float
    frequency: float
    attractor: Attractor
    pipe_rms: float
    rms_frequency: float
    relative_detuning: float
    relative_frequency: float
    not_excluded: float
    verified: bool
    unverified: tuple[str, ...]
    surveys: tuple[AttractorSet, ...]
    min_basin: float


def worst_case(
    case_or_system: Case | System | str,
    *,
    detuning: tuple[float, float] | None = None,
    frequency: tuple[float, float] | None = None,
    wind: tuple[float, float] | None = None,
    samples: int = 100,
    min_basin: float = 0.01,
    seed: int = 1,
    region: dict[str, tuple[float, float]] | None = None,
    periods: int = PERIODS,
    workers: int | None = None,
    rms: bool = False,
) -> WorstCase:
    """Largest pipe and relative peak over all attractors with a basin fraction of at least `min_basin`.

    The frequencies looked at are spread over the window, stand beside the special points of the exact response curve
    and at its stable maxima; around the worst they are then halved until it is known to 0.2 % of the window.

    Parameters
    ----------
    case_or_system : Case, System or str
        What is excited.
    detuning, frequency : tuple of float
        Window (lo, hi) of sigma or Omega [rad/s].
    wind : tuple of float
        Window (lo, hi) of the wind speed of a case [m/s]: shedding frequency and lift both follow it. Give one of the
        three.
    samples : int
        Initial states at every frequency.
    min_basin : float
        Least basin fraction in the sample that counts [-].
    seed : int
        Of the sample.
    region : dict, optional
        Of the initial states, see `find_attractors`; by default one region for the whole window, scaled by the largest
        stable periodic response in it.
    periods : int
        Periods after which a motion that has not settled is given up; it counts as it is, as unverified.
    workers : int, optional
        Threads; one per core by default.
    rms : bool
        Whether the largest rms of the pipe is bracketed, too.

    Returns
    -------
    WorstCase

    Raises
    ------
    ParameterError
        For bad input.
    """
    system = as_system(case_or_system)
    axis = None
    if wind is None:
        lo, hi = excitation_window(system, detuning=detuning, frequency=frequency)
    elif detuning is not None or frequency is not None or isinstance(case_or_system, System):
        allowed = "for a case, and without detuning and frequency"
        raise ParameterError("wind", wind, allowed)
    else:
        axis = wind_axis(load_case(case_or_system), wind)
        lo, hi = axis.frequency
    return worst_over(
        system, lo, hi, axis,
        samples=check_count("samples", samples, at_most=MOST_SAMPLES),
        min_basin=check_number("min_basin", min_basin, at_least=0.0, at_most=1.0),
        seed=check_count("seed", seed, at_least=0),
        region=None if region is None else checked_region(system, region),
        periods=check_count("periods", periods, at_most=1_000_000),
        workers=None if workers is None else check_count("workers", workers, at_most=1024),
        rms=rms,
    )  # fmt: skip


def worst_over(
    system: System, lo: float, hi: float, axis: WindAxis | None = None, *, samples: int, min_basin: float, seed: int,
    region: Region | None = None, periods: int = PERIODS, workers: int | None = None, rms: bool = False,
) -> WorstCase:  # fmt: skip
    """`worst_case` of a system between two frequencies Omega [rad/s]; with a wind axis the lift follows the wind."""
    factor = None if axis is None else axis.factor
    curve = exact_curve(system, lo, hi, None, factor)
    box = region or _region_of(system, curve, hi)
    at, responses_at = _systems(system, axis), _responses(system, lo, hi, axis)
    surveys: dict[float, AttractorSet] = {}
    sizes = (_pipe, _relative, _rms) if rms else (_pipe, _relative)

    def look(W: float, exponents: bool = False) -> None:
        strobe = stroboscope(at(W), W, workers)
        surveys[W] = attractors_from(strobe, responses_at(W), box, samples, seed, periods, exponents)

    interrupted = False
    try:
        for W in _first_frequencies(curve, lo, hi):
            look(W)
        _refine(surveys, look, lo, hi, min_basin, sizes)
        look(_largest(surveys, _pipe, min_basin)[0], exponents=True)
    except KeyboardInterrupt:
        interrupted = True
        if not surveys:
            raise
    return _verdict(system, curve, surveys, lo, hi, min_basin, interrupted, sizes)


def _pipe(attractor: Attractor) -> float:
    return attractor.pipe_peak


def _relative(attractor: Attractor) -> float:
    return attractor.relative_peak


def _rms(attractor: Attractor) -> float:
    return attractor.pipe_rms


def _systems(system: System, axis: WindAxis | None) -> Callable[[float], System]:
    """The system as it is driven at a frequency."""
    if axis is None:
        return lambda W: system
    return lambda W: with_parameters(system, force=axis.lift_factor(W))


def _responses(
    system: System, lo: float, hi: float, axis: WindAxis | None
) -> Callable[[float], list[PeriodicResponse]]:
    """Periodic responses at a frequency of the window, whose branches are followed once."""
    if is_linear(system) or not np.any(system.forcing):
        at = _systems(system, axis)
        return lambda W: periodic_responses_of(at(W), W, None)
    search = begin(system, lo, hi, None, None if axis is None else axis.factor)
    tracks = find_branches(search)
    return lambda W: responses_on(search, tracks, W)


def _region_of(system: System, curve: ResponseCurve, frequency: float) -> Region:
    pipe, stroke = (
        float(np.max(peaks[curve.stable & np.isfinite(peaks)], initial=0.0))
        for peaks in (curve.pipe_peak, curve.relative_peak)
    )
    return region_for(system, frequency, pipe, stroke)


def _first_frequencies(curve: ResponseCurve, lo: float, hi: float) -> list[float]:
    """Frequencies to start with, ascending, none too near to another."""
    width = hi - lo
    wanted = [lo, hi, *np.linspace(lo, hi, _SPREAD)[1:-1]]
    for peaks in (curve.pipe_peak, curve.relative_peak):
        for branch in np.unique(curve.branch):
            here = np.flatnonzero((curve.branch == branch) & curve.stable & np.isfinite(peaks))
            if here.size:
                wanted.append(float(curve.frequency[here[np.argmax(peaks[here])]]))
    largest_first = sorted(curve.special_points, key=lambda point: -point.pipe_peak)
    for point in largest_first[:_SPECIAL]:
        wanted += [point.frequency - _BESIDE * width, point.frequency + _BESIDE * width]
    chosen: list[float] = []
    for W in wanted:
        if lo <= W <= hi and all(abs(W - other) > _CLOSE * width for other in chosen):
            chosen.append(float(W))
    return sorted(chosen)


def _refine(
    surveys: dict[float, AttractorSet], look: Callable[[float], None], lo: float, hi: float, min_basin: float,
    sizes: tuple[Size, ...],
) -> None:  # fmt: skip
    """Halve the gaps beside the worst until they are fine."""
    for _ in range(_ROUNDS):
        middles = {
            middle
            for size in sizes
            for middle in _gaps(surveys, _largest(surveys, size, min_basin)[0], _FINE * (hi - lo))
        }
        if not middles:
            return
        for W in sorted(middles):
            look(W)


def _gaps(surveys: Iterable[float], worst: float, fine: float) -> list[float]:
    """Middles of the gaps beside the worst that are wider than `fine`."""
    grid = sorted(surveys)
    at = grid.index(worst)
    return [
        0.5 * (worst + grid[other])
        for other in (at - 1, at + 1)
        if 0 <= other < len(grid) and abs(grid[other] - worst) > fine
    ]


def _largest(surveys: dict[float, AttractorSet], size: Size, min_basin: float) -> tuple[float, Attractor]:
    """Frequency and attractor of the largest motion that counts."""
    counting = [
        (W, attractor)
        for W in sorted(surveys)
        for attractor in surveys[W]
        if attractor.basin_fraction >= min_basin and not np.isnan(size(attractor))
    ]
    if not counting:
        counting = [(W, attractor) for W in sorted(surveys) for attractor in surveys[W]]
    return max(counting, key=lambda item: size(item[1]))


def _verdict(
    system: System, curve: ResponseCurve, surveys: dict[float, AttractorSet], lo: float, hi: float, min_basin: float,
    interrupted: bool, sizes: tuple[Size, ...],
) -> WorstCase:  # fmt: skip
    W, worst = _largest(surveys, _pipe, min_basin)
    W_relative, stroke = _largest(surveys, _relative, min_basin)
    W_rms, loudest = _largest(surveys, _rms, min_basin)
    doubts = [*curve.unverified]
    if interrupted or any(survey.outcome is Outcome.INTERRUPTED for survey in surveys.values()):
        doubts.append(Outcome.INTERRUPTED.value)
    for at in sorted(surveys):
        for attractor in surveys[at]:
            if attractor.kind == "unsettled" and attractor.basin_fraction >= min_basin:
                share = f"{100 * attractor.basin_fraction:.2g} % of the motions at Omega = {at:.6g} rad/s"
                doubts.append(f"{share} are unsettled: {attractor.outcome.value}")
    if any(_gaps(surveys, at, _FINE * (hi - lo)) for at in {_largest(surveys, size, min_basin)[0] for size in sizes}):
        doubts.append("The worst was not bracketed to 0.2 % of the window.")
    possible = [a.pipe_peak for s in surveys.values() for a in s if a.basin_interval[1] >= min_basin]
    return WorstCase(
        pipe_peak=worst.pipe_peak,
        relative_peak=stroke.relative_peak,
        detuning=float(detuning_of(system, W)),
        frequency=W,
        attractor=worst,
        pipe_rms=loudest.pipe_rms,
        rms_frequency=W_rms,
        relative_detuning=float(detuning_of(system, W_relative)),
        relative_frequency=W_relative,
        not_excluded=float(np.nanmax([*possible, worst.pipe_peak])),
        verified=not doubts,
        unverified=tuple(doubts),
        surveys=tuple(surveys[at] for at in sorted(surveys)),
        min_basin=min_basin,
    )
