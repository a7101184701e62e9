"""Damage in closed form, for a constant range and for Weibull distributed ranges: what counts are held against."""

from __future__ import annotations

import math

from scipy.special import gamma, gammainc, gammaincc

from frahm.errors import check_number
from frahm.published.dnv_rp_c203 import SNCurve
from frahm.units import MPA


def constant_range_damage(curve: SNCurve, stress_range: float, cycles: float) -> float:
    """Palmgren-Miner sum of `cycles` cycles of one stress range [Pa]: n/N(S) [-]."""
    S = check_number("stress_range", stress_range, at_least=0, unit="Pa")
    return check_number("cycles", cycles, at_least=0) / float(curve.cycles(S))


def weibull_damage(curve: SNCurve, largest_range: float, cycles: float, shape: float) -> float:
    """Palmgren-Miner sum of Weibull distributed stress ranges.

    D = n0 [q^m1/a1 Gamma(1 + m1/h, (S1/q)^h) + q^m2/a2 gamma(1 + m2/h, (S1/q)^h)], q = S0/(ln n0)^(1/h), S1 the limit
    of the curve at 1e7 cycles. Standing: the formula is secondary (DNV-RP-C203, quoted from elsewhere), its value
    checked against direct summation.

    Parameters
    ----------
    curve : SNCurve
    largest_range : float
        S0 [Pa], exceeded once in n0 cycles.
    cycles : float
        n0 [-].
    shape : float
        h [-].
    """
    S0 = check_number("largest_range", largest_range, above=0, unit="Pa") / MPA
    n0, h = check_number("cycles", cycles, above=1), check_number("shape", shape, above=0)
    q = S0 / math.log(n0) ** (1 / h)
    limit = (curve.limit / MPA / q) ** h
    upper, lower = 1 + curve.m1 / h, 1 + curve.m2 / h
    above = q**curve.m1 / 10**curve.log_a1 * gamma(upper) * gammaincc(upper, limit)
    below = q**curve.m2 / 10**curve.log_a2 * gamma(lower) * gammainc(lower, limit)
    return float(n0 * (above + below))
