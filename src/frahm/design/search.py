"""The best design by the closed form of one harmonic, under corrections learnt from the exact equations.

Differential evolution: Storn and Price (1997), doi 10.1023/A:1008202821328.
"""

from __future__ import annotations

import copy
import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.stats import qmc

from frahm.arrays import Floats
from frahm.design.objective import Objective
from frahm.design.screening import Screening, fold_ceilings
from frahm.design.space import CUBIC, LINEAR, DesignSpace
from frahm.design.springs import coil_springs

STROKE, GROWTH, BIRTH, CEILING, SPRINGS, PEAKS = range(6)  # columns of what is judged
_GRID = {2: (72, 72), 3: (24, 30, 26)}
_SOBOL = 2**14  # designs of the first look at more parameters
_SOBOL_OF_GROUPS = 2**11  # the same of several absorbers, whose closed form takes a hundred times as long
_BESIDE, _GENERATIONS_BESIDE = 0.04, 25  # of the cube, and of a search that begins beside what was best before
_ASKED = 2**8  # of these: how many are asked for their detached curves
_CONVERGED, _CONVERGED_GROUPS = 1e-6, 1e-3  # spread of the values over their mean that ends a search
_MEMBERS, _GENERATIONS, _SEED = 36, 80, 1
_STARTS = 8
_RESERVE = 1.05  # on the screened stroke, where springs must fit
_AVOIDED = 0.15  # of the cube: how near a design that failed is not searched again
_APART = 0.08  # of the cube: starts are at least so far from one another


