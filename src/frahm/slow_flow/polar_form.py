"""The paper form of the slow flow in polar coordinates and its equilibria (Eqs. 18 and 20), with SymPy."""

from __future__ import annotations

import functools
from typing import Any

import sympy as sp

from frahm.slow_flow import expansion as ex
from frahm.slow_flow.derivation import multiple_scales

a, b = sp.symbols("a b", positive=True)
da, db, dalpha, dbeta = sp.symbols("da db dalpha dbeta", real=True)
cos1, sin1, cos2, sin2 = sp.symbols("cos1 sin1 cos2 sin2", real=True)


@functools.lru_cache(maxsize=1)
def polar_equations() -> tuple[Any, Any, Any, Any]:
    """Rows of Eq. 18 of doi 10.3390/app12147272 as residuals, left-hand side minus right-hand side [m/s^2].

    Put A = a e^{i alpha} / 2 and B = b e^{i beta} / 2 into Eqs. 13 and 16, with gamma1 = alpha - beta - sigma t1
    and gamma2 = alpha - sigma t1; `da` ... `dbeta` are the rates, `cos1` ... `sin2` the cosines and sines.

    Returns
    -------
    tuple of sympy.Expr
        Rows that begin with omega a alpha', omega a', rho2 omega b beta' and -rho2 omega b'.
    """
    scales = multiple_scales()
    phase1, phase2 = cos1 + sp.I * sin1, cos2 + sp.I * sin2
    pipe_rate, sink_rate = (da + sp.I * a * dalpha) / 2, (db + sp.I * b * dbeta) / 2
    # The host's equation in the frame of A, where the sink turns by -gamma1 and the force by -gamma2.
    in_host = {ex.A: a / 2, ex.B1: b / 2, ex.B1_bar: b / 2}
    driven = sp.expand(2 * ex.omega * scales.host_rate.subs(in_host))
    forced = driven.coeff(ex.F) * ex.F / ex.carrier
    coupled = driven.coeff(ex.carrier, 1) - forced
    rotated = driven.coeff(ex.carrier, 0) + ex.conjugated(phase1) * coupled + ex.conjugated(phase2) * forced
    host = sp.expand(2 * ex.omega * pipe_rate - rotated)
    in_sink = {
        ex.A: a / 2 * phase1 * ex.carrier, ex.A_rate: pipe_rate * phase1 * ex.carrier,
        ex.B: b / 2, ex.B_bar: b / 2, ex.B_rate: sink_rate,
    }  # fmt: skip
    sink = sp.expand(-scales.sink.subs(in_sink, simultaneous=True) / ex.carrier)
    along, across = host.as_real_imag()
    return tuple(sp.expand(row) for row in (across, along, *sink.as_real_imag()))


@functools.lru_cache(maxsize=1)
def equilibrium_relations() -> dict[str, Any]:
    """Sines and cosines of both phases at an equilibrium of amplitudes a and b (Eq. 20).

    Returns
    -------
    dict of str to sympy.Expr
        Keys sin1, cos1, sin2, cos2.
    """
    at_rest = {da: 0, db: 0, dalpha: ex.sigma, dbeta: 0}
    host_across, host_along, sink_along, sink_across = (row.subs(at_rest) for row in polar_equations())
    inner = sp.solve([sink_along, sink_across], [cos1, sin1], dict=True)[0]
    outer = sp.solve([host_across.subs(inner), host_along.subs(inner)], [cos2, sin2], dict=True)[0]
    return {symbol.name: sp.factor(value) for symbol, value in {**inner, **outer}.items()}
