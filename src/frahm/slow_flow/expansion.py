"""Signals as Fourier polynomials with slowly varying coefficients: the algebra of two time scales.

Needs SymPy; import it only where a derivation is asked for.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

omega, Omega, xi1, xi2, kappa, rho2, F = sp.symbols("omega Omega xi1 xi2 kappa rho2 F", positive=True)
sigma = sp.Symbol("sigma", real=True)
epsilon = sp.Symbol("epsilon", positive=True)
carrier = sp.Symbol("E", nonzero=True)  # e^{i sigma t1}

_CONJUGATE = {carrier: 1 / carrier, sp.I: -sp.I}
_SLOW_RATE = {carrier: sp.I * sigma * carrier}


def _amplitude(name: str) -> tuple[Any, Any, Any, Any]:
    """Symbols of a complex amplitude, its conjugate, its slow rate and the conjugate of that."""
    value, rate, second = sp.symbols(f"{name} D1{name} D1D1{name}")
    value_bar, rate_bar, second_bar = sp.symbols(f"{name}bar D1{name}bar D1D1{name}bar")
    for one, other in ((value, value_bar), (rate, rate_bar), (second, second_bar)):
        _CONJUGATE.update({one: other, other: one})
    _SLOW_RATE.update({value: rate, rate: second, value_bar: rate_bar, rate_bar: second_bar})
    return value, value_bar, rate, rate_bar


A, A_bar, A_rate, A_rate_bar = _amplitude("A")
B, B_bar, B_rate, B_rate_bar = _amplitude("B")
B1, B1_bar, B1_rate, B1_rate_bar = _amplitude("B1")
B2, B2_bar, B2_rate, B2_rate_bar = _amplitude("B2")
X, X_bar, X_rate, X_rate_bar = _amplitude("X")
Z, Z_bar, Z_rate, Z_rate_bar = _amplitude("Z")


def conjugated(expression: Any) -> Any:
    """Complex conjugate, with amplitudes and their conjugates as independent symbols."""
    return sp.sympify(expression).xreplace(_CONJUGATE)


def slow_rate(expression: Any) -> Any:
    """D1 of an expression: its derivative with respect to the slow time t1."""
    return sum((sp.diff(expression, symbol) * rate for symbol, rate in _SLOW_RATE.items()), sp.Integer(0))


@dataclass(frozen=True)
class Signal:
    """Real signal sum_n c_n(t1) e^{i n w t0} whose coefficients are SymPy expressions.

    Parameters
    ----------
    frequency : sympy.Expr
        w [rad/s].
    coefficients : mapping of int to sympy.Expr
        c_n, for positive and negative n.
    """

    frequency: Any
    coefficients: Mapping[int, Any]

    @classmethod
    def harmonic(cls, frequency: Any, coefficient: Any, order: int = 1) -> Signal:
        """Signal c e^{i n w t0} + cc."""
        return cls(frequency, {order: sp.sympify(coefficient), -order: conjugated(coefficient)})

    def __add__(self, other: Signal) -> Signal:
        orders = {*self.coefficients, *other.coefficients}
        return Signal(self.frequency, {n: sp.expand(self[n] + other[n]) for n in orders})

    def __mul__(self, other: Any) -> Signal:
        if not isinstance(other, Signal):
            return Signal(self.frequency, {n: sp.expand(c * other) for n, c in self.coefficients.items()})
        product: dict[int, Any] = {}
        for n, c in self.coefficients.items():
            for m, d in other.coefficients.items():
                product[n + m] = sp.expand(product.get(n + m, 0) + c * d)
        return Signal(self.frequency, product)

    __rmul__ = __mul__

    def __sub__(self, other: Signal) -> Signal:
        return self + other * -1

    def __getitem__(self, order: int) -> Any:
        return self.coefficients.get(order, sp.Integer(0))

    @functools.cached_property
    def rate(self) -> Signal:
        """Time derivative (D0 + epsilon D1)."""
        i_w = sp.I * self.frequency
        return Signal(
            self.frequency,
            {n: sp.expand(n * i_w * c + epsilon * slow_rate(c)) for n, c in self.coefficients.items()},
        )


def residuals(x: Signal, z: Signal, forcing: Signal, sink_damping: Any) -> tuple[Signal, Signal]:
    """Both equations of motion (Eq. 3 of doi 10.3390/app12147272), right-hand sides taken to the left.

    Parameters
    ----------
    x, z : Signal
        Displacement x1 of the host and z = x2 - x1 of the sink [m].
    forcing : Signal
        F cos(Omega t) [m/s^2].
    sink_damping : sympy.Expr
        xi2 [1/s] in the sink's equation: `xi2` where it counts as large as the sink's inertia, as the paper has
        it, `epsilon * xi2` where it counts as small.

    Returns
    -------
    host, sink : Signal
        x1'' + eps xi1 x1' + omega^2 x1 - eps xi2 z' - eps kappa z^3 - eps F cos, and
        rho2 (z'' + x1'') + xi2 z' + kappa z^3 (the common factor eps of the paper's equation divided out).
    """
    spring = kappa * (z * z * z)
    host = x.rate.rate + omega**2 * x + epsilon * (xi1 * x.rate - xi2 * z.rate - spring - forcing)
    sink = rho2 * (z.rate.rate + x.rate.rate) + sink_damping * z.rate + spring
    return host, sink
