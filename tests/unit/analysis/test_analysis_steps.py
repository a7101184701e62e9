import json

import numpy as np
import pytest
import xarray as xr

import frahm
from frahm.analysis import STEPS, Work, analyse, load_analysis, save_analysis
from frahm.analysis import analysis as analysis_module
from frahm.analysis.cross_check import cross_check, equilibrium
from frahm.analysis.response import response
from frahm.slow_flow import slow_flow_of
from frahm.slow_flow.motion import slow_velocity

CASE = frahm.load_case("jacket-pipe")


@pytest.mark.parametrize("form", ["averaged", "paper"])
def test_equilibrium_with_its_phase_is_at_rest_in_the_slow_flow(form):
    system = frahm.build_system(CASE)
    slow = slow_flow_of(system, form)
    curve = frahm.frequency_response(system, detuning=(-0.2, 0.2), method="slow-flow", form=form, points=9)
    for W, amplitude, pipe in zip(curve.frequency, curve.relative_amplitude, curve.pipe_amplitude, strict=True):
        X, Z = equilibrium(slow, W, amplitude)
        assert abs(Z) == pytest.approx(amplitude, rel=1e-7)
        assert abs(X) == pytest.approx(pipe, rel=1e-7)
        velocity = slow_velocity(slow.code, *slow.host, slow.force, slow.kappa, W, X, Z)
        assert np.abs(velocity) == pytest.approx(0, abs=1e-9 * slow.omega * amplitude)


def test_cross_check_sees_the_detached_branch_and_states_its_error():
    # shooting gives .0256, .0520 where the one-harmonic theory gives .0258, .0498 (sigma -.144)
    started = Work(CASE.with_absorber(xi2=0.0085).with_analysis(detuning=(-0.18, 0.0)))
    section = cross_check(started.with_section(response(started)))
    table = section.data["cross_check"]
    on_detached = table["slow_relative_peak"].values > 0.045
    assert np.sum(on_detached) >= 3
    assert np.all(np.abs(table["pipe_error"].values[~on_detached]) < 0.004)
    assert np.max(np.abs(table["relative_error"].values[on_detached])) == pytest.approx(0.045, abs=0.015)


def test_a_disagreement_is_a_failed_check_with_its_numbers():
    stiff = CASE.with_absorber(kappa=1e12).with_analysis(periods=200)
    started = Work(stiff)
    (check,) = cross_check(started.with_section(response(started))).checks
    assert check.status == "fail"
    assert "rad/s the pipe peak is off by" in check.detail


def test_an_interruption_keeps_the_finished_steps(monkeypatch, tmp_path):
    def stop(work):
        raise KeyboardInterrupt

    steps = (*STEPS[:2], analysis_module.Step("what was stopped", stop), *STEPS[2:])
    monkeypatch.setattr(analysis_module, "STEPS", steps)
    kept = analyse(CASE)
    assert kept.interrupted
    assert set(kept.data) == {"without_absorber", "response"}
    assert "what was stopped" in kept.unverified[-1]
    save_analysis(kept, tmp_path)
    assert load_analysis(tmp_path).summary() == kept.summary()


def test_progress_is_told_every_step():
    told = []
    analyse(CASE.without_absorbers().with_analysis(periods=50), progress=lambda *step: told.append(step))
    assert [number for _, number, _ in told] == list(range(len(STEPS) + 1))


def test_an_analysis_is_the_same_after_a_round_trip(tmp_path):
    done = analyse(CASE.with_analysis(periods=100))
    save_analysis(done, tmp_path)
    again = load_analysis(tmp_path)
    assert again.summary() == done.summary()
    assert again.case.digest == done.case.digest
    for name, dataset in done.data.items():
        xr.testing.assert_equal(again.data[name], dataset.reset_coords())
        assert set(again.data[name].attrs) == set(dataset.attrs)
        for variable in dataset.variables:
            assert again.data[name][variable].attrs == dataset[variable].attrs


@pytest.mark.parametrize("absorbers", ["two sinks", "polynomial"])
def test_what_the_slow_flow_cannot_treat_is_said(absorbers):
    sink = CASE.to_dict()["absorbers"][0]
    polynomial = {"name": "p", "mass": 4.94, "law": {"kind": "polynomial", "coefficients": [10, 5, 9e4], "damping": 2}}
    chosen = {"two sinks": [sink, sink | {"name": "b"}], "polynomial": [polynomial]}[absorbers]
    done = analyse(CASE.to_dict() | {"absorbers": chosen})
    assert not done.verified
    assert "one mode with one cubic sink" in done.unverified[0]
    assert len(done.results["motions"]) == 2


@pytest.mark.parametrize(
    "case",
    [
        CASE.with_pipe(damping_ratio=0).without_absorbers(),
        CASE.with_wind(lift_coefficient=0),
        CASE.with_absorber(kappa=1e-9),
        CASE.with_absorber(xi2=0.08),
        CASE.with_analysis(periods=1),
        CASE.with_analysis(detuning=(1.0, 2.0)),
    ],
    ids=["undamped bare pipe", "no lift", "hardly a spring", "no folds", "one period", "window without resonance"],
)
def test_summaries_at_the_edges_are_strict_json(case):
    done = analyse(case.with_analysis(periods=min(200, case.analysis.periods)))
    text = json.dumps(done.summary(), allow_nan=False)
    assert json.loads(text)["results"]["verdict"] == done.verdict
