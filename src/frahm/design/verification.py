"""Tier 3: a finalist against all attractors, under every disturbance, with the force given and with its margin."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from frahm.assessment.climate_mean import climate_mean
from frahm.assessment.counting import counted_band
from frahm.attractors import BESIDE, WorstCase, WorstMotion, joined, worst_over
from frahm.case import Case
from frahm.design.disturbance import Disturbance
from frahm.design.exact import ExcitedMode
from frahm.design.objective import Objective
from frahm.errors import Outcome
from frahm.harmonic_balance import is_linear
from frahm.loads import operating_range
from frahm.systems import build_system

_REFINEMENTS = 4
_FARTHER = 2e-3  # of the frequency
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
    mode : int
        In which of the modes looked at it occurs, 0 being the governing one.
    nominal : tuple of WorstCase
        The worst of the pipe as given in every mode; empty if that was not looked at.
    """

    value: float
    motion: WorstMotion
    disturbance: Disturbance
    mode: int = 0
    nominal: tuple[WorstCase, ...] = ()

    @property
    def pipe_peak(self) -> float:
        """Largest pipe peak [m]."""
        return self.motion.pipe_peak

    @property
    def relative_peak(self) -> float:
        """Largest stroke [m]."""
        return self.motion.relative_peak

    @property
    def pipe_rms(self) -> float:
        """Largest pipe rms [m]."""
        return self.motion.pipe_rms

    @property
    def frequency(self) -> float:
        """Where the pipe peak occurs [rad/s]."""
        return self.motion.frequency

    @property
    def kind(self) -> str:
        """Of the motion that causes the pipe peak."""
        return self.motion.kind

    @property
    def verified(self) -> bool:
        """Whether nothing speaks against it."""
        return self.motion.verified

    @property
    def unverified(self) -> tuple[str, ...]:
        """What speaks against it."""
        return self.motion.unverified


def verification(
    modes: Sequence[ExcitedMode],
    disturbances: Sequence[Disturbance],
    objective: Objective,
    *,
    samples: int,
    seed: int,
    force: float = 1.0,
    min_basin: float = 0.0,
    periods: int | None = None,
    refine: bool = True,
    quick: bool = False,
) -> Verification:
    """Worst case over all attractors under every disturbance; where these are a grid, with more beside the worst one.

    With `quick` special points are looked at from farther away, where motions
    settle sooner.

    Raises
    ------
    KeyboardInterrupt
        If the search was interrupted.
    """
    found: dict[Disturbance, dict[int, WorstCase]] = {}

    def worst_of_mode(mode: ExcitedMode, one: Disturbance) -> WorstCase:
        changed = one.at_force(force).of(mode.system)
        worst = worst_over(
            changed, mode.windows.range(one, changed.reference_frequency), samples=samples, seed=seed,
            min_basin=min_basin, periods=periods, rms=objective.of_rms,
            beside=_FARTHER if quick else BESIDE,
        )  # fmt: skip
        if Outcome.INTERRUPTED.value in worst.unverified:
            raise KeyboardInterrupt
        return worst

    def look(one: Disturbance) -> None:
        found[one] = {
            at: worst_of_mode(mode, one) for at, mode in enumerate(modes) if at == 0 or mode.windows.includes(one)
        }

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
    plain = all(
        replace(one, pipe_frequency=1.0) == Disturbance(lock_in=one.lock_in, others=one.others) for one in disturbances
    )
    return plain and list(disturbances) == sorted(disturbances)


def _beside_worst(found: dict[Disturbance, dict[int, WorstCase]], objective: Objective) -> list[Disturbance]:
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


def _value(worst: dict[int, WorstCase], objective: Objective) -> float:
    """Of the objective, for a pipe in every mode."""
    return max(objective.at_worst(mode) for mode in worst.values())


def _joined(found: dict[Disturbance, dict[int, WorstCase]], objective: Objective) -> Verification:
    grid = sorted(found)
    at = max(grid, key=lambda one: max(mode.pipe_peak for mode in found[one].values()))
    parts = [(one, mode) for one in grid for mode in found[one].values()]
    motions = [replace(mode.motion, unverified=_named(one, mode.unverified)) for one, mode in parts]
    nominal = next(
        (tuple(found[one].values()) for one in grid if replace(one, lock_in=True, others=0) == Disturbance()), ()
    )
    return Verification(
        value=float(objective.over_scatter(np.array([_value(found[one], objective) for one in grid]))),
        motion=joined(motions),
        disturbance=at,
        mode=max(found[at], key=lambda mode: found[at][mode].pipe_peak),
        nominal=nominal,
    )


def _named(one: Disturbance, doubts: Sequence[str]) -> tuple[str, ...]:
    """Doubts with what is off in front."""
    return tuple((f"With {one.text} off: " if one.text else "") + sentence for sentence in doubts)


def climate_verification(
    case: Case, disturbances: Sequence[Disturbance], objective: Objective, *, samples: int, seed: int,
    counted: Sequence[tuple[Case, tuple[float, float]]] = (),
) -> Verification:  # fmt: skip
    """Mean over the wind climate of a case under every disturbance, over all attractors at every wind.

    The damage of other modes, cases that they govern with the winds [m/s] of each, counts besides.
    """
    parts = [(case, None), *counted]
    found = []
    for one in disturbances:
        means = [climate_mean(part, objective.name, samples=samples, seed=seed, changed=one.of, band=band)
                 for part, band in parts]  # fmt: skip
        largest = max(means, key=lambda mean: mean.pipe_peak)
        found.append(replace(
            largest, value=sum(mean.value for mean in means), pipe_rms=max(mean.pipe_rms for mean in means),
            relative_peak=max(mean.relative_peak for mean in means),
            unverified=tuple(dict.fromkeys(doubt for mean in means for doubt in mean.unverified)),
        ))  # fmt: skip
    at = max(range(len(found)), key=lambda i: found[i].pipe_peak)
    doubts = [doubt for one, mean in zip(disturbances, found, strict=True) for doubt in _named(one, mean.unverified)]
    linear = is_linear(build_system(case))
    worst, reference = found[at], disturbances[at].pipe_frequency * case.pipe.frequency
    within = operating_range(case, wind=counted_band(case))
    motion = WorstMotion(
        pipe_peak=worst.pipe_peak, frequency=worst.frequency, detuning=worst.frequency - reference,
        wind_speed=math.nan if counted else float(within.speed(worst.frequency)), kind=worst.kind,
        basin_fraction=math.nan,
        basin_interval=(math.nan, math.nan), relative_peak=max(mean.relative_peak for mean in found),
        relative_frequency=math.nan, pipe_rms=max(mean.pipe_rms for mean in found), rms_frequency=math.nan,
        state=np.empty(0), range=within.text, samples=0 if linear else samples, searched=len(found),
        tier="exact linear response" if linear else "attractor search over the wind climate",
        unverified=tuple(dict.fromkeys(doubts)),
    )  # fmt: skip
    value = float(objective.over_scatter(np.array([mean.value for mean in found])))
    return Verification(value, motion, disturbances[at])
