"""The quantities of a study, computed at points: what is asked for in, numbers and doubts out."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from frahm.analysis.ranges import ranges_without_stable_response, unstable_ranges
from frahm.assessment import fatigue_damage
from frahm.attractors import Attractor, find_attractors, worst_over
from frahm.attractors.attractor import KINDS
from frahm.errors import Outcome, ParameterError
from frahm.response import ResponseCurve, frequency_response, periodic_responses, slow_flow_map
from frahm.response.exact import ROUGH, exact_curve
from frahm.response.frequency_response import highest_harmonic
from frahm.sweep.points import StudyPoint
from frahm.sweep.study import Study
from frahm.sweep.variables import at_window

_INNER = ("kappa", "xi2", "detuning")


@dataclass(frozen=True)
class PointResult:
    """What a quantity is at one point: numbers by the name of the variable without its prefix, and doubts."""

    numbers: dict[str, Any] = field(default_factory=dict)
    doubts: tuple[str, ...] = ()
    failure: str = ""


def computed(name: str, points: Sequence[StudyPoint]) -> list[PointResult]:
    """One quantity at some points of a study. Whatever goes wrong at a point stays with it.

    A keyboard interrupt goes through, as does the one that a search for attractors answers with half a result.
    """
    study = points[0].study
    asked = study.asked[name]
    if is_closed_form(study, name):
        numbers, failures = equilibria(study, np.array([point.index for point in points]))
        return [
            PointResult(failure=failures[row])
            if row in failures
            else PointResult({key: v[row] for key, v in numbers.items()})
            for row in range(len(points))
        ]
    function = _ONE_BY_ONE[name, at_window(study, asked)]
    return [_guarded(function, point, asked) for point in points]


def is_closed_form(study: Study, name: str) -> bool:
    """Whether a quantity is computed for many points at once."""
    return name == "slow_flow" and not at_window(study, study.asked[name])


# Not of a point: another time, or on another machine, it may go well. What is not finished stays to be computed.
OF_THE_MACHINE = (OSError, MemoryError)


def _guarded(function: Callable[[StudyPoint, Any], PointResult], point: StudyPoint, asked: Any) -> PointResult:
    try:
        return function(point, asked)
    except OF_THE_MACHINE:
        raise
    except Exception as error:  # a sweep never dies: any failure of a point is a value
        return PointResult(failure=_said(error))


def _said(error: Exception) -> str:
    return str(error) if isinstance(error, ParameterError) else f"{type(error).__name__}: {error}"


def equilibria(study: Study, indices: np.ndarray) -> tuple[dict[str, np.ndarray], dict[int, str]]:
    """The slow flow at one detuning, many points in one compiled call.

    Parameters
    ----------
    study : Study
    indices : ndarray of int, shape (points,)
        Numbers of the points.

    Returns
    -------
    numbers : dict
        Arrays of shape (points,) or (points, 3); what they hold where a point failed means nothing.
    failures : dict
        Why a point failed, by its place among the points.
    """
    places = dict(zip(study.axes_given, np.unravel_index(indices, study.shape), strict=True))
    values = {name: np.array(study.axes_given[name])[place] for name, place in places.items() if name in _INNER}
    outer = [place for name, place in places.items() if name not in _INNER]
    pipe, relative = np.full((indices.size, 3), np.nan), np.full((indices.size, 3), np.nan)
    stability, failures = np.full((indices.size, 3), -1, dtype="i1"), {}
    waiting = [np.flatnonzero(group) for group in _groups(outer, indices.size)]
    while waiting:
        rows = waiting.pop()
        first = StudyPoint(study, int(indices[rows[0]]))
        try:
            found = _map(first, {name: column[rows] for name, column in values.items()}, rows.size)
            pipe[rows], relative[rows], stability[rows] = found
        except OF_THE_MACHINE:
            raise
        except Exception as error:
            if rows.size == 1:
                failures[int(rows[0])] = _said(error)
            else:  # one of them is to blame
                waiting += np.array_split(rows, 2)
    stable = np.where(stability == 0, pipe, np.nan)
    numbers = {
        "pipe_amplitude": pipe,
        "relative_amplitude": relative,
        "stability": stability,
        "equilibria": np.count_nonzero(stability >= 0, axis=1),
        "stable_equilibria": np.count_nonzero(stability == 0, axis=1),
        "pipe_peak": np.fmax.reduce(pipe, axis=1),
        "stable_pipe_peak": np.fmax.reduce(stable, axis=1),
    }
    return numbers, failures


def _groups(outer: list[np.ndarray], points: int) -> Iterator[np.ndarray]:
    """Which points are alike in all axes but those that a map takes as arrays."""
    if not outer:
        yield np.ones(points, dtype=bool)
        return
    _, group = np.unique(np.array(outer), axis=1, return_inverse=True)
    for number in range(int(group.max()) + 1):
        yield group.ravel() == number


def _map(first: StudyPoint, axes: dict[str, Any], points: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Amplitudes [m] and stability of the equilibria at points that are like the first one but for the axes given."""
    asked = first.study.quantities.slow_flow
    axes.setdefault("detuning", np.full(points, first.place(asked)))
    found = slow_flow_map(first.system, form=first.case.analysis.form, **axes)
    pipe, relative, stability = (
        found[name].values.reshape(-1, 3) for name in ("pipe_amplitude", "relative_amplitude", "stability")
    )
    return pipe, relative, stability


def _largest(values: Any) -> float:
    """Largest of some numbers, NaN if there is none."""
    numbers = np.asarray(values, dtype=float)
    numbers = numbers[~np.isnan(numbers)]
    return float(np.max(numbers)) if numbers.size else float("nan")


