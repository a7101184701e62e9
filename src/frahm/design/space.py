"""The designs searched: a box in the parameters that scale with the pipe, mapped to the unit cube."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.design.absorber import DesignedAbsorber
from frahm.design.host import Host
from frahm.design.settings import DesignSettings
from frahm.errors import ParameterError

MASS, LINEAR, CUBIC, DAMPING, QUINTIC = range(5)  # columns of a design: m, k1, k3, c, k5
_NAMES = {LINEAR: "linear", CUBIC: "kappa", DAMPING: "xi2", QUINTIC: "quintic"}
# Multiples of the scales below that the default ranges reach; the optima of all pipes lie well inside.
_REACH = {LINEAR: (0.0, 1.6), CUBIC: (1e-3, 20.0), DAMPING: (0.01, 2.0), QUINTIC: (1e-3, 20.0)}
_NEXT_TO_NOTHING = 1e-6  # of the upper end
_POWER = {LINEAR: 1, CUBIC: 3, DAMPING: 1, QUINTIC: 5}  # of the mass that a scale grows with


@dataclass(frozen=True, eq=False)
class DesignSpace:
    """Box of designs of one family.

    Attributes
    ----------
    mass : float
        Of the absorber [kg]; where the mass is free, that the bounds of the others belong to.
    host_mass : float
        The mass parameters are divided by [kg].
    columns : tuple of int
        Which of m, k1, k3, c, k5 are free.
    lo, hi : ndarray
        Bounds of the free ones, logarithms for all but k1.
    powers : ndarray of int
        Power of the mass over `mass` that each bound grows with.
    position : float or None
        Of the absorber on the pipe [m]; None where the case has it.
    """

    mass: float
    host_mass: float
    columns: tuple[int, ...]
    lo: Floats
    hi: Floats
    powers: np.ndarray
    position: float | None = None

    @property
    def size(self) -> int:
        """Number of free parameters."""
        return len(self.columns)

    def designs(self, unit: Floats) -> Floats:
        """Designs (D, 5) in SI units at points (D, d) of the unit cube."""
        values = self.lo + np.clip(unit, 0.0, 1.0) * (self.hi - self.lo)
        found = np.zeros((len(values), 5))
        found[:, MASS] = self.mass
        for at, column in enumerate(self.columns):
            plain = values[:, at] if column == LINEAR else np.exp(values[:, at])
            found[:, column] = plain * (found[:, MASS] / self.mass) ** self.powers[at]
        return found

    def units(self, designs: Floats) -> Floats:
        """Points (D, d) of the unit cube of designs (D, 5); the way back of `designs`."""
        values = np.empty((len(designs), self.size))
        for at, column in enumerate(self.columns):
            plain = designs[:, column] / (designs[:, MASS] / self.mass) ** self.powers[at]
            values[:, at] = plain if column == LINEAR else np.log(plain)
        return (values - self.lo) / (self.hi - self.lo)

    def absorber(self, design: Floats) -> DesignedAbsorber:
        """A row of `designs` in the parameters users know."""
        m, k1, k3, c, k5 = (float(value) / self.host_mass for value in design)
        return DesignedAbsorber(m, k1, k3, c, k5, self.position)


def design_space(host: Host, host_mass: float, family: str, settings: DesignSettings) -> DesignSpace:
    """Box of a family on a host, by the settings' ranges or by ranges that scale with host and mass.

    The scales are m omega^2 for the linear spring, m omega for the damper, and for the others the one whose equivalent
    stiffness at the amplitude at which the force accelerates the mass of the absorber, F/(m omega^2), is m omega^2.

    Raises
    ------
    ParameterError
        If the family needs a spring that a range excludes.
    """
    masses = settings.mass_range
    ratio = settings.mass_ratio if masses is None else math.sqrt(masses[0] * masses[1])
    if not isinstance(ratio, float):
        raise ParameterError("mass_ratio", ratio, "a number, or two (lo, hi) with lo < hi [-]")
    m, omega = ratio * host_mass, host.frequency
    stiffness = m * omega**2
    amplitude = host.blocked_force / stiffness
    scales = {
        LINEAR: stiffness, CUBIC: 4 / 3 * stiffness / amplitude**2, DAMPING: m * omega,
        QUINTIC: 8 / 5 * stiffness / amplitude**4,
    }  # fmt: skip
    columns = {"sink": (CUBIC, DAMPING), "tuned": (LINEAR, DAMPING), "mixed": (LINEAR, CUBIC, DAMPING)}[family]
    columns += (QUINTIC,) if settings.quintic is not None and family != "tuned" else ()
    bounds, powers = [], []
    if masses is not None:
        bounds.append((math.log(masses[0] * host_mass), math.log(masses[1] * host_mass)))
        powers.append(0)
    for column in columns:
        asked = getattr(settings, _NAMES[column])
        reach = _REACH[column]
        lo, hi = (v * scales[column] for v in reach) if asked is None else (v * host_mass for v in asked)
        if column == LINEAR:
            bounds.append((lo, hi))
        else:  # a range that starts at zero has no logarithm: what hardly matters stands for none
            bounds.append((math.log(lo or min(_NEXT_TO_NOTHING * hi, 1e-3 * reach[0] * scales[column])), math.log(hi)))
        powers.append(_POWER[column] if asked is None and masses is not None else 0)
    columns = ((MASS,) if masses is not None else ()) + columns
    lower, upper = (np.array(ends) for ends in zip(*bounds, strict=True))
    return DesignSpace(m, host_mass, columns, lower, upper, np.array(powers))
