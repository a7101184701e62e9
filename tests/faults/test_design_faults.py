"""`frahm design` with input it cannot use: one message, exit code 2."""

import re

import pytest
from typer.testing import CliRunner

import frahm
from frahm.cli import app
from frahm.design import DesignedAbsorber, DesignSettings


def design(tmp_path, *arguments):
    return CliRunner().invoke(app, ["design", "jacket-pipe", "--out", str(tmp_path / "out"), *map(str, arguments)])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--family", "sinks"), "family"),
        (("--mass-ratio", -1), "mass_ratio"),
        (("--scatter", 0.9), "scatter"),
        (("--force-margin", 0.9), "force_margin"),
        (("--samples", 0), "samples"),
        (("--stroke", 0), "stroke"),
    ],
)
def test_a_number_out_of_bounds_is_named(tmp_path, arguments, words):
    done = design(tmp_path, *arguments)
    assert done.exit_code == 2
    assert words in done.output
    assert "Traceback" not in done.output


@pytest.mark.parametrize("kappa", [(5.0, 2.0), (2.0, 2.0), (1.0,), "wide", (-1.0, 5.0), (1.0, float("inf"))])
def test_an_empty_or_inverted_range_is_refused(kappa):
    with pytest.raises(frahm.ParameterError, match="kappa"):
        DesignSettings(kappa=kappa)


def test_an_unknown_setting_is_refused_with_the_nearest():
    with pytest.raises(frahm.ParameterError, match="force_margin"):
        frahm.design_absorber("jacket-pipe", force_margins=1.2)


def test_limits_no_design_keeps_name_the_one_that_binds(tmp_path):
    done = design(tmp_path, "--stroke", 1e-4)
    assert done.exit_code == 2
    assert re.search(r"binds: stroke at most 0\.0001 m", done.output.replace("\n", " "))


def test_a_second_nonlinear_absorber_is_refused():
    case = frahm.load_case("jacket-pipe")
    other = case.absorbers[0].model_copy(update={"name": "other"})
    both = frahm.load_case(case.to_dict() | {"absorbers": [case.absorbers[0].model_dump(), other.model_dump()]})
    with pytest.raises(frahm.ParameterError, match=r"absorbers\[1\]"):
        frahm.design_absorber(both)


def test_an_absorber_without_a_spring_is_no_design():
    with pytest.raises(frahm.ParameterError, match="spring"):
        DesignedAbsorber(0.02, 0.0, 0.0, 0.01)


def test_an_interrupted_design_gives_the_best_so_far_and_says_so(tmp_path, monkeypatch):
    from frahm.design import designing

    whole = designing.best_of_family

    def stop_after_the_first(work, family):
        if family != "tuned":
            raise KeyboardInterrupt
        return whole(work, family)

    monkeypatch.setattr(designing, "best_of_family", stop_after_the_first)
    done = design(tmp_path, "--family", "tuned", "--samples", 4)
    assert done.exit_code == 130
    assert (tmp_path / "out" / "best.yaml").is_file()
    shown = CliRunner().invoke(app, ["show", str(tmp_path / "out")])
    assert shown.exit_code == 0
    assert "tuned mass damper" in shown.output
    assert "Interrupted" in shown.output
    assert "nterrupted" in (tmp_path / "out" / "summary.json").read_text(encoding="utf-8")
    assert "Traceback" not in done.output


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--kappa", 5, 2), "kappa: given (5.0, 2.0); allowed: two numbers (lo, hi) with lo < hi"),
        (("--wind", 3.0, 2.5), "wind: given (3.0, 2.5)"),
        (("--objective", "peek"), "Did you mean 'peak'?"),
        (("--objective", "damage"), "climate: given None; allowed: a case with the section climate"),
        (("--objective", "expected"), "climate: given None"),
        (("--quantile", 0.9), "design.quantile: given 0.9; allowed: nothing where nothing scatters"),
        (("--quantile", 1.5, "--scatter", 0.1), "quantile: given 1.5"),
        (("--position", 0, 1), "design.position: given (0.0, 1.0); allowed: nothing, because a pipe given as one mode"),
        (("--masses", 0.01, 0.02, "--mass-ratio", 0.02), "--masses"),
    ],
)
def test_what_the_case_lacks_or_a_range_is_named(tmp_path, arguments, words):
    done = design(tmp_path, *arguments)
    assert done.exit_code == 2
    assert words in done.output.replace("\n", " ")
    assert "Traceback" not in done.output
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())


def test_damage_needs_a_detail_besides_the_climate():
    climate = {"duration": "20 year", "weibull": {"scale": 7, "shape": 2}}
    case = frahm.load_case(frahm.load_case("jacket-pipe").to_dict() | {"climate": climate})
    with pytest.raises(frahm.ParameterError, match="fatigue: given None; allowed: a case with the section fatigue"):
        frahm.design_absorber(case, objective="damage")
    with pytest.raises(frahm.ParameterError, match=r"design\.wind"):
        frahm.design_absorber(case, objective="expected", wind=(2.5, 3.0))


def test_a_section_design_with_a_typing_error_is_refused_with_file_and_line(tmp_path):
    text = frahm.load_case("jacket-pipe").to_yaml().replace("design: null", "design:\n  objektive: rms")
    file = tmp_path / "pipe.yaml"
    file.write_text(text, encoding="utf-8")
    done = CliRunner().invoke(app, ["check", str(file)])
    assert done.exit_code == 2
    line = 1 + text.splitlines().index("  objektive: rms")
    assert f"pipe.yaml:{line}: design.objektive" in done.output.replace("\n", "")
    assert "objective" in done.output


def test_a_place_beyond_the_pipe_is_refused():
    with pytest.raises(frahm.ParameterError, match=r"design\.position.*0 to 31\.2 m"):
        frahm.design_absorber("jacket-pipe-elastic", position=(20.0, 40.0))


def test_springs_that_do_not_fit_name_what_binds(tmp_path):
    done = design(tmp_path, "--spring-stress", 1e4)
    assert done.exit_code == 2
    assert "coil springs of 0.01 MPa that fit into their length" in done.output.replace("\n", " ")
