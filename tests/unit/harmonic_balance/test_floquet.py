"""Floquet multipliers against integration of the variational equation by another code, and the peak of an orbit."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import frahm
from frahm.harmonic_balance.condensation import condense
from frahm.harmonic_balance.floquet import map_multipliers, monodromy, shifted_eigenvalues
from frahm.harmonic_balance.hill import refine_exponents
from frahm.harmonic_balance.kernels import harmonic_count, harmonics_of
from frahm.harmonic_balance.orbits import peak_of
from frahm.harmonic_balance.variation import variation_of

KINDS = (("odd", True), ("any", False), ("sliding", True), ("heavy", False))
CASES = [(seed, laws, odd) for seed in range(3) for laws, odd in KINDS]


def some_orbit(problem, H, odd, seed):
    """Harmonics of an arbitrary closed curve: the variational equation along it needs no equilibrium of forces."""
    r, count = problem.M11.shape[0], harmonic_count(H, odd)
    X = np.random.default_rng(seed).normal(size=(count, r, 2)) * 0.5 ** np.arange(count)[:, None, None]
    if not odd:
        X[0, :, 1] = 0
    u = np.empty((H + 5, r), complex)
    harmonics_of(problem, H, odd, X.ravel(), u)
    return u


def fundamental_matrix(system, problem, u, W, span):
    """By scipy: M dx'' + (C + sum dg/dw n n^T) dx' + (K + sum dg/dz n n^T) dx = 0, states (x, v)."""
    n, M = system.size, np.linalg.inv(system.mass)
    N = np.column_stack([element.direction for element in system.elements])
    ks = np.arange(len(u))

    def rate(t, y):
        waves = u * np.exp(1j * ks * W * t)[:, None]
        z, w = (problem.directions.T @ part.sum(axis=0).real for part in (waves, 1j * ks[:, None] * W * waves))
        C = system.damping + (N * [float(e.law.damping_at(w[i])) for i, e in enumerate(system.elements)]) @ N.T
        p = [float(e.law.stiffness(z[i])) for i, e in enumerate(system.elements)]
        K = system.stiffness + (N * p) @ N.T
        x, v = y.reshape(2, n, -1)
        return np.concatenate([v, -M @ (C @ v + K @ x)]).ravel()

    start = np.eye(2 * n)
    done = solve_ivp(rate, (0, span), start.ravel(), method="DOP853", rtol=1e-12, atol=1e-13)
    return done.y[:, -1].reshape(2 * n, 2 * n)


@pytest.mark.parametrize(("seed", "laws", "odd"), CASES)
def test_monodromy_of_random_systems(make_system, seed, laws, odd):
    system = make_system(seed, n=2 + seed, laws=laws)
    problem, W, H = condense(system), 1.2, 5
    u = some_orbit(problem, H, odd, seed)
    Phi = np.empty((2 * system.size, 2 * system.size))
    monodromy(problem, variation_of(system), H, odd, W, u, Phi)
    expected = fundamental_matrix(system, problem, u, W, (np.pi if odd else 2 * np.pi) / W)
    np.testing.assert_allclose(Phi, expected, atol=5e-7 * max(1, np.abs(expected).max()))


def host_of_six_modes(kappa=2.0):
    shape = np.array([1.0, 0.9, -0.8, 0.7, 1.0, -0.9])
    omega = np.array([1.0, 2.7, 5.2, 8.9, 13.0, 18.5])
    return frahm.System(
        np.diag([1.0] * 6 + [0.05]), np.diag([*(0.04 * omega), 0]), np.diag([*omega**2, 0]),
        [*(0.05 * shape), 0], [frahm.Element([*-shape, 1], frahm.Cubic(kappa, 0.01))],
        output=[*shape, 0],
    )  # fmt: skip


def test_refined_exponents_are_those_of_the_complete_host():
    system = host_of_six_modes()
    problem, H, W = condense(system), 13, 1.05
    for odd in (True, False):
        u = np.zeros((H + 5, 1), complex)
        u[1], u[3] = 0.3 - 0.1j, 0.01j
        exact, started = np.empty(14, complex), np.empty(14, complex)
        map_multipliers(problem, variation_of(system), H, odd, W, u, exact)
        started[:] = exact
        started[:2] *= 1.002  # conjugates or two real ones
        refine_exponents(problem, H, odd, W, u, started, 2)
        np.testing.assert_allclose(np.abs(started[:2]), np.abs(exact[:2]), rtol=1e-8)


