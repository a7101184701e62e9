"""The best design by the closed form of one harmonic, under corrections learnt from the exact equations."""

from __future__ import annotations

import copy
import dataclasses
import itertools
import math
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.design.screening import Screening, fold_ceilings
from frahm.design.space import DesignSpace

STROKE, GROWTH, BIRTH, CEILING, PEAKS = 0, 1, 2, 3, 4  # columns of what is judged
_GRID = {2: (72, 72), 3: (24, 30, 26)}
_MEMBERS, _GENERATIONS, _SEED = 36, 80, 1
_STARTS = 8
_APART = 0.08  # of the cube: starts are at least so far from one another
_MODULATED = 1.08  # modulated peaks over the larger of the periodic one and the ceiling of the slow manifold


@dataclass(frozen=True, eq=False)
class Corrections:
    """Ratios of exact to screened values, and limits, under which the screening is searched.

    Attributes
    ----------
    peaks : ndarray, shape (R,), or float
        Exact pipe peak over screened amplitude at every frequency error [-].
    stroke : float
        Exact stroke over screened amplitude [-].
    birth : float
        Exact birth factor over screened one [-].
    damping : float
        Least decay rate asked of the screened responses [1/s] where they must be stable; minus infinity where not.
    """

    peaks: Floats | float = 1.0
    stroke: float = 1.0
    birth: float = 1.0
    damping: float = -math.inf


@dataclass(frozen=True)
class Limits:
    """What a design must keep: the force margin [-], the stroke [m] and whether it must be stable everywhere."""

    force_margin: float
    stroke: float
    stable: bool


@dataclass(eq=False)
class TierOne:
    """Search over a space; the coarse grid is judged once and used again under other corrections and limits."""

    screening: Screening
    space: DesignSpace
    count: int = 0

    def __post_init__(self) -> None:
        axes = [np.linspace(0.0, 1.0, n) for n in _GRID[self.space.size]]
        self.grid = np.array(list(itertools.product(*axes)))
        designs = self.space.designs(self.grid)
        self.grid_judged = self.judge(designs)

    def judge(self, designs: Floats) -> Floats:
        """Stroke [m], growth [1/s], birth [-], ceiling [m], then pipe amplitudes over the force [m]: (D, 4 + R)."""
        self.count += len(designs)
        screening = self.screening
        births, ceilings = screening.births(designs), fold_ceilings(screening, designs)
        peaks, others = screening.responses(designs)
        return np.column_stack([others, births, ceilings, peaks / screening.conditions.forces])

    def reloaded(self, margin: float) -> TierOne:
        """The same with another margin on the force, and the grid judged before to start from."""
        other = copy.copy(self)
        conditions = self.screening.conditions.reloaded(margin)
        other.screening = dataclasses.replace(self.screening, conditions=conditions)
        return other

    def best(self, limits: Limits, corrections: Corrections) -> tuple[Floats, float] | None:
        """Design (4,) with the least predicted pipe peak [m], and that peak; None if no design keeps the limits.

        Differential evolution from the best designs of the grid and the best that lie apart from them.
        """
        from scipy.optimize import differential_evolution

        values = predicted_peaks(self.grid_judged, limits, corrections)
        members = self._members(values)
        if not len(members):
            return None
        worst = 10.0 * float(np.max(values[np.isfinite(values)]))

        def objective(units: Floats) -> Floats:
            peaks = predicted_peaks(self.judge(self.space.designs(units.T)), limits, corrections)
            return np.where(np.isfinite(peaks), peaks, worst)

        found = differential_evolution(
            objective, [(0.0, 1.0)] * self.space.size, init=members, maxiter=_GENERATIONS, vectorized=True,
            updating="deferred", polish=False, seed=_SEED, tol=1e-6, mutation=(0.4, 0.9), recombination=0.9,
        )  # fmt: skip
        return self.space.designs(found.x[None])[0], float(found.fun)

    def binding(self, limits: Limits) -> str:
        """Which limit leaves no design: the one without which most designs remain."""
        birth, stroke, stable = _kept(self.grid_judged, limits, Corrections())
        tests = {
            f"no detached curve up to {limits.force_margin:g} times the force": birth,
            f"stroke at most {limits.stroke:g} m": stroke,
            "a stable response everywhere": stable,
        }
        left = {
            name: int(np.sum(np.logical_and.reduce([t for other, t in tests.items() if other != name])))
            for name in tests
        }
        return max(left, key=lambda name: left[name])

    def _members(self, values: Floats) -> Floats:
        """First population: the best designs of the grid, a little off it, and the best that lie apart."""
        order = [int(i) for i in np.argsort(values, kind="stable") if np.isfinite(values[i])]
        if not order:
            return np.empty((0, self.space.size))
        chosen: list[int] = []
        for index in order:
            if len(chosen) == _STARTS:
                break
            if all(np.max(np.abs(self.grid[index] - self.grid[other])) > _APART for other in chosen):
                chosen.append(index)
        chosen += [index for index in order[:_MEMBERS] if index not in chosen][: _MEMBERS - len(chosen)]
        step = 1.0 / (np.array(_GRID[self.space.size]) - 1)
        members = self.grid[np.resize(chosen, _MEMBERS)]
        off = np.random.default_rng(_SEED).uniform(-0.7, 0.7, members.shape) * step
        off[: len(chosen)] *= 0.3  # where few designs keep the limits, the copies of them must differ
        off[0] = 0.0
        return np.asarray(np.clip(members + off, 0.0, 1.0))


def _kept(judged: Floats, limits: Limits, corrections: Corrections) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    birth = judged[:, BIRTH] * corrections.birth >= limits.force_margin
    stroke = judged[:, STROKE] * corrections.stroke <= limits.stroke
    stable = judged[:, GROWTH] <= -corrections.damping if limits.stable else np.ones(len(judged), bool)
    return birth, stroke, stable


def predicted_peaks(judged: Floats, limits: Limits, corrections: Corrections) -> Floats:
    """Predicted worst pipe peak [m] of judged designs (D, 4 + R); infinite where a limit is not kept.

    Where a response is unstable, the modulated motion that takes its place is expected a little above the larger of
    the periodic response and the ceiling of the slow manifold.
    """
    birth, stroke, stable = _kept(judged, limits, corrections)
    peak = np.max(corrections.peaks * judged[:, PEAKS:], axis=1)
    ceiling = np.nan_to_num(judged[:, CEILING])
    unstable = judged[:, GROWTH] > 0
    peak = np.where(unstable, _MODULATED * np.maximum(peak, ceiling), peak)
    return np.where(birth & stroke & stable, peak, np.inf)
