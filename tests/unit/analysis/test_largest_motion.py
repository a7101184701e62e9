"""The one worst motion: what another step met in the range counts, what it met outside and what is transient do not."""

import dataclasses

import pytest

import frahm
from frahm import readable
from frahm.analysis.largest import largest_motion
from frahm.analysis.linear import without_absorber
from frahm.analysis.long_term import worst
from frahm.analysis.motions import motions
from frahm.analysis.response import exact_response
from frahm.analysis.section import Work
from frahm.loads import vortex_shedding

CASE = frahm.load_case("jacket-pipe").with_analysis(periods=200, samples=10)
BARE = CASE.without_absorbers()


def worked(case):
    work = Work(case)
    for step in (without_absorber, exact_response, motions, worst):
        work = work.with_section(step(work))
    return work


@pytest.fixture(scope="module")
def nonlinear():
    return worked(CASE)


def with_motion(work, **changes):
    """The work with the first motion from rest changed."""
    first, *rest = work.done.results["motions"]
    results = work.done.results | {"motions": [first | changes, *rest]}
    return Work(work.case, dataclasses.replace(work.done, results=results))


def test_a_transient_of_a_nonlinear_pipe_is_a_doubt_only_where_it_is_larger_than_the_worst(nonlinear):
    peak = nonlinear.done.results["worst_case"]["pipe_peak"]
    smaller = largest_motion(with_motion(nonlinear, kind="unsettled", pipe_peak=0.9 * peak, relative_peak=0.0))
    assert smaller.unverified == ()
    assert smaller.results["worst_case"]["pipe_peak"] == pytest.approx(peak)
    larger = largest_motion(with_motion(nonlinear, kind="unsettled", pipe_peak=1.5 * peak, relative_peak=0.0))
    (doubt,) = larger.unverified
    assert "has not settled within 200 periods" in doubt
    assert "raise analysis.periods" in doubt
    assert larger.results["worst_case"]["pipe_peak"] == pytest.approx(1.5 * peak)
    assert larger.results["worst_case"]["verified"] is False


def test_a_transient_of_a_linear_pipe_is_never_the_worst():
    work = worked(BARE)
    peak = work.done.results["worst_case"]["pipe_peak"]
    section = largest_motion(with_motion(work, kind="unsettled", pipe_peak=1.5 * peak))
    assert section.unverified == ()
    assert section.results["largest_motion"]["pipe_peak"] == peak


@pytest.mark.parametrize(("name", "what"), [("pipe_peak", "motion"), ("relative_peak", "stroke")])
def test_a_lasting_motion_that_the_search_missed_counts_and_is_named(nonlinear, name, what):
    size = 2 * nonlinear.done.results["worst_case"][name]
    section = largest_motion(with_motion(nonlinear, kind="periodic", **{name: size}))
    (doubt,) = section.unverified
    assert doubt.startswith(f"The search for the worst case missed a {what} of {readable.length(size)} at detuning")
    assert section.results["worst_case"][name] == size
    assert section.results["worst_case"]["verified"] is False


def test_a_motion_outside_the_window_is_no_motion_the_search_missed():
    work = worked(BARE.with_analysis(detuning=(0.1, 0.4), periods=1000))
    section = largest_motion(work)
    worst_in_it = work.done.results["worst_case"]["pipe_peak"]
    assert section.unverified == ()
    assert section.results["worst_case"]["pipe_peak"] == worst_in_it
    (note,) = section.notes
    assert note.startswith("Outside the range asked about, at detuning 0 rad/s, the motion is larger")


def test_the_design_wind_outside_the_winds_asked_about_keeps_its_own_lift_and_speed():
    table = [[1e3, 0.7], [1.3e5, 0.7], [1.6e5, 0.2], [1e7, 0.2]]
    case = frahm.load_case(BARE.to_dict() | {"analysis": {"wind": [4.0, 6.0], "periods": 1000}})
    case = case.with_wind(lift_coefficient=table)  # 2.7 m/s is Re 1.37e5, on the slope; 4 m/s is beyond it
    (motion, *_) = motions(Work(case)).results["motions"]
    assert motion["wind_speed"] == 2.7
    assert motion["frequency"] == pytest.approx(vortex_shedding(case).frequency)
    there = frahm.load_case(case.to_dict() | {"analysis": {"wind": [2.6, 2.8]}})
    curve = frahm.frequency_response(there)
    at_speed = float(curve.to_dataset().swap_dims(point="wind_speed")["pipe_peak"].interp(wind_speed=2.7))
    assert motion["pipe_peak"] == pytest.approx(at_speed, rel=1e-2)
    assert motion["pipe_peak_without_absorber"] == pytest.approx(at_speed, rel=1e-2)
