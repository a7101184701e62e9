"""Continuation on curves known in closed form."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from frahm.continuation import ContinuationSettings, CurvePoint, between_points, follow_curve, newton, zero_curves
from frahm.continuation.dense import factorise, solve_factorised
from frahm.errors import Outcome, ParameterError
from searching import at_most


def circle(y):
    return np.array([y @ y - 1.0]), 2 * y[None]


def everywhere(_):
    return True


def collected(residual, start, direction, inside=everywhere, **settings):
    items = list(follow_curve(residual, np.array(start), np.array(direction), inside, ContinuationSettings(**settings)))
    return items[:-1], items[-1]


def test_a_closed_curve_is_recognised_and_stays_on_itself():
    points, outcome = collected(circle, [1.0, 0.0], [0.0, 1.0])
    assert outcome is Outcome.CLOSED
    ys = np.array([p.y for p in points])
    assert np.linalg.norm(ys, axis=1) == pytest.approx(np.ones(len(ys)), abs=1e-12)
    assert np.sum(np.linalg.norm(np.diff(ys, axis=0), axis=1)) == pytest.approx(2 * math.pi, rel=1e-3)


@pytest.mark.parametrize("step", [0.005, 0.02, 0.05])
def test_a_fold_is_passed_and_located_whatever_the_step(step):
    def cusp(y):  # x^3 - x = p: folds at p = -+ 2/(3 sqrt 3)
        x, p = y
        return np.array([x**3 - x - p]), np.array([[3 * x * x - 1, -1.0]])

    points, outcome = collected(
        cusp, [-2.0, -6.0], [1.0, 0.0], lambda y: abs(y[1]) < 7, longest_step=step * 10, first_step=step
    )
    assert outcome is Outcome.WINDOW_LEFT
    folds = []
    for a, b in itertools.pairwise(points):
        if a.tangent[1] * b.tangent[1] < 0:
            folds.append(between_points(cusp, a, b, lambda p: float(p.tangent[1]), 1e-10).y[1])
    assert sorted(folds) == pytest.approx([-2 / (3 * math.sqrt(3)), 2 / (3 * math.sqrt(3))], abs=1e-12)


def test_ends_are_said_in_words():
    def parabola(y):
        return np.array([y[1] - y[0] ** 2]), np.array([[-2 * y[0], 1.0]])

    _, outcome = collected(parabola, [0.0, 0.0], [1.0, 0.0], lambda y: y[0] < 0.5)
    assert outcome is Outcome.WINDOW_LEFT
    _, outcome = collected(parabola, [0.0, 0.0], [1.0, 0.0], most_points=5)
    assert outcome is Outcome.STEP_LIMIT
    _, outcome = collected(lambda y: (np.array([np.nan]), np.ones((1, 2))), [0.0, 0.0], [1.0, 0.0])
    assert outcome is Outcome.NOT_CONVERGED


def test_newton_gives_up_without_an_exception():
    assert newton(lambda y: (np.array([1.0]), np.zeros((1, 2))), np.zeros(2), np.array([1.0, 0.0]), 1e-9) is None


def test_no_point_between_ends_of_one_sign():
    a, b = (CurvePoint(np.array([x, 0.0]), np.array([1.0, 0.0])) for x in (0.0, 1.0))
    assert between_points(circle, a, b, lambda p: 1.0, 1e-9) is None


@pytest.mark.parametrize("name", ["first_step", "longest_step", "angle", "tolerance"])
def test_settings_check_themselves(name):
    with pytest.raises(ParameterError, match=name):
        ContinuationSettings(**{name: 0})


def test_zero_curves_lie_on_the_curve_to_rounding():
    x, y = np.linspace(-2, 2, 41), np.linspace(-2, 2, 38)
    (curve,) = zero_curves(lambda a, b: a**2 + b**2 - 1, x, y)
    assert np.hypot(curve[:, 0], curve[:, 1]) == pytest.approx(np.ones(len(curve)), abs=1e-14)
    assert len(zero_curves(lambda a, b: np.where(a > 0, a**2 + b**2 - 1, np.nan), x, y)) == 1


@at_most(60)
@given(st.integers(1, 12), st.integers(0, 10**6))
def test_factorisation_solves_as_numpy_does(n, seed):
    rng = np.random.default_rng(seed)
    A, b = rng.normal(size=(n, n)), rng.normal(size=n)
    expected = np.linalg.solve(A, b)
    work, pivots, x = A.copy(), np.empty(n, np.int64), b.copy()
    assert factorise(work, pivots, n)
    solve_factorised(work, pivots, n, x)
    assert A @ x == pytest.approx(b, abs=1e-9 * np.linalg.cond(A))
    assert x == pytest.approx(expected, rel=1e-8 * np.linalg.cond(A), abs=1e-10 * np.linalg.cond(A))


def test_a_singular_matrix_is_said_to_be_one():
    assert not factorise(np.zeros((3, 3)), np.empty(3, np.int64), 3)
