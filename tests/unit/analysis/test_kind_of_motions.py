"""One motion has one kind and one size, wherever a run tells of it."""

import json

import numpy as np
import pytest

import frahm
from frahm.analysis import STEPS, Work, analyse
from frahm.analysis import analysis as steps
from frahm.analysis.motions import motions
from frahm.report import motion_tables
from frahm.systems import build_system

KINDS_OF_SEARCH = {"quasi-periodic": "modulated"}


def chaotic_case():
    """Near its resonance the pipe beats irregularly: neighbours part, as the attractors there show."""
    case = frahm.load_case("jacket-pipe").to_dict()
    del case["analysis"]["detuning"]
    return frahm.load_case(case | {"wind": case["wind"] | {"speed": 2.64}, "name": "near-resonance"})


@pytest.fixture(scope="module")
def analysis():
    chosen = ("without_absorber", "exact_response", "motions", "attractors", "worst", "largest_motion", "lock_in")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(steps, "STEPS", tuple(step for step in STEPS if step.run.__name__ in chosen))
        return analyse(chaotic_case())


def test_the_motion_from_rest_has_the_kind_of_the_attractor_it_lands_on(analysis):
    (landed,) = [row for row in analysis.results["attractors"] if row["from_rest"]]
    assert landed["kind"] == "chaotic"
    design = analysis.results["motions"][0]
    assert design["kind"] == landed["kind"]
    assert design["pipe_peak"] == pytest.approx(landed["pipe_peak"], rel=1e-3)
    assert analysis.results["lock_in"]["kind"] == landed["kind"]
    assert f"({landed['kind']}, " in analysis.verdict


def test_no_table_or_summary_says_another_word(analysis):
    assert "quasi-periodic" not in json.dumps(analysis.summary())
    assert motion_tables.motion_rows(analysis)[0][2] == motion_tables.attractor_rows(analysis)[0][0]


def test_kinds_at_other_winds_are_those_of_a_search_there(analysis):
    work = Work(analysis.case)
    rows = analysis.results["motions"][1:]
    assert len(rows) >= 3
    for row in rows:
        found = frahm.find_attractors(work.driven(row["frequency"]), frequency=row["frequency"], samples=0)
        (landed,) = [one for one in found if one.from_rest]
        assert (row["kind"], row["period_multiple"]) == (
            KINDS_OF_SEARCH.get(landed.kind, landed.kind),
            landed.period_multiple,
        )


def test_the_check_where_nothing_is_stable_takes_any_motion_that_is_not_the_unstable_one(analysis):
    (check,) = [check for check in analysis.checks if "no motion repeats every period" in check.name]
    assert check.status == "pass"
    assert "chaotic at 2.64 m/s" in check.detail


def test_an_unsettled_run_of_a_linear_system_tells_the_response_in_closed_form():
    case = frahm.load_case("jacket-pipe").without_absorbers().with_analysis(periods=100)
    section = motions(Work(case))
    for row in section.results["motions"]:
        system, W = build_system(case), row["frequency"]
        stiffness, damping = system.stiffness[0, 0], system.damping[0, 0]
        closed = abs(system.forcing[0] / complex(stiffness - system.mass[0, 0] * W**2, damping * W))
        assert row["kind"] == "periodic"
        assert row["pipe_peak"] == pytest.approx(closed, rel=1e-9)
        assert row["pipe_rms"] == pytest.approx(closed / np.sqrt(2), rel=1e-9)
        assert np.isnan(row["relative_peak"])
    assert any("has not settled within 100 periods" in note for note in section.notes)
    assert any("its numbers are of the motion it tends to" in note for note in section.notes)


def test_an_unsettled_run_of_an_undamped_pipe_stays_unsettled():
    case = frahm.load_case("jacket-pipe").without_absorbers().to_dict()
    case["pipe"]["damping_ratio"] = 0.0
    (row, *_) = motions(Work(frahm.load_case(case | {"name": "undamped"}))).results["motions"]
    assert row["kind"] == "unsettled"
