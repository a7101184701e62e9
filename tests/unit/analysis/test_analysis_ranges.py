import numpy as np
import pytest

import frahm
from frahm.analysis.points import points_of_interest
from frahm.analysis.ranges import (
    detached_ranges,
    growth_rates_at,
    ranges_without_stable_response,
    unstable_ranges,
)
from frahm.analysis.response import exact_response, slow_flow_response
from frahm.analysis.section import Work

CASE = frahm.load_case("jacket-pipe")
STIFF = CASE.with_absorber(xi2=0.0085)


@pytest.fixture(scope="module")
def work():
    started = Work(STIFF)
    return started.with_section(exact_response(started)).with_section(slow_flow_response(started))


@pytest.mark.parametrize(
    ("name", "left", "hopf", "right_from", "right_to"),
    [
        ("slow_flow", (-0.16809, -0.09737), -0.01307, 0.05099, 0.12949),  # closed form
        ("response", (-0.16923, -0.09507), -0.01347, 0.05115, 0.13107),  # AUTO-07p, collocation
    ],
)
def test_ranges_at_damping_0085_against_independent_values(work, name, left, hopf, right_from, right_to):
    curve = work.done.data[name]
    assert np.array(unstable_ranges(curve)) == pytest.approx(np.array([left, (hopf, right_to)]), abs=1e-5)
    assert np.array(ranges_without_stable_response(curve)) == pytest.approx(np.array([(hopf, right_from)]), abs=1e-5)
    assert np.array(detached_ranges(curve)) == pytest.approx(np.array([left]), abs=1e-5)


def test_growth_rates_between_points_are_those_of_the_multipliers_there(work):
    for sigma in (-0.144, 0.02, 0.1):
        exact = [np.log(abs(r.multipliers[0])) / r.period for r in frahm.periodic_responses(STIFF, detuning=sigma)]
        assert np.sort(growth_rates_at(work.done.data["response"], sigma)) == pytest.approx(np.sort(exact), abs=2e-3)


def test_points_name_the_design_wind_first_and_join_reasons(work):
    points = points_of_interest(work)
    assert points[0].key == "design-wind"
    assert points[0].detuning == pytest.approx(2 * np.pi * (0.225 * 2.7 / 0.762 - 0.78))
    assert points[1].detuning == 0.0
    gaps = np.diff(np.sort([point.detuning for point in points]))
    assert gaps.min() > 1e-4
    (joined,) = [point for point in points if "unstable" in point.reason and "detached" in point.reason]
    assert joined.detuning == pytest.approx(0.5 * (-0.16923 - 0.09507), abs=1e-5)


def test_a_case_without_unstable_responses_has_no_such_ranges():
    curve = exact_response(Work(CASE.with_absorber(kappa=24.425, xi2=0.0085))).data["response"]
    assert unstable_ranges(curve) == ranges_without_stable_response(curve) == detached_ranges(curve) == []
