"""The step `fatigue`, its figure and its part of the report, on a pipe that is quick to count."""

import json
import math

import numpy as np
import pytest

import frahm
from frahm.analysis import Work, analyse, load_analysis, save_analysis
from frahm.analysis import analysis as steps
from frahm.analysis.fatigue import fatigue
from frahm.analysis.linear import without_absorber
from frahm.plotting.fatigue import bin_edges, damage_range, fatigue_figure, per_speed
from frahm.report import write_report

SECTIONS = {
    "climate": {"duration": "20 year", "weibull": {"scale": 7, "shape": 2}},
    "fatigue": {"curve": "D", "stress_per_displacement": "283.5 MPa/m", "bins": 4, "samples": 2,
                "wind_speeds": [2.62, 2.72], "design_fatigue_factor": 3},
}  # fmt: skip


@pytest.fixture(scope="module")
def case():
    return frahm.load_case({**frahm.load_case("jacket-pipe").to_dict(), **SECTIONS})


@pytest.fixture(scope="module")
def section(case):
    return fatigue(Work(case))


@pytest.fixture(scope="module")
def folder(case, tmp_path_factory):
    """A whole folder of results with the quick steps only."""
    kept = steps.STEPS
    steps.STEPS = tuple(step for step in kept if step.run in (without_absorber, fatigue))
    try:
        analysis = analyse(case)
    finally:
        steps.STEPS = kept
    folder = tmp_path_factory.mktemp("fatigue")
    save_analysis(analysis, folder)
    write_report(load_analysis(folder), folder)
    return folder


def test_numbers_of_the_summary(case, section):
    found = section.results["fatigue"]
    direct = frahm.fatigue_damage(case)
    assert found["damage_with"] == direct.damage_with < found["damage_without"] == direct.damage_without
    assert found["utilisation_with"] == pytest.approx(3 * found["damage_with"])
    assert found["life_years"] == pytest.approx(20 / found["utilisation_with"])
    assert found["lock_in"] == pytest.approx([0.78 * 0.762 / 0.225 / 1.2, 0.78 * 0.762 / 0.225 / 0.8])
    c, k, (low, high) = 7.0, 2.0, found["lock_in"]
    assert found["persistence"]["probability"] == pytest.approx(
        math.exp(-((low / c) ** k)) - math.exp(-((high / c) ** k))
    )
    assert found["persistence"]["build_up"] == pytest.approx(136.0, rel=1e-3)
    assert sum(section.data["fatigue"]["damage_with"].values) == pytest.approx(found["damage_with"])


def test_the_closed_form_check_passes(section):
    assert [check.status for check in section.checks] == ["pass"]


def test_no_sections_no_step(case):
    assert fatigue(Work(frahm.load_case("jacket-pipe"))).results == {}


def test_a_band_that_is_not_there_is_unverified_not_dropped(case):
    other = case.with_wind(strouhal=[[1e5, 0.225], [1.4e5, 0.225]]).with_fatigue(wind_speeds=(2.7, 5.0))
    section = fatigue(Work(other))
    assert "could not be counted" in section.unverified[0]
    assert section.results == {}


def test_stored_and_reported(folder):
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    found = summary["results"]["fatigue"]
    assert 0 < found["damage_with"] < found["damage_without"]
    assert "The fatigue damage of 20.0 years times the design fatigue factor 3" in summary["results"]["verdict"]
    assert (folder / "figures" / "fatigue.png").stat().st_size > 10_000
    text = (folder / "report.html").read_text(encoding="utf-8")
    assert '<section id="fatigue">' in text
    assert 'id="plot-fatigue"' in text
    assert "ASTM E1049" in text
    assert "reproduced in the notebook of fatpack" in text


def test_the_figure_shows_the_bins(section):
    damage = section.data["fatigue"]
    figure = fatigue_figure(damage)
    upper, lower = figure.axes
    assert upper.get_yscale() == "log"
    widths = np.diff(bin_edges(damage))
    assert np.nansum(per_speed(damage, "damage_without") * widths) == pytest.approx(
        damage["damage_without"].values.sum()
    )
    low, high = damage_range(damage)
    assert low < np.nanmax(per_speed(damage, "damage_with")) < high
    assert lower.get_ylim()[1] > damage["stress_range_without"].values.max() / 1e6
