"""The fixed-point indices of all responses at a frequency add up; a response left out is seen by them."""

import numpy as np
import pytest

import frahm
from frahm.harmonic_balance.indices import degree, index, missing

OMEGA = 2 * np.pi * 0.78


def host(stiffness=1.0, force=0.006, damping=0.003):
    return frahm.System(
        mass=np.diag([1.0, 0.02]), damping=np.diag([damping, 0.0]), stiffness=np.diag([1.0, 0.0]), forcing=[force, 0.0],
        elements=[frahm.Element([-1.0, 1.0], frahm.Cubic(stiffness, 0.002))], output=0, reference_frequency=1.0,
    )  # fmt: skip


def one_mass(coefficients, damping=0.1, force=0.08, stiffness=1.0):
    law = frahm.Polynomial(coefficients)
    return frahm.System(
        mass=[[1.0]], damping=[[damping]], stiffness=[[stiffness]], forcing=[force],
        elements=[frahm.Element([1.0], law)],
    )  # fmt: skip


@pytest.mark.parametrize(
    ("coefficients", "expected"),
    [
        ([0, 0, 1.0], 1),  # hardening
        ([0, 0, -1.0], -1),  # softening: one well between two tops
        ([0, 1.0], 0),  # one well and one top
        ([-2.0, 0, 1.0], 1),  # two wells
        ([0, 0, -1.0, 0, 0.2], 1),
    ],
)
def test_the_degree_of_one_mass_is_told_by_its_force_far_out(coefficients, expected):
    system = one_mass(coefficients)
    assert degree(system, 1e9) == expected
    static = np.poly1d([*reversed(coefficients), 0.0]) + np.poly1d([1.0, 0.0])
    at_rest = static.roots[np.abs(static.roots.imag) < 1e-9].real
    assert sum(np.sign(static.deriv()(at_rest))) == expected


@pytest.mark.parametrize("frequency", [0.7, 0.9, 0.95, 1.1])
@pytest.mark.parametrize("coefficients", [[0, 0, 1.0], [0, 0, -1.0], [0, 0, -1.0, 0, 0.3]])
def test_indices_of_all_responses_add_up_and_one_left_out_is_seen(coefficients, frequency):
    system = one_mass(coefficients, force=0.05)
    found = frahm.periodic_responses(system, frequency=frequency)
    multipliers = [response.multipliers for response in found]
    largest = max(response.relative_peak for response in found)
    assert sum(index(values) for values in multipliers) == degree(system, 1e9)
    assert missing(system, multipliers, largest) == ()
    if len(found) > 1:
        (said,) = missing(system, multipliers[1:], largest)
        assert "There are further responses" in said


@pytest.mark.parametrize("detuning", [-0.3, -0.11, 0.0, 0.06, 0.2])
def test_indices_of_a_pipe_with_a_sink_add_up(detuning):
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0044)
    found = frahm.periodic_responses(case, detuning=detuning)
    assert found
    assert sum(index(response.multipliers) for response in found) == 1
    assert not found.unverified


def test_nothing_is_claimed_where_motions_may_grow_or_rounding_decides():
    assert degree(host(damping=-0.01), 1e9) is None
    assert degree(host(stiffness=-1.0), 1e9) is None
    assert index(np.array([1 + 1e-9, 0.2])) == 0
    assert index(np.array([np.nan, np.nan])) == 0
    assert index(np.array([3.0, 0.2, 0.5 + 0.5j, 0.5 - 0.5j])) == -1


def test_an_empty_list_says_that_nothing_was_found():
    found = frahm.periodic_responses(host(force=100.0), frequency=1.02)
    assert list(found) == []
    assert "No periodic response was found: Newton's method failed from every seed." in found.unverified


def test_a_law_with_other_equilibria_says_that_unstable_responses_may_lack():
    system = one_mass([0, -0.6962968851147534], damping=0.16434414603471012, force=0.2487637765688694)
    found = frahm.periodic_responses(system, frequency=0.44944347909161264)
    assert any("further unstable responses" in sentence for sentence in found.unverified)
    hardening = frahm.periodic_responses(one_mass([0, 0, 1.0]), frequency=1.0)
    assert not hardening.unverified


@pytest.mark.filterwarnings("error")
def test_a_frequency_at_which_forces_vanish_among_roundings_is_a_value():
    found = frahm.periodic_responses(host(), frequency=1e-9)
    assert found.unverified
    assert all(response.pipe_peak == pytest.approx(0.006) for response in found)
