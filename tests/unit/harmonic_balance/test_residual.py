"""Residual and Jacobian of harmonic balance against the equations in time, differences, and exact convolution."""

import numpy as np
import pytest

from frahm.harmonic_balance.condensation import condense
from frahm.harmonic_balance.kernels import (
    element_force,
    fourier_tables,
    harmonic_count,
    harmonics_of,
    residual_and_jacobian,
    sample_count,
)

CASES = [
    (seed, laws, odd, dependent)
    for seed in range(3)
    for laws, odd in (
        ("cubic", True),
        ("odd", True),
        ("cubic", False),
        ("any", False),
        ("sliding", True),
        ("heavy", False),
    )
    for dependent in (False, True)
]


def evaluate(problem, H, odd, W, X):
    n = 2 * problem.M11.shape[0] * harmonic_count(H, odd)
    R, J = np.empty(n + 1), np.empty((n + 1, n + 1))
    tables = fourier_tables(H, odd, sample_count(problem, H, odd))
    truncation = residual_and_jacobian(problem, H, odd, W, X, *tables, R, J)
    return R[:n], J[:n, : n + 1], truncation


def point(problem, H, odd, seed):
    """Random unknowns with decaying harmonics; the imaginary part of harmonic 0 is no unknown and kept at zero."""
    r = problem.M11.shape[0]
    count = harmonic_count(H, odd)
    X = np.random.default_rng(seed).normal(size=(count, r, 2)) * 0.7 ** np.arange(count)[:, None, None]
    if not odd:
        X[0, :, 1] = 0
    return np.concatenate([X.ravel(), [0.0]])


@pytest.mark.parametrize(("seed", "laws", "odd", "dependent"), CASES)
def test_jacobian_against_differences(make_system, seed, laws, odd, dependent):
    problem = condense(make_system(seed, n=4, elements=2, laws=laws, dependent=dependent))
    H, W, h = 5, 1.3, 1e-6
    X = point(problem, H, odd, seed)
    _, J, _ = evaluate(problem, H, odd, W, X)
    n = J.shape[0]
    differences = np.empty_like(J)
    for j in range(n):
        step = h * np.eye(n + 1)[j]
        differences[:, j] = (evaluate(problem, H, odd, W, X + step)[0] - evaluate(problem, H, odd, W, X - step)[0]) / (
            2 * h
        )
    differences[:, n] = (evaluate(problem, H, odd, W + h, X)[0] - evaluate(problem, H, odd, W - h, X)[0]) / (2 * h)
    np.testing.assert_allclose(J, differences, rtol=2e-6, atol=2e-8 * np.abs(J).max())


@pytest.mark.parametrize(("laws", "odd"), [("cubic", True), ("odd", True), ("any", False)])
def test_element_force_is_free_of_aliasing(make_system, laws, odd):
    # a polynomial of a Fourier polynomial is a convolution: z(t) = sum_k c_k e^{ikt}
    system = make_system(5, n=3, elements=1, laws=laws)
    problem = condense(system)
    H = 7 if odd else 6
    u = np.empty((H + 5, 1), complex)
    harmonics_of(problem, H, odd, point(problem, H, odd, 3), u)
    tables = fourier_tables(H, odd, sample_count(problem, H, odd))
    G, slope = np.zeros(H + 5, complex), np.zeros(2 * H + 1, complex)
    element_force(problem, 0, H, odd, 1.0, u, *tables, G, slope, np.zeros_like(slope))
    half = problem.directions[0, 0] * u[: H + 1, 0] / 2
    z = np.concatenate([half[:0:-1].conj(), [2 * half[0].real], half[1:]])
    law = system.elements[0].law.coefficients
    force, stiff, power = np.zeros(1, complex), np.zeros(1, complex), np.ones(1, complex)
    for k, c in enumerate(law, start=1):
        if k > 1:  # the linear spring belongs to the host
            stiff = _plus(stiff, k * c * power)
        power = np.convolve(power, z)
        force = _plus(force, (c if k > 1 else 0.0) * power)
    middle = len(force) // 2
    expected = np.concatenate([force[middle : middle + 1], 2 * force[middle + 1 : middle + H + 5]])
    kept = slice(1, None, 2) if odd else slice(None)
    np.testing.assert_allclose(G[kept], expected[kept], rtol=1e-11, atol=1e-12 * np.abs(expected).max())
    middle = len(stiff) // 2
    kept = slice(0, None, 2) if odd else slice(None)
    expected = stiff[middle : middle + 2 * H + 1]
    np.testing.assert_allclose(slope[kept], expected[kept], rtol=1e-11, atol=1e-12 * np.abs(expected).max())


def _plus(a, b):
    long, short = (a, b) if len(a) >= len(b) else (b, a)
    out = long.copy()
    start = (len(long) - len(short)) // 2
    out[start : start + len(short)] += short
    return out


def test_truncation_is_the_part_of_the_force_nothing_balances(make_system):
    # one cubic spring, H = 1: the force has harmonics 1 and 3 with |G_3| = c |Z|^3/4; 5 does not occur
    system = make_system(2, n=2, elements=1)
    problem = condense(system)
    X = np.array([0.8, -0.3, 0.0])
    _, _, truncation = evaluate(problem, 1, True, 1.1, X)
    Z = problem.directions[0, 0] * abs(0.8 - 0.3j)
    c = system.elements[0].law.coefficients[2]
    S = np.empty((1, 1), complex)
    f = np.empty(1, complex)
    from frahm.harmonic_balance.kernels import stiffness

    stiffness(problem, 1.1j, S, S.copy(), f, f.copy())
    size = np.hypot(abs(f[0]), 0.75 * c * Z**3)
    assert truncation == pytest.approx(0.25 * c * Z**3 / size, rel=1e-12)