def test_the_order_within_a_pair_does_not_matter():
    system = host_of_six_modes()
    problem, H, W = condense(system), 13, 1.05
    u = np.zeros((H + 5, 1), complex)
    u[1], u[3] = 0.3 - 0.1j, 0.01j
    exact = np.empty(14, complex)
    map_multipliers(problem, variation_of(system), H, True, W, u, exact)
    pair = next(i for i in range(13) if exact[i].imag != 0 and abs(exact[i] - exact[i + 1].conjugate()) < 1e-8)
    for order in ([pair, pair + 1], [pair + 1, pair]):
        started = exact[order] * 1.001
        refine_exponents(problem, H, True, W, u, started, 1)
        np.testing.assert_allclose(np.abs(started), np.abs(exact[pair]), rtol=1e-8)


def test_fast_modes_that_follow_statically_leave_the_critical_multipliers_exact():
    # the full matrices, integrated by scipy, know nothing of static modes
    system = host_of_six_modes()
    problem, H, W = condense(system), 13, 1.05
    u = np.zeros((H + 5, 1), complex)
    u[1], u[3] = 0.3 - 0.1j, 0.01j
    reduced = variation_of(system, 3 * 2.0 * 0.35**2, W)
    assert reduced.K.shape[0] < system.size
    out = np.empty(2 * reduced.K.shape[0], complex)
    map_multipliers(problem, reduced, H, True, W, u, out)
    exact = np.linalg.eigvals(-fundamental_matrix(system, problem, u, W, np.pi / W))
    exact = exact[np.argsort(-np.abs(exact))]
    np.testing.assert_allclose(np.abs(out[:2]), np.abs(exact[:2]), rtol=1e-8)


def test_eigenvalues_of_four_by_four_matrices():
    random = np.random.default_rng(0)
    for _ in range(300):
        A = random.normal(size=(4, 4)) * 10 ** random.uniform(-3, 1)
        out = np.empty(4, complex)
        shifted_eigenvalues(A, out)
        expected = np.linalg.eigvals(A)
        key = lambda values: np.lexsort((np.round(values.imag, 8), np.round(values.real, 8)))  # noqa: E731
        np.testing.assert_allclose(out[key(out)], expected[key(expected)], atol=1e-7 * np.abs(A).max())


@pytest.mark.parametrize("odd", [True, False])
def test_peak_against_dense_sampling(odd):
    random = np.random.default_rng(1)
    tau = np.linspace(0, 2 * np.pi, 40001)
    for H in (1, 3, 7, 15, 31):
        for _ in range(20):
            x = np.zeros(H + 1, complex)
            k = np.arange(1, H + 1, 2) if odd else np.arange(H + 1)
            x[k] = (random.normal(size=k.size) + 1j * random.normal(size=k.size)) / (1 + k) ** 2
            sampled = np.max(np.abs((x[k, None] * np.exp(1j * k[:, None] * tau)).real.sum(axis=0)))
            assert peak_of(x, H, odd) >= sampled * (1 - 1e-12)
            assert peak_of(x, H, odd) == pytest.approx(sampled, rel=2e-6)


def test_multipliers_of_a_linear_system_are_the_exponentials_of_its_eigenvalues(make_system):
    # a tiny cubic term makes it a nonlinear system for the program; the orbit is put to zero
    system = make_system(4, n=3, elements=1)
    element = frahm.Element(system.elements[0].direction, frahm.Cubic(1e-30, 0.1))
    plain = frahm.System(system.mass, system.damping, system.stiffness, system.forcing, [element])
    problem, W = condense(plain), 0.9
    n, inverse = plain.size, np.linalg.inv(plain.mass)
    C = plain.damping + 0.1 * np.outer(element.direction, element.direction)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ plain.stiffness, -inverse @ C]])
    expected = -np.exp(np.linalg.eigvals(A) * np.pi / W)
    out = np.empty(2 * n, complex)
    map_multipliers(problem, variation_of(plain), 3, True, W, np.zeros((8, 1), complex), out)
    for value in out:
        assert np.min(np.abs(expected - value)) < 1e-10
