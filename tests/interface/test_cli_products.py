"""`frahm design --members`: from a table to kinds of absorber, and on to `frahm run`."""

import csv
import json
import re

import pytest
from typer.testing import CliRunner

import frahm
from frahm.cli import app
from frahm.products.store import CSV_COLUMNS

HEAD = "name;diameter [mm];wall [mm];length [m];ends;damping ratio [%];highest wind [m/s];displacement limit [mm];modes"
PASSES = "A0;508;12,7;8;fixed;0,3;20;10;1"
FAILS = ("A1;508;12,7;21;fixed;0,3;20;2,5;1", "A2;508;12,7;27;fixed;0,3;20;2,5;1")
HOPELESS = "A3;508;12,7;25;fixed;0,3;20;0,05;1"
UNREAD = "A9;508;12,7;25;fixd;0,3;20;10;1"


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def table(tmp_path, *rows, head=HEAD):
    path = tmp_path / "members.csv"
    path.write_text("\n".join([head, *rows]) + "\n")
    return path


@pytest.fixture(scope="module")
def example(tmp_path_factory):
    folder = tmp_path_factory.mktemp("products")
    path = table(folder, PASSES, *FAILS)
    return run("design", "--members", path, "--products", "1-2", "--family", "tuned", "--out", folder / "out"), folder


def test_a_table_becomes_kinds_cases_and_a_report(example):
    result, folder = example
    assert result.exit_code == 0, result.output
    assert "2 kinds of tuned mass damper let the 2 members that fail alone pass" in result.stdout
    out = folder / "out"
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    results = summary["results"]
    assert [product["count"] for product in results["products"]] == [1, 2]
    best = results["products"][1]
    assert results["best"] == {"family": "tuned", "count": 2, "kinds": 2}
    assert best["passes"]
    assert best["verified"]
    assert {"kappa", "linear", "xi2", "mass", "members"} <= set(best["kinds"][0])
    assert sorted(name for kind in best["kinds"] for name in kind["members"]) == ["A1", "A2"]
    with (out / "products.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert list(rows[0]) == [head for head, _ in CSV_COLUMNS]
    assert [row["recommended"] for row in rows] == ["yes", "yes", "no", "no"]
    for row, one in zip(rows, best["members"], strict=False):
        assert row["member"] == one["member"]
        assert float(row["peak [mm]"]) == pytest.approx(1e3 * one["pipe_peak"], rel=1e-5)
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "data:image/svg+xml" in page
    assert not re.search(r'(src|href)="(?!data:|#)', page)


def test_the_case_of_a_member_has_the_peak_that_was_promised(example):
    _, folder = example
    results = json.loads((folder / "out" / "summary.json").read_text(encoding="utf-8"))["results"]
    for one in results["products"][1]["members"]:
        case = frahm.load_case(folder / "out" / "cases" / f"{one['member']}.yaml")
        assert frahm.worst_case(case).pipe_peak == pytest.approx(one["pipe_peak"], rel=1e-12)


def test_show_says_it_again_and_another_table_is_refused(example, tmp_path):
    _, folder = example
    shown = run("show", folder / "out")
    assert shown.exit_code == 0
    assert "2 kinds of tuned mass damper" in shown.stdout
    other = run("design", "--members", table(tmp_path, FAILS[0]), "--out", folder / "out")
    assert other.exit_code == 2
    assert "one of the same table" in other.stderr


def test_products_that_cannot_satisfy_all_name_the_member_that_binds(tmp_path):
    path = table(tmp_path, FAILS[0], HOPELESS)
    result = run("design", "--members", path, "--products", 1, "--family", "tuned", "--out", tmp_path / "out")
    assert result.exit_code == 4, result.output
    assert "A3 binds, fails" in result.stdout.replace("\n", " ")


def test_nothing_is_designed_where_no_member_fails(tmp_path):
    result = run("design", "--members", table(tmp_path, PASSES), "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert "No member" in result.stdout
    assert "nothing is designed" in result.stdout
    assert json.loads((tmp_path / "out" / "summary.json").read_text())["results"]["products"] == []


def test_a_row_that_cannot_be_read_is_named_and_the_others_go_on(tmp_path):
    path = table(tmp_path, PASSES, UNREAD)
    result = run("design", "--members", path, "--family", "tuned", "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    assert re.search(r"nothing was designed for A9, not judged: ends: given 'fixd'", result.stderr.replace("\n", " "))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--products", "0"), "products: given 0"),
        (("--products", "3-1"), "the least number of kinds first"),
        (("--products", "two"), "--products: given 'two'"),
        (("--count", "2"), "--count: given 2"),
        (("--scatter", "0.1"), "--scatter: given 0.1"),
        (("--mass-ratio", "0"), "mass_ratio: given 0"),
        (("--family", "tunned"), "Did you mean 'tuned'?"),
        (("jacket-pipe",), "CASE: given 'jacket-pipe'"),
    ],
)
def test_bad_input_is_one_message_and_writes_nothing(tmp_path, arguments, words):
    out = tmp_path / "out"
    result = run("design", "--members", table(tmp_path, *FAILS), "--out", out, *arguments)
    assert result.exit_code == 2, result.output
    assert words in result.stderr.replace("\n", " ")
    assert "Traceback" not in result.output
    assert not out.exists()


def test_a_table_without_a_column_is_refused_with_the_nearest_name(tmp_path):
    path = table(tmp_path, *FAILS, head=HEAD.replace("length", "lenght"))
    result = run("design", "--members", path, "--out", tmp_path / "out")
    assert result.exit_code == 2
    assert "'length'" in result.stderr
    assert not (tmp_path / "out").exists()


def test_a_case_or_members_are_needed_and_products_go_with_members(tmp_path):
    assert "CASE: given 'nothing'" in run("design").stderr
    refused = run("design", "jacket-pipe", "--products", "2", "--out", tmp_path / "out")
    assert refused.exit_code == 2
    assert "left out where there is no --members" in refused.stderr
