"""`frahm reproduce`: one real run, and what happens when something is in the way."""

from __future__ import annotations

import csv
import json
import xml.etree.ElementTree as ElementTree

import matplotlib.image
import pytest
from typer.testing import CliRunner

from frahm.cli import app
from frahm.reproduction import reproducing
from frahm.reproduction.claims import judge
from frahm.reproduction.judging import Evidence

FIGURES = [f"fig{number:02d}" for number in range(3, 13)]
VERDICTS = {"reproduced", "misprint", "not-reproduced"}


def run(*arguments):
    return CliRunner().invoke(app, ["reproduce", *map(str, arguments)])


def test_ends_well_and_shows_the_verdicts_without_progress(reproduction):
    assert reproduction.exit_code == 0, reproduction.stderr
    assert reproduction.stderr == ""
    assert "15 reproduced, 1 misprint, 3 not-reproduced" in " ".join(reproduction.stdout.split())
    assert "\x1b" not in reproduction.stdout


def test_takes_about_a_minute_at_most(reproduction):
    assert reproduction.seconds < 120


def test_files_are_all_there_and_nothing_else(reproduction):
    found = {path.relative_to(reproduction.directory).as_posix() for path in reproduction.directory.rglob("*.*")}
    figures = {f"figures/{name}.{kind}" for name in FIGURES for kind in ("png", "svg")}
    assert found == figures | {"claims.json", "claims.csv", "claims.md", "equations.csv", "summary.json"}


@pytest.mark.parametrize("name", FIGURES)
def test_figure_opens_and_shows_something(reproduction, name):
    image = matplotlib.image.imread(reproduction.directory / "figures" / f"{name}.png")
    assert image.shape[0] >= 500
    assert image.shape[1] >= 800
    assert image[..., :3].std() > 0.05
    root = ElementTree.parse(reproduction.directory / "figures" / f"{name}.svg").getroot()
    assert root.tag.endswith("svg")


def test_claims_json_has_the_fields_of_the_contract(reproduction):
    rows = reproduction.claims
    assert [key for key in rows if key.isdigit()] == [str(number) for number in range(1, 20)]
    for row in rows.values():
        assert {"id", "claim", "printed", "computed", "verdict", "tolerance", "method", "explanation"} <= row.keys()
        assert row["verdict"] in VERDICTS
        assert row["printed"].keys() == row["computed"].keys() == row["tolerance"].keys()
        assert all(row[field] for field in ("claim", "printed", "method", "explanation"))


def test_claims_csv_has_the_same_verdicts(reproduction):
    with (reproduction.directory / "claims.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["id"]: row["verdict"] for row in csv.DictReader(file)}
    assert rows == {str(key): row["verdict"] for key, row in reproduction.claims.items()}


def test_equations_csv_has_every_term(reproduction):
    with (reproduction.directory / "equations.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert {row["equation"] for row in rows} >= {"18", "20", "A1", "A2"}
    assert any(row["verdict"].startswith("missing in print") for row in rows)


def test_summary_says_what_was_checked(reproduction):
    summary = json.loads((reproduction.directory / "summary.json").read_text(encoding="utf-8"))
    assert summary["complete"] is True
    assert summary["unverified"] == []
    assert {check["status"] for check in summary["checks"]} == VERDICTS


def test_markdown_has_a_section_for_every_claim(reproduction):
    text = (reproduction.directory / "claims.md").read_text(encoding="utf-8")
    assert all(f"\n### {number}. " in text for number in range(1, 20))


@pytest.fixture
def quick(monkeypatch):
    """Verdicts without computation and no figures: for tests of what is around them."""

    def as_printed(computed):
        for claim in reproducing.yang2022.CLAIMS:
            values = {value.name: value.value for value in claim.printed}
            yield judge(claim, Evidence("given", values, dict.fromkeys(claim.statements, True)))

    monkeypatch.setattr(reproducing, "judge_claims", as_printed)
    monkeypatch.setattr(reproducing, "figures", dict)
    return monkeypatch


def test_directory_of_something_else_is_left_alone(quick, tmp_path):
    (tmp_path / "summary.json").write_text('{"schema": "another"}', encoding="utf-8")
    result = run("--out", tmp_path)
    assert result.exit_code == 2
    assert "--force" in result.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["summary.json"]
    assert (tmp_path / "summary.json").read_text(encoding="utf-8") == '{"schema": "another"}'


def test_force_writes_beside_what_is_there(quick, tmp_path):
    (tmp_path / "notes.txt").write_text("mine", encoding="utf-8")
    assert run("--out", tmp_path, "--force").exit_code == 0
    assert (tmp_path / "notes.txt").read_text(encoding="utf-8") == "mine"
    assert (tmp_path / "claims.json").exists()


def test_earlier_reproduction_is_replaced(quick, tmp_path):
    out = tmp_path / "deep" / "down"
    assert run("--out", out).exit_code == 0
    (out / "claims.csv").unlink()
    assert run("--out", out).exit_code == 0
    assert (out / "claims.csv").exists()


def test_file_in_the_place_of_the_directory_is_bad_input(quick, tmp_path):
    file = tmp_path / "a"
    file.write_text("x", encoding="utf-8")
    for target in (file, file / "below"):
        result = run("--out", target)
        assert result.exit_code == 2
        assert "Traceback" not in result.output


def test_unverified_results_end_with_their_own_code(quick, tmp_path):
    quick.setattr(reproducing, "_draw", lambda out, computed, progress: computed.unverified.append("one motion"))
    result = run("--out", tmp_path)
    assert result.exit_code == 3
    assert "one motion" in result.stderr
    assert json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))["unverified"] == ["one motion"]


def test_interruption_keeps_what_was_finished(quick, tmp_path):
    def stop(out, computed, progress):
        raise KeyboardInterrupt

    quick.setattr(reproducing, "_draw", stop)
    assert run("--out", tmp_path).exit_code == 130
    assert (tmp_path / "claims.json").exists()
    assert json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))["complete"] is False
    assert run("--out", tmp_path).exit_code == 130  # the directory is known as a reproduction
