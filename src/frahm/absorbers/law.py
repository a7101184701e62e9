"""What force laws of local elements share: g(z, w) with z the element's displacement and w its velocity.

g = spring(z) + damping w + stops(z) + friction(w) - weight. Laws differ in their spring only.
"""

from __future__ import annotations

import copy
import math
from abc import ABC, abstractmethod
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from frahm.absorbers.attachments import Friction, Stops
from frahm.arrays import Floats, frozen
from frahm.errors import ParameterError, check_number

_SAMPLES = 512  # of a harmonic motion, where a describing stiffness is a quadrature


class Law(ABC):
    """What all force laws share: g = spring(z) + damping w + stops(z) + friction(w) - weight.

    Attributes
    ----------
    coefficients : ndarray, shape (p,)
        c_1 ... c_p of the spring's polynomial part [N/m ... N/m^p].
    damping : float
        d [N s/m]; negative values (self-excitation) are allowed.
    stops : Stops or None
    friction : Friction or None
    weight : float
        Constant force in the direction of positive z [N], such as the weight of a sink that moves up and down. z is
        then counted from where the spring is unloaded, and the structure's displacements from rest under the weight.
    """

    coefficients: Floats
    damping: float
    stops: Stops | None
    friction: Friction | None
    weight: float

    def __init__(
        self, coefficients: ArrayLike, damping: float, stops: Stops | None, friction: Friction | None, weight: float
    ):
        if stops is not None and not isinstance(stops, Stops):
            raise ParameterError("stops", stops, "frahm.Stops(gap=..., stiffness=...) or None")
        if friction is not None and not isinstance(friction, Friction):
            raise ParameterError("friction", friction, "frahm.Friction(force=..., speed=...) or None")
        self._put(
            coefficients=frozen(coefficients),
            damping=check_number("damping", damping, unit="N s/m"),
            stops=stops,
            friction=friction,
            weight=check_number("weight", weight, unit="N"),
        )

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a force law does not change: {name} cannot be set")

    def __repr__(self) -> str:
        parts = {
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in self.__dict__.items()
            if value is not None and (name != "weight" or value)
        }
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in parts.items())})"

    def _put(self, **values: Any) -> None:
        self.__dict__.update(values)

    def _changed(self, **values: Any) -> Self:
        other = copy.copy(self)
        other._put(**values)
        return other

    @property
    @abstractmethod
    def cubic_stiffness(self) -> float:
        """Coefficient of z^3 in the spring's force about z = 0 [N/m^3]."""

    @abstractmethod
    def with_cubic_stiffness(self, value: float) -> Law:
        """The law with its nonlinear spring changed so that it has this cubic stiffness [N/m^3]."""

    @abstractmethod
    def by_cubic_stiffness(self, factor: float = 1.0) -> Law:
        """Derivative of the law by its cubic stiffness, times `factor`, as a law."""

    @property
    def is_polynomial(self) -> bool:
        """Whether the force is a polynomial of z beside a linear damper, and nothing else."""
        return self.stops is None and self.friction is None and self.weight == 0

    @property
    def is_smooth(self) -> bool:
        """Whether the force has neither stops nor friction, so that its harmonics fall off quickly."""
        return self.stops is None and self.friction is None

    @property
    def is_linear(self) -> bool:
        """Whether the spring has its linear term only, with neither stops nor friction nor weight."""
        return self.is_polynomial and self.coefficients.size == 1

    @property
    def is_odd(self) -> bool:
        """Whether g(-z, -w) = -g(z, w)."""
        return not np.any(self.coefficients[1::2]) and self.weight == 0

    @property
    def cubic_only(self) -> float | None:
        """c_3 [N/m^3] when the law is a purely cubic spring (zero allowed) and a damper, otherwise None."""
        c = self.coefficients
        if not self.is_polynomial:
            return None
        if c.size == 1 and c[0] == 0:
            return 0.0
        return float(c[2]) if c.size == 3 and c[0] == 0 and c[1] == 0 else None

    def with_damping(self, value: float) -> Self:
        """The law with another damping [N s/m]."""
        return self._changed(damping=check_number("damping", value, unit="N s/m"))

    @abstractmethod
    def scaled(self, spring: float, damper: float) -> Law:
        """The law with its whole spring, linear part included, and its damper times a factor; stops stay."""

    def with_weight(self, value: float) -> Self:
        """The law with another weight [N]."""
        return self._changed(weight=check_number("weight", value, unit="N"))

    def without_linear_part(self) -> Self:
        """The law without c_1 and its damping."""
        return self._changed(coefficients=frozen([0.0, *self.coefficients[1:]]), damping=0.0)

    def spring_force(self, z: ArrayLike) -> Floats:
        """Force of the spring alone [N]."""
        return np.asarray(np.polynomial.polynomial.polyval(np.asarray(z, dtype=float), [0.0, *self.coefficients]))

    def static_force(self, z: ArrayLike) -> Floats:
        """g(z, 0) [N]: spring, stops and weight."""
        stops = 0.0 if self.stops is None else self.stops.force(z)
        return np.asarray(self.spring_force(z) + stops - self.weight)

    def force(self, z: ArrayLike, w: ArrayLike = 0.0) -> Floats:
        """g(z, w) [N] for displacement z [m] and velocity w [m/s], broadcast."""
        friction = 0.0 if self.friction is None else self.friction.at(w)
        return np.asarray(self.static_force(z) + self.damping * np.asarray(w) + friction)

    def stiffness(self, z: ArrayLike) -> Floats:
        """dg/dz [N/m] at displacement z [m]."""
        slope = np.polynomial.polynomial.polyder([0.0, *self.coefficients])
        stops = 0.0 if self.stops is None else self.stops.slope(z)
        return np.asarray(np.polynomial.polynomial.polyval(np.asarray(z, dtype=float), slope) + stops)

    def damping_at(self, w: ArrayLike) -> Floats:
        """dg/dw [N s/m] at velocity w [m/s]."""
        w = np.asarray(w, dtype=float)
        return np.asarray(self.damping + (np.zeros_like(w) if self.friction is None else self.friction.slope(w)))

    def curvature(self, z: ArrayLike) -> Floats:
        """d2g/dz2 [N/m^2] at displacement z [m]."""
        bend = np.polynomial.polynomial.polyder([0.0, *self.coefficients], 2)
        stops = 0.0 if self.stops is None else self.stops.curvature(z)
        return np.asarray(np.polynomial.polynomial.polyval(np.asarray(z, dtype=float), bend) + stops)

    def energy(self, z: ArrayLike) -> Floats:
        """Potential energy of spring, stops and weight [J], zero at z = 0."""
        z = np.asarray(z, dtype=float)
        integral = np.polynomial.polynomial.polyint([0.0, *self.coefficients])
        stops = 0.0 if self.stops is None else self.stops.energy(z)
        return np.asarray(np.polynomial.polynomial.polyval(z, integral) + stops - self.weight * z)

    def describing_stiffness(self, amplitude: ArrayLike) -> Floats:
        """Equivalent stiffness [N/m] of the first harmonic for the motion z = amplitude cos tau.

        In closed form for a polynomial, sum over odd k of c_k binom(k, (k-1)/2) (|Z|/2)^(k-1); else by quadrature.
        """
        b = np.asarray(amplitude, dtype=float)
        if self.is_polynomial:
            odd = range(1, self.coefficients.size + 1, 2)
            terms = [self.coefficients[k - 1] * math.comb(k, (k - 1) // 2) * (b / 2) ** (k - 1) for k in odd]
            return np.asarray(sum(terms))
        c = np.cos(2 * np.pi * np.arange(_SAMPLES) / _SAMPLES)
        safe = np.where(b == 0, 1.0, b)
        mean = np.mean(self.static_force(safe[..., None] * c) * c, axis=-1)
        return np.asarray(np.where(b == 0, self.stiffness(0.0), 2 * mean / safe))
