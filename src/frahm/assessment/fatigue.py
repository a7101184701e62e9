"""`fatigue_damage`: damage of a case over its wind climate, every attractor counted, with and without absorbers."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from frahm.arrays import Floats, frozen
from frahm.assessment.counting import CALM, STORM, Counting, Progress
from frahm.assessment.damage import FatigueDamage
from frahm.assessment.detail import Detail, detail_of, fatigue_section, other_places
from frahm.assessment.linear_damage import LinearPipe, linear_damage, linear_pipe
from frahm.assessment.verdict import doubts_of, doubts_of_the_rest, notes_of
from frahm.assessment.wind_bins import first_edges, gaps, interpolated_damage, middles, refined
from frahm.assessment.wind_survey import WindSurvey
from frahm.case import Case, load_case
from frahm.harmonic_balance import is_linear
from frahm.loads import (
    WindClimate,
    lock_in_band,
    persistence,
    wind_climate,
    wind_excitation,
)
from frahm.systems import build_system
from frahm.tolerances import AS_LARGE

_FIRST = 0.5  # share of the bins laid out before it is known where the damage changes
_PLACES = 3  # sections tried
_OUTSIDE = 200  # panels for the winds outside the band


def fatigue_damage(
    case: Case | str | dict[str, Any],
    bins: int | None = None,
    *,
    wind: tuple[float, float] | None = None,
    samples: int | None = None,
    seed: int | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> FatigueDamage:
    """Fatigue damage of a case over its wind climate, with its absorbers and without.

    At every wind the excitation has the frequency and the amplitude that belong to this wind. With absorbers every
    attractor found there, modulated ones included, is integrated, its stress rainflow counted, and the worst of them
    taken; the sum weighted by basin fractions stands beside it. Half of the bins are laid out evenly and towards the
    resonances, the others go where the damage changes most from bin to bin. Without absorbers, or if all laws are
    linear, the response is known in closed form and integrated over the wind speed.

    Parameters
    ----------
    case : Case, str, Path or dict
        With the sections `climate` and `fatigue`.
    bins : int, optional
        Wind bins; `fatigue.bins` of the case by default.
    wind : tuple of float, optional
        Band (lo, hi) of wind speeds [m/s]; by default `fatigue.wind_speeds`, or the winds of the range of operation
        of the case.
    samples : int, optional
        Initial states in the search for attractors at every wind; `fatigue.samples` by default.
    seed : int, optional
        Of these samples; `analysis.seed` by default.
    workers : int, optional
        Threads; one per core by default. The result does not depend on it.
    progress : callable, optional
        Called with the number of winds done and the number of bins.

    Returns
    -------
    FatigueDamage

    Raises
    ------
    ParameterError
        If the case has no climate or no detail, or for bad input. What could not be settled the result names.
    """
    case = load_case(case)
    counting = Counting.of(case, bins, wind=wind, samples=samples, seed=seed, workers=workers, progress=progress)
    found = damage_beside(case, (), counting)
    return dataclasses.replace(found, unverified=(*found.unverified, *doubts_of_the_rest((found,))))


def damage_beside(case: Case, others: Sequence[tuple[float, float]], counting: Counting) -> FatigueDamage:
    """`fatigue_damage` where winds of other bands [m/s] are counted elsewhere, and nothing said of those nobody counts.

    `doubts_of_the_rest` of all parts together says it.
    """
    climate, band, count = wind_climate(case), counting.band, counting.bins
    survey = WindSurvey(case, detail_of(case), counting.samples, counting.seed, counting.workers, counting.seen)
    bare = linear_pipe(case.without_absorbers())
    resonances = [] if bare is None else [speed for speed, _ in bare.resonances(*band)]
    if is_linear(build_system(case)) or bare is None:
        edges = first_edges(*band, count, resonances)
        return _result(survey, bare, linear_pipe(case) if case.absorbers else bare, climate, edges, others)
    survey, edges = surveyed(survey, climate, band, count, resonances)
    return _result(survey, bare, None, climate, edges, others)


def surveyed(
    survey: WindSurvey, climate: WindClimate, band: tuple[float, float], count: int, resonances: list[float]
) -> tuple[WindSurvey, Floats]:
    """The motions at the middles of up to `count` wind bins, more where the damage changes, and the ends of the bins.

    The damage is that of the section of an elastic pipe that takes most.
    """
    edges = first_edges(*band, max(4, count - 2 * math.floor(count * (1 - _FIRST) / 2)), resonances)
    edges = refined(edges, count, survey.look, lambda ends: _loss(survey, climate, ends))
    _keep(survey, edges)
    survey.carry()
    return _at_the_worst_place(survey, survey.case, climate, edges), edges


def _loss(survey: WindSurvey, climate: WindClimate, edges: Floats) -> Floats:
    """What each bin may miss: its probability times the largest difference of the rate to its neighbours."""
    rates = _rates(survey, edges)
    step = np.abs(np.diff(rates))
    jump = np.maximum(np.append(step, 0.0), np.insert(step, 0, 0.0))
    return np.asarray(climate.probability(edges[:-1], edges[1:]) * np.where(np.isfinite(jump), jump, 0.0))


def _rates(survey: WindSurvey, edges: Floats) -> Floats:
    return np.array([survey.at[float(speed)].worst_rate for speed in middles(edges)])


def _keep(survey: WindSurvey, edges: Floats) -> None:
    """Forget the winds that are no middle of a bin."""
    survey.at = {float(speed): survey.at[float(speed)] for speed in middles(edges)}


def _at_the_worst_place(survey: WindSurvey, case: Case, climate: WindClimate, edges: Floats) -> WindSurvey:
    """The survey at the section of an elastic pipe that takes most damage, of those with the largest ranges."""
    places = other_places(case)
    if places is None:
        return survey
    best, tried = survey, {survey.place.section}
    for _ in range(_PLACES):
        larger = best.larger_place(*places, least=AS_LARGE)
        if larger is None or larger[0] in tried:
            break
        tried.add(larger[0])
        other = best.moved_to(best.place.with_place(larger[0], frozen(places[1][larger[1]])))
        if _sum(other, climate, edges) <= _sum(best, climate, edges):
            break
        best = other
    return best


def _sum(survey: WindSurvey, climate: WindClimate, edges: Floats) -> float:
    return float(np.nansum(climate.probability(edges[:-1], edges[1:]) * _rates(survey, edges)))


def _result(
    survey: WindSurvey, bare: LinearPipe | None, linear: LinearPipe | None, climate: WindClimate, edges: Floats,
    others: Sequence[tuple[float, float]],
) -> FatigueDamage:  # fmt: skip
    case, detail = survey.case, survey.place
    bare_detail = _bare_detail(detail, case)
    excitation, speeds = wind_excitation(case), middles(edges)
    chances = np.asarray(climate.probability(edges[:-1], edges[1:]))
    T, lock_in = climate.duration, _lock_in(case, edges)
    held = float(np.asarray(climate.probability(*lock_in)))
    without, range_without = _closed_form(bare, bare_detail, climate, edges)
    held_without = _locked_in(bare, bare_detail, climate, edges, held)
    none = np.zeros(speeds.size)
    binning = 0.0
    if survey.at:
        found = [survey.at[float(speed)] for speed in speeds]
        rates, weighted = _rates(survey, edges), np.array([one.weighted_rate for one in found])
        counted = chances > 0  # a wind that never blows does no damage, however large the motion
        bin_with, bin_weighted = (T * chances * np.where(counted, each, 0.0) for each in (rates, weighted))
        ranges = np.array([one.damage[one.worst].largest_range if one.damage else 0.0 for one in found])
        kinds = tuple(one.found[one.worst].kind if len(one.found) else "unsettled" for one in found)
        number = np.array([sum(a.kind != "unsettled" for a in one.found) for one in found])
        unsettled = np.array([one.unsettled for one in found])
        total = float(np.sum(bin_with))
        between = T * interpolated_damage(speeds, rates, edges, chances)
        binning = abs(between - total) / total if 0 < total < math.inf else 0.0
        locked = T * held * float(np.max(rates, initial=0.0))
    else:
        bin_with, ranges = (without, range_without) if linear is bare else _closed_form(linear, detail, climate, edges)
        bin_weighted, number, unsettled, kinds = bin_with, none + 1, none, ("linear",) * speeds.size
        locked = held_without if linear is bare else _locked_in(linear, detail, climate, edges, held)
    growth = case.pipe.damping_ratio * case.pipe.frequency
    counted_winds = [(float(edges[0]), float(edges[-1])), *others]
    outside, worst_outside = _outside(bare, bare_detail, climate, counted_winds)
    known: dict[str, Any] = dict(  # noqa: C408 keyword by keyword, as the result takes them
        damage_with=float(np.sum(bin_with)),
        damage_with_weighted=float(np.sum(bin_weighted)),
        damage_without=float(np.sum(without)),
        locked_in_with=locked,
        locked_in_without=held_without,
        outside_without=outside, outside_wind=worst_outside,
        speeds=frozen(speeds), lower=frozen(edges[:-1]), upper=frozen(edges[1:]),
        frequencies=frozen(excitation.frequency(speeds)),
        detunings=frozen(excitation.frequency(speeds) - case.pipe.frequency),
        probabilities=frozen(chances), bin_with=frozen(bin_with), bin_weighted=frozen(bin_weighted),
        bin_without=frozen(without), range_with=frozen(ranges), range_without=frozen(range_without), kinds=kinds,
        attractors=frozen(number, dtype=np.int64), unsettled=frozen(unsettled), binning=binning,
        persistence=persistence(climate, lock_in[0], lock_in[1], 1 / growth if growth > 0 else math.inf),
        stress_range_without=float(np.max(range_without, initial=0.0)), section=detail.section, case=case,
        lock_in=lock_in, settings=_settings(survey, climate),
    )  # fmt: skip
    return FatigueDamage(**known, unverified=doubts_of(known, survey, bare, linear), notes=notes_of(known, survey))


def _bare_detail(detail: Detail, case: Case) -> Detail:
    """The detail on the pipe without absorbers, whose coordinates come last."""
    modes = detail.row.size - len(case.absorbers)
    return Detail(detail.curve, detail.factor, detail.row[:modes], detail.section)


def _closed_form(pipe: LinearPipe | None, detail: Detail, climate: WindClimate, edges: Floats) -> tuple[Floats, Floats]:
    """Damage and largest stress range by bin; infinite everywhere for a pipe whose free motions never die out."""
    if pipe is None:
        return np.zeros(edges.size - 1), np.zeros(edges.size - 1)
    if not pipe.decays:
        return np.full(edges.size - 1, np.inf), np.full(edges.size - 1, np.inf)
    return linear_damage(pipe, detail, climate, edges)


def _lock_in(case: Case, edges: Floats) -> tuple[float, float]:
    """Wind speeds over which the shedding may lock in [m/s]; the band counted where tables do not tell."""
    band = lock_in_band(case)
    if math.isfinite(band.low) and math.isfinite(band.high) and band.low < band.high:
        return band.low, band.high
    return float(edges[0]), float(edges[-1])


def _locked_in(pipe: LinearPipe | None, detail: Detail, climate: WindClimate, edges: Floats, chance: float) -> float:
    """Damage if the pipe did what it does at the worst wind in a share `chance` of the time."""
    if pipe is None or not pipe.decays:
        return 0.0 if pipe is None else math.inf
    speeds = np.concatenate([np.linspace(edges[0], edges[-1], 4001)]
                            + [speed + width * np.linspace(-1, 1, 201) for speed, width in
                               pipe.resonances(edges[0], edges[-1])])  # fmt: skip
    speeds = speeds[(speeds >= edges[0]) & (speeds <= edges[-1])]  # a well damped resonance is wider than the band
    return climate.duration * chance * float(np.max(pipe.rate(speeds, detail)))


def _outside(
    pipe: LinearPipe | None, detail: Detail, climate: WindClimate, counted: Sequence[tuple[float, float]]
) -> tuple[float, float]:
    """Damage by all winds in none of the bands counted, in closed form, and the wind [m/s] that does most of it."""
    if pipe is None or not pipe.decays:
        return (0.0 if pipe is None else math.inf), math.nan
    low, high = max(pipe.excitation.speed_range[0], CALM), min(pipe.excitation.speed_range[1], STORM)
    total, worst, where = 0.0, 0.0, math.nan
    for first, last in gaps(low, high, counted):
        ends = np.linspace(first, last, _OUTSIDE)
        parts = linear_damage(pipe, detail, climate, ends)[0]
        total += float(np.sum(parts))
        if parts.max() > worst:
            worst, where = float(parts.max()), float(middles(ends)[np.argmax(parts)])
    return total, where


def _settings(survey: WindSurvey, climate: WindClimate) -> dict[str, Any]:
    fatigue = fatigue_section(survey.case)
    return {
        "duration": climate.duration,
        "curve": fatigue.curve,
        "stress_factor": survey.place.factor,
        "stress_concentration": fatigue.stress_concentration,
        "thickness": fatigue.thickness,
        "design_fatigue_factor": fatigue.design_fatigue_factor,
        "samples": survey.samples,
        "seed": survey.seed,
        "section": survey.place.section,
    }
