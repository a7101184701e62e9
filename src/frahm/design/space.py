"""The designs searched: a box in the parameters that scale with the pipe, mapped to the unit cube."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.design.absorber import DesignedAbsorber
from frahm.design.host import Host
from frahm.design.settings import DesignSettings

# Multiples of the scales below that the default ranges reach; the optima of all pipes lie well inside.
_LINEAR, _CUBIC, _DAMPING = (0.0, 1.6), (1e-3, 20.0), (0.01, 2.0)
LINEAR, CUBIC, DAMPING = 1, 2, 3  # columns of a design: m, k1, k3, c


@dataclass(frozen=True, eq=False)
class DesignSpace:
    """Box of designs of one family and mass.

    Attributes
    ----------
    mass : float
        Of the absorber [kg].
    host_mass : float
        The mass parameters are divided by [kg].
    columns : tuple of int
        Which of k1, k3, c are free.
    lo, hi : ndarray
        Bounds of the free ones, logarithms for k3 and c.
    """

    mass: float
    host_mass: float
    columns: tuple[int, ...]
    lo: Floats
    hi: Floats

    @property
    def size(self) -> int:
        """Number of free parameters."""
        return len(self.columns)

    def designs(self, unit: Floats) -> Floats:
        """Designs (D, 4) in SI units at points (D, d) of the unit cube."""
        return self.of_values(self.lo + np.clip(unit, 0.0, 1.0) * (self.hi - self.lo))

    def of_values(self, values: Floats) -> Floats:
        """Designs (D, 4) in SI units of values (D, d) of the free parameters."""
        found = np.zeros((len(values), 4))
        found[:, 0] = self.mass
        for at, column in enumerate(self.columns):
            found[:, column] = values[:, at] if column == LINEAR else np.exp(values[:, at])
        return found

    def absorber(self, design: Floats) -> DesignedAbsorber:
        """A row of `designs` in the parameters users know."""
        m, k1, k3, c = (float(value) / self.host_mass for value in design)
        return DesignedAbsorber(m, k1, k3, c)


def design_space(host: Host, host_mass: float, family: str, settings: DesignSettings) -> DesignSpace:
    """Box of a family on a host, by the settings' ranges or by ranges that scale with the host.

    The scales are m omega^2 for the linear spring, m omega for the damper, and for the cubic spring the one that
    resonates at the amplitude at which the force accelerates the mass of the absorber: 4/3 m omega^2/(F/(m omega^2))^2.
    """
    m, omega = settings.mass_ratio * host_mass, host.frequency
    stiffness = m * omega**2
    amplitude = host.blocked_force / stiffness
    scales = {LINEAR: stiffness, CUBIC: 4 / 3 * stiffness / amplitude**2, DAMPING: m * omega}
    reach = {LINEAR: _LINEAR, CUBIC: _CUBIC, DAMPING: _DAMPING}
    given = {LINEAR: settings.linear, CUBIC: settings.kappa, DAMPING: settings.xi2}
    columns = {"sink": (CUBIC, DAMPING), "tuned": (LINEAR, DAMPING), "mixed": (LINEAR, CUBIC, DAMPING)}[family]
    bounds = []
    for column in columns:
        asked = given[column]
        lo, hi = (
            (value * scales[column] for value in reach[column]) if asked is None else (v * host_mass for v in asked)
        )
        # a range that starts at zero has no logarithm: a thousandth of what matters stands for none
        least = 1e-3 * reach[column][0] * scales[column] or 1e-12 * scales[column]
        bounds.append((lo, hi) if column == LINEAR else (math.log(max(lo, least)), math.log(max(hi, 2 * least))))
    return DesignSpace(m, host_mass, columns, np.array([b[0] for b in bounds]), np.array([b[1] for b in bounds]))
