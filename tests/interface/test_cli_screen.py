"""`frahm screen`: from a table to a report, and on to `frahm run` and `frahm design`."""

import csv
import json
import re

import pytest
from typer.testing import CliRunner

import frahm
from frahm.cli import app
from frahm.screening.store import CSV_COLUMNS

HEAD = "name;diameter [mm];wall [mm];length [m];ends;damping ratio [%];highest wind [m/s];displacement limit [mm]"
PASSES = "A1;508;12,7;8;fixed;0,15;20;50"
FAILS = "A2;508;12,7;25;fixed;0,15;20;5"
OPEN = "A3;508;12,7;16,5;fixed;0,15;26;50"


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def table(tmp_path, *rows):
    path = tmp_path / "members.csv"
    path.write_text("\n".join([HEAD, *rows]) + "\n")
    return path


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    folder = tmp_path_factory.mktemp("screen")
    return run("screen", "members-example", "--out", folder / "out", "--cases", folder / "cases"), folder


def test_the_example_writes_what_was_promised(example):
    result, folder = example
    assert result.exit_code == 4, result.output
    out = folder / "out"
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    members = summary["results"]["members"]
    assert summary["frahm"] == frahm.__version__
    assert len(members) == 30
    assert summary["results"]["provenance"]["digest"]
    assert summary["checks"][0]["status"] == "pass"
    with (out / "members.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert list(rows[0]) == [head for head, _ in CSV_COLUMNS]
    assert [row["name"] for row in rows] == [member["name"] for member in members]
    for row, member in zip(rows, members, strict=True):
        assert float(row["amplitude [mm]"]) == pytest.approx(1e3 * member["pipe_peak"], rel=1e-5)
        assert float(row["stress range [MPa]"]) == pytest.approx(1e-6 * member["stress_range"], rel=1e-5)
        assert row["verdict"] == member["verdict"]
        assert frahm.load_case(member["case"]).digest == member["digest"]
    counts = summary["results"]["counts"]
    assert set(counts) == {"FAIL", "LOOK CLOSER", "NOT JUDGED", "PASS"}
    assert min(counts["FAIL"], counts["LOOK CLOSER"], counts["PASS"]) > 0
    written = sorted(path.stem for path in (folder / "cases").iterdir())
    assert written == sorted(member["name"] for member in members if member["verdict"] != "PASS")
    page = (out / "report.html").read_text(encoding="utf-8")
    assert page.count("data:image/svg+xml") >= 4
    assert not re.search(r'(src|href)="(?!data:|#)', page)


def test_a_member_that_fails_goes_on_to_run_with_the_same_amplitude(example):
    _, folder = example
    name = "FB-502"
    result = run("run", folder / "cases" / f"{name}.yaml", "--out", folder / "run")
    assert result.exit_code == 4, result.output
    worst = json.loads((folder / "run" / "summary.json").read_text(encoding="utf-8"))["results"]["worst_case"]
    members = json.loads((folder / "out" / "summary.json").read_text(encoding="utf-8"))["results"]["members"]
    assert worst["pipe_peak"] == next(member["pipe_peak"] for member in members if member["name"] == name)


def test_show_and_report_know_the_folder(example):
    _, folder = example
    shown = run("show", folder / "out")
    assert shown.exit_code == 0
    assert "16 FAIL" in shown.stdout
    assert len(shown.stdout.splitlines()) == 31


@pytest.mark.parametrize(
    ("rows", "code"), [((PASSES,), 0), ((PASSES, FAILS), 4), ((PASSES, OPEN), 3), ((FAILS, OPEN), 4)]
)
def test_exit_codes(tmp_path, rows, code):
    result = run("screen", table(tmp_path, *rows), "--out", tmp_path / "out")
    assert result.exit_code == code, result.output


def test_a_row_that_cannot_be_read_is_named_and_the_others_go_on(tmp_path):
    result = run("screen", table(tmp_path, PASSES, "A9;508;12,7;8;fixd;0,15;20;50"), "--out", tmp_path / "out")
    assert result.exit_code == 3
    assert re.search(r"members\.csv:3: A9: not judged\. ends: given 'fixd'.*Did you mean 'fixed'", result.stderr)
    results = json.loads((tmp_path / "out" / "summary.json").read_text())["results"]
    assert [row["name"] for row in results["members"]] == ["A1"]
    assert results["not_judged"][0]["place"].endswith("members.csv:3")
    assert "Rows that were not judged" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "A9" in (tmp_path / "out" / "members.csv").read_text()


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ((), "at least one member"),
        ((PASSES, PASSES), "a name no other member has"),
        (("A9;508;12,7;8;fixd;0,15;20;50",), "at least one row that can be read"),
    ],
)
def test_bad_input_is_one_message_and_writes_nothing(tmp_path, rows, words):
    result = run("screen", table(tmp_path, *rows), "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert words in result.stderr
    assert "Traceback" not in result.output
    assert not (tmp_path / "out" / "summary.json").exists()


def test_a_folder_of_something_else_is_left_alone(tmp_path):
    path, out = table(tmp_path, PASSES), tmp_path / "out"
    assert run("screen", path, "--out", out).exit_code == 0
    assert sorted(file.name for file in out.iterdir()) == ["figures", "members.csv", "report.html", "summary.json"]
    assert run("screen", path, "--out", out).exit_code == 0
    other = table(tmp_path, FAILS)
    refused = run("screen", other, "--out", out)
    assert refused.exit_code == 2
    assert "--force" in refused.stderr
    assert run("screen", other, "--out", out, "--force").exit_code == 4
    assert run("run", "jacket-pipe", "--out", out).exit_code == 2


def test_one_member_as_a_case(tmp_path):
    path, out = table(tmp_path, PASSES, FAILS), tmp_path / "out"
    result = run("screen", path, "--out", out, "--case", "A1")
    assert "1 case in" in result.stdout
    assert [file.name for file in (out / "cases").iterdir()] == ["A1.yaml"]
    assert run("check", out / "cases" / "A1.yaml").exit_code == 0
    wrong = run("screen", path, "--out", out, "--case", "A11")
    assert wrong.exit_code == 2
    assert "Did you mean 'A1'" in wrong.stderr


@pytest.mark.parametrize("ending", ["csv", "xlsx"])
def test_a_new_table_can_be_screened(tmp_path, ending):
    path = tmp_path / f"mine.{ending}"
    made = run("new", path, "--members")
    assert made.exit_code == 0
    assert f"frahm screen {path}" in made.stdout.replace("\n", "")
    assert run("new", path, "--members").exit_code == 2
    assert run("new", path, "--members", "--force").exit_code == 0
    assert run("new", tmp_path / "mine.yaml", "--members").exit_code == 2
    assert run("new", path, "--members", "--study").exit_code == 2
    result = run("screen", path, "--out", tmp_path / "out")
    assert result.exit_code in (0, 3, 4)
    assert len(json.loads((tmp_path / "out" / "summary.json").read_text())["results"]["members"]) == 3


def test_names_that_no_file_system_takes(tmp_path):
    path = table(tmp_path, FAILS.replace("A2", "../A/2"), FAILS.replace("A2", "..A 2"), FAILS.replace("A2", "=1+1"))
    result = run("screen", path, "--out", tmp_path / "out", "--cases", tmp_path / "cases")
    assert result.exit_code == 4, result.output
    names = sorted(file.name for file in (tmp_path / "cases").iterdir())
    assert names == ["1-1.yaml", "A-2-2.yaml", "A-2.yaml"]
    assert "\n'=1+1," in (tmp_path / "out" / "members.csv").read_text()
    assert "<script" not in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