def _slow_flow_curve(point: StudyPoint, asked: Any) -> PointResult:
    window: Any = point.place(asked)
    curve = frequency_response(point.system, detuning=window, method="slow-flow", form=point.case.analysis.form)
    return _of_curve(curve, {"saddle_nodes": "saddle-node", "hopfs": "hopf"})


def _exact_curve(point: StudyPoint, asked: Any) -> PointResult:
    harmonics, within = highest_harmonic(point.case.analysis.harmonics), point.asked_range(asked)
    curve = exact_curve(point.system, *within.frequency, harmonics, within.factor)
    return _of_curve(curve, {"saddle_nodes": "saddle-node", "neimark_sackers": "neimark-sacker"})


def _of_curve(curve: ResponseCurve, counted: dict[str, str]) -> PointResult:
    (peak, at), (stable, stable_at) = curve.largest(), curve.largest(stable_only=True)
    omega = float(curve.frequency[0] - curve.detuning[0]) if curve.frequency.size else float("nan")
    data = curve.to_dataset()
    detached = [branch.pipe_peak for branch in curve.branches if branch.detached]
    kinds = [point.kind for point in curve.special_points]
    return PointResult(
        {
            "stable_pipe_peak": stable,
            "stable_peak_detuning": stable_at - omega,
            "pipe_peak": peak,
            "peak_detuning": at - omega,
            "stable_relative_peak": _largest(curve.relative_peak[curve.stable_or_limit]),
            "branches": len(curve.branches),
            "detached_branches": len(detached),
            "detached_pipe_peak": _largest(np.concatenate(detached)) if detached else float("nan"),
            "unstable_ranges": len(unstable_ranges(data)),
            "ranges_without_stable": len(ranges_without_stable_response(data)),
            **{name: kinds.count(kind) for name, kind in counted.items()},
            "verified": not curve.unverified,
        },
        curve.unverified,
    )


def _responses(point: StudyPoint, asked: Any) -> PointResult:
    sigma: Any = point.place(asked)
    found = periodic_responses(point.system, detuning=sigma, harmonics=point.case.analysis.harmonics)
    stable = [response for response in found if response.stable]
    doubts = found.unverified
    residual = max((response.residual for response in found), default=0.0)
    if residual > ROUGH and point.case.analysis.harmonics == "auto":
        doubts += (f"Up to {100 * residual:.3g} % of the forces lie beyond the highest harmonic there is room for.",)
    return PointResult(
        {
            "stable_pipe_peak": _largest([response.pipe_peak for response in stable]),
            "pipe_peak": _largest([response.pipe_peak for response in found]),
            "stable_relative_peak": _largest([response.relative_peak for response in stable]),
            "responses": len(found),
            "stable_responses": len(stable),
            "verified": not doubts,
        },
        doubts,
    )


def _worst(point: StudyPoint, asked: Any) -> PointResult:
    found = worst_over(
        point.system, point.asked_range(asked), samples=asked.samples, min_basin=asked.min_basin, seed=point.seed,
        workers=1,
    )  # fmt: skip
    if Outcome.INTERRUPTED.value in found.unverified:
        raise KeyboardInterrupt
    return PointResult(
        {
            "pipe_peak": found.pipe_peak,
            "relative_peak": found.relative_peak,
            "kind": KINDS.index(found.attractor.kind),
            "basin_fraction": found.attractor.basin_fraction,
            "not_excluded": found.not_excluded,
            "peak_detuning": found.detuning,
            "frequencies": len(found.surveys),
            "verified": found.verified,
        },
        found.unverified,
    )


def _attractors(point: StudyPoint, asked: Any) -> PointResult:
    sigma: Any = point.place(asked)
    found = find_attractors(point.system, detuning=sigma, samples=asked.samples, seed=point.seed, workers=1)
    if found.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    counting = [motion for motion in found if motion.basin_fraction >= asked.min_basin] or list(found)
    worst = max(counting, key=_peak)
    unsettled = [motion for motion in found if motion.kind == "unsettled"]
    doubts = (*found.unsettled(asked.min_basin), *found.unverified)
    return PointResult(
        {
            "pipe_peak": worst.pipe_peak,
            "relative_peak": _largest([motion.relative_peak for motion in counting]),
            "kind": KINDS.index(worst.kind),
            "basin_fraction": worst.basin_fraction,
            "not_excluded": _largest(
                [m.pipe_peak for m in found if m.basin_interval[1] >= asked.min_basin] + [worst.pipe_peak]
            ),
            "motions": len(found) - len(unsettled),
            "unsettled": float(sum(motion.basin_fraction for motion in unsettled)),
            "verified": not doubts,
        },
        doubts,
    )


def _peak(motion: Attractor) -> float:
    return -1.0 if np.isnan(motion.pipe_peak) else motion.pipe_peak


def _fatigue(point: StudyPoint, asked: Any) -> PointResult:
    found = fatigue_damage(point.case, seed=point.seed, workers=1)
    return PointResult(
        {
            "damage_with": found.damage_with,
            "damage_weighted": found.damage_with_weighted,
            "damage_without": found.damage_without,
            "verified": found.verified,
        },
        found.unverified,
    )


_ONE_BY_ONE: dict[tuple[str, bool], Callable[[StudyPoint, Any], PointResult]] = {
    ("slow_flow", True): _slow_flow_curve,
    ("response", True): _exact_curve,
    ("response", False): _responses,
    ("attractors", True): _worst,
    ("attractors", False): _attractors,
    ("fatigue", False): _fatigue,
}
