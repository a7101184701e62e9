"""A sink at a node of the governing mode: nothing moves it, and nothing is divided by its stroke of nothing."""

import numpy as np
import pytest

import frahm
from frahm.analysis import Work
from frahm.analysis.cross_check import cross_check
from frahm.analysis.modes import modes
from frahm.analysis.response import exact_response
from frahm.analysis.section import Section

BRACE = {
    "pipe": {"kind": "tube", "diameter": "16 inch", "wall": "10 mm", "length": "26 m", "damping_ratio": "0.2 %",
             "supports": [{"at": "0 m", "kind": "pinned"}, {"at": "26 m", "kind": "pinned"}], "mode_count": 2,
             "governing_mode": 2},
    "wind": {"speed": "15.1 m/s", "strouhal": 0.2, "lift_coefficient": 0.3},
    "absorbers": [{"mass": "40 kg", "position": "13 m",
                   "law": {"kind": "cubic", "stiffness": "1e8 N/m^3", "damping": "200 N s/m"}}],
    "analysis": {"detuning": [-0.5, 0.5]},
}  # fmt: skip


@pytest.fixture(scope="module")
def work():
    work = Work(frahm.load_case(BRACE))
    return work.with_section(exact_response(work))


def test_a_stroke_of_rounding_is_compared_with_the_motion(work):
    section = cross_check(work)
    table = section.data["cross_check"]
    assert np.max(table["relative_peak"].values / table["pipe_peak"].values) < 1e-9
    assert section.results["cross_check"]["largest_relative_error"] < 1e-9
    assert section.checks[0].status == "pass"


def test_a_disturbance_that_neither_grows_nor_dies_leaves_the_largest_motion_stable(work):
    """The sink at rest has no stiffness: its multiplier is 1, and rounding says whether that is stable."""
    curve = work.done.data["response"]
    assert np.max(np.abs(curve["growth_rate"].values)) < 1e-9
    rounded = curve.assign(stable=curve["stable"] | True)
    (check,) = modes(work.with_section(Section(data={"response": rounded}))).checks
    assert "largest stable pipe peak" in check.detail
    assert check.status == "pass", check.detail
