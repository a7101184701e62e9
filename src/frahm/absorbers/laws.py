"""Force laws of local elements: g(z, w) with z the element's displacement and w its velocity."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats, frozen
from frahm.errors import ParameterError, check_number

_HIGHEST_POWER = 15


@dataclass(frozen=True, eq=False, init=False)
class Polynomial:
    """Spring c_1 z + c_2 z^2 + ... + c_p z^p beside a linear damper: g = sum_k c_k z^k + d w.

    Parameters
    ----------
    coefficients : sequence of float, shape (p,)
        c_1 ... c_p [N/m, N/m^2, ..., N/m^p].
    damping : float
        d [N s/m]; negative values (self-excitation) are allowed.

    Raises
    ------
    ParameterError
        If a number is not finite or there are more than 15 coefficients.
    """

    coefficients: Floats
    damping: float

    def __init__(self, coefficients: ArrayLike, damping: float = 0.0):
        allowed = f"between 1 and {_HIGHEST_POWER} finite numbers [N/m, N/m^2, ...]"
        try:
            values = np.atleast_1d(np.asarray(coefficients, dtype=float))
        except (TypeError, ValueError):
            raise ParameterError("coefficients", coefficients, allowed) from None
        if values.ndim != 1 or not 1 <= values.size <= _HIGHEST_POWER or not np.all(np.isfinite(values)):
            raise ParameterError("coefficients", coefficients, allowed)
        used = max(1, int(np.max(np.nonzero(values)[0], initial=0)) + 1)
        object.__setattr__(self, "coefficients", frozen(values[:used]))
        object.__setattr__(self, "damping", check_number("damping", damping, unit="N s/m"))

    @property
    def is_linear(self) -> bool:
        """Whether the spring has its linear term only."""
        return self.coefficients.size == 1

    @property
    def is_odd(self) -> bool:
        """Whether g(-z, -w) = -g(z, w)."""
        return not np.any(self.coefficients[1::2])

    @property
    def cubic_only(self) -> float | None:
        """c_3 [N/m^3] when the spring is purely cubic (zero allowed), otherwise None."""
        c = self.coefficients
        if c.size == 1 and c[0] == 0:
            return 0.0
        return float(c[2]) if c.size == 3 and c[0] == 0 and c[1] == 0 else None

    def force(self, z: ArrayLike, w: ArrayLike = 0.0) -> Floats:
        """g(z, w) [N] for displacement z [m] and velocity w [m/s], broadcast."""
        z = np.asarray(z, dtype=float)
        return np.asarray(np.polynomial.polynomial.polyval(z, self._with_zero) + self.damping * np.asarray(w))

    def stiffness(self, z: ArrayLike) -> Floats:
        """dg/dz [N/m] at displacement z [m]."""
        slope = np.polynomial.polynomial.polyder(self._with_zero)
        return np.asarray(np.polynomial.polynomial.polyval(np.asarray(z, dtype=float), slope))

    def describing_stiffness(self, amplitude: ArrayLike) -> Floats:
        """Equivalent stiffness of the first harmonic [N/m]: sum over odd k of c_k binom(k, (k-1)/2) (|Z|/2)^(k-1)."""
        b = np.asarray(amplitude, dtype=float)
        odd = range(1, self.coefficients.size + 1, 2)
        terms = [self.coefficients[k - 1] * math.comb(k, (k - 1) // 2) * (b / 2) ** (k - 1) for k in odd]
        return np.asarray(sum(terms))

    @property
    def _with_zero(self) -> Floats:
        return np.concatenate([[0.0], self.coefficients])


class Cubic(Polynomial):
    """Spring of a nonlinear energy sink: g = stiffness z^3 + damping w.

    Parameters
    ----------
    stiffness : float
        Cubic stiffness [N/m^3].
    damping : float
        [N s/m].
    """

    def __init__(self, stiffness: float, damping: float = 0.0):
        super().__init__((0.0, 0.0, check_number("stiffness", stiffness, unit="N/m^3")), damping)


class Linear(Polynomial):
    """Linear spring and damper, as in a tuned mass damper: g = stiffness z + damping w.

    Parameters
    ----------
    stiffness : float
        [N/m].
    damping : float
        [N s/m].
    """

    def __init__(self, stiffness: float, damping: float = 0.0):
        super().__init__((check_number("stiffness", stiffness, unit="N/m"),), damping)
