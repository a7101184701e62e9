"""Tier 3: a finalist against all attractors, under every disturbance, with the force given and with its margin."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from frahm.assessment.climate_mean import climate_mean
from frahm.assessment.fatigue import counted_band
from frahm.attractors import WorstCase, WorstMotion, find_attractors, joined, worst_over
from frahm.case import Case
from frahm.design.disturbance import Disturbance
from frahm.design.exact import Windows
from frahm.design.objective import Objective
from frahm.errors import Outcome
from frahm.harmonic_balance import is_linear
from frahm.loads import operating_range
from frahm.response import ResponseCurve
from frahm.systems import System, build_system, with_parameters

_REFINEMENTS = 4
_MOST_POINTS = 6  # special points looked at on both sides in a glimpse, the largest first
_BESIDE = 3e-3
_CLOSE = 0.006  # frequency errors nearer than this are one


@dataclass(frozen=True, eq=False)
class Verification:
    """The worst of all attractors of one design.

    Attributes
    ----------
    value : float
        Of the objective, see `Objective`.
    motion : WorstMotion
        Largest over all attractors, frequencies and disturbances, every doubt included.
    disturbance : Disturbance
        Under which it occurs.
    nominal : WorstCase or None
        The worst of the pipe as given, if that was looked at.
    """

    value: float
    motion: WorstMotion
    disturbance: Disturbance
    nominal: WorstCase | None = None

    @property
    def pipe_peak(self) -> float:
        """Largest pipe peak [m]."""
        return self.motion.pipe_peak

    @property
    def relative_peak(self) -> float:
        """Largest stroke [m]."""
        return self.motion.relative_peak

    @property
    def verified(self) -> bool:
        """Whether nothing speaks against it."""
        return self.motion.verified

    @property
    def unverified(self) -> tuple[str, ...]:
        """What speaks against it."""
        return self.motion.unverified


def verification(
    system: System,
    windows: Windows,
    disturbances: Sequence[Disturbance],
    objective: Objective,
    *,
    samples: int,
    seed: int,
    force: float = 1.0,
    min_basin: float = 0.0,
    periods: int = 3000,
    refine: bool = True,
) -> Verification:
    """Worst case over all attractors under every disturbance; where these are a grid, with more beside the worst one.

    Raises
    ------
    KeyboardInterrupt
        If the search was interrupted.
    """
    found: dict[Disturbance, WorstCase] = {}

    def look(one: Disturbance) -> None:
        changed = one.at_force(force).of(system)
        worst = worst_over(
            changed, windows.range(one, changed.reference_frequency), samples=samples, seed=seed,
            min_basin=min_basin, periods=periods, rms=objective.name == "rms",
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
    return _joined(found, objective)


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
        return verification(system, windows, [disturbance], objective, samples=samples, seed=seed)
    window, _ = windows.at(disturbance)
    changed = disturbance.of(system)
    within = windows.range(disturbance, changed.reference_frequency)
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
    peak, kind, frequency, state = periodic, "periodic", math.nan, np.empty(0)
    if stable.any():
        frequency = float(curve.frequency[int(np.argmax(np.where(stable, curve.pipe_peak, -1.0)))])
    chance, interval = 0.0, (0.0, 1.0)
    if best is not None and not best.pipe_peak < periodic:
        peak, kind, frequency, state = best.pipe_peak, best.kind, best.frequency, best.representative_state
        chance, interval, stroke = best.basin_fraction, best.basin_interval, max(stroke, best.relative_peak)
    rms = max(rms, periodic / math.sqrt(2))
    motion = WorstMotion(
        pipe_peak=peak, frequency=frequency, detuning=frequency - changed.reference_frequency,
        wind_speed=float(within.speed(frequency)) if math.isfinite(frequency) else math.nan, kind=kind,
        basin_fraction=chance, basin_interval=interval, relative_peak=stroke, relative_frequency=frequency,
        pipe_rms=rms, rms_frequency=frequency, state=state, range=within.text, tier="attractors at few frequencies",
        samples=samples, searched=len(places), unverified=tuple(dict.fromkeys(doubts)),
    )  # fmt: skip
    return Verification(rms if objective.name == "rms" else peak, motion, disturbance)


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


def _joined(found: dict[Disturbance, WorstCase], objective: Objective) -> Verification:
    grid = sorted(found)
    at = max(grid, key=lambda one: found[one].pipe_peak)
    motions = [replace(found[one].motion, unverified=_named(one, found[one].unverified)) for one in grid]
    nominal = next((found[one] for one in grid if replace(one, lock_in=True) == Disturbance()), None)
    return Verification(
        value=float(objective.over_scatter(np.array([_value(found[one], objective) for one in grid]))),
        motion=joined(motions),
        disturbance=at,
        nominal=nominal,
    )


def _named(one: Disturbance, doubts: Sequence[str]) -> tuple[str, ...]:
    """Doubts with what is off in front."""
    return tuple((f"With {one.text} off: " if one.text else "") + sentence for sentence in doubts)


def climate_verification(
    case: Case, disturbances: Sequence[Disturbance], objective: Objective, *, samples: int, seed: int
) -> Verification:
    """Mean over the wind climate of a case under every disturbance, over all attractors at every wind."""
    found = [climate_mean(case, objective.name, samples=samples, seed=seed, changed=one.of) for one in disturbances]
    at = max(range(len(found)), key=lambda i: found[i].pipe_peak)
    doubts = [doubt for one, mean in zip(disturbances, found, strict=True) for doubt in _named(one, mean.unverified)]
    linear = is_linear(build_system(case))
    worst, reference = found[at], disturbances[at].pipe_frequency * case.pipe.frequency
    within = operating_range(case, wind=counted_band(case))
    motion = WorstMotion(
        pipe_peak=worst.pipe_peak, frequency=worst.frequency, detuning=worst.frequency - reference,
        wind_speed=float(within.speed(worst.frequency)), kind=worst.kind, basin_fraction=math.nan,
        basin_interval=(math.nan, math.nan), relative_peak=max(mean.relative_peak for mean in found),
        relative_frequency=math.nan, pipe_rms=max(mean.pipe_rms for mean in found), rms_frequency=math.nan,
        state=np.empty(0), range=within.text, samples=0 if linear else samples, searched=len(found),
        tier="exact linear response" if linear else "attractor search over the wind climate",
        unverified=tuple(dict.fromkeys(doubts)),
    )  # fmt: skip
    value = float(objective.over_scatter(np.array([mean.value for mean in found])))
    return Verification(value, motion, disturbances[at])
