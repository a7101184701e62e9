"""The slow flow derived from the equations of motion, in both forms, with SymPy.

Equation numbers are those of doi 10.3390/app12147272. Nothing here is transcribed from the paper: the ansatz is
put into the equations of motion, and every equation below follows. SymPy takes seconds to load, so nothing
imports this file but tests, documentation and the check of the printed equations.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from frahm.errors import check_choice
from frahm.slow_flow import expansion as ex
from frahm.slow_flow.expansion import Signal

Form = Literal["paper", "averaged"]
FORMS: tuple[Form, ...] = ("paper", "averaged")
PARAMETERS = ("omega", "sigma", "xi1", "xi2", "kappa", "rho2", "F")

p1, q1, p2, q2 = STATE = sp.symbols("p1 q1 p2 q2", real=True)
lam = sp.Symbol("lambda", real=True)

Numeric = Callable[[ArrayLike, Mapping[str, float]], NDArray[Any]]


@dataclass(frozen=True)
class MultipleScales:
    """Equations 12 to 16 in the amplitudes A, B1, B2, B and E = e^{i sigma t1}; residuals are zero.

    Parameters
    ----------
    slow_manifold : sympy.Expr
        Residual of Eq. 12.
    host_rate : sympy.Expr
        D1 A, Eq. 13.
    correction : sympy.Expr
        Coefficient of e^{3 i omega t0} in x12, Eq. 14.
    second_order : sympy.Expr
        Residual of Eq. 15.
    sink : sympy.Expr
        Residual of Eq. 16, in B = B1 + B2.
    """

    slow_manifold: Any
    host_rate: Any
    correction: Any
    second_order: Any
    sink: Any


@dataclass(frozen=True)
class Derivation:
    """Slow flow of the pipe with one sink, in complex and Cartesian amplitudes.

    With x1 = Re X e^{i Omega t}, z = Re Z e^{i Omega t}, X = p1 + i q1, Z = p2 + i q2 and a prime for d/dt, both
    forms read (epsilon = 1)

        p X' + a X = F + (i c1 + 3/4 kappa |Z|^2) Z
        q X' - e X + r Z' - e Z + (i c2 + 3/4 kappa |Z|^2) Z = 0.

    Parameters
    ----------
    form : {"paper", "averaged"}
        "paper" expands about omega (Eqs. 13 and 16), "averaged" keeps the forcing frequency Omega.
    host, sink : sympy.Expr
        Residuals of the two solvability conditions in X, Z, their conjugates and rates [m/s^2].
    slow_manifold : sympy.Expr
        Residual of the relation between X and Z on the slow invariant manifold (Eq. 12) [m/s^2].
    coefficients : mapping of str to sympy.Expr
        p, a, q, r, e, c1, c2 and `cubic` (3/4 kappa), read off the residuals.
    cartesian : sympy.Matrix, shape (4, 1)
        p1', q1', p2', q2' [m/s] (Eq. A1).
    jacobian : sympy.Matrix, shape (4, 4)
        Its derivative with respect to (p1, q1, p2, q2) [1/s] (Eq. A2).
    """

    form: Form
    host: Any
    sink: Any
    slow_manifold: Any
    coefficients: Mapping[str, Any]
    cartesian: Any
    jacobian: Any

    @property
    def symbols(self) -> Mapping[str, Any]:
        """Every symbol of the Cartesian equations by name; Omega = omega + sigma appears in the averaged form."""
        names = {symbol.name: symbol for symbol in self.cartesian.free_symbols | set(STATE)}
        return {**names, **{s.name: s for s in (ex.omega, ex.sigma)}}

    def numeric(self) -> tuple[Numeric, Numeric]:
        """Cartesian slow flow and its Jacobian as functions of (state, parameters).

        Returns
        -------
        rates, jacobian : callable
            Functions of a state (p1, q1, p2, q2) [m], real or complex, and of a mapping with the names in
            `PARAMETERS` (SI units); they return arrays of shape (4,) and (4, 4).
        """
        return _compiled(self.cartesian, (4,)), _compiled(self.jacobian, (4, 4))

    def coefficient_values(self, parameters: Mapping[str, float]) -> dict[str, complex]:
        """Return the complex coefficients at one parameter point (names in `PARAMETERS`, SI units)."""
        values = {sp.Symbol(n, **_assumptions(n)): v for n, v in parameters.items()}
        return {
            name: complex(expression.subs(ex.Omega, ex.omega + ex.sigma).subs(values))
            for name, expression in self.coefficients.items()
        }


def _assumptions(name: str) -> dict[str, bool]:
    return {"real": True} if name == "sigma" else {"positive": True}


def _compiled(expression: Any, shape: tuple[int, ...]) -> Numeric:
    explicit = expression.subs(ex.Omega, ex.omega + ex.sigma)
    arguments = (*STATE, *(sp.Symbol(n, **_assumptions(n)) for n in PARAMETERS))
    function = sp.lambdify(arguments, list(explicit), "numpy")

    def evaluated(state: ArrayLike, parameters: Mapping[str, float]) -> NDArray[Any]:
        values = function(*np.asarray(state), *(parameters[name] for name in PARAMETERS))
        return np.array(values).reshape(shape)

    return evaluated


@functools.lru_cache(maxsize=1)
def multiple_scales() -> MultipleScales:
    """Equations 12 to 16 from the equations of motion.

    Returns
    -------
    MultipleScales
    """
    eps = ex.epsilon
    x11 = Signal.harmonic(ex.omega, ex.A)
    z11 = Signal.harmonic(ex.omega, ex.B1 * ex.carrier)
    z12 = Signal.harmonic(ex.omega, ex.B2 * ex.carrier)
    forcing = Signal.harmonic(ex.omega, ex.F * ex.carrier / 2)

    first_order, _ = ex.residuals(x11, z11, forcing, ex.xi2)
    secular = first_order[1].coeff(eps, 1)
    correction = sp.expand(first_order[3].coeff(eps, 1) / ((3 * ex.omega) ** 2 - ex.omega**2))
    x12 = Signal.harmonic(ex.omega, correction, order=3)

    _, sink = ex.residuals(x11 + eps * x12, z11 + eps * z12, forcing, ex.xi2)
    manifold, second_order = (sink[1].coeff(eps, order) for order in (0, 1))
    return MultipleScales(
        slow_manifold=manifold,
        host_rate=sp.expand(sp.solve(secular, ex.A_rate)[0]),
        correction=correction,
        second_order=second_order,
        sink=_reconstituted(manifold, second_order),
    )


def _reconstituted(first: Any, second: Any) -> Any:
    """Sum of both orders in B = B1 + eps B2, terms of order eps^2 dropped, at eps = 1."""
    eps = ex.epsilon
    whole = {
        ex.B1: ex.B - eps * ex.B2, ex.B1_bar: ex.B_bar - eps * ex.B2_bar,
        ex.B1_rate: ex.B_rate - eps * ex.B2_rate, ex.B1_rate_bar: ex.B_rate_bar - eps * ex.B2_rate_bar,
    }  # fmt: skip
    total = sp.expand((first + eps * second).subs(whole, simultaneous=True))
    return total.coeff(eps, 0) + total.coeff(eps, 1)


@functools.lru_cache(maxsize=2)
def derive(form: Form = "paper") -> Derivation:
    """Slow flow of the pipe with one cubic sink, from the equations of motion.

    Parameters
    ----------
    form : {"paper", "averaged"}
        "paper": multiple scales mixed with harmonic balance, as in the paper. "averaged": one harmonic of the
        forcing frequency Omega; second derivatives of the amplitudes and their rates in damping terms dropped.

    Returns
    -------
    Derivation

    Raises
    ------
    ParameterError
        If there is no such form.
    """
    check_choice("form", form, FORMS)
    host, sink, manifold = _paper_conditions() if form == "paper" else _averaged_conditions()
    coefficients = _coefficients(host, sink)
    cartesian = _cartesian(host, sink)
    return Derivation(
        form=form,
        host=host,
        sink=sink,
        slow_manifold=manifold,
        coefficients=coefficients,
        cartesian=cartesian,
        jacobian=cartesian.jacobian(STATE),
    )


def _paper_conditions() -> tuple[Any, Any, Any]:
    """Solvability conditions and slow manifold with A = X e^{i sigma t1} / 2, B = B1 = Z / 2 (Eq. 22)."""
    scales = multiple_scales()
    rotating = {
        ex.A: ex.X * ex.carrier / 2, ex.A_rate: (ex.X_rate + sp.I * ex.sigma * ex.X) * ex.carrier / 2,
        ex.B: ex.Z / 2, ex.B_bar: ex.Z_bar / 2, ex.B_rate: ex.Z_rate / 2, ex.B1: ex.Z / 2, ex.B1_bar: ex.Z_bar / 2,
    }  # fmt: skip
    host = 2 * sp.I * ex.omega * (ex.A_rate - scales.host_rate)
    return tuple(
        sp.expand(2 * condition.subs(rotating, simultaneous=True) / ex.carrier)
        for condition in (host, scales.sink, scales.slow_manifold)
    )


def _averaged_conditions() -> tuple[Any, Any, Any]:
    """First harmonic of both equations of motion, up to the first order of slowness and damping."""
    x, z = (Signal.harmonic(ex.Omega, amplitude / 2) for amplitude in (ex.X, ex.Z))
    forcing = Signal.harmonic(ex.Omega, ex.F / 2)
    both = ex.residuals(x, z, forcing, ex.epsilon * ex.xi2)
    host, sink = (sp.expand(2 * (r[1].coeff(ex.epsilon, 0) + r[1].coeff(ex.epsilon, 1))) for r in both)
    return host, sink, sink.subs({ex.X_rate: 0, ex.Z_rate: 0})


def _coefficients(host: Any, sink: Any) -> dict[str, Any]:
    """p, a, q, r, e, c1, c2 and 3/4 kappa, read off the solvability conditions."""
    e = sp.expand(-sink.coeff(ex.X))
    return {
        "p": host.coeff(ex.X_rate),
        "a": sp.expand(host.coeff(ex.X)),
        "q": sink.coeff(ex.X_rate),
        "r": sink.coeff(ex.Z_rate),
        "e": e,
        "c1": sp.expand(sp.I * host.coeff(ex.Z)),
        "c2": sp.expand(-sp.I * (sink.coeff(ex.Z) + e)),
        "cubic": sink.coeff(ex.Z**2 * ex.Z_bar),
    }


def _cartesian(host: Any, sink: Any) -> Any:
    """p1', q1', p2', q2' from the complex solvability conditions, which are linear in the rates."""
    values = {ex.X: p1 + sp.I * q1, ex.X_bar: p1 - sp.I * q1, ex.Z: p2 + sp.I * q2, ex.Z_bar: p2 - sp.I * q2}
    host_rate = _quotient(-host.subs(ex.X_rate, 0).subs(values), host.coeff(ex.X_rate))
    rest = sink.subs({ex.Z_rate: 0, ex.X_rate: host_rate}).subs(values)
    sink_rate = _quotient(-rest, sink.coeff(ex.Z_rate))
    return sp.Matrix([part for rate in (host_rate, sink_rate) for part in rate.as_real_imag()])


def _quotient(numerator: Any, denominator: Any) -> Any:
    """Complex numerator / denominator with a real denominator, as an expanded sum."""
    bar = ex.conjugated(denominator)
    below = sp.expand(denominator * bar)
    above = sp.expand(sp.expand(numerator) * bar)
    real, imaginary = above.as_real_imag()
    return sp.expand(real) / below + sp.I * sp.expand(imaginary) / below


def characteristic_polynomial(coefficients: Mapping[str, Any], relative_amplitude: Any) -> Any:
    """det(lambda I - J) |p r|^2 at an equilibrium, in closed form and for real lambda.

    Parameters
    ----------
    coefficients : mapping of str to number or sympy.Expr
        As in `Derivation.coefficients`.
    relative_amplitude : number or sympy.Expr
        |Z| [m].

    Returns
    -------
    sympy.Expr
        |d + 2 n s|^2 - n^2 |s|^2, a polynomial of degree 4 in `lam`, with n = 3/4 kappa |Z|^2,
        d = (q lam - e) i c1 + (p lam + a)(r lam - e + i c2) and s = (q lam - e) + (p lam + a).
    """
    p, a, q, r, e, c1, c2, cubic = (coefficients[k] for k in ("p", "a", "q", "r", "e", "c1", "c2", "cubic"))
    n = cubic * relative_amplitude**2
    d = (q * lam - e) * sp.I * c1 + (p * lam + a) * (r * lam - e + sp.I * c2)
    s = (q * lam - e) + (p * lam + a)
    shifted = d + 2 * n * s
    return sp.expand(shifted * ex.conjugated(shifted) - n**2 * s * ex.conjugated(s))
