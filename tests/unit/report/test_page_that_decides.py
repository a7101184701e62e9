"""The head of a report: what it prints is what summary.json holds, and nothing green stands beside what fails."""

import json
import re

import jinja2
import pytest

import frahm
from frahm import readable
from frahm.analysis import analyse, save_analysis
from frahm.assessment import accepted
from frahm.plotting.decision import DEVICES
from frahm.report import decision, render_report
from frahm.report.document import document_rows
from frahm.report.input_tables import input_rows
from frahm.report.references import reference_rows


@pytest.fixture(scope="module")
def failing(tmp_path_factory):
    case = frahm.load_case("jacket-pipe").without_absorbers()
    case = frahm.load_case(case.to_dict() | {"limits": {"displacement": 0.02, "amplitude_ratio": 1.0}})
    analysis = analyse(case)
    folder = tmp_path_factory.mktemp("failing")
    save_analysis(analysis, folder)
    summary = json.loads((folder / "summary.json").read_text())
    return analysis, summary["results"], render_report(analysis, {})


def text_of(html):
    return re.sub(r"\s+", " ", re.sub(r"<[^>]+>", " ", html))


def head_of(html):
    return text_of(html[: html.index('class="cards"')])


def test_the_banner_says_in_words_that_a_limit_is_exceeded(failing):
    _, results, html = failing
    assert results["acceptance"]["verdict"] == "fail"
    assert 'class="banner fail"' in html
    assert '<p class="word">FAIL</p>' in html
    assert "all checks passed" not in html
    for row in results["acceptance"]["rows"]:
        assert row["text"] in head_of(html)
        assert readable.share(row["ratio"]) in head_of(html)


def test_the_devices_of_the_head_have_the_numbers_of_the_summary(failing):
    _, results, html = failing
    rows = results["decision"]["rows"]
    assert [row["name"] for row in rows] == ["none", "tuned mass damper"]
    for row, shown in zip(rows, decision.device_rows(results["decision"]), strict=True):
        assert shown[0].startswith(DEVICES[row["name"]])
        assert shown[1] == readable.in_mm(row["pipe_peak"])
        assert shown[1] in head_of(html)
    assert rows[0]["pipe_peak"] == results["worst_case"]["pipe_peak"]
    assert rows[0]["utilisation"] == results["acceptance"]["utilisation"]
    assert results["largest_motion"]["pipe_peak"] == rows[0]["pipe_peak"]


def test_the_figure_of_the_head_has_the_peaks_of_its_table_as_its_largest_values(failing):
    analysis, results, _ = failing
    data = analysis.data["decision"]
    for number, row in enumerate(results["decision"]["rows"]):
        one = data.isel(point=data["device"].values == number)
        assert float(one["pipe_peak"].max()) == pytest.approx(row["pipe_peak"], rel=1e-12)


def test_the_row_without_error_is_the_comparison(failing):
    _, results, _ = failing
    errors = results["decision"]["frequency_errors"]
    at = [abs(error) < 1e-12 for error in errors["error"]].index(True)
    for row in results["decision"]["rows"]:
        assert errors["pipe_peak"][row["name"]][at] == row["pipe_peak"]
    tuned = [1e3 * peak for peak in errors["pipe_peak"]["tuned mass damper"]]
    assert tuned == pytest.approx([12.3, 7.4, 4.3, 2.6, 4.1, 6.2, 8.6], abs=0.06)  # a damper of 2 %, by the same rule


def test_a_case_without_limits_is_not_coloured_as_one_that_keeps_them():
    status, word, sentence = decision.banner(accepted([], True))
    assert (status, word) == ("open", "NOT JUDGED")
    assert sentence.startswith("The case gives no limit")
    kept = {"verdict": "pass", "rows": [{"ratio": 0.5}], "sentence": "PASS: the limit used most is stroke, 50%."}
    assert decision.banner(kept)[0] == "pass"


def test_what_is_unverified_names_its_reason():
    row = {
        "name": "sink", "pipe_peak": 0.00671, "wind_speed": 11.06, "detuning": 0.0, "kind": "quasi-periodic",
        "amplitude_ratio": 0.011, "stress_range": 21.8e6, "damage": 0.0111, "damage_times_factor": 0.111,
        "life_years": None, "stroke": 0.0108, "utilisation": {"damage": 0.111}, "verified": False,
        "unverified": ["The worst motion sits at the upper end of the range."],
    }  # fmt: skip
    (shown,) = decision.device_rows({"rows": [row]})
    assert shown[-1] == "no: The worst motion sits at the upper end of the range."
    assert shown[1:4] == ("6.71", "11.06 m/s", "modulated")
    assert shown[7] == "without end"


def test_checks_never_say_passed_where_one_failed():
    assert decision.numerical_checks([("a", "fail"), ("b", "pass")], ["c"])[0] == "fail"
    assert decision.numerical_checks([("a", "pass")], ["c"])[0] == "unverified"
    assert decision.numerical_checks([("a", "pass")], [])[0] == "sound"


def test_the_title_block_frames_the_report_and_inputs_come_back_as_typed():
    case = frahm.load_case("jacket-pipe").to_dict()
    case["pipe"]["diameter"] = "30 inch"
    case = frahm.load_case(case | {"document": {"project": "Kittiwake", "revision": "B", "checked": "A. N. Other"}})
    assert document_rows(case) == [("Project", "Kittiwake"), ("Revision", "B"), ("Checked by", "A. N. Other")]
    (diameter,) = [row for row in input_rows(case, [], case.typed) if row.path == "pipe.diameter"]
    assert (diameter.typed, diameter.value, diameter.unit) == ("30 inch", "0.762", "m")
    assert not [row for row in input_rows(case, [], case.typed) if row.path.startswith("document")]


def test_every_formula_and_limit_is_a_reference_with_a_standing(failing):
    analysis, results, html = failing
    rows = reference_rows(analysis.case, results["wind"], ["none", "tuned mass damper"])
    assert all(source and standing for _, source, standing in rows)
    used = [name for name, _, _ in rows]
    for criterion in results["wind"]["criteria"]:
        assert f"Onset: {criterion['name']}" in used
    assert "Lock-in band" in used
    assert "Limit: displacement" in used
    assert 'id="references"' in html


@pytest.mark.parametrize("name", ["report.html.jinja", "design.html.jinja"])
def test_the_templates_can_be_read(name):
    environment = jinja2.Environment(loader=jinja2.PackageLoader("frahm.report", "."))
    for part in [name, *(p for p in environment.list_templates() if p.startswith("sections/"))]:
        assert environment.get_template(part)


def test_a_case_without_title_block_has_no_frame():
    assert document_rows(frahm.load_case("jacket-pipe")) == []
