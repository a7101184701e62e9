import json
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import frahm
from frahm.analysis import STEPS, Work, analyse, load_analysis, margin_sentence, save_analysis
from frahm.analysis import analysis as analysis_module
from frahm.analysis import cross_check as cross_check_module
from frahm.analysis import margin as margin_module
from frahm.analysis.analysis import plain
from frahm.analysis.cross_check import cross_check
from frahm.analysis.gusts import gusts
from frahm.analysis.linear import without_absorber
from frahm.analysis.margin import detached_curve_margin
from frahm.analysis.response import exact_response, slow_flow_response
from frahm.analysis.section import Section
from frahm.analysis.wind import wind
from frahm.loads import operating_range
from frahm.plotting.gallery import drawings
from frahm.reproduction.motions import equilibrium_state
from frahm.response.exact import exact_curve
from frahm.slow_flow import slow_flow_of
from frahm.slow_flow.motion import slow_velocity
from frahm.systems import with_parameters
from frahm.time_integration import integrate_batch

CASE = frahm.load_case("jacket-pipe")


SINK = CASE.to_dict()["absorbers"][0]
POLYNOMIAL = {"name": "p", "mass": 4.94, "law": {"kind": "polynomial", "coefficients": [10, 5, 9e4], "damping": 2}}
TUNED = {"name": "tuned", "mass": 4.94, "law": {"kind": "linear", "stiffness": 114.0, "damping": 4.0}}


def with_absorbers(*absorbers):
    return frahm.load_case(CASE.to_dict() | {"absorbers": list(absorbers)})


def checks_of(section):
    return {check.name: check for check in section.checks}


def after_responses(case):
    work = Work(case)
    for step in (exact_response, slow_flow_response):
        work = work.with_section(step(work))
    return work


@pytest.mark.parametrize("form", ["averaged", "paper"])
def test_state_of_an_equilibrium_is_at_rest_in_the_slow_flow(form):
    system = frahm.build_system(CASE)
    slow = slow_flow_of(system, form)
    curve = frahm.frequency_response(system, detuning=(-0.2, 0.2), method="slow-flow", form=form, points=9)
    for W, amplitude, pipe in zip(curve.frequency, curve.relative_amplitude, curve.pipe_amplitude, strict=True):
        x1, v1, x2, v2 = equilibrium_state(slow, W, amplitude)
        X, Z = x1 - 1j * v1 / W, (x2 - x1) - 1j * (v2 - v1) / W
        assert abs(Z) == pytest.approx(amplitude, rel=1e-7)
        assert abs(X) == pytest.approx(pipe, rel=1e-7)
        velocity = slow_velocity(slow.code, *slow.host, slow.force, slow.kappa, W, X, Z)
        assert np.abs(velocity) == pytest.approx(0, abs=1e-9 * slow.omega * amplitude)


def test_special_points_of_the_exact_response_are_those_of_collocation():
    # AUTO-07p at xi2 .0085: detuning and peak of x1; of the detached curve the detuning only
    section = exact_response(Work(CASE.with_absorber(xi2=0.0085)))
    found = section.results["response"]["harmonic-balance"]
    collocation = [
        ("saddle-node", -0.16923, None), ("saddle-node", -0.09507, None), ("neimark-sacker", -0.01347, 0.016055),
        ("saddle-node", 0.05115, 0.014799), ("neimark-sacker", 0.05906, 0.016291), ("saddle-node", 0.13107, 0.010654),
    ]  # fmt: skip
    for point, (kind, detuning, peak) in zip(found["special_points"], collocation, strict=True):
        assert point["kind"] == kind
        assert point["detuning"] == pytest.approx(detuning, abs=6e-6)
        assert peak is None or point["pipe_peak"] == pytest.approx(peak, abs=3e-6)
    assert [branch["detached"] for branch in found["branches"]] == [False, True]
    assert "first-harmonic roots" in found["inventory"]
    assert checks_of(section)["Special points of the exact response are located"].status == "pass"


def test_three_methods_agree_on_the_detached_branch_too():
    # shooting gives .0256, .0520 where the one-harmonic theory gives .0258, .0498 (sigma -.144)
    section = cross_check(after_responses(CASE.with_absorber(xi2=0.0085).with_analysis(detuning=(-0.18, 0.0))))
    table = section.data["cross_check"]
    on_detached = table["relative_peak"].values > 0.04
    assert np.sum(on_detached) >= 3
    assert np.sum(~on_detached) >= 7
    for name in ("pipe_error", "relative_error"):
        assert np.max(np.abs(table[name].values)) < 1e-8
    assert np.max(np.abs(table["slow_pipe_error"].values[~on_detached])) < 0.004
    assert np.max(np.abs(table["slow_relative_error"].values[on_detached])) == pytest.approx(0.045, abs=0.015)
    assert {check.status for check in section.checks} == {"pass"}
    assert section.results["cross_check"]["slow_flow"]["within_bounds"]


