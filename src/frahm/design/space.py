"""The designs searched: a box in the parameters that scale with the pipe, mapped to the unit cube."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.design.absorber import DesignedAbsorber, together
from frahm.design.host import Host
from frahm.design.settings import DesignSettings
from frahm.errors import ParameterError

MASS, LINEAR, CUBIC, DAMPING, QUINTIC = range(5)  # columns of a design: m, k1, k3, c, k5
_NAMES = {LINEAR: "linear", CUBIC: "kappa", DAMPING: "xi2", QUINTIC: "quintic"}
# Multiples of the scales below that the default ranges reach; the optima of all pipes lie well inside.
_REACH = {LINEAR: (0.0, 1.6), CUBIC: (1e-3, 20.0), DAMPING: (0.01, 2.0), QUINTIC: (1e-3, 20.0)}
_MOST_UNLIKE = math.log(4.0)  # ln of a mass over that of the first absorber, where masses are free
_NEXT_TO_NOTHING = 1e-6  # of the upper end
_POWER = {LINEAR: 1, CUBIC: 3, DAMPING: 1, QUINTIC: 5}  # of the mass that a scale grows with


@dataclass(frozen=True, eq=False)
class DesignSpace:
    """Box of designs of one family: one absorber, or several that share a mass.

    Attributes
    ----------
    mass : float
        Of all absorbers together [kg]; where it is free, that the bounds of the others belong to.
    host_mass : float
        The mass parameters are divided by [kg].
    columns : tuple of int
        Which of k1, k3, c, k5 are free.
    lo, hi : ndarray
        Bounds of the free ones of an absorber that has an equal share of the mass, logarithms for all but k1.
    powers : ndarray of int
        Power of the mass over `mass` that each bound grows with; 0 where ranges were asked for.
    masses : tuple of float, optional
        Range of the mass [kg], if it is free.
    shares : tuple of float, optional
        Of the mass that each absorber has; None where they are free.
    count : int
        Number of absorbers.
    equal : bool
        Whether all of them are one device.
    position : float or None
        Of the absorbers on the pipe [m]; None where the case has them.
    """

    mass: float
    host_mass: float
    columns: tuple[int, ...]
    lo: Floats
    hi: Floats
    powers: np.ndarray
    masses: tuple[float, float] | None = None
    shares: tuple[float, ...] | None = (1.0,)
    count: int = 1
    equal: bool = False
    position: float | None = None

    @property
    def _drawings(self) -> int:
        """Number of absorbers that differ."""
        return 1 if self.equal else self.count

    @property
    def _before(self) -> int:
        """Number of parameters that are masses."""
        return (self.masses is not None) + (self.count - 1 if self.shares is None else 0)

    @property
    def size(self) -> int:
        """Number of free parameters."""
        return self._before + self._drawings * len(self.columns)

    @property
    def is_quick(self) -> bool:
        """Whether a design takes the closed form little time: one absorber, or linear ones, which have one response."""
        return self.count == 1 or not {CUBIC, QUINTIC} & set(self.columns)

    def designs(self, unit: Floats) -> Floats:
        """Designs (D, 5 N) in SI units at points (D, d) of the unit cube."""
        unit = np.clip(unit, 0.0, 1.0)
        total, masses = self._masses(unit)
        found = np.zeros((len(unit), self.count, 5))
        found[:, :, MASS] = masses
        for one in range(self._drawings):
            at = self._before + one * len(self.columns)
            values = self.lo + unit[:, at : at + len(self.columns)] * (self.hi - self.lo)
            for j, column in enumerate(self.columns):
                plain = values[:, j] if column == LINEAR else np.exp(values[:, j])
                found[:, one, column] = plain * self._scale(j, total, masses[:, one])
        if self.equal:
            found[:, 1:, 1:] = found[:, :1, 1:]
        return found.reshape(len(unit), -1)

    def units(self, designs: Floats) -> Floats:
        """Points (D, d) of the unit cube of designs (D, 5 N); the way back of `designs`."""
        groups = np.reshape(designs, (len(designs), self.count, 5))
        masses = groups[:, :, MASS]
        total = masses.sum(axis=1)
        units = np.empty((len(designs), self.size))
        at = 0
        if self.masses is not None:
            lo, hi = np.log(self.masses)
            units[:, 0], at = (np.log(total) - lo) / (hi - lo), 1
        if self.shares is None:
            units[:, at : self._before] = 0.5 + np.log(masses[:, 1:] / masses[:, :1]) / (2 * _MOST_UNLIKE)
        for one in range(self._drawings):
            for j, column in enumerate(self.columns):
                plain = groups[:, one, column] / self._scale(j, total, masses[:, one])
                # what a corner of the family lacks has no logarithm
                value = plain if column == LINEAR else np.log(np.maximum(plain, np.exp(self.lo[j])))
                place = self._before + one * len(self.columns) + j
                units[:, place] = (value - self.lo[j]) / (self.hi[j] - self.lo[j])
        return units

    def _masses(self, unit: Floats) -> tuple[Floats, Floats]:
        """Mass of all (D,) and of each (D, N) [kg]."""
        total, at = np.full(len(unit), self.mass), 0
        if self.masses is not None:
            lo, hi = np.log(self.masses)
            total, at = np.exp(lo + unit[:, 0] * (hi - lo)), 1
        if self.shares is not None:
            return total, total[:, None] * np.array(self.shares)
        over_first = np.exp(2 * _MOST_UNLIKE * (unit[:, at : self._before] - 0.5))
        shares = np.column_stack([np.ones(len(unit)), over_first])
        return total, total[:, None] * shares / shares.sum(axis=1, keepdims=True)

    def _scale(self, j: int, total: Floats, mass: Floats) -> Floats:
        """What the bounds of a parameter are multiplied by for an absorber of a mass (D,) [-]."""
        power = self.powers[j]
        return (total / self.mass) ** power * (self.count * mass / total if power else 1.0)

    def split(self, design: Floats) -> Floats:
        """A design (5,) of one absorber as equal absorbers (5 N,) beside each other, which answer as it does."""
        return np.tile(design / self.count, self.count)

    def absorber(self, design: Floats) -> DesignedAbsorber:
        """A row of `designs` in the parameters users know."""
        groups = np.reshape(design, (self.count, 5)) / self.host_mass
        return together([DesignedAbsorber(m, k1, k3, c, k5, self.position) for m, k1, k3, c, k5 in groups.tolist()])


def design_space(host: Host, host_mass: float, family: str, settings: DesignSettings, count: int = 1) -> DesignSpace:
    """Box of a family on a host, by the settings' ranges or by ranges that scale with host and mass.

    The scales are m omega^2 for the linear spring, m omega for the damper, and for the others the one whose equivalent
    stiffness at the amplitude at which the force accelerates all absorbers, F/(m omega^2), is m omega^2.

    Raises
    ------
    ParameterError
        If the family needs a spring that a range excludes.
    """
    masses = settings.mass_range
    ratio = settings.mass_ratio if masses is None else math.sqrt(masses[0] * masses[1])
    if not isinstance(ratio, float):
        raise ParameterError("mass_ratio", ratio, "a number, or two (lo, hi) with lo < hi [-]")
    total, omega = ratio * host_mass, host.frequency
    m, amplitude = total / count, host.blocked_force / (total * omega**2)
    stiffness = m * omega**2
    scales = {
        LINEAR: stiffness, CUBIC: 4 / 3 * stiffness / amplitude**2, DAMPING: m * omega,
        QUINTIC: 8 / 5 * stiffness / amplitude**4,
    }  # fmt: skip
    columns = {"sink": (CUBIC, DAMPING), "tuned": (LINEAR, DAMPING), "mixed": (LINEAR, CUBIC, DAMPING)}[family]
    columns += (QUINTIC,) if settings.quintic is not None and family != "tuned" else ()
    bounds, powers = [], []
    for column in columns:
        asked = getattr(settings, _NAMES[column])
        reach = _REACH[column]
        lo, hi = (v * scales[column] for v in reach) if asked is None else (v * host_mass for v in asked)
        if column == LINEAR:
            bounds.append((lo, hi))
        else:  # a range that starts at zero has no logarithm: what hardly matters stands for none
            bounds.append((math.log(lo or min(_NEXT_TO_NOTHING * hi, 1e-3 * reach[0] * scales[column])), math.log(hi)))
        powers.append(_POWER[column] if asked is None else 0)
    lower, upper = (np.array(ends) for ends in zip(*bounds, strict=True))
    return DesignSpace(
        total, host_mass, columns, lower, upper, np.array(powers),
        masses=None if masses is None else (masses[0] * host_mass, masses[1] * host_mass),
        shares=settings.shares(count), count=count, equal=settings.equal and count > 1,
    )  # fmt: skip
