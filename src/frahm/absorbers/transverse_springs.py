"""The force law of springs at right angles to the motion, whose geometry is exact."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from frahm.absorbers.attachments import Friction, Stops
from frahm.absorbers.law import Law
from frahm.arrays import Floats
from frahm.errors import check_number


class TransverseSprings(Law):
    """Two equal springs at right angles to the motion, exact geometry: the hardware behind a cubic spring.

    Each spring reaches from an anchor at the distance `length` to the mass, so that a displacement z stretches it to
    q = sqrt(length^2 + z^2). With the tension T0 + k (q - length) along it and two of them,

        g = 2 (T0 + k (q - L)) z/q + damping w = 2 k z (1 - L/q) + 2 T0 z/q + damping w .

    Small motions see 2 T0/L z + (k - T0/L)/L^2 z^3. With T0 < 0 the springs are pressed together and z = 0 lies
    between two wells at +-sqrt(L0^2 - L^2), L0 = L - T0/k being the springs' free length.

    Parameters
    ----------
    stiffness : float
        k of one spring [N/m], positive.
    length : float
        L [m], positive: distance from the anchor to the mass in the middle. It is the free length without pretension.
    damping : float
        [N s/m].
    pretension : float
        T0 of one spring in the middle [N], below stiffness times length; negative where they push.
    stops, friction, weight
        See `Polynomial`.

    Raises
    ------
    ParameterError
        If a number is not allowed, or the free length would not be positive.
    """

    spring_stiffness: float
    length: float
    pretension: float

    def __init__(
        self,
        stiffness: float,
        length: float,
        damping: float = 0.0,
        *,
        pretension: float = 0.0,
        stops: Stops | None = None,
        friction: Friction | None = None,
        weight: float = 0.0,
    ):
        k = check_number("stiffness", stiffness, above=0, unit="N/m")
        L = check_number("length", length, above=0, unit="m")
        # A spring of free length zero already pulls with k L: more is no coil spring.
        T0 = check_number("pretension", pretension, below=k * L, unit="N")
        super().__init__((0.0,), damping, stops, friction, weight)
        self._put(spring_stiffness=k, length=L, pretension=T0)

    @property
    def free_length(self) -> float:
        """Length of a spring that carries nothing [m]."""
        return self.length - self.pretension / self.spring_stiffness

    @property
    def is_polynomial(self) -> bool:
        """Never: the geometry is exact."""
        return False

    @property
    def cubic_stiffness(self) -> float:
        """(k - T0/L)/L^2 [N/m^3]."""
        return (self.spring_stiffness - self.pretension / self.length) / self.length**2

    def with_cubic_stiffness(self, value: float) -> TransverseSprings:
        """The law with the springs' stiffness changed, pretension and length kept."""
        k = value * self.length**2 + self.pretension / self.length
        check_number("stiffness", k, above=0, unit="N/m")
        return self._changed(spring_stiffness=k)

    def scaled(self, spring: float, damper: float) -> TransverseSprings:
        """The law with stiffness, pretension and damping times a factor."""
        return self._changed(
            spring_stiffness=spring * self.spring_stiffness, pretension=spring * self.pretension,
            damping=damper * self.damping,
        )  # fmt: skip

    def by_cubic_stiffness(self, factor: float = 1.0) -> TransverseSprings:
        """Springs of the stiffness L^2 without pretension."""
        return TransverseSprings(factor * self.length**2, self.length)

    def spring_force(self, z: ArrayLike) -> Floats:
        """Force of the springs [N], without cancellation at small z."""
        z, q = self._lengths(z)
        return np.asarray(2 * z / q * (self.spring_stiffness * z**2 / (q + self.length) + self.pretension))

    def stiffness(self, z: ArrayLike) -> Floats:
        """dg/dz [N/m] at displacement z [m]."""
        L, (z, q) = self.length, self._lengths(z)
        stretch = self.spring_stiffness * z**2 / (q + L) * (q * q + q * L + L * L) / q**3
        return np.asarray(2 * stretch + 2 * self.pretension * L**2 / q**3 + super().stiffness(z))

    def curvature(self, z: ArrayLike) -> Floats:
        """d2g/dz2 [N/m^2] at displacement z [m]."""
        z, q = self._lengths(z)
        bend = 6 * self.length**2 * (self.spring_stiffness * self.length - self.pretension) * z / q**5
        return np.asarray(bend + super().curvature(z))

    def energy(self, z: ArrayLike) -> Floats:
        """Potential energy of springs, stops and weight [J], zero at z = 0."""
        z, q = self._lengths(z)
        stretch = z**2 / (q + self.length)
        return np.asarray(stretch * (self.spring_stiffness * stretch + 2 * self.pretension) + super().energy(z))

    def _lengths(self, z: ArrayLike) -> tuple[Floats, Floats]:
        z = np.asarray(z, dtype=float)
        return z, np.hypot(self.length, z)
