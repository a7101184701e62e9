"""The screen of a list of members says of each what `frahm run` and `frahm.worst_case` of it say."""

import pytest

import frahm
from frahm.analysis import STEPS, analyse
from frahm.analysis import analysis as steps
from frahm.analysis.fatigue import fatigue
from frahm.analysis.largest import largest_motion
from frahm.analysis.linear import without_absorber
from frahm.analysis.long_term import worst
from frahm.analysis.wind import wind
from frahm.design import check_design
from frahm.screening import FAIL, save_cases

NEEDED = (without_absorber, worst, fatigue, wind, largest_motion)
NAMES = ("FB-502", "RS-601", "DB-205", "CS-702", "XB-302", "CG-403")  # of every verdict, kind of ends and range


@pytest.fixture(scope="module")
def screen():
    return frahm.screen_members("members-example")


@pytest.mark.parametrize("name", NAMES)
def test_a_member_moves_as_far_in_a_run(screen, name, tmp_path, monkeypatch):
    """Read back from the file that the screen writes of it."""
    (path,) = save_cases([screen[name]], tmp_path)
    monkeypatch.setattr(steps, "STEPS", tuple(step for step in STEPS if step.run in NEEDED))
    run, found = analyse(path).results, screen[name].findings
    assert run["worst_case"]["pipe_peak"] == found.motion.pipe_peak
    assert run["worst_case"]["wind_speed"] == found.motion.wind_speed
    assert run["worst_case"]["stress_range"] == found.motion.stress_range
    assert run["without_absorber"]["worst"]["pipe_peak"] == found.motion.pipe_peak
    assert run["fatigue"]["damage_without"] == found.damage["damage_with"]
    assert run["wind"]["scruton_number"] == found.numbers.scruton_number
    assert run["wind"]["lock_in_band"]["resonance"] == found.band.resonance
    assert (run["acceptance"]["verdict"] == "fail") == (screen[name].verdict.word == FAIL)


@pytest.mark.parametrize("name", NAMES[:3])
def test_the_verbs_of_python_say_the_same(screen, name):
    worst_case = frahm.worst_case(screen[name].case)
    assert worst_case.pipe_peak == screen[name].findings.motion.pipe_peak
    assert max(frahm.frequency_response(screen[name].case).pipe_peak) <= worst_case.pipe_peak * 1.001


def test_a_design_can_start_from_every_member(screen):
    for member in screen:
        check_design(member.case)


def test_a_table_without_climate_moves_as_far_as_its_case():
    row = {"name": "A", "diameter": 0.4064, "wall": 0.0127, "length": 30.0, "ends": "fixed", "damping": 0.002,
           "highest wind": 40.0, "lift": "mode-shape"}  # fmt: skip
    (found,) = frahm.screen_members([row])
    assert found.case.pipe.mode_count > 3
    assert frahm.worst_case(found.case).pipe_peak == found.findings.motion.pipe_peak
