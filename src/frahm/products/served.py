"""A member that needs an absorber: its utilisation with any device, in closed form, and with one, verified."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.assessment import utilisations
from frahm.case import Case
from frahm.design import (
    DesignedAbsorber,
    DesignSettings,
    DesignSpace,
    Objective,
    Problem,
    Screening,
    design_space,
    with_design,
)
from frahm.screening import ScreenedMember

GROWTH = 1  # column of the largest growth rate in `Screening.responses`; the other is the stroke
SIZES = ("pipe_peak", "stress_range", "relative_peak", "utilisation_with")


@dataclass(frozen=True, eq=False)
class ServedMember:
    """A member of a platform on which devices are tried.

    Devices are rows (D, 5) in SI units: m [kg], k1 [N/m], k3 [N/m^3], c [N s/m], k5 [N/m^5].

    Attributes
    ----------
    screened : ScreenedMember
        How it is judged without an absorber.
    most_mass : float
        Heaviest absorber it may carry [kg].
    problem : Problem
        Its winds, as `frahm.design_absorber` sees them.
    screening : Screening
        Its closed form.
    force_margin : float
        Factor on the force up to which no detached curve may exist [-].
    shares : ndarray, shape (L, 4)
        Utilisation of every limit by a unit of each of `SIZES`.
    base : ndarray, shape (L,)
        Utilisation of every limit at rest.
    stress : ndarray, shape (R,)
        Stress range by a unit of motion in every row of the screening [Pa/m].
    """

    screened: ScreenedMember
    most_mass: float
    problem: Problem
    screening: Screening
    force_margin: float
    shares: Floats
    base: Floats
    stress: Floats

    @property
    def name(self) -> str:
        """As in the table."""
        return self.screened.name

    @property
    def case(self) -> Case:
        """The member without an absorber."""
        return self.screened.case

    @property
    def frequency(self) -> float:
        """Natural frequency [rad/s]."""
        return float(self.case.pipe.frequency)

    def carries(self, devices: Floats) -> np.ndarray:
        """Which devices (D, 5) are not too heavy for it, (D,)."""
        return np.asarray(devices[:, 0] <= self.most_mass * (1 + 1e-9))

    def utilisation(self, devices: Floats) -> Floats:
        """Largest utilisation of a limit with each device (D, 5), by the closed form of one harmonic, (D,).

        Every root of every response counts. Infinite where the device is too heavy or a detached curve exists below
        the margin of the force.
        """
        found, allowed = np.full(len(devices), np.inf), self.carries(devices)
        if np.any(allowed):
            found[allowed] = self._utilisation(devices[allowed])
        return found

    def births(self, devices: Floats) -> Floats:
        """Factor on the force at which a detached curve is born (D,); infinite where none is."""
        return self.screening.births(devices)

    def _utilisation(self, devices: Floats) -> Floats:
        peaks, others = self.screening.responses(devices)
        unstable, none = others[:, GROWTH] > 0, np.zeros(len(devices))
        motions = Objective("peak").of_peaks(peaks / self.screening.forces, unstable, none)
        means = self.screening.climate_means(devices)
        damage = Objective("damage").of_means(means, unstable).max(axis=1) if means.shape[1] else none
        factor = 1.0 if self.case.fatigue is None else self.case.fatigue.design_fatigue_factor
        sizes = np.array([motions.max(axis=1), (self.stress * motions).max(axis=1), others[:, 0], factor * damage])
        used = np.max(self.base[:, None] + self.shares @ sizes, axis=0)
        return np.where(self.births(devices) >= self.force_margin, used, np.inf)

    def with_device(self, device: Floats) -> Case:
        """The member as a case, with a device (5,)."""
        return with_design(self.case, DesignedAbsorber(*(device / self.case.pipe.mass).tolist()))

    def space(self, family: str, mass: float) -> DesignSpace:
        """Devices of a family and a mass [kg] that may suit it, as `frahm.design_absorber` would look for them."""
        ratio = min(mass / self.case.pipe.mass, 1.0)
        settings = DesignSettings(family=family, mass_ratio=ratio, force_margin=self.force_margin)
        return design_space(self.screening.host, self.case.pipe.mass, family, settings)


def served_member(screened: ScreenedMember, mass_ratio: float, force_margin: float) -> ServedMember:
    """A member on which devices up to a mass ratio are tried."""
    case = screened.case
    objective = "peak" if case.fatigue is None or case.climate is None else "damage"
    settings = DesignSettings(objective=objective, mass_ratio=mass_ratio, force_margin=force_margin)
    problem = Problem.of(case, settings)
    screening = problem.screening(sorted({1.0, force_margin}))
    base, shares = _limits(screened)
    stress = np.concatenate([
        np.full(len(part.conditions.forces), _stress_by_motion(screened, mode))
        for part, mode in zip((screening, *screening.others), _modes(problem), strict=True)
    ])  # fmt: skip
    return ServedMember(screened, mass_ratio * case.pipe.mass, problem, screening, force_margin, shares, base, stress)


def _modes(problem: Problem) -> list[int]:
    return [problem.case.pipe.governing_mode, *(mode for mode, _, _ in problem.others)]


def _stress_by_motion(screened: ScreenedMember, mode: int) -> float:
    """Stress range over amplitude of a mode [Pa/m], as the member without an absorber has it; 0 where it is unknown."""
    assert screened.findings is not None
    known = [
        motion.stress_range / motion.pipe_peak
        for case, motion in screened.findings.motions
        if case.pipe.governing_mode == mode and motion.pipe_peak > 0 and math.isfinite(motion.stress_range)
    ]
    return max(known, default=0.0)


def _limits(screened: ScreenedMember) -> tuple[Floats, Floats]:
    """Utilisation of every limit at rest (L,), and by a unit of each of `SIZES` (L, 4), in which all are linear.

    At rest: by a static stress, and by winds outside all bands, which an absorber does not change.
    """
    case, outside = screened.case, _outside(screened)
    carrying = with_design(case, DesignedAbsorber(0.01, 0.0, 1.0, 0.0))

    def ratios(**sizes: float) -> Floats:
        row = dict.fromkeys(SIZES, 0.0) | sizes
        found = utilisations(carrying, row, None if case.fatigue is None else row)
        return np.array([one.ratio + (outside if one.name == "damage" else 0.0) for one in found])

    base = ratios()
    return base, np.column_stack([ratios(**{name: 1.0}) - base for name in SIZES])


def _outside(screened: ScreenedMember) -> float:
    """Utilisation by damage of winds outside all bands without an absorber [-]."""
    case = screened.case
    if screened.findings is None or screened.findings.damage is None or case.fatigue is None:
        return 0.0
    limit = 1.0 if case.limits is None else case.limits.damage
    return float(case.fatigue.design_fatigue_factor * screened.findings.damage["outside"] / limit)


def hull(spaces: list[DesignSpace]) -> DesignSpace:
    """The box around those of several members, all for devices of one mass and family."""
    lo, hi = np.min([one.lo for one in spaces], axis=0), np.max([one.hi for one in spaces], axis=0)
    return dataclasses.replace(spaces[0], lo=lo, hi=hi)
