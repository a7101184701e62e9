"""What a design promises is what an analysis of it finds; no mode that a wind of the site excites is left out."""

import pytest

import frahm
from frahm.analysis import analyse

MEMBER = {
    "name": "member",
    "pipe": {"kind": "mode", "mass": "200 kg", "frequency": "2.1 Hz", "damping_ratio": 0.003, "diameter": "0.5 m"},
    "wind": {"speed": "5.4 m/s", "strouhal": 0.2, "lift_coefficient": 0.35, "range": [0, 25]},
    "climate": {"duration": "20 year", "weibull": {"scale": 6, "shape": 2}},
    "fatigue": {
        "curve": "F1",
        "stress_per_displacement": "900 MPa/m",
        "samples": 8,
        "bins": 8,
        "design_fatigue_factor": 2,
    },
    "limits": {"amplitude_ratio": 0.1},
}
CLAMPED = {
    "name": "span",
    "pipe": {
        "kind": "tube", "diameter": "0.4 m", "wall": "12 mm", "length": "30 m", "damping_ratio": 0.0015,
        "mode_count": 2,
        "supports": [{"at": 0, "kind": "clamped"}, {"at": "30 m", "kind": "clamped"}],
    },
    "wind": {"speed": "7 m/s", "strouhal": 0.2, "lift_coefficient": 0.3},
    "climate": {"duration": "1 year", "table": [{"speed": s, "probability": 0.25} for s in (3, 8, 13, 18)]},
    "fatigue": {"curve": "D"},
}  # fmt: skip


def test_an_analysis_of_the_best_design_finds_what_was_promised():
    case = frahm.load_case(MEMBER)
    study = frahm.design_absorber(case, samples=8, errors=(0.95, 1.0, 1.05), margins=())
    row = next(row for row in study.results()["comparison"] if row["name"] == "sink")
    assert row["worst_pipe_peak"] == study.best.worst_pipe_peak == study.error_table["sink"][1]
    found = analyse(study.best_case).results
    assert found["worst_case"]["pipe_peak"] == pytest.approx(row["worst_pipe_peak"], rel=1e-12)
    assert found["worst_case"]["frequency"] == pytest.approx(row["frequency"], rel=1e-12)
    assert found["worst_case"]["relative_peak"] == pytest.approx(row["relative_peak"], rel=1e-12)
    assert found["worst_case"]["stress_range"] == pytest.approx(row["stress_range"], rel=1e-12)
    assert found["fatigue"]["damage_with"] == pytest.approx(row["fatigue"]["damage"], rel=1e-9)
    assert found["fatigue"]["life_years"] == pytest.approx(20 / (2 * row["fatigue"]["damage"]), rel=1e-9)
    bare = next(row for row in study.results()["comparison"] if row["name"] == "none")
    assert found["without_absorber"]["pipe_peak_max"] == pytest.approx(bare["worst_pipe_peak"], rel=1e-9)
    used = found["acceptance"]["utilisation"]["amplitude_ratio"]
    assert used == pytest.approx(row["worst_pipe_peak"] / 0.5 / 0.1, rel=1e-12)


def test_damage_and_ranking_take_every_mode_that_a_wind_excites():
    first, second = (frahm.load_case({**CLAMPED, "pipe": CLAMPED["pipe"] | {"governing_mode": k}}) for k in (1, 2))
    found = {case.pipe.governing_mode: analyse(case).results for case in (first, second)}
    damage = {mode: results["fatigue"]["damage_with"] for mode, results in found.items()}
    assert damage[1] == pytest.approx(damage[2], rel=1e-4)  # whichever governs: the bins of the winds differ
    assert found[1]["fatigue"]["other_modes"][0]["damage_with"] > 0.5 * damage[1]
    assert found[1]["acceptance"]["verdict"] == found[2]["acceptance"]["verdict"] == "fail"
    errors = found[1]["decision"]["frequency_errors"]
    largest = found[1]["other_modes"][0]["pipe_peak"]
    assert found[1]["worst_case"]["pipe_peak"] >= largest
    at = errors["error"].index(pytest.approx(0.05))
    off = frahm.load_case({**CLAMPED, "pipe": CLAMPED["pipe"] | {"youngs_modulus": 2.06e11 * 1.05**2}})
    assert errors["pipe_peak"]["none"][at] == pytest.approx(frahm.worst_case(off).pipe_peak, rel=0.02)


def test_winds_that_move_the_pipe_more_than_the_one_lift_asked_about_unverify_design_and_analysis_alike():
    case = frahm.load_case("jacket-pipe").with_wind(speed=1.5)  # with the lift of this wind over its whole window
    study = frahm.design_absorber(case, samples=4, errors=(), margins=())
    own = frahm.frequency_response(study.best_case, wind=(2.56, 2.72)).largest(stable_only=True)[0]
    assert own > 10 * study.best.worst_pipe_peak
    assert not study.best.verified
    (sentence,) = study.best.worst.unverified
    assert f"{1000 * own:.1f} mm" in sentence
    rivals = {rival.name: rival for rival in study.comparison}
    assert rivals["tuned mass damper"].verified  # what was asked of it holds
    (check,) = [check for check in analyse(study.best_case).checks if check.detail == sentence]
    assert check.status == "unverified"
