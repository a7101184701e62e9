"""The condensed host against the full matrices."""

import numpy as np
import pytest

import frahm
from frahm.harmonic_balance.condensation import condense
from frahm.harmonic_balance.kernels import output_harmonic, stiffness

CASES = [(seed, dependent) for seed in range(8) for dependent in (False, True)]


def condensed(problem, s):
    r = problem.M11.shape[0]
    S, dS = np.empty((r, r), complex), np.empty((r, r), complex)
    f, df = np.empty(r, complex), np.empty(r, complex)
    stiffness(problem, complex(s), S, dS, f, df)
    return S, dS, f, df


def full(system):
    """C, K with the elements' linear parts, and the elements' directions as columns."""
    C, K = system.damping.copy(), system.stiffness.copy()
    for element in system.elements:
        outer = np.outer(element.direction, element.direction)
        C, K = C + element.law.damping * outer, K + element.law.coefficients[0] * outer
    return C, K, np.column_stack([element.direction for element in system.elements])


@pytest.mark.parametrize(("seed", "dependent"), CASES)
def test_element_displacements_under_any_element_forces(make_system, seed, dependent):
    # D x = f - N G has the elements' displacements z = N^T x: the condensed S u = F - directions G must give the same z
    system = make_system(seed, dependent=dependent)
    problem = condense(system)
    random = np.random.default_rng(seed)
    C, K, N = full(system)
    for s in (0.3j, 1.7j, 0.2 + 4.1j, -0.1 + 0.6j):
        G = random.normal(size=N.shape[1]) + 1j * random.normal(size=N.shape[1])
        x = np.linalg.solve(s * s * system.mass + s * C + K, system.forcing - N @ G)
        S, _, f, _ = condensed(problem, s)
        u = np.linalg.solve(S, f - problem.directions @ G)
        np.testing.assert_allclose(problem.directions.T @ u, N.T @ x, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize(("seed", "dependent"), CASES)
def test_all_coordinates_from_the_elements_displacements(make_system, seed, dependent):
    system = make_system(seed, dependent=dependent)
    problem = condense(system)
    C, K, N = full(system)
    W = 1.37
    G = np.arange(1.0, N.shape[1] + 1) - 0.4j
    for k in (1, 2, 5):  # the excitation acts at k = 1 only
        s = 1j * k * W
        drive = system.forcing if k == 1 else 0 * system.forcing
        x = np.linalg.solve(s * s * system.mass + s * C + K, drive - N @ G)
        S, _, f, _ = condensed(problem, s)
        u = np.linalg.solve(S, (f if k == 1 else 0 * f) - problem.directions @ G)
        rows = [output_harmonic(problem, k, W, u, row) for row in range(2 + system.size)]
        expected = [system.output @ x, system.elements[0].direction @ x, *x]
        np.testing.assert_allclose(rows, expected, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("seed", range(8))
def test_derivative_by_the_complex_frequency(make_system, seed):
    problem = condense(make_system(seed))
    h = 1e-5
    for s in (0.3j, 1.7j, 0.2 + 4.1j):
        _, dS, _, df = condensed(problem, s)
        (ahead, _, f_ahead, _), (behind, _, f_behind, _) = condensed(problem, s + h), condensed(problem, s - h)
        np.testing.assert_allclose(dS, (ahead - behind) / (2 * h), rtol=1e-7, atol=1e-7 * np.abs(dS).max())
        np.testing.assert_allclose(df, (f_ahead - f_behind) / (2 * h), rtol=1e-7, atol=1e-6 * (1 + np.abs(df).max()))


def test_a_sink_by_hand():
    # x1 = (F + n g)/(m1 s^2 + c1 s + k1): S = m2 s^2 D1/(D1 + m2 s^2) + c s, with D1 of the host alone
    m1, c1, k1, m2, c, F = 2.0, 0.3, 5.0, 0.4, 0.05, 1.5
    sink = frahm.Element((-1, 1), frahm.Cubic(7.0, c))
    problem = condense(frahm.System(np.diag([m1, m2]), np.diag([c1, 0]), np.diag([k1, 0]), (F, 0), [sink]))
    for s in (0.5j, 1.6j, 3j):
        D1, inertia = m1 * s * s + c1 * s + k1, m2 * s * s
        S, _, f, _ = condensed(problem, s)
        np.testing.assert_allclose(S[0, 0], inertia * D1 / (D1 + inertia) + c * s, rtol=1e-11)
        np.testing.assert_allclose(f[0], -inertia * F / (D1 + inertia), rtol=1e-11)
    S, dS, _, _ = condensed(problem, 0)
    assert abs(S[0, 0]) < 1e-12  # a sink without linear spring rests wherever it is put
    assert np.isfinite(dS).all()


def test_a_structure_free_to_move_has_finite_stiffness_at_harmonic_zero():
    sink = frahm.Element((-1, 1), frahm.Cubic(1.0, 0.05))
    problem = condense(frahm.System(np.diag([1, 0.1]), np.diag([0.02, 0]), np.zeros((2, 2)), (1, 0), [sink]))
    S, dS, f, df = condensed(problem, 0)
    assert np.isfinite([S[0, 0], dS[0, 0], f[0], df[0]]).all()
    assert abs(S[0, 0]) < 1e-12


def test_drifting_structure_is_refused():
    sink = frahm.Element((-1, 1, 0), frahm.Cubic(1.0, 0.1))
    with pytest.raises(frahm.ParameterError, match=r"system: .*supported"):
        condense(frahm.System(np.eye(3), np.zeros((3, 3)), np.diag([1.0, 0, 0]), (1, 0, 0), [sink]))
