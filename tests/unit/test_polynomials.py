"""Roots in closed form, held against exact arithmetic: what comes out solves an equation a few roundings away."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from frahm.polynomials import growth_rate, quadratic_factors, universal_roots
from searching import at_most

ROUNDING = 2.0**-52
sizes = st.floats(-30, 30).map(lambda power: 10.0**power)
numbers = st.floats(-2, 2).map(lambda value: round(value, 15))


def backward_error(coefficients, factors):
    """Largest error of a coefficient of the product over what the moduli of the roots add up to, in roundings."""
    A, B, G, H = (Fraction(value) for value in factors)
    product = (A + G, B + H + A * G, A * H + B * G, B * H)
    a, g = (max(abs(p), 2 * math.sqrt(abs(q))) for p, q in (factors[:2], factors[2:]))
    b, h = abs(factors[1]), abs(factors[3])
    scales = (a + g, b + h + a * g, a * h + b * g, b * h)
    errors = [abs(p - Fraction(c)) for p, c in zip(product, coefficients, strict=True)]
    return max(
        float(error / Fraction(scale)) / ROUNDING if scale else (math.inf if error else 0.0)
        for error, scale in zip(errors, scales, strict=True)
    )


def quartic_of(quadratics):
    return [float(c) for c in np.polymul([1, *quadratics[:2]], [1, *quadratics[2:]])[1:]]


@at_most(300)
@given(st.lists(numbers, min_size=4, max_size=4))
@example([0.819331900705947, 0.0, 0.0, 0.0])  # three roots are 0
@example([1.0, 0.0, 0.0, 1e-10])  # three small roots about a triple one
@example([0.7617598898818461, 0.0, 1e-10, 1e-10])
@example([0.0, 2.0, 0.0, 1.0])  # two equal pairs
@example([0.0, 1e-10, 0.0, -1.0])
@example([1e-10, -1.0, 0.0, 0.0])
@example([-4.0, 6.0, -4.0, 1.0])  # one root four times
@example([2.62821795365135, 2.5903237022014673, 1.1346559622886017, 0.18638271931055223])  # two pairs, all but equal
@example([7.319878316756202, 20.092732401510975, 24.5127271045445, 11.214386957718641])
def test_quadratic_factors_multiply_back(coefficients):
    assert backward_error(coefficients, quadratic_factors(*coefficients)) < 64


@at_most(300)
@given(st.lists(st.tuples(sizes, st.sampled_from([-1.0, 1.0])).map(math.prod), min_size=4, max_size=4))
@example([-1e8, 1.0, 2e-8, 1e-16])
def test_factors_whose_roots_differ_much_in_size_multiply_back(quadratics):
    coefficients = quartic_of(quadratics)
    assert backward_error(coefficients, quadratic_factors(*coefficients)) < 64


@at_most(300)
@given(numbers, st.floats(-16, -1), st.lists(numbers, min_size=4, max_size=4))
def test_factors_of_roots_that_gather_multiply_back(centre, power, spread):
    roots = [centre + 10.0**power * part for part in spread]
    coefficients = [float(c) for c in np.poly(roots)[1:]]
    assert backward_error(coefficients, quadratic_factors(*coefficients)) < 64


@pytest.mark.parametrize(
    "roots", [(-1e6, -1e-6, -2e6, -3e-6), (-1e8, -1e-8, 1e-9j, -1e-9j), (-1e7, -3e-7, -1e-3 + 1j, -1e-3 - 1j)]
)
def test_slow_growth_beside_fast_decay_keeps_its_digits(roots):
    coefficients = np.poly(roots)[1:].real
    slowest = max(complex(root).real for root in roots)
    assert growth_rate(*coefficients) == pytest.approx(slowest, rel=1e-9, abs=1e-20)


@at_most(300)
@given(st.floats(-1, 1), st.floats(-12, 12))
@example(-0.9999999998277942, math.log10(3.4441164077249846e-10))  # two roots all but equal, and a small one
@example(-0.9957623283234587, math.log10(0.008403510595899732))
@example(0.0, -30.0)
def test_universal_roots_solve_their_cubic(c, power):
    h = 10.0**power
    assert_universal_roots(c, h)


@at_most(300)
@given(st.floats(0, 0.13397459), st.floats(-16, -2), st.sampled_from([-1, 1]), st.sampled_from([-1, 1]))
@example(0.0, -16.0, 1, 1)
@example(0.03125, -16.0, -1, 1)  # two roots all but equal, in the wrong order
def test_universal_roots_solve_their_cubic_beside_a_fold(offset, power, side, fold):
    c = -1.0 + offset
    m = (-2 * c + fold * math.sqrt(4 * c * c - 3)) / 3
    assert_universal_roots(c, max((m * m + 2 * c * m + 1) * m * (1 + side * 10.0**power), 1e-18))


def assert_universal_roots(c, h):
    count, *roots = universal_roots(c, h)
    for root in roots[:count]:
        m, C, F = Fraction(root), Fraction(c), Fraction(h)
        assert m > 0
        assert abs(m**3 + 2 * C * m**2 + m - F) <= 8 * Fraction(ROUNDING) * (m**3 + 2 * abs(C) * m**2 + m + F)
    assert list(roots[:count]) == sorted(roots[:count])