def test_an_error_of_the_slow_flow_is_its_limit_and_not_a_doubt():
    section = cross_check(after_responses(CASE.with_absorber(xi2=0.0044).with_analysis(detuning=(-0.13, -0.08))))
    check = checks_of(section)["The error of the slow flow against harmonic balance is known"]
    assert check.status == "pass"
    assert "the slow flow is at its limit, and the exact curve stands in its place" in check.detail
    assert not section.results["cross_check"]["slow_flow"]["within_bounds"]
    assert section.unverified == ()


def test_a_disagreement_with_integration_fails_with_its_numbers(monkeypatch):
    def coarse(*arguments, **settings):
        return integrate_batch(*arguments, **settings | {"tolerance": 1e-3})

    monkeypatch.setattr(cross_check_module, "integrate_batch", coarse)
    check = checks_of(cross_check(after_responses(CASE)))["Harmonic balance and integration agree on stable responses"]
    assert check.status == "fail"
    assert "Peaks differ by more than 1e-06: " in check.detail
    assert "rad/s" in check.detail


@pytest.mark.parametrize("absorbers", [[], [TUNED], [POLYNOMIAL], [TUNED, SINK]], ids=lambda a: f"{len(a)} absorbers")
def test_harmonic_balance_holds_against_integration_for_any_absorbers(absorbers):
    case = with_absorbers(*absorbers)
    section = cross_check(after_responses(case))
    assert [check.status for check in section.checks] == ["pass"]
    assert section.results["cross_check"]["points"] >= 6
    assert ("relative_peak" in section.data["cross_check"]) == bool(absorbers)


def test_an_undamped_resonance_is_left_out():
    case = CASE.with_pipe(damping_ratio=0).without_absorbers().with_analysis(detuning=(-1e-9, 1e-9))
    work = after_responses(case)
    assert "does not attract" in work.done.unverified[0]
    bounded = cross_check(work).data["cross_check"]["detuning"].values
    assert bounded.size == 8  # at resonance there is no response
    assert np.min(np.abs(bounded)) > 1e-10


def margin_at(case):
    work = detached_curve_margin(after_responses(case)).results
    return work["response"]["harmonic-balance"]["detached_curve_margin"] if work else None


def has_detached(case, factor):
    """Whether the complete response under another lift has a detached branch."""
    stronger = case.with_wind(lift_coefficient=0.4535 * factor)
    return any(frahm.frequency_response(stronger, detuning=case.analysis.detuning).detached)


def test_a_detached_curve_appears_just_beyond_the_margin():
    case = CASE.with_analysis(detuning=(-0.2, 0.0))
    margin = margin_at(case)
    ahead = margin["next_event"]
    assert (margin["exists"], margin["born"], ahead["kind"]) == (False, None, "birth")
    assert not has_detached(case, 0.995 * ahead["force"])
    assert has_detached(case, 1.005 * ahead["force"])
    assert -0.2 < ahead["detuning"] < 0
    assert margin["force_margin"] == ahead["force"]
    said = f"The force margin is {ahead['force']:.4g}: beyond that factor on the force a detached response curve"
    assert margin_sentence(margin).startswith(said)


def test_the_force_at_which_an_existing_detached_curve_was_born():
    case = CASE.with_absorber(xi2=0.0085).with_analysis(detuning=(-0.2, 0.0))
    margin = margin_at(case)
    assert margin["exists"]
    assert not has_detached(case, 0.995 * margin["born"]["force"])
    assert has_detached(case, 1.005 * margin["born"]["force"])
    assert margin["force_margin"] == margin["born"]["force"] < 1
    assert margin_sentence(margin).startswith(f"The force margin is {margin['force_margin']:.4g}: ")


