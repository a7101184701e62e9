"""`climate_mean`: what a pipe does on average over its wind climate, whatever is off it and its absorber."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.assessment.counting import counted_band
from frahm.assessment.detail import detail_of, fatigue_section
from frahm.assessment.fatigue import surveyed
from frahm.assessment.linear_damage import LinearPipe, linear_damage, linear_pipe
from frahm.assessment.verdict import unsettled_winds
from frahm.assessment.wind_bins import first_edges, middles, refined
from frahm.assessment.wind_survey import WindFindings, WindSurvey
from frahm.case import Case
from frahm.harmonic_balance import is_linear, linear_response
from frahm.loads import WindClimate, wind_climate, wind_excitation
from frahm.systems import System

_BINS = 40
_FINE = 4001
Change = Callable[[System], System]


@dataclass(frozen=True)
class ClimateMeanOf:
    """A mean over the wind climate, and the largest motions met on the way.

    Attributes
    ----------
    value : float
        Damage over the duration of the climate [-], or expected pipe peak [m] while the wind is in the band.
    pipe_peak, relative_peak, pipe_rms : float
        Largest of any attractor [m].
    frequency : float
        Where the pipe peak occurs [rad/s].
    kind : str
        Of the attractor that causes it.
    unverified : tuple of str
    """

    value: float
    pipe_peak: float
    relative_peak: float
    pipe_rms: float
    frequency: float
    kind: str
    unverified: tuple[str, ...]


def climate_mean(
    case: Case, measure: str, *, samples: int, seed: int, bins: int | None = None, changed: Change | None = None,
    band: tuple[float, float] | None = None,
) -> ClimateMeanOf:  # fmt: skip
    """Mean over the wind climate of a case, every attractor at every wind considered.

    Parameters
    ----------
    case : Case
        With the section `climate` and, for the damage, `fatigue`.
    measure : {"damage", "expected"}
        "damage": fatigue damage over the duration of the climate, of the worst attractor at every wind, as
        `fatigue_damage` counts it. "expected": mean of the pipe peak over the attractors, weighted by their basin
        fractions, and over the winds of the band, weighted by their probability.
    samples, seed : int
        Of the initial states at every wind.
    bins : int, optional
        Wind bins; by default those of the section `fatigue`, or 40.
    changed : callable, optional
        What is done to the system at every wind.
    band : (float, float), optional
        Winds [m/s] in place of those that count for the case.

    Raises
    ------
    ParameterError
        If a section is missing.
    """
    climate, band = wind_climate(case), counted_band(case, band)
    detail = None
    if measure == "damage":
        fatigue_section(case)
        detail = detail_of(case)
    count = bins or (_BINS if case.fatigue is None else case.fatigue.bins)
    pipe = linear_pipe(case)
    if pipe is None or is_linear(pipe.system):
        return _linear(pipe, case, measure, climate, band, count, changed)
    bare = linear_pipe(case.without_absorbers())
    resonances = [] if bare is None else [speed for speed, _ in _changed(bare, changed).resonances(*band)]
    survey = WindSurvey(case, detail, samples, seed, changed=changed)
    if measure == "damage":
        survey, edges = surveyed(survey, climate, band, count, resonances)
        found = _found(survey, edges)
        chances = climate.probability(edges[:-1], edges[1:])
        value = climate.duration * float(np.sum(chances * [one.worst_rate for one in found]))
    else:
        edges = first_edges(*band, max(4, count - 2 * (count // 4)), resonances)
        edges = refined(edges, count, survey.look, lambda ends: _loss(survey, climate, ends))
        found = _found(survey, edges)
        value = _expected(climate, edges, [_mean_peak(one) for one in found])
    return _result(value, found)


def _changed(pipe: LinearPipe, changed: Change | None) -> LinearPipe:
    return pipe if changed is None else LinearPipe(changed(pipe.system), pipe.excitation, pipe.reference_lift)


def _found(survey: WindSurvey, edges: Floats) -> list[WindFindings]:
    return [survey.at[float(speed)] for speed in middles(edges)]


def _mean_peak(found: WindFindings) -> float:
    """Pipe peak weighted by basins [m]; what has not settled counts as it is."""
    return float(sum(a.basin_fraction * a.pipe_peak for a in found.found if a.basin_fraction > 0))


def _expected(climate: WindClimate, edges: Floats, values: Sequence[float]) -> float:
    chances = climate.probability(edges[:-1], edges[1:])
    total = float(np.sum(chances))
    return float(np.sum(chances * np.asarray(values))) / total if total > 0 else 0.0


def _loss(survey: WindSurvey, climate: WindClimate, edges: Floats) -> Floats:
    """What each bin may miss: its probability times the largest difference of the mean peak to its neighbours."""
    step = np.abs(np.diff([_mean_peak(one) for one in _found(survey, edges)]))
    jump = np.maximum(np.append(step, 0.0), np.insert(step, 0, 0.0))
    return np.asarray(climate.probability(edges[:-1], edges[1:]) * jump)


def _result(value: float, found: list[WindFindings]) -> ClimateMeanOf:
    attractors = [attractor for one in found for attractor in one.found if np.isfinite(attractor.pipe_peak)]
    worst = max(attractors, key=lambda attractor: attractor.pipe_peak)
    doubts = unsettled_winds(found)
    if not np.isfinite(value):
        doubts.append("The mean over the wind climate has no finite value.")
    return ClimateMeanOf(
        value, worst.pipe_peak, max(a.relative_peak for a in attractors), max(a.pipe_rms for a in attractors),
        worst.frequency, worst.kind, tuple(doubts),
    )  # fmt: skip


def _linear(
    pipe: LinearPipe | None, case: Case, measure: str, climate: WindClimate, band: tuple[float, float], count: int,
    changed: Change | None,
) -> ClimateMeanOf:  # fmt: skip
    """The one response of a linear system, over the winds in closed form."""
    if pipe is None:
        return ClimateMeanOf(0.0, 0.0, 0.0, 0.0, float(wind_excitation(case).frequency(band[0])), "periodic", ())
    pipe = _changed(pipe, changed)
    resonances = pipe.resonances(*band)
    near = [speed + width * np.linspace(-20, 20, 401) for speed, width in resonances]
    speeds = np.unique(np.concatenate([np.linspace(*band, _FINE), *near]))
    speeds = speeds[(speeds >= band[0]) & (speeds <= band[1])]
    frequencies = pipe.excitation.frequency(speeds)
    X = linear_response(pipe.system, frequencies) * (pipe.excitation.lift(speeds) / pipe.reference_lift)[:, None]
    peaks = np.abs(X @ pipe.system.output)
    first = pipe.system.elements[0].direction if pipe.system.elements else np.zeros(pipe.system.size)
    if measure == "damage":
        edges = first_edges(*band, count, [speed for speed, _ in resonances])
        value = float(np.sum(linear_damage(pipe, detail_of(case), climate, edges)[0]))
    else:
        density = climate.density(speeds)
        total = float(np.trapezoid(density, speeds))
        value = float(np.trapezoid(density * peaks, speeds)) / total if total > 0 else 0.0
    at = int(np.argmax(peaks))
    doubts = () if pipe.decays else ("Free motions never die out: the motion has no bound.",)
    return ClimateMeanOf(
        value, float(peaks[at]), float(np.max(np.abs(X @ first))), float(peaks[at]) / np.sqrt(2),
        float(frequencies[at]), "periodic", doubts,
    )  # fmt: skip
