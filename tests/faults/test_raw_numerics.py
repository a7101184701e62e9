"""Matrices that are singular or hold what is no number: a value, or one sentence, never the library's own exception."""

import numpy as np
import pytest

import frahm
from frahm.arrays import eigenvalues
from frahm.attractors import orbits
from frahm.attractors.stroboscope import stroboscope
from frahm.continuation.pseudo_arclength import follow_curve, newton
from frahm.errors import Outcome
from frahm.harmonic_balance.condensation import condense
from frahm.harmonic_balance.seeds import searched_seeds, seeder_for

BROKEN = {"nan": np.full((3, 3), np.nan), "infinite": np.full((3, 3), np.inf)}


@pytest.mark.parametrize("matrix", BROKEN.values(), ids=BROKEN)
def test_eigenvalues_of_no_numbers_are_none(matrix):
    assert np.all(np.isnan(eigenvalues(matrix)))
    assert orbits.spectral_radius(matrix) == np.inf


def test_eigenvalues_of_numbers_are_those_of_numpy():
    matrix = np.array([[0.0, 1.0], [-1.0, 0.0]])
    np.testing.assert_allclose(sorted(eigenvalues(matrix), key=np.imag), [-1j, 1j])


def _decomposes(y):
    np.linalg.svd(np.full((2, 2), np.nan))
    return np.zeros(1), np.ones((1, 2))


def _singular(y):
    return np.array([y[0]]), np.array([[0.0, 0.0]])


@pytest.mark.parametrize("residual", [_decomposes, _singular])
def test_newton_fails_where_a_matrix_cannot_be_taken_apart(residual):
    start, normal = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    assert newton(residual, start, normal, 1e-9) is None
    assert list(follow_curve(residual, start, normal, lambda y: True)) == [Outcome.NOT_CONVERGED]


@pytest.mark.parametrize("stiffness", [1e300, 1e160])
def test_an_orbit_on_which_a_slope_is_no_number_is_none(stiffness):
    system = frahm.System(
        [[1.0]], [[0.1]], [[1.0]], [1.0], [frahm.Element([1.0], frahm.Polynomial([0.0, 0.0, stiffness]))]
    )
    assert orbits.points_needed(system, 6.0, np.array([1e30])) > orbits._MOST_POINTS
    assert orbits.orbit_at(stroboscope(system, 1.0), np.array([1e30, 0.0])) is None


def test_a_ball_whose_norm_cannot_be_found_claims_what_linear_theory_does(monkeypatch):
    system = frahm.build_system(frahm.load_case("jacket-pipe"))
    strobe = stroboscope(system, 4.5)

    def fails(*_):
        raise np.linalg.LinAlgError("SVD did not converge")

    monkeypatch.setattr(orbits, "_adapted_root", fails)
    ball = orbits._ball(strobe, np.zeros(4), 0.5 * np.eye(4), np.ones(4), 1)
    assert not ball.verified


def test_two_sinks_on_an_undamped_structure_right_at_its_resonance():
    mass, stiffness = np.eye(3), np.diag([1.0, 0.0, 0.0])
    elements = [frahm.Element(n, frahm.Cubic(1.0)) for n in ((-1.0, 1.0, 0.0), (-1.0, 0.0, 1.0))]
    system = frahm.System(mass, np.zeros((3, 3)), stiffness, (0.1, 0.0, 0.0), elements)
    problem = condense(system)
    # three masses held together on the spring
    W = np.sqrt(1.0 / 3.0)
    S = np.zeros((2, 2))
    for frequency in (W, np.nextafter(W, 0), np.nextafter(W, 1)):
        seeds = searched_seeds(problem, float(frequency), 1.0, True)
        assert all(np.all(np.isfinite(seed.harmonics[1])) for seed in seeds)
        first = seeder_for(problem, np.array([0.5, 0.6])).at(float(frequency), 1.0, first_only=True)
        assert all(np.all(np.isfinite(seed.harmonics[1])) for seed in first)
    from frahm.harmonic_balance.seeds import _linear

    np.testing.assert_array_equal(_linear(S + 0j, np.ones(2) + 0j), 0)


def test_a_beam_beyond_the_range_of_numbers_is_refused_in_one_sentence(monkeypatch):
    import scipy.linalg

    from frahm.structure.modes import beam_modes

    beam = frahm.load_case("jacket-pipe-elastic").pipe.beam()
    beam_modes.cache_clear()  # another test may have had these modes

    def fails(*_, **__):
        raise np.linalg.LinAlgError("The leading minor of order 3 of B is not positive definite.")

    monkeypatch.setattr(scipy.linalg, "eigh", fails)
    with pytest.raises(frahm.ParameterError, match="modes cannot be computed: The leading minor"):
        beam_modes(beam, 2)


@pytest.mark.filterwarnings("error")
def test_a_structure_of_sizes_beyond_numbers_is_refused_in_one_sentence():
    system = frahm.System(
        np.diag([1e-200, 1e-200]), np.zeros((2, 2)), np.diag([1e200, 1e200]), (1.0, 0.0),
        [frahm.Element((-1.0, 1.0), frahm.Cubic(1.0))], reference_frequency=1.0,
    )  # fmt: skip
    with np.errstate(all="ignore"), pytest.raises(frahm.ParameterError, match="a structure that"):
        frahm.frequency_response(system, frequency=(0.5, 1.5))
