"""Where a basin map is made, and what the report says of it."""

import numpy as np
import pytest

import frahm
from frahm.analysis import CaseAnalysis, modulated
from frahm.analysis.long_term import _row
from frahm.analysis.modulated import basins
from frahm.analysis.section import Section, Work
from frahm.loads import operating_range
from frahm.report.motion_tables import basin_caption, coexisting_rows

CASE = frahm.load_case("jacket-pipe").with_absorber(xi2=0.0085)
DETACHED = -0.1  # below the upper saddle-node of the detached branch, -.09507 by collocation


@pytest.fixture(scope="module")
def detached():
    """Attractors where the detached branch is stable, as a search over the window leaves them."""
    found = frahm.find_attractors(CASE, detuning=DETACHED, samples=12, seed=1)
    return [_row(attractor, operating_range(CASE)) for attractor in found]


def results(at_design, coexisting):
    return {"attractors": at_design, "worst_case": {"detuning": DETACHED}, "coexisting": coexisting}


def test_one_motion_at_the_design_wind_and_several_at_the_worst(detached, monkeypatch):
    monkeypatch.setattr(modulated, "_RESOLUTION", 15)
    single = [detached[0] | {"detuning": 0.108}]
    section = basins(Work(CASE, Section(results=results(single, detached))))
    assert section.results["basin_map"]["detuning"] == pytest.approx(DETACHED, abs=1e-9)
    data = section.data["basin_map"]
    peaks = data["pipe_peak"].values[np.unique(data["label"].values[data["label"].values >= 0])]
    assert peaks.max() > 0.045  # detached; 0.0174 at its lower end and 0.0519 at its upper, by collocation
    assert np.abs(peaks - 0.0063).min() < 3e-4  # on the branch that comes from low frequency
    analysis = CaseAnalysis(
        case=CASE, results=section.results | {"coexisting": detached}, data={}, checks=(), unverified=(), notes=(),
        interrupted=False, version="",
    )  # fmt: skip
    assert "where the worst motion is" in basin_caption(analysis)
    assert "at -0.1 rad/s" in basin_caption(analysis)
    windy = CaseAnalysis(
        case=CASE, results={"coexisting": [detached[0] | {"wind_speed": 2.59}]}, data={}, checks=(), unverified=(),
        notes=(), interrupted=False, version="",
    )  # fmt: skip
    assert coexisting_rows(windy)[0][0] == "2.59"
    rows = coexisting_rows(analysis)
    assert [row[0] for row in rows] == ["-0.1"] * len(detached)
    assert {row[-1] for row in rows} == {"yes", "no"}


@pytest.mark.parametrize("alone", ["nothing", "no share", "unsettled"])
def test_where_one_motion_lasts_there_is_no_map(detached, alone):
    beside = {
        "nothing": [],
        "no share": [detached[0], detached[1] | {"basin_fraction": 0.0}],
        "unsettled": [detached[0], detached[1] | {"kind": "unsettled"}],
    }[alone]
    section = basins(Work(CASE, Section(results=results([detached[0]], beside))))
    assert section == Section()
