"""What a search says of itself, and responses that lie far from where one looks first."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import frahm
from frahm.harmonic_balance import find_branches, search_over
from frahm.harmonic_balance.bifurcations import unstable_count
from frahm.harmonic_balance.found import Budget

OMEGA = 2 * math.pi * 0.78


def spring(stiffness=1.0, cubic=-1.0, force=0.08):
    element = frahm.Element([1.0], frahm.Cubic(cubic, 0.0))
    return frahm.System([[1.0]], [[0.1]], [[stiffness]], [force], [element], reference_frequency=1.0)


def with_bistable_sink():
    law = frahm.Bistable(5598.142229318235, 6.183908375234579, 0.014775054946318766)
    force = 0.00624696 * 2.7006029734716
    host = [np.diag(row) for row in ([1.0, 0.022065808349632], [0.003 * OMEGA, 0.0], [OMEGA**2, 0.0])]
    return frahm.System(*host, [force, 0.0], [frahm.Element([-1.0, 1.0], law)])


@pytest.mark.parametrize(("frequency", "peak"), [(0.9, 1.0277), (1.2, 1.0227)])
def test_orbits_about_the_hill_tops_of_a_softening_spring_are_found(frequency, peak):
    found = frahm.periodic_responses(spring(), frequency=frequency)
    tops = [response for response in found if not response.symmetric]
    assert len(found) == 3
    assert sorted(float(r.harmonics[0][0].real) for r in tops) == pytest.approx([-1, 1], abs=2e-3)
    assert [r.pipe_peak for r in tops] == pytest.approx([peak, peak], abs=1e-4)
    assert not any(r.stable for r in tops)
    for response in tops:  # unstable: they can be integrated over a part of the period only
        t = np.linspace(0, 0.3 * response.period, 20)

        def motion(s, y):
            return [y[1], 0.08 * math.cos(frequency * s) - 0.1 * y[1] - y[0] + y[0] ** 3]

        run = solve_ivp(motion, (0, t[-1]), response.state, t_eval=t, rtol=1e-11, atol=1e-12)
        assert response.x(t)[:, 0] == pytest.approx(run.y[0], abs=1e-7)


def test_branches_in_a_well_are_asymmetric_though_no_loss_of_symmetry_leads_to_them():
    curve = frahm.frequency_response(spring(-0.5, 0.5, 0.02), frequency=(0.8, 1.1))
    in_well = [b for b in curve.branches if np.all(b.pipe_peak > 0.9) and np.all(b.pipe_amplitude < 0.5)]
    assert in_well
    assert all(b.asymmetric for b in in_well)
    assert not all(b.asymmetric for b in curve.branches)  # the orbit about the top in the middle


def test_a_window_far_below_resonance_is_no_failure():
    curve = frahm.frequency_response(spring(), frequency=(0.3, 0.9))
    assert len(curve.branches) >= 2
    assert np.all(np.isfinite(curve.pipe_peak))


def test_growth_beyond_all_numbers_is_said_and_counts_as_unstable():
    curve = frahm.frequency_response(spring(force=0.001), frequency=(0.004, 0.006))
    on_top = [b for b in curve.branches if b.asymmetric]
    assert on_top
    assert not any(np.any(b.stable) for b in on_top)
    assert any("beyond all numbers" in text for text in curve.unverified)
    responses = frahm.periodic_responses(spring(force=0.001), frequency=0.005)
    tops = [r for r in responses if not r.symmetric]
    assert tops
    assert not any(r.stable for r in tops)
    assert all(np.isinf(r.multipliers).all() for r in tops)


def test_multipliers_that_drown_in_the_rounding_of_a_large_one_are_not_counted():
    assert unstable_count(np.array([2.0, 1.0 + 1e-6, 0.5])) == 2
    assert unstable_count(np.array([1e20, 40.0, 0.5])) == 1
    assert unstable_count(np.array([np.inf, np.inf])) == 1


def test_a_search_without_end_stops_at_its_limit_and_says_so():
    search = search_over(with_bistable_sink(), 0.88 * OMEGA, 1.12 * OMEGA, None)
    search = dataclasses.replace(search, budget=Budget(points=2500, bifurcations=10))
    found = find_branches(search)
    assert found
    assert len(search.budget.sentences()) == 2
    assert sum(event.located for branch in found for event in branch.bifurcations) <= 20


def test_lists_say_what_was_searched():
    case = frahm.load_case("jacket-pipe")
    responses = frahm.periodic_responses(case, detuning=-0.05)
    assert "all first-harmonic roots" in responses.searched
    assert responses.unverified == ()
    events = frahm.detached_curve_events(case, "force", (1.0, 1.05), detuning=(-0.02, 0.0), slices=2)
    assert "force between 1 and 1.05" in events.searched
    assert "rad/s" in events.searched
