"""Branches as they are followed: numbers of harmonics, and starts that see every root."""

import numpy as np
import pytest

import frahm
from frahm.harmonic_balance import find_branches, search_over
from frahm.harmonic_balance.condensation import condense
from frahm.harmonic_balance.seeds import amplitude_roots, seeder_for, spring_polynomial


def sink(coefficients=(0, 0, 0.01), damping=0.05):
    law = frahm.Polynomial(coefficients, damping)
    return frahm.System(np.diag([1, 0.1]), np.diag([0.02, 0]), np.diag([1.0, 0]), (1, 0), [frahm.Element((-1, 1), law)])


@pytest.mark.parametrize("harmonics", [3, 9, 25])
def test_a_given_number_of_harmonics_is_kept(harmonics):
    for branch in find_branches(search_over(sink(), 0.7, 0.85, harmonics)):
        assert set(branch.points.Hs) == {harmonics}


def test_automatic_number_of_harmonics_reaches_its_goal():
    for branch in find_branches(search_over(sink(), 0.6, 1.5, None)):
        assert np.max(branch.points.truncations) < 1e-8
        assert len(set(branch.points.Hs)) > 1


@pytest.mark.parametrize(
    "coefficients", [(0, 0, 0.3), (0.2, 0, -0.1), (0, 0, 0.1, 0, 0.02), (0.1, 0, -0.3, 0, 0.2, 0, 0.1)]
)
def test_all_amplitude_roots_against_brute_force(coefficients):
    problem = condense(sink(coefficients))
    e = spring_polynomial(problem)
    random = np.random.default_rng(0)
    law = frahm.Polynomial(coefficients)
    linear = coefficients[0]
    for _ in range(30):
        S, F = complex(random.normal(), 0.2 * random.normal()), complex(random.normal(), random.normal())
        grid = np.linspace(1e-6, 12, 200001)  # amplitudes; the linear spring belongs to S
        miss = np.abs(S + law.describing_stiffness(grid) - linear) * grid - abs(F)
        at = np.flatnonzero(miss[:-1] * miss[1:] < 0)
        roots = np.sqrt(amplitude_roots(S, F, e))
        roots = roots[roots < 12]
        np.testing.assert_allclose(roots, 0.5 * (grid[at] + grid[at + 1]), atol=1e-4)


def test_starts_of_a_law_with_even_powers_balance_its_mean_force():
    coefficients = (0.2, 0.3, 0.1)
    problem = condense(sink(coefficients))
    tau = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    seeds = seeder_for(problem, np.array([0.8, 0.9, 1.0])).at(0.9, 1.0)
    assert seeds
    for seed in seeds:
        z = seed.harmonics[0][0].real + abs(seed.harmonics[1][0]) * np.cos(tau)
        force = frahm.Polynomial(coefficients).force(z)
        assert abs(np.mean(force)) < 1e-3 * np.max(np.abs(force))
