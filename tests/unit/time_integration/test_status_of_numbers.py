"""A number that stands for a run that failed is NaN, with the outcome beside it; what was sampled is kept."""

import json
import math

import numpy as np
import pytest

import frahm
from frahm.analysis import Work
from frahm.analysis import motions as motions_module
from frahm.analysis.gusts import gusts
from frahm.analysis.motions import motions
from frahm.analysis.settling import judge
from frahm.assessment.motion_damage import largest_place
from frahm.attractors import find_attractors
from frahm.errors import Outcome
from frahm.exchange import write_data
from frahm.web.jobs import motion

# A softening spring beyond its range pushes the sink away for good.
_SOFT = {"mass": 4.94, "law": {"kind": "polynomial", "coefficients": [10.0, 0.0, -1e9], "damping": 0.0}}
RUNAWAY = frahm.load_case("jacket-pipe").to_dict() | {"absorbers": [_SOFT]}
STEPS = ([0.0, 60.0], [2.65, 2.65])


@pytest.fixture(scope="module")
def escaped():
    system = frahm.System(
        np.diag([1.0, 0.02]), np.diag([0.01, 0.0]), np.diag([1.0, 0.0]), (1.0, 0.0),
        [frahm.Element((-1, 1), frahm.Polynomial((0.02, 0.0, -1.0), 0.001))],
    )  # fmt: skip
    history = frahm.integrate(system, frequency=1.0, periods=50)
    assert history.outcome is Outcome.DIVERGED
    assert 0 < history.time[-1] < 50 * 2 * np.pi
    return history


def test_peaks_and_rms_of_an_escape_are_not_numbers(escaped):
    numbers = [*escaped.peaks(), *escaped.peaks(last=0.5), escaped.rms, escaped.relative_rms, escaped.last(0.1).rms]
    assert np.all(np.isnan(numbers))
    assert np.all(np.isfinite(escaped.pipe))


def test_the_spectrum_of_an_escape_is_not_a_number_however_soon_it_was(escaped):
    for history in (escaped, escaped.last(1 / escaped.samples_per_period)):
        spectrum = history.spectrum()
        assert np.all(np.isnan(spectrum["pipe_amplitude"]))
        assert np.all(np.isnan(spectrum["relative_amplitude"]))
        assert spectrum.attrs["outcome"] == "DIVERGED"


def test_samples_of_an_escape_carry_its_outcome_wherever_they_go(escaped, tmp_path):
    assert escaped.to_dataset().attrs["outcome"] == escaped.poincare().attrs["outcome"] == "DIVERGED"
    for name in ("history.csv", "history.nc", "history.json", "history.mat"):
        first, *_ = write_data(escaped, tmp_path / name)
        assert frahm.read_data(first).attrs["outcome"] == "DIVERGED"
    frahm.write_time_history(escaped, tmp_path / "history.txt")
    assert (tmp_path / "history.txt").read_text(encoding="utf-8").startswith("# DIVERGED: The motion left every bound")
    np.testing.assert_array_equal(np.loadtxt(tmp_path / "history.txt", skiprows=2)[:, 1], escaped.pipe)


def test_a_motion_that_ends_well_keeps_its_numbers(jacket_pipe):
    history = frahm.integrate(jacket_pipe(), detuning=0.0, periods=20)
    assert history.outcome is Outcome.DONE
    assert np.all(np.isfinite([*history.peaks(), history.rms, history.relative_rms]))
    assert np.all(np.isfinite(history.spectrum()["pipe_amplitude"]))


def test_the_kind_of_an_escape_has_no_spread(escaped):
    kind, spread = judge(escaped)
    assert kind == "unsettled"
    assert math.isnan(spread)


def test_stress_of_a_motion_that_cannot_be_followed_is_not_a_number(monkeypatch):
    case = frahm.load_case("jacket-pipe")
    system = frahm.build_system(case)
    (first, *_) = find_attractors(system, detuning=-0.3, samples=2)
    sections, rows = np.array([0.2, 0.5]), np.array([[1.0, 0.0], [2.0, 0.0]])
    assert largest_place(system, first, sections, rows)[0] == 0.5
    monkeypatch.setattr("frahm.time_integration.batch.LEAST_STEPS", 1.0)
    monkeypatch.setattr("frahm.time_integration.batch.STEPS_PER_PERIOD", 1.0)
    section, ranges = largest_place(system, first, sections, rows)
    assert math.isnan(section)
    assert np.all(np.isnan(ranges))


def test_gusts_that_push_a_sink_away_leave_no_peak():
    case = frahm.load_case(RUNAWAY | {"wind": RUNAWAY["wind"] | {"record": [[0.0, 2.65], [60.0, 2.65]]}})
    section = gusts(Work(case))
    found = section.results["unsteady_wind"]
    assert found["outcome"] == "DIVERGED"
    assert section.unverified
    for name in ("pipe_peak", "pipe_rms", "relative_peak", "reduction_by_absorbers"):
        assert math.isnan(found[name]), name
    assert found["bare_pipe_peak"] > 0
    assert found["duration"] == pytest.approx(60.0, rel=0.01)


def test_a_wind_sweep_goes_on_from_rest_after_a_motion_that_failed():
    curve = frahm.wake_response(RUNAWAY, wind=(2.9, 3.0), speeds=2)
    assert not all(outcome.ok for row in curve.curve.outcomes for outcome in row)
    for row, outcomes in zip(curve.curve.pipe_peak, curve.curve.outcomes, strict=True):
        for peak, outcome in zip(row, outcomes, strict=True):
            assert np.isfinite(peak) == outcome.ok
    assert any("left every bound" in sentence for sentence in curve.unverified)
    assert np.isfinite(curve.bare.largest[0])


def test_motions_of_an_analysis_that_fail_have_no_numbers(monkeypatch):
    monkeypatch.setattr(motions_module, "_MOST_KEPT", 20)  # the end of a long run follows a part that is not kept
    case = frahm.load_case(RUNAWAY | {"analysis": {"periods": 100}})
    section = motions(Work(case))
    for found in section.results["motions"]:
        assert found["outcome"] == "diverged"
        for name in ("pipe_peak", "relative_peak", "pipe_rms", "pipe_peak_whole_run", "section_spread"):
            assert math.isnan(found[name]), name
        assert np.all(np.isnan(found["pipe_envelope"]))


def test_the_page_says_how_a_motion_failed_and_gives_no_peak():
    found = motion(frahm.load_case(RUNAWAY), lambda *_: None, at=0.0)
    assert found["pipe_peak"] is None
    assert found["relative_peak"] is None
    assert found["outcome"].startswith("The motion left every bound")
    json.dumps(found, allow_nan=False)