@pytest.mark.parametrize("birth", [1.013, 1.0634, 1.42, 2.9])
def test_over_the_winds_the_margin_is_bisected_to_the_birth(monkeypatch, birth):
    case = frahm.load_case(CASE.to_dict() | {"analysis": {}})
    curve = {"special_points": [], "branches": []}
    work = Work(case, Section(results={"response": {"harmonic-balance": curve}}, data={"response": None}))
    monkeypatch.setattr(margin_module, "_detached_count", lambda system, within, force: int(force >= birth))
    monkeypatch.setattr(margin_module, "_born", lambda system, within, force: {"force": force})
    monkeypatch.setattr(margin_module, "_next_birth", lambda system, within, most: None)
    found = detached_curve_margin(work).results["response"]["harmonic-balance"]["detached_curve_margin"]
    assert found["force_margin"] < birth <= found["next_event"]["force"]
    assert found["force_margin"] == pytest.approx(found["next_event"]["force"], rel=1e-3)


def test_a_detached_curve_that_merges_soon_after_its_birth_ends_the_margin():
    """Born at 1.0643 times the force, merged at 1.085: between the factors at which the curve is looked at."""
    law = {"kind": "cubic", "stiffness": 2.169e7, "damping": 73.7}
    mast = frahm.load_case(Path(__file__).parents[2] / "cases" / "table.yaml")
    case = frahm.load_case(mast.to_dict() | {"absorbers": [{"name": "sink", "mass": 18.0, "law": law}]})
    system, within = frahm.build_system(case), operating_range(case)

    def count(force):
        curve = exact_curve(with_parameters(system, force=force), *within.frequency, None, within.factor)
        return sum(curve.detached)

    assert [count(force) for force in (1.0, 1.0635, 1.065, 1.08, 1.1)] == [0, 0, 1, 1, 0]
    found = margin_at(case)
    assert found["force_margin"] == found["next_event"]["force"] == pytest.approx(1.0643, abs=1e-4)
    assert (found["exists"], found["next_event"]["change"]) == (False, "appears")


def test_a_birth_of_no_detached_curve_does_not_hide_the_next(monkeypatch):
    case = frahm.load_case(CASE.to_dict() | {"analysis": {}})
    curve = {"special_points": [], "branches": []}
    work = Work(case, Section(results={"response": {"harmonic-balance": curve}}, data={"response": None}))
    monkeypatch.setattr(margin_module, "_detached_count", lambda system, within, force: 0)
    monkeypatch.setattr(margin_module, "births_ahead", lambda search: [(1.1, 4.9), (1.2, 4.9)])
    monkeypatch.setattr(
        margin_module, "_born", lambda system, within, force: None if force < 1.15 else {"force": force}
    )
    found = detached_curve_margin(work).results["response"]["harmonic-balance"]["detached_curve_margin"]
    assert found["force_margin"] == found["next_event"]["force"] == 1.2


def test_no_margin_where_no_detached_curve_can_be():
    assert margin_at(with_absorbers(TUNED)) is None
    assert margin_at(CASE.with_wind(lift_coefficient=0)) is None
    soft = margin_at(CASE.with_absorber(kappa=24.425, xi2=0.0085).with_analysis(detuning=(-0.2, 0.2)))
    assert (soft["exists"], soft["next_event"], soft["searched"]) == (False, None, [1.0, 3.0])
    assert margin_sentence(soft).startswith("The force margin is at least 3: ")


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
    done = analyse(CASE.with_analysis(periods=100, samples=10))
    save_analysis(done, tmp_path)
    again = load_analysis(tmp_path)
    assert again.summary() == done.summary()
    assert again.case.digest == done.case.digest
    for name, dataset in done.data.items():
        xr.testing.assert_equal(again.data[name], dataset.reset_coords())
        assert set(again.data[name].attrs) == set(dataset.attrs)
        for variable in dataset.variables:
            assert again.data[name][variable].attrs == dataset[variable].attrs


def test_what_the_slow_flow_cannot_treat_has_an_exact_response():
    done = analyse(with_absorbers(POLYNOMIAL).with_analysis(detuning=(0.1, 0.4), samples=20))
    assert all(check.status == "pass" for check in done.checks)
    # the window leaves the resonance out, and nothing else is in doubt
    assert done.unverified
    assert all(re.match("The worst motion sits at the lower end", doubt) for doubt in done.unverified)
    (outside,) = (note for note in done.notes if note.startswith("Outside the range asked about, at detuning 0 rad/s"))
    assert "15.1 mm" in outside
    assert done.results["largest_motion"]["pipe_peak"] == done.results["worst_case"]["pipe_peak"] < 0.0151
    assert set(done.results["response"]) == {"harmonic-balance"}
    assert any("one mode with one cubic sink" in note for note in done.notes)


