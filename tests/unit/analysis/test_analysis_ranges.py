import numpy as np
import pytest

import frahm
from frahm.analysis.points import points_of_interest
from frahm.analysis.ranges import detached_ranges, ranges_without_stable_response, unstable_ranges
from frahm.analysis.response import response
from frahm.analysis.section import Work

CASE = frahm.load_case("jacket-pipe")
GRID = 0.8 / 1999


@pytest.fixture(scope="module")
def work():
    started = Work(CASE.with_absorber(xi2=0.0085))
    return started.with_section(response(started))


def test_ranges_at_damping_0085_against_values_of_an_independent_prototype(work):
    # Hopf -.01307, .05901, saddle-nodes -.16809, -.09737, .05099, .12949 of the one-harmonic equations
    curve = work.done.data["response"]
    assert np.array(unstable_ranges(curve)) == pytest.approx(
        np.array([[-0.16809, -0.09737], [-0.01307, 0.12949]]), abs=GRID
    )
    assert np.array(ranges_without_stable_response(curve)) == pytest.approx(np.array([[-0.01307, 0.05099]]), abs=GRID)
    assert np.array(detached_ranges(curve)) == pytest.approx(np.array([[-0.16809, -0.09737]]), abs=1e-5)


def test_points_name_the_design_wind_first_and_join_reasons(work):
    points = points_of_interest(work)
    assert points[0].key == "design-wind"
    assert points[0].detuning == pytest.approx(2 * np.pi * (0.225 * 2.7 / 0.762 - 0.78))
    assert points[1].detuning == 0.0
    assert points[2].detuning == pytest.approx(-0.0978, abs=5e-4)
    gaps = np.diff(np.sort([point.detuning for point in points]))
    assert gaps.min() > 1e-4
    (joined,) = [point for point in points if "unstable" in point.reason and "detached" in point.reason]
    assert joined.detuning == pytest.approx(0.5 * (-0.16809 - 0.09737), abs=GRID)


def test_a_case_without_unstable_responses_has_no_such_ranges():
    started = Work(CASE.with_absorber(kappa=24.425, xi2=0.0085))
    curve = response(started).data["response"]
    assert unstable_ranges(curve) == ranges_without_stable_response(curve) == detached_ranges(curve) == []
