"""Force laws whose spring is a polynomial of the displacement: cubic, linear, bistable, any."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from frahm.absorbers.attachments import Friction, Stops
from frahm.absorbers.law import Law
from frahm.arrays import frozen
from frahm.errors import ParameterError, check_number

_HIGHEST_POWER = 15


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
