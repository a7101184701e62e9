"""What a search for branches works with: the system, its scales and its frequencies."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from frahm.absorbers.packed import law_force_and_slopes
from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import CondensedSystem, condense, unknowns
from frahm.harmonic_balance.found import Budget
from frahm.harmonic_balance.quasi_static import searched_window
from frahm.harmonic_balance.seeds import Seeder, seeder_for
from frahm.harmonic_balance.variation import Variation, variation_of
from frahm.systems import System

GOAL = 1e-8
_ROUGH_GOAL = 1e-6  # with stops or friction, whose force harmonics fall off slowly
_AUTO_HARMONICS = 101
LOWEST = 0.02  # of the lower edge of the window: branches are not followed below
_SCALE_FREQUENCIES = 17


@dataclass(frozen=True)
class Search:
    """What a search over one window works with."""

    system: System
    problem: CondensedSystem
    seeder: Seeder
    variation: Variation
    lo: float
    hi: float
    outer: tuple[float, float]
    x_scale: float
    w_scale: float
    harmonics: int | None
    unsearched: tuple[str, ...] = ()
    budget: Budget = field(default_factory=Budget)
    undecided: list[float] = field(default_factory=list)  # Omega near which a detached curve may exist or not

    @property
    def highest(self) -> int:
        """Highest harmonic there is room for."""
        return _AUTO_HARMONICS if self.harmonics is None else self.harmonics

    @property
    def goal(self) -> float:
        """Truncation to reach; infinite when the number of harmonics is the user's."""
        if self.harmonics is not None:
            return math.inf
        return GOAL if self.smooth else _ROUGH_GOAL

    @property
    def smooth(self) -> bool:
        """Whether no element has stops or friction."""
        return all(element.law.is_smooth for element in self.system.elements)

    def size(self, odd: bool) -> int:
        """Length of a stored point."""
        return unknowns(self.problem, self.highest, odd) + 1


def search_over(system: System, lo: float, hi: float, harmonics: int | None, forcing: Floats | None = None) -> Search:
    """Condense the system and set the scales of the search; `forcing` is a factor over Omega, see `forcing_factor`."""
    lo, hi, unsearched = searched_window(system, lo, hi)
    pb = condense(system, forcing)
    grid = np.linspace(lo, hi, _SCALE_FREQUENCIES)
    largest = 0.0
    seeder = seeder_for(pb, grid)
    for W in grid:
        for seed in seeder.at(float(W), 1.0, first_only=True):
            largest = max(largest, *(float(np.max(np.abs(u))) for u in seed.harmonics.values()))
    width = hi - lo
    outer = (max(lo - width, LOWEST * lo), hi + width)
    scale = largest or 1.0
    variation = variation_of(system, *_strongest(pb, scale, hi)) if system.size > 3 else variation_of(system)
    return Search(system, pb, seeder, variation, lo, hi, outer, scale, width, harmonics, unsearched)


def _strongest(pb: CondensedSystem, scale: float, hi: float) -> tuple[float, float]:
    """Largest slope of the elements [N/m] at the largest amplitude expected, and the frequency [rad/s]."""
    z = scale * np.linspace(-1.0, 1.0, 201)
    slopes = [law_force_and_slopes(*row, pb.table, value, 0.0)[1] for row in pb.codes for value in z]
    return float(np.max(np.abs(slopes))), hi