@pytest.mark.parametrize(
    "case",
    [
        CASE.with_pipe(damping_ratio=0).without_absorbers(),
        CASE.with_wind(lift_coefficient=0),
        CASE.with_absorber(xi2=0.08),
        CASE.with_analysis(periods=1),
        CASE.with_analysis(detuning=(1.0, 2.0)),
    ],
    ids=["undamped bare pipe", "no lift", "no folds", "one period", "window without resonance"],
)
def test_summaries_at_the_edges_are_strict_json(case):
    done = analyse(case.with_analysis(periods=min(200, case.analysis.periods), samples=10))
    text = json.dumps(done.summary(), allow_nan=False)
    assert json.loads(text)["results"]["verdict"] == done.verdict


@pytest.mark.parametrize(
    "case",
    [
        CASE.with_pipe(damping_ratio=0).with_analysis(detuning=(0.15, 0.2)),
        CASE.with_absorber(xi2=0).with_analysis(detuning=(0.0, 0.1)),
        CASE.with_absorber(kappa=1e-6),
        CASE.with_absorber(kappa=5000).with_analysis(detuning=(0.1, 0.2)),
        CASE.with_wind(lift_coefficient=0),
        CASE.with_analysis(detuning=(3.0, 9.0)),
    ],
    ids=["undamped pipe", "undamped sink", "hardly a spring", "hard spring", "no lift", "far from resonance"],
)
def test_exact_responses_at_the_edges_hold_against_integration(case):
    section = cross_check(after_responses(case))
    check = checks_of(section)["Harmonic balance and integration agree on stable responses"]
    assert check.status == "pass"
    assert section.results["cross_check"]["points"] >= 3


def test_wind_step_lists_criteria_and_estimates_beside_the_computed_amplitude():
    found = wind(Work(CASE)).results["wind"]
    assert found["reduced_velocity"] == pytest.approx(4.54, abs=5e-3)
    assert found["computed"] == pytest.approx(0.0867, abs=5e-5)
    assert found["interval"][0] < found["computed"] < found["interval"][1]
    assert found["build_up_time"] == pytest.approx(136, abs=0.5)
    assert "no section climate" in found["load_cycles"]["detail"]
    assert {row["standing"] for row in found["criteria"]} == {"verified", "secondary"}
    assert [row["expects_vibration"] for row in found["criteria"]] == [False, True, True, None, True, True]
    kept = json.loads(json.dumps(plain(found), allow_nan=False))
    assert kept["criteria"][1]["speeds"][1] is None
    assert (kept["load_cycles"]["number"], kept["estimates"][2]["ratio"]) == (None, None)


def test_gusts_step_is_there_when_the_case_names_an_unsteady_wind():
    assert gusts(Work(CASE)).results == {}
    found = gusts(Work(CASE.with_wind(record=[[0, 2.6], [30, 2.7], [60, 2.5]])))
    numbers = found.results["unsteady_wind"]
    assert numbers["duration"] == pytest.approx(60, abs=0.1)
    assert numbers["build_up_time"] == pytest.approx(136.03, abs=0.1)
    direct = frahm.unsteady_response(CASE, record=([0, 30, 60], [2.6, 2.7, 2.5]))
    assert numbers["pipe_peak"] == direct.history.pipe_peak
    assert found.unverified == ()
    assert any("no margin to design on" in note for note in found.notes)
    json.dumps(plain(numbers), allow_nan=False)
    beyond = CASE.with_wind(lift_coefficient=[[1.2e5, 0.4], [1.5e5, 0.4]], record=[[0, 2.6], [30, 4.0]])
    assert "not extrapolated" in gusts(Work(beyond)).unverified[0]


def test_report_shows_wind_and_gusts():
    from frahm.report.report import render_report

    case = CASE.with_wind(turbulence={"intensity": 0.1, "length_scale": 60.0})
    case = frahm.load_case(case.to_dict() | {"climate": {"duration": "1 year", "weibull": {"scale": 6, "shape": 2}}})
    work = Work(case)
    for step in (without_absorber, wind, gusts):
        work = work.with_section(step(work))
    kept = analysis_module._concluded(work, False)
    text = render_report(kept, {})
    for said in ("Brown &amp; Root 1985", "counter-example", "Griffin and Skop", "secondary", "Unsteady wind",
                 "EN 1991-1-4, method 2", "load cycles at resonance", "2.36e6",
                 "plot-unsteady-wind", "Synthetic turbulence"):  # fmt: skip
        assert said in text, said
    names = [name for name, _ in drawings(kept.results, kept.data)]
    assert names == ["unsteady-wind"]
