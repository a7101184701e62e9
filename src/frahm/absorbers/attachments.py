"""What any force law can carry beside its spring: end stops and dry friction, each with its regularisation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats
from frahm.errors import check_number

_ROUNDING = 0.1


@dataclass(frozen=True, init=False)
class Stops:
    """Elastic end stops on both sides, each a buffer that hardens over a short depth.

    Nothing acts for |z| <= gap. Beyond it the stop's stiffness rises from 0 to `stiffness` as the smooth step
    3 r^2 - 2 r^3 of r = (|z| - gap)/depth, and stays there: the force is twice continuously differentiable, and exactly
    zero inside the gap. At depth -> 0 it is the piecewise linear stop. The stops return all their energy; losses at
    impact are not modelled.

    Parameters
    ----------
    gap : float
        Free travel to either side of the springs' middle [m].
    stiffness : float
        Stiffness of a stop once its buffer is compressed [N/m].
    depth : float, optional
        Depth over which the buffer hardens [m]; a tenth of the gap by default.

    Raises
    ------
    ParameterError
        If a number is not finite and positive.
    """

    gap: float
    stiffness: float
    depth: float

    def __init__(self, gap: float, stiffness: float, depth: float | None = None):
        gap = check_number("gap", gap, above=0, unit="m")
        object.__setattr__(self, "gap", gap)
        object.__setattr__(self, "stiffness", check_number("stiffness", stiffness, above=0, unit="N/m"))
        depth = _ROUNDING * gap if depth is None else check_number("depth", depth, above=0, unit="m")
        object.__setattr__(self, "depth", depth)

    def force(self, z: ArrayLike) -> Floats:
        """Force [N] of the stops at displacement z [m]."""
        r, beyond = self._compression(z)
        return np.asarray(np.sign(z) * self.stiffness * (self.depth * (r**3 - r**4 / 2) + beyond))

    def slope(self, z: ArrayLike) -> Floats:
        """Stiffness [N/m] at displacement z [m]."""
        r, _ = self._compression(z)
        return np.asarray(self.stiffness * (3 * r**2 - 2 * r**3))

    def curvature(self, z: ArrayLike) -> Floats:
        """Second derivative of the force [N/m^2]."""
        r, _ = self._compression(z)
        return np.asarray(np.sign(z) * self.stiffness / self.depth * (6 * r - 6 * r**2))

    def energy(self, z: ArrayLike) -> Floats:
        """Potential energy [J]."""
        r, beyond = self._compression(z)
        rounded = self.depth**2 * (r**4 / 4 - r**5 / 10)
        return np.asarray(self.stiffness * (rounded + beyond * (beyond + self.depth) / 2))

    def _compression(self, z: ArrayLike) -> tuple[Floats, Floats]:
        """Share r of the buffer's depth that is used, and the travel beyond it [m]."""
        x = np.abs(np.asarray(z, dtype=float)) - self.gap
        return np.clip(x / self.depth, 0.0, 1.0), np.maximum(x - self.depth, 0.0)


@dataclass(frozen=True, init=False)
class Friction:
    """Dry friction, regularised: force tanh(w / speed).

    Sliding faster than three times `speed` it is Coulomb's force to 0.5 %. Below, it creeps like a damper of
    force/speed: it never holds at rest, so a motion that would stick creeps instead.

    Parameters
    ----------
    force : float
        Friction force mu N when sliding [N].
    speed : float
        Velocity of the regularisation v_s [m/s].

    Raises
    ------
    ParameterError
        If a number is not finite and positive.
    """

    force: float
    speed: float

    def __init__(self, force: float, speed: float):
        object.__setattr__(self, "force", check_number("force", force, above=0, unit="N"))
        object.__setattr__(self, "speed", check_number("speed", speed, above=0, unit="m/s"))

    def at(self, w: ArrayLike) -> Floats:
        """Force [N] at the velocity w [m/s]."""
        return np.asarray(self.force * np.tanh(np.asarray(w, dtype=float) / self.speed))

    def slope(self, w: ArrayLike) -> Floats:
        """Derivative of the force by the velocity [N s/m]."""
        with np.errstate(over="ignore"):
            return np.asarray(self.force / self.speed / np.cosh(np.asarray(w, dtype=float) / self.speed) ** 2)
