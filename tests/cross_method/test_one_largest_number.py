"""Over members of every size: the motion called worst is the largest number of its folder, and the same everywhere."""

import csv
import json
import math
import re
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, given
from hypothesis import strategies as st

import frahm
from frahm import readable
from frahm.analysis import analyse, load_analysis, save_analysis
from frahm.analysis.largest import FIXED_LIFT
from frahm.report import check_tables, write_report
from searching import at_most

TRANSIENT = 1e-3  # a motion called periodic may still hold so much of its start
OTHERS = {"without_absorber", "wind", "unsteady_wind", "lock_in", "without_absorber_over_wind", "provenance", "fatigue"}
NOT_PEAKS = {
    "pipe_peak_max_detuning",
    "stable_pipe_peak_max_detuning",
    "pipe_peak_max_without",
    "pipe_peak_without_absorber",
    "pipe_peak_whole_run",
}  # places, other devices, the start of a run


@st.composite
def members(draw):
    """A member of one mode with a limit, bare or with a tuned mass damper, asked over its winds or over a window."""
    diameter = draw(st.floats(0.1, 2.0))
    frequency = draw(st.floats(0.3, 15.0))
    zeta = draw(st.floats(0.001, 0.02))
    mass = draw(st.floats(50.0, 500.0)) * diameter
    strouhal = draw(st.floats(0.15, 0.25))
    resonant = frequency * diameter / strouhal
    detuning = {"detuning": [-0.3 * 2 * math.pi * frequency, 0.3 * 2 * math.pi * frequency]}
    case = {
        "pipe": {"kind": "mode", "mass": mass, "length": 1.0, "frequency": 2 * math.pi * frequency,
                 "damping_ratio": zeta, "diameter": diameter},
        "wind": {"speed": resonant * draw(st.floats(0.85, 1.2)), "strouhal": strouhal,
                 "lift_coefficient": draw(st.floats(0.05, 0.7))},
        "absorbers": [],
        "limits": {"displacement": draw(st.floats(0.001, 0.1)) * diameter},
        "analysis": draw(st.sampled_from([{}, detuning])),
    }  # fmt: skip
    if draw(st.booleans()):
        small, omega = 0.02 * mass, 2 * math.pi * frequency * draw(st.floats(0.9, 1.1))
        law = {"kind": "linear", "stiffness": small * omega**2, "damping": 2 * 0.08 * small * omega}
        case["absorbers"] = [{"mass": small, "law": law}]
    return frahm.load_case(case | {"name": "member"})


def peaks_of(found, own, path=()):
    """Every pipe peak of a summary that belongs to a lasting motion of the case itself, by where it stands."""
    if isinstance(found, list):
        for number, entry in enumerate(found):
            yield from peaks_of(entry, own, (*path, number))
    elif isinstance(found, dict):
        if found.get("kind") == "unsettled" or (path[:1] and path[0] in OTHERS):
            return
        if path[:2] == ("decision", "rows") and len(path) == 3 and found["name"] != own:
            return
        for name, entry in found.items():
            if "pipe_peak" in name and isinstance(entry, int | float) and name not in NOT_PEAKS:
                yield (*path, name), entry
            elif name != "frequency_errors":
                yield from peaks_of(entry, own, (*path, name))


@given(case=members())
@at_most(3, more=10, phases=(Phase.explicit, Phase.generate))
def test_the_worst_is_the_largest_number_of_its_folder_and_the_same_everywhere(case):
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        save_analysis(analyse(case), folder)
        write_report(load_analysis(folder), folder)
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        results = summary["results"]
        worst = results["worst_case"]["pipe_peak"]

        own = "case" if case.absorbers else "none"
        found = dict(peaks_of(results, own))
        if case.analysis.detuning is not None:  # one lift at all frequencies: a check says whether it is exceeded
            over_wind = found.pop(("response_over_wind", "pipe_peak_max_with"))
            (check,) = [check for check in summary["checks"] if check["name"] == FIXED_LIFT]
            assert (check["status"] == "pass") == (over_wind <= 1.01 * worst)
        assert len(found) >= 5
        for where, peak in found.items():
            slack = TRANSIENT if where[0] == "motions" else 1e-9
            assert peak <= worst * (1 + slack), where
        assert max(peak for where, peak in found.items() if where[0] != "motions") == worst

        (row,) = [row for row in results["decision"]["rows"] if row["name"] == own]
        assert row["pipe_peak"] == worst
        assert results["largest_motion"]["pipe_peak"] == worst
        assert results["lock_in"]["resonant"] == worst
        if not case.absorbers:
            assert results["without_absorber"]["worst"]["pipe_peak"] == worst

        limit = case.limits.displacement
        assert results["acceptance"]["utilisation"]["displacement"] * limit == pytest.approx(worst, rel=1e-12)
        (judged,) = [row for row in results["acceptance"]["rows"] if row["name"] == "displacement"]
        assert judged["value"] == worst
        assert (results["acceptance"]["verdict"] == "fail") == (worst > limit)

        said = readable.length(worst)
        assert f"the largest pipe motion found, transients aside, is {said} " in results["verdict"]
        html = (folder / "report.html").read_text(encoding="utf-8")
        banner = re.search(r'<section id="verdict".*?</section>', html, re.DOTALL)[0]
        assert (f"Displacement {said} of" in banner) == (worst > limit)
        assert f">{said}</b>" in html  # the card

        for name, peak in columns_of_figures(folder, results).items():
            assert peak <= worst * (1 + 1e-9), name
        analysis = load_analysis(folder)
        for cells in check_tables.comparison_rows(analysis):
            assert float(cells[1]) <= 1e3 * worst * (1 + 1e-5)


def columns_of_figures(folder, results):
    """Largest pipe displacement [m] of every curve of the case itself, as the figures have it."""
    own = [row["name"] for row in results["decision"]["rows"]].index("case" if results["has_absorber"] else "none")
    found = {}
    for name in ("response-harmonic-balance", "decision"):
        text = (folder / "figures" / f"{name}.csv").read_text(encoding="utf-8")
        lines = [line for line in text.splitlines() if not line.startswith("#")]
        rows = list(csv.DictReader(lines))[1:]  # the first has the units
        mine = [row for row in rows if name != "decision" or float(row["device"]) == own]
        found[name] = float(np.nanmax([float(row["pipe_peak"]) for row in mine]))
    return found
