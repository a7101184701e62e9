"""Tier 3: a finalist against all attractors, under every disturbance, with the force given and with its margin."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from frahm.assessment.climate_mean import climate_mean
from frahm.attractors import WorstCase, find_attractors
from frahm.attractors.worst import worst_over
from frahm.case import Case
from frahm.design.disturbance import Disturbance
from frahm.design.exact import Windows, exact_judgement
from frahm.design.objective import Objective
from frahm.errors import Outcome
from frahm.harmonic_balance import is_linear
from frahm.response import ResponseCurve
from frahm.systems import System, build_system, with_parameters

_REFINEMENTS = 4
_MOST_POINTS = 6  # special points looked at on both sides in a glimpse, the largest first
_BESIDE = 3e-3
_CLOSE = 0.006  # frequency errors nearer than this are one


@dataclass(frozen=True)
class Verification:
    """The worst of all attractors of one design.

    Attributes
    ----------
    value : float
        Of the objective, see `Objective`.
    pipe_peak, relative_peak, pipe_rms : float
        Largest over all attractors, frequencies and disturbances [m].
    disturbance : Disturbance
    frequency : float
        Where the pipe peak occurs.
    kind : str
        Of the attractor that causes it.
    verified : bool
    unverified : tuple of str
        What speaks against it.
    samples : int
        Initial states per frequency; 0 where the equations are linear and the response is unique.
    searched : int
        Frequencies searched, all disturbances together.
    tier : str
        What the numbers rest on.
    """

    value: float
    pipe_peak: float
    relative_peak: float
    pipe_rms: float
    disturbance: Disturbance
    frequency: float
    kind: str
    verified: bool
    unverified: tuple[str, ...]
    samples: int
    searched: int
    tier: str


def verification(
    system: System,
    windows: Windows,
    disturbances: Sequence[Disturbance],
    objective: Objective,
    *,
    samples: int,
    seed: int,
    force: float = 1.0,
    min_basin: float = 0.01,
    periods: int = 3000,
    refine: bool = True,
) -> Verification:
    """Worst case over all attractors under every disturbance; where these are a grid, with more beside the worst one.

    Raises
    ------
    KeyboardInterrupt
        If the search was interrupted.
    """
    if is_linear(system):
        return _linear(system, windows, disturbances, objective, force)
    found: dict[Disturbance, WorstCase] = {}

    def look(one: Disturbance) -> None:
        window, _ = windows.at(one)
        worst = worst_over(
            one.at_force(force).of(system), *window, windows.axis, samples=samples, seed=seed, min_basin=min_basin,
            periods=periods, rms=objective.name == "rms",
        )  # fmt: skip
        if Outcome.INTERRUPTED.value in worst.unverified:
            raise KeyboardInterrupt
        found[one] = worst

    for one in disturbances:
        look(one)
    for _ in range(_REFINEMENTS if refine and is_grid(disturbances) else 0):
        middles = _beside_worst(found, objective)
        if not middles:
            break
        for one in middles:
            look(one)
    return _joined(found, objective, samples)


def is_grid(disturbances: Sequence[Disturbance]) -> bool:
    """Whether they differ in the frequency of the pipe alone, on both sides of the nominal one, and ascend."""
    if len(disturbances) < 2:
        return False
    plain = all(replace(one, pipe_frequency=1.0) == Disturbance(lock_in=one.lock_in) for one in disturbances)
    return plain and list(disturbances) == sorted(disturbances)


def glimpse(
    system: System, windows: Windows, disturbance: Disturbance, objective: Objective, *, samples: int, seed: int,
    periods: int,
) -> Verification:  # fmt: skip
    """Worst of few frequencies under one disturbance: all periodic responses, and attractors where the worst may be.

    Attractors are looked for at the largest stable responses, beside the special points and in the middle of unstable
    ranges. Cheaper than `verification` and less sure: for tables.

    Raises
    ------
    KeyboardInterrupt
        If the search was interrupted.
    """
    if is_linear(system):
        return _linear(system, windows, [disturbance], objective, 1.0)
    window, _ = windows.at(disturbance)
    changed = disturbance.of(system)
    curve = windows.curve(system, disturbance)
    inside = (curve.frequency >= window[0]) & (curve.frequency <= window[1])
    best, doubts = None, list(curve.unverified)
    places = _telling_frequencies(curve, inside)
    rms = 0.0
    for frequency in places:
        driven = (
            changed if windows.axis is None else with_parameters(changed, force=windows.axis.lift_factor(frequency))
        )
        found = find_attractors(driven, frequency=frequency, samples=samples, seed=seed, periods=periods)
        if found.outcome is Outcome.INTERRUPTED:
            raise KeyboardInterrupt
        for attractor in found:
            if attractor.kind == "unsettled":
                doubts.append(f"Some motions did not settle at Omega = {frequency:.6g} rad/s.")
            rms = max(rms, attractor.pipe_rms)
            if best is None or attractor.pipe_peak > best.pipe_peak:
                best = attractor
    stable = inside & curve.stable
    periodic = float(np.max(curve.pipe_peak[stable], initial=0.0))
    stroke = float(np.max(curve.relative_peak[stable], initial=0.0))
    if best is None or best.pipe_peak < periodic:
        at = int(np.argmax(np.where(stable, curve.pipe_peak, -1.0)))
        peak, kind, frequency = periodic, "periodic", float(curve.frequency[at])
    else:
        peak, kind, frequency = best.pipe_peak, best.kind, best.frequency
        stroke = max(stroke, best.relative_peak)
    rms = max(rms, periodic / math.sqrt(2))
    return Verification(
        rms if objective.name == "rms" else peak, peak, stroke, rms, disturbance, frequency, kind, not doubts,
        tuple(dict.fromkeys(doubts)), samples, len(places), "attractors at few frequencies",
    )  # fmt: skip


def _telling_frequencies(curve: ResponseCurve, inside: np.ndarray) -> list[float]:
    """Frequencies at which the worst attractor of a response curve is likely, no two nearer than 0.2 %."""
    wanted: list[float] = []
    for branch in np.unique(curve.branch[inside]):
        here = np.flatnonzero(inside & (curve.branch == branch))
        for state in (True, False):
            part = here[curve.stable[here] == state]
            if part.size:
                wanted.append(float(curve.frequency[part[np.argmax(curve.pipe_peak[part])]]))
                if not state:
                    ends = curve.frequency[part].min(), curve.frequency[part].max()
                    wanted += [float(W) for W in np.linspace(*ends, 5)[1:-1]]
    lo, hi = curve.frequency[inside].min(), curve.frequency[inside].max()
    for point in sorted(curve.special_points, key=lambda point: -point.pipe_peak)[:_MOST_POINTS]:
        wanted += [point.frequency * (1 - _BESIDE), point.frequency * (1 + _BESIDE)]
    chosen: list[float] = []
    for W in wanted:
        if lo <= W <= hi and all(abs(W / other - 1) > 2e-3 for other in chosen):
            chosen.append(W)
    return sorted(chosen)


def _beside_worst(found: dict[Disturbance, WorstCase], objective: Objective) -> list[Disturbance]:
    """Middles of the gaps beside the worst frequency of the pipe."""
    grid = sorted(found)
    at = max(range(len(grid)), key=lambda i: _value(found[grid[i]], objective))
    neighbours = [grid[i] for i in (at - 1, at + 1) if 0 <= i < len(grid)]
    here = grid[at].pipe_frequency
    return [
        replace(grid[at], pipe_frequency=0.5 * (here + other.pipe_frequency))
        for other in neighbours
        if abs(here - other.pipe_frequency) > _CLOSE
    ]


def _value(worst: WorstCase, objective: Objective) -> float:
    return worst.pipe_rms if objective.name == "rms" else worst.pipe_peak


def _joined(found: dict[Disturbance, WorstCase], objective: Objective, samples: int) -> Verification:
    grid = sorted(found)
    at = max(grid, key=lambda one: found[one].pipe_peak)
    worst = found[at]
    doubts = tuple(
        dict.fromkeys(
            (f"With {one.text} off: " if one.text else "") + sentence
            for one in grid
            for sentence in found[one].unverified
        )
    )
    return Verification(
        value=float(objective.over_scatter(np.array([_value(found[one], objective) for one in grid]))),
        pipe_peak=worst.pipe_peak,
        relative_peak=max(item.relative_peak for item in found.values()),
        pipe_rms=max(item.pipe_rms for item in found.values()),
        disturbance=at,
        frequency=worst.frequency,
        kind=worst.attractor.kind,
        verified=not doubts and math.isfinite(worst.pipe_peak),
        unverified=doubts,
        samples=samples,
        searched=sum(len(item.surveys) for item in found.values()),
        tier="attractor search",
    )


def _linear(
    system: System, windows: Windows, disturbances: Sequence[Disturbance], objective: Objective, force: float
) -> Verification:
    """A damped linear system has one response, which attracts every motion: the exact curve is the proof."""
    conditions = list(disturbances)
    if is_grid(conditions):
        ends = conditions[0].pipe_frequency, conditions[-1].pipe_frequency
        fine = np.linspace(*ends, 4 * len(conditions) - 3)
        conditions = [replace(conditions[0], pipe_frequency=float(r)) for r in fine]
    looks = [exact_judgement(system, windows, [one], (force,)) for one in conditions]
    worst = max(looks, key=lambda look: look.pipe_peak)
    doubts = tuple(dict.fromkeys(doubt for look in looks for doubt in look.unverified))
    doubts += () if all(look.growth_rate < 0 for look in looks) else ("The linear response is not stable.",)
    rms = worst.pipe_peak / math.sqrt(2)
    scale = 1 / math.sqrt(2) if objective.name == "rms" else 1.0
    value = scale * float(objective.over_scatter(np.array([look.pipe_peak for look in looks])))
    return Verification(
        value, worst.pipe_peak, max(look.relative_peak for look in looks), rms, worst.disturbance, worst.frequency,
        "periodic", not doubts, doubts, 0, len(conditions), "exact linear response",
    )  # fmt: skip


def climate_verification(
    case: Case, disturbances: Sequence[Disturbance], objective: Objective, *, samples: int, seed: int
) -> Verification:
    """Mean over the wind climate of a case under every disturbance, over all attractors at every wind."""
    found = [climate_mean(case, objective.name, samples=samples, seed=seed, changed=one.of) for one in disturbances]
    at = max(range(len(found)), key=lambda i: found[i].pipe_peak)
    doubts = tuple(
        dict.fromkeys(
            (f"With {one.text} off: " if one.text else "") + sentence
            for one, mean in zip(disturbances, found, strict=True)
            for sentence in mean.unverified
        )
    )
    linear = is_linear(build_system(case))
    return Verification(
        value=float(objective.over_scatter(np.array([mean.value for mean in found]))),
        pipe_peak=found[at].pipe_peak,
        relative_peak=max(mean.relative_peak for mean in found),
        pipe_rms=max(mean.pipe_rms for mean in found),
        disturbance=disturbances[at],
        frequency=found[at].frequency,
        kind=found[at].kind,
        verified=not doubts,
        unverified=doubts,
        samples=0 if linear else samples,
        searched=len(found),
        tier="exact linear response" if linear else "attractor search over the wind climate",
    )
