"""The best design by the closed form of one harmonic, under corrections learnt from the exact equations."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.design.screening import Screening, fold_ceilings
from frahm.design.space import DesignSpace

_GRID = {2: (72, 72), 3: (24, 30, 26)}
_STARTS = 6
_APART = 0.08  # of the cube: starts are at least so far from one another
_ROUNDS, _SHRINK = 16, 0.62
_POINTS = {2: 5, 3: 4}
_MODULATED = 1.08  # modulated peaks over the larger of the periodic one and the ceiling of the slow manifold


@dataclass(frozen=True)
class Corrections:
    """Ratios of exact to screened values, and limits, under which the screening is searched.

    Attributes
    ----------
    peak : float
        Exact pipe peak over screened amplitude [-].
    stroke : float
        Exact stroke over screened amplitude [-].
    birth : float
        Exact birth factor over screened one [-].
    damping : float
        Least decay rate asked of the screened responses [1/s] where they must be stable; minus infinity where not.
    """

    peak: float = 1.0
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
        """Amplitude of the pipe [m] and of the absorber [m], growth [1/s], birth factor [-], ceiling [m]: (D, 5)."""
        self.count += len(designs)
        screening = self.screening
        births, ceilings = screening.births(designs), fold_ceilings(screening, designs)
        return np.column_stack([screening.responses(designs), births, ceilings])

    def best(self, limits: Limits, corrections: Corrections) -> tuple[Floats, float] | None:
        """Design (4,) with the least predicted pipe peak [m], and that peak; None if no design keeps the limits."""
        values = predicted_peaks(self.grid_judged, limits, corrections)
        best: tuple[Floats, float] | None = None
        for start in self._starts(values):
            unit, value = self._zoomed(start, limits, corrections)
            if best is None or value < best[1]:
                best = self.space.designs(unit[None])[0], value
        return best

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

    def _starts(self, values: Floats) -> list[Floats]:
        chosen: list[Floats] = []
        for index in np.argsort(values, kind="stable"):
            if not np.isfinite(values[index]) or len(chosen) == _STARTS:
                break
            point = self.grid[index]
            if all(np.max(np.abs(point - other)) > _APART for other in chosen):
                chosen.append(point)
        return chosen

    def _zoomed(self, start: Floats, limits: Limits, corrections: Corrections) -> tuple[Floats, float]:
        """Grids around the best point so far, ever finer; they do not mind edges and jumps of what they search."""
        d = self.space.size
        half = 1.5 / (np.array(_GRID[d]) - 1)
        offsets = np.array(list(itertools.product(np.linspace(-1, 1, _POINTS[d]), repeat=d)))
        best, value = start, math.inf
        for _ in range(_ROUNDS):
            points = np.clip(np.vstack([best, best + offsets * half]), 0.0, 1.0)
            values = predicted_peaks(self.judge(self.space.designs(points)), limits, corrections)
            at = int(np.argmin(values))
            moved = at > 0 and values[at] < value
            best, value = points[at], float(values[at])
            half = half * (0.9 if moved and np.max(np.abs(offsets[at - 1])) == 1 else _SHRINK)
        return best, value


def _kept(judged: Floats, limits: Limits, corrections: Corrections) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    birth = judged[:, 3] * corrections.birth >= limits.force_margin
    stroke = judged[:, 1] * corrections.stroke <= limits.stroke
    stable = judged[:, 2] <= -corrections.damping if limits.stable else np.ones(len(judged), bool)
    return birth, stroke, stable


def predicted_peaks(judged: Floats, limits: Limits, corrections: Corrections) -> Floats:
    """Predicted worst pipe peak [m] of judged designs (D, 5); infinite where a limit is not kept.

    Where a response is unstable, the modulated motion that takes its place is expected a little above the larger of
    the periodic response and the ceiling of the slow manifold.
    """
    birth, stroke, stable = _kept(judged, limits, corrections)
    peak = corrections.peak * judged[:, 0]
    ceiling = np.where(np.isfinite(judged[:, 4]), judged[:, 4], 0.0)
    unstable = judged[:, 2] > 0
    peak = np.where(unstable, _MODULATED * np.maximum(peak, ceiling), peak)
    return np.where(birth & stroke & stable, peak, np.inf)
