"""Force laws of local elements: g(z, w) with z the element's displacement and w its velocity.

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

_HIGHEST_POWER = 15
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


class Polynomial(Law):
    """Spring c_1 z + c_2 z^2 + ... + c_p z^p beside a linear damper: g = sum_k c_k z^k + d w.

    Parameters
    ----------
    coefficients : sequence of float, shape (p,)
        c_1 ... c_p [N/m, N/m^2, ..., N/m^p].
    damping : float
        d [N s/m]; negative values (self-excitation) are allowed.
    stops : Stops, optional
    friction : Friction, optional
    weight : float
        Constant force in the direction of positive z [N], see `Law`.

    Raises
    ------
    ParameterError
        If a number is not finite or there are more than 15 coefficients.
    """

    def __init__(
        self,
        coefficients: ArrayLike,
        damping: float = 0.0,
        *,
        stops: Stops | None = None,
        friction: Friction | None = None,
        weight: float = 0.0,
    ):
        allowed = f"between 1 and {_HIGHEST_POWER} finite numbers [N/m, N/m^2, ...]"
        try:
            values = np.atleast_1d(np.asarray(coefficients, dtype=float))
        except (TypeError, ValueError):
            raise ParameterError("coefficients", coefficients, allowed) from None
        if values.ndim != 1 or not 1 <= values.size <= _HIGHEST_POWER or not np.all(np.isfinite(values)):
            raise ParameterError("coefficients", coefficients, allowed)
        used = max(1, int(np.max(np.nonzero(values)[0], initial=0)) + 1)
        super().__init__(values[:used], damping, stops, friction, weight)

    @property
    def cubic_stiffness(self) -> float:
        """c_3 [N/m^3]."""
        return float(self.coefficients[2]) if self.coefficients.size >= 3 else 0.0

    def with_cubic_stiffness(self, value: float) -> Polynomial:
        """The law with c_2, c_3, ... scaled so that c_3 is `value` [N/m^3]."""
        scale = value / self.cubic_stiffness
        return self._changed(coefficients=frozen([self.coefficients[0], *(scale * self.coefficients[1:])]))

    def scaled(self, spring: float, damper: float) -> Polynomial:
        """The law with all c_k and the damping times a factor."""
        return self._changed(coefficients=frozen(spring * self.coefficients), damping=damper * self.damping)

    def by_cubic_stiffness(self, factor: float = 1.0) -> Polynomial:
        """The spring without its linear term, per c_3."""
        return Polynomial([0.0, *(factor / self.cubic_stiffness * self.coefficients[1:])])


class Cubic(Polynomial):
    """Spring of a nonlinear energy sink: g = stiffness z^3 + damping w.

    Parameters
    ----------
    stiffness : float
        Cubic stiffness [N/m^3].
    damping : float
        [N s/m].
    stops, friction, weight
        See `Polynomial`.
    """

    def __init__(
        self,
        stiffness: float,
        damping: float = 0.0,
        *,
        stops: Stops | None = None,
        friction: Friction | None = None,
        weight: float = 0.0,
    ):
        cubic = check_number("stiffness", stiffness, unit="N/m^3")
        super().__init__((0.0, 0.0, cubic), damping, stops=stops, friction=friction, weight=weight)


class Linear(Polynomial):
    """Linear spring and damper, as in a tuned mass damper: g = stiffness z + damping w.

    Parameters
    ----------
    stiffness : float
        [N/m].
    damping : float
        [N s/m].
    stops, friction, weight
        See `Polynomial`.
    """

    def __init__(
        self,
        stiffness: float,
        damping: float = 0.0,
        *,
        stops: Stops | None = None,
        friction: Friction | None = None,
        weight: float = 0.0,
    ):
        linear = check_number("stiffness", stiffness, unit="N/m")
        super().__init__((linear,), damping, stops=stops, friction=friction, weight=weight)


class Bistable(Polynomial):
    """Two wells: g = -negative_stiffness z + stiffness z^3 + damping w.

    The wells lie at +-sqrt(negative_stiffness/stiffness). For two wells made by springs pressed together see
    `TransverseSprings` with a negative pretension.

    Parameters
    ----------
    stiffness : float
        Cubic stiffness [N/m^3], positive.
    negative_stiffness : float
        Size of the negative linear stiffness between the wells [N/m], positive.
    damping : float
        [N s/m].
    stops, friction, weight
        See `Polynomial`.

    Raises
    ------
    ParameterError
        If a stiffness is not positive.
    """

    def __init__(
        self,
        stiffness: float,
        negative_stiffness: float,
        damping: float = 0.0,
        *,
        stops: Stops | None = None,
        friction: Friction | None = None,
        weight: float = 0.0,
    ):
        cubic = check_number("stiffness", stiffness, above=0, unit="N/m^3")
        linear = check_number("negative_stiffness", negative_stiffness, above=0, unit="N/m")
        super().__init__((-linear, 0.0, cubic), damping, stops=stops, friction=friction, weight=weight)


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