@dataclass(frozen=True, eq=False)
class Corrections:
    """Ratios of exact to screened values, and limits, under which the screening is searched.

    Attributes
    ----------
    peaks : ndarray, shape (R,), or float
        Exact pipe peak over screened amplitude in every row of the conditions of every mode [-].
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
class DesignLimits:
    """What a design must keep.

    Attributes
    ----------
    force_margin : float
        Factor on the force without detached curve [-].
    stroke : float
        [m].
    stable : bool
        Whether every response must be stable.
    room, stress : float, optional
        Free length of a transverse spring [m], and shear stress [Pa] at which coil springs must fit into it.
    """

    force_margin: float
    stroke: float
    stable: bool
    room: float | None = None
    stress: float | None = None

    def filling(self, designs: Floats, stroke: Floats) -> Floats:
        """Share (D,) of their free length that the coils of transverse springs of designs (D, 5 N) take [-]."""
        if self.stress is None:
            return np.zeros(len(designs))
        if designs.shape[1] > 5:
            parts = [designs[:, at : at + 5] for at in range(0, designs.shape[1], 5)]
            return np.asarray(np.max([self.filling(part, stroke) for part in parts], axis=0))
        springs = coil_springs(designs[:, LINEAR], designs[:, CUBIC], stroke, self.room, self.stress)
        there = designs[:, CUBIC] > 0
        return np.divide(springs.solid, springs.free, out=np.zeros(len(designs)), where=there)


@dataclass(eq=False)
class Ledger:
    """What a search has come to: designs judged, where in the cube it is not to look again (d,), and its last best.

    One for a search and all its parts, under whatever limits these are.
    """

    count: int = 0
    avoided: list[Floats] = field(default_factory=list)
    last: Floats | None = None


@dataclass(eq=False)
class ClosedFormSearch:
    """Search over a space; the coarse grid is judged once and used again under other corrections and limits."""

    screening: Screening
    space: DesignSpace
    objective: Objective
    limits: DesignLimits
    ledger: Ledger = field(default_factory=Ledger)
    known: Floats = field(default_factory=lambda: np.empty((0, 5)))  # designs the search starts from besides

    def __post_init__(self) -> None:
        if self.space.count == 1 and self.space.size in _GRID:
            axes = [np.linspace(0.0, 1.0, n) for n in _GRID[self.space.size]]
            self.grid = np.array(list(itertools.product(*axes)))
            self.step = 1.0 / (np.array(_GRID[self.space.size]) - 1)
        else:
            number = _SOBOL if self.space.is_quick else _SOBOL_OF_GROUPS
            self.grid = qmc.Sobol(self.space.size, seed=_SEED).random(number)
            self.step = np.full(self.space.size, number ** (-1 / self.space.size))
        if len(self.known):
            self.grid = np.vstack([self.grid, np.clip(self.space.units(self.known), 0.0, 1.0)])
        designs = self.space.designs(self.grid)
        self.grid_judged = self.judge(designs)

    def judge(self, designs: Floats) -> Floats:
        """Stroke [m], growth [1/s], birth [-], ceiling [m], filling of the springs [-], pipe amplitudes over the force
        [m] in all R rows of every mode, climate means of all disturbances: (D, 5 + R + C).
        """  # noqa: D205
        self.ledger.count += len(designs)
        screening = self.screening
        ceilings = fold_ceilings(screening, designs)
        peaks, others = screening.responses(designs)
        births = self._births(designs, peaks)
        filling = self.limits.filling(designs, _RESERVE * others[:, 0])
        means = screening.climate_means(designs)
        return np.column_stack([others, births, ceilings, filling, peaks / screening.forces, means])

    def _births(self, designs: Floats, peaks: Floats) -> Floats:
        """Least factors (D,) on the force at a birth.

        Of many designs of several absorbers only those with the least responses are asked, for the others are not
        chosen; a search that comes to one of them asks for it then.
        """
        if self.space.count == 1 or len(designs) <= _ASKED:
            return self.screening.births(designs)
        births = np.full(len(designs), np.inf)
        best = np.argsort(np.max(peaks, axis=1), kind="stable")[:_ASKED]
        births[best] = self.screening.births(designs[best])
        return births

    @property
    def peak_columns(self) -> slice:
        """Columns of what is judged that hold the pipe amplitudes."""
        return slice(PEAKS, PEAKS + len(self.screening.forces))

    def peak_rows(self, peaks: Sequence[float]) -> Floats:
        """Exact peaks in the rows of the amplitudes; those of a linear device are the same at every force."""
        modes, disturbances = 1 + len(self.screening.others), len(self.screening.conditions.disturbances)
        by_force = np.reshape(peaks, (modes, -1, disturbances))
        rows = len(self.screening.forces) // (modes * disturbances)
        return np.broadcast_to(by_force, (modes, rows, disturbances)).ravel()

    def peak_ratios(self, peaks: Sequence[float], judged: Floats) -> Floats:
        """Exact peaks over the amplitudes of a judged design; 1 where nothing excites the pipe."""
        screened = judged[self.peak_columns]
        return np.divide(self.peak_rows(peaks), screened, out=np.ones(len(screened)), where=screened > 0)

    def predicted(self, judged: Floats, limits: DesignLimits, corrections: Corrections) -> Floats:
        """Value of the objective expected of judged designs, (D,); infinite where a limit is not kept."""
        birth, stroke, stable, springs = _kept(judged, limits, corrections)
        values = self.values(judged, corrections)
        return np.where(birth & stroke & stable & springs, self.objective.over_scatter(values), np.inf)

    def values(self, judged: Floats, corrections: Corrections) -> Floats:
        """Values of the objective under every disturbance, expected of judged designs (D, ...)."""
        conditions, unstable = self.screening.conditions, judged[:, GROWTH] > 0
        columns = self.peak_columns
        if self.objective.over_climate:
            return self.objective.of_means(judged[:, columns.stop :], unstable)
        # a response that jumps before the force has its margin shows at the larger force
        by_force = (corrections.peaks * judged[:, columns]).reshape(len(judged), -1, len(conditions.disturbances))
        return self.objective.of_peaks(by_force.max(axis=1), unstable, np.nan_to_num(judged[:, CEILING]))

    @property
    def is_asked_beside_1(self) -> bool:
        """Whether it is asked about a factor on the force other than 1, too."""
        return bool(np.any(self.screening.forces != 1))

    def again(self, margin: float) -> ClosedFormSearch:
        """As `reloaded`, for a search of its own that begins where this one came to."""
        other = self.reloaded(margin)
        other.ledger = Ledger(0, list(self.ledger.avoided), self.ledger.last)
        return other

    def reloaded(self, margin: float) -> ClosedFormSearch:
        """The same with another margin on the force, and the grid judged before to start from."""
        other = copy.copy(self)
        other.screening = self.screening.reloaded(margin)
        return other

    def best(self, limits: DesignLimits, corrections: Corrections) -> tuple[Floats, float] | None:
        """Design (5 N,) with the least value expected, and that value; None if no design keeps the limits.

        Differential evolution from the best designs of the grid and the best that lie apart from them.
        """
        from scipy.optimize import differential_evolution

        values = self._allowed(self.grid, self.predicted(self.grid_judged, limits, corrections))
        members, generations = self._members(values), _GENERATIONS
        if self.space.count > 1 and len(members) and self.ledger.last is not None:
            members, generations = self._beside(self.ledger.last, members), _GENERATIONS_BESIDE
        if not len(members):
            return None
        worst = 10.0 * float(np.max(values[np.isfinite(values)]))

        def objective(units: Floats) -> Floats:
            peaks = self.predicted(self.judge(self.space.designs(units.T)), limits, corrections)
            peaks = self._allowed(units.T, peaks)
            return np.where(np.isfinite(peaks), peaks, worst)

        tolerance = _CONVERGED if self.space.is_quick else _CONVERGED_GROUPS
        found = differential_evolution(
            objective, [(0.0, 1.0)] * self.space.size, init=members, maxiter=generations, vectorized=True,
            updating="deferred", polish=False, seed=_SEED, tol=tolerance, mutation=(0.4, 0.9), recombination=0.9,
        )  # fmt: skip
        self.ledger.last = found.x
        return self.space.designs(found.x[None])[0], float(found.fun)

    def _beside(self, last: Floats, members: Floats) -> Floats:
        """Population of a search whose corrections have changed a little: half of it beside what was best before."""
        count = len(members) // 2
        near = last + np.random.default_rng(_SEED).normal(0.0, _BESIDE, (count, len(last)))
        near[0] = last
        return np.clip(np.vstack([near, members[: len(members) - count]]), 0.0, 1.0)

    def avoid(self, design: Floats) -> None:
        """Search no longer near a design (5 N,), because it was found worse than it looked."""
        self.ledger.avoided.append(self.space.units(design[None])[0])

    def _allowed(self, units: Floats, values: Floats) -> Floats:
        """Values (D,) at points (D, d) of the unit cube; infinite near those avoided."""
        for point in self.ledger.avoided:
            values = np.where(np.max(np.abs(units - point), axis=1) < _AVOIDED, np.inf, values)
        return values

    def binding(self, limits: DesignLimits) -> str:
        """Which limit leaves no design: the one without which most designs remain."""
        birth, stroke, stable, springs = _kept(self.grid_judged, limits, Corrections())
        tests = {
            f"no detached curve up to {limits.force_margin:g} times the force": birth,
            f"stroke at most {limits.stroke:g} m": stroke,
            "a stable response everywhere": stable,
            f"coil springs of {(limits.stress or 0) / 1e6:g} MPa that fit into their length": springs,
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
        members = self.grid[np.resize(chosen, _MEMBERS)]
        off = np.random.default_rng(_SEED).uniform(-0.7, 0.7, members.shape) * self.step
        off[: len(chosen)] *= 0.3  # where few designs keep the limits, the copies of them must differ
        off[0] = 0.0
        return np.asarray(np.clip(members + off, 0.0, 1.0))


def _kept(judged: Floats, limits: DesignLimits, corrections: Corrections) -> tuple[np.ndarray, ...]:
    birth = judged[:, BIRTH] * corrections.birth >= limits.force_margin
    stroke = judged[:, STROKE] * corrections.stroke <= limits.stroke
    stable = judged[:, GROWTH] <= -corrections.damping if limits.stable else np.ones(len(judged), bool)
    return birth, stroke, stable, judged[:, SPRINGS] <= 1.0
