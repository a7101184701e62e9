"""Where the lift follows the wind every table says the wind; displacements are in millimetres everywhere."""

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest

import frahm
from frahm.analysis import analyse
from frahm.analysis import analysis as steps
from frahm.analysis.cross_check import cross_check
from frahm.analysis.linear import without_absorber
from frahm.analysis.long_term import attractors
from frahm.analysis.manifold import manifold
from frahm.analysis.motions import motions
from frahm.analysis.response import exact_response
from frahm.analysis.section import Work
from frahm.analysis.wind import wind
from frahm.cli.results import results_text
from frahm.errors import Outcome
from frahm.plotting.basins import basin_map_figure
from frahm.plotting.interactive import basin_map_plot, manifold_plot
from frahm.plotting.static import manifold_figure
from frahm.report import check_tables, fatigue_tables, motion_tables, render_report, response_tables

TUBE = frahm.load_case(Path(__file__).parents[2] / "cases" / "tube.yaml")


@pytest.fixture(scope="module")
def analysis():
    """A tube with a sink over the wind, by the steps whose tables say places."""
    mass = 0.02 * TUBE.pipe.mass
    law = {"kind": "cubic", "stiffness": 0.8 * mass * TUBE.pipe.frequency**2 / 0.02**2, "damping": 0.3 * mass}
    case = TUBE.to_dict() | {
        "absorbers": [{"mass": mass, "position": 12.0, "law": law}],
        "analysis": {"samples": 8, "periods": 200, "wind": ["4.2 m/s", "4.6 m/s"]},
    }
    case = frahm.load_case(case).with_wind(speed=4.4)
    chosen = (without_absorber, exact_response, wind, motions, cross_check, attractors)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(steps, "STEPS", tuple(step for step in steps.STEPS if step.run in chosen))
        return analyse(case)


def tables_of(html):
    """Head and body cells of every table of a report but those of its inputs."""
    html = re.sub(r'<section id="inputs">.*?</section>', "", html, flags=re.DOTALL)
    return [re.sub(r"<[^>]+>", " ", table) for table in re.findall(r"<table.*?</table>", html, re.DOTALL)]


def test_no_table_over_the_wind_counts_detunings(analysis):
    html = render_report(analysis, {})
    found = tables_of(html)
    assert len(found) > 8
    for table in (*found, results_text(analysis)):
        assert "rad/s" not in table, table[:300]
    for head in (
        response_tables.special_point_head(analysis),
        motion_tables.motion_head(analysis),
        check_tables.comparison_head(analysis),
    ):
        assert "Wind [m/s]" in head
        assert not any(head_cell.endswith("[m]") for head_cell in head)
    assert fatigue_tables.BIN_HEAD[:2] == ["Wind [m/s]", "Frequency [Hz]"]


def test_every_place_is_the_wind_that_sheds_there(analysis):
    lo, hi = analysis.case.analysis.wind
    law = frahm.loads.wind_excitation(analysis.case)
    exact = analysis.results["response"]["harmonic-balance"]
    for point in exact["special_points"]:
        assert float(law.frequency(point["wind_speed"])) == pytest.approx(point["frequency"], rel=1e-9)
    compared = [float(row[0]) for row in check_tables.comparison_rows(analysis)]
    assert compared == sorted(compared)
    assert lo * 0.999 <= compared[0]
    assert compared[-1] <= hi * 1.001
    omega = analysis.case.pipe.frequency
    for branch in exact["branches"]:
        assert np.asarray(law.frequency(np.sort(branch["wind_speed"]))) == pytest.approx(
            omega + np.array(branch["detuning"]), rel=1e-6
        )


def test_a_bare_pipe_is_not_compared_with_itself():
    done = analyse(TUBE)
    assert "Without absorber [mm]" not in motion_tables.motion_head(done)
    assert {len(row) for row in motion_tables.motion_rows(done)} == {len(motion_tables.motion_head(done))}
    assert "without absorber" not in re.search(r'id="data-response-pipe">(.*?)</script>', render_report(done, {}))[1]


def test_slow_manifold_and_basins_are_drawn_in_millimetres():
    case = frahm.load_case("jacket-pipe")
    section = manifold(Work(case))
    folds, data = section.results["slow_manifold"]["folds"], section.data["slow_manifold"]
    figure = manifold_figure(data, None, folds)
    axes = figure.axes[0]
    assert (axes.get_xlabel()[-4:], axes.get_ylabel()[-4:]) == ("[mm]", "[mm]")
    (fold,) = (line for line in axes.lines if line.get_label() == "fold")
    assert fold.get_ydata() == pytest.approx([1e3 * pipe for pipe in folds["pipe"]])
    (drawn,) = (trace for trace in manifold_plot(data, None, folds).data if trace.get("name") == "fold")
    assert drawn["x"] == pytest.approx([1e3 * size for size in folds["relative"]])
    basins = frahm.basin_map(case, detuning=0.0, resolution=(6, 4))
    wide = 1e3 * float(basins["x1"].max())
    assert max(basin_map_plot(basins).data[0]["x"]) == pytest.approx(wide, rel=1e-6)
    axes = basin_map_figure(basins).axes[0]
    assert axes.get_xlim()[1] > wide
    assert axes.get_xlabel().endswith("[mm]")
    assert axes.get_ylabel().endswith("[mm/s]")


@pytest.mark.parametrize("outcome", ["step_too_small", "diverged", "step_limit"])
def test_what_stopped_a_motion_is_printed_beside_it(analysis, outcome):
    first, *rest = analysis.results["motions"]
    stopped = first | {"kind": "unsettled", "outcome": outcome, "pipe_peak": None}
    one = dict(analysis.results["attractors"][0], kind="unsettled", outcome=outcome)
    shown = dataclasses.replace(analysis, results=analysis.results | {"motions": [stopped, *rest], "attractors": [one]})
    words = Outcome[outcome.upper()].value
    assert motion_tables.motion_rows(shown)[0][2] == f"unsettled: {words}"
    assert motion_tables.attractor_rows(shown)[0][0] == f"unsettled: {words}"
    assert results_text(shown).count(words) == 2
    assert render_report(shown, {}).count(words) >= 2
