"""Folders of results whose files are not as they were written: one message, exit code 2, no traceback."""

import json

import pytest
from typer.testing import CliRunner

import frahm
from frahm.analysis import load_analysis
from frahm.analysis.analysis import SCHEMA
from frahm.cli import app
from frahm.sweep import summary_of

CASE = frahm.load_case("jacket-pipe").to_dict()
RESULTS = {"notes": [], "interrupted": False}
GOOD = {"schema": SCHEMA, "frahm": "0.1.0", "case": CASE, "results": RESULTS, "checks": [], "unverified": []}
DESIGN = {"family": "sink", "verdict": "A verdict.", "comparison": []}
ROW = {"name": "sink", "worst_pipe_peak": None, "verified": False}


@pytest.fixture
def shown(tmp_path):
    def run(summary, name="summary.json"):
        text = summary if isinstance(summary, str) else json.dumps(summary)
        (tmp_path / name).write_text(text, encoding="utf-8")
        result = CliRunner().invoke(app, ["show", str(tmp_path)])
        assert result.exception is None or isinstance(result.exception, SystemExit), repr(result.exception)
        return result

    return run


@pytest.fixture
def arrays(tmp_path):
    import xarray as xr

    xr.Dataset(attrs={"sections": ""}).to_netcdf(tmp_path / "results.nc", engine="h5netcdf")


@pytest.mark.parametrize(
    "summary",
    [
        "", "[" * 100_000, "1" * 5000, "null", "[]", {}, GOOD | {"schema": None},
        GOOD | {"results": None}, GOOD | {"results": []}, GOOD | {"results": {}},
        GOOD | {"results": RESULTS | {"notes": None}}, GOOD | {"checks": None}, GOOD | {"checks": [None]},
        GOOD | {"checks": [{"name": 1}]}, GOOD | {"unverified": None}, GOOD | {"case": None}, GOOD | {"case": {"a": 1}},
    ],
)  # fmt: skip
@pytest.mark.usefixtures("arrays")
def test_a_summary_of_any_other_kind_is_refused(shown, tmp_path, summary):
    result = shown(summary)
    assert (result.exit_code, result.stdout) == (2, "")
    with pytest.raises(frahm.ParameterError):
        load_analysis(tmp_path)


@pytest.mark.parametrize(
    "results", [None, {}, {"design": None}, {"design": {}}, {"design": DESIGN | {"comparison": [None]}}]
)
def test_a_summary_of_a_design_of_any_other_kind_is_refused(shown, results):
    result = shown(GOOD | {"schema": "frahm-design-1", "results": results})
    assert (result.exit_code, result.stdout) == (2, "")


def test_what_a_design_could_not_bound_is_said(shown):
    result = shown(GOOD | {"schema": "frahm-design-1", "results": {"design": DESIGN | {"comparison": [ROW]}}})
    assert result.exit_code == 0
    assert "not bounded, unverified" in result.stdout


def test_what_a_file_says_cannot_command_the_terminal(shown):
    design = DESIGN | {"verdict": "All well.\u001b[31m \u202etxet"}
    result = shown(GOOD | {"schema": "frahm-design-1", "results": {"design": design}})
    assert r"All well.\x1b[31m \u202etxet" in result.stdout


@pytest.mark.parametrize("study", [None, 1, "null", "[]", "{", "[" * 100_000, '{"case": 1}'])
def test_a_store_whose_study_is_none_is_refused(shown, tmp_path, study):
    group = {"zarr_format": 3, "node_type": "group", "attributes": {"schema": "frahm-sweep-1", "study": study}}
    result = shown(group, "zarr.json")
    assert (result.exit_code, result.stdout) == (2, "")
    with pytest.raises(frahm.ParameterError):
        summary_of(tmp_path)


@pytest.mark.parametrize("attributes", [None, 1, [], {"schema": 1}])
def test_a_group_of_any_other_kind_is_no_store(shown, tmp_path, attributes):
    for group in ({"zarr_format": 3, "attributes": attributes}, "[" * 100_000):
        shown(group, "zarr.json")
        with pytest.raises(frahm.ParameterError):
            summary_of(tmp_path)


@pytest.mark.parametrize("command", ["show", "report"])
def test_a_misspelt_folder_is_told_its_neighbour(tmp_path, command):
    (tmp_path / "brace-b12").mkdir()
    (tmp_path / "brace-b11.txt").write_text("no folder")
    result = CliRunner().invoke(app, [command, str(tmp_path / "brace-b1")])
    assert result.exit_code == 2
    assert f"Did you mean '{tmp_path / 'brace-b12'}'?" in result.stderr
    assert "Did you mean" not in CliRunner().invoke(app, [command, str(tmp_path / "zzz")]).stderr


@pytest.mark.parametrize("name", ["bracee.yaml", "brace.yml", "brace"])
def test_a_misspelt_case_is_told_its_neighbour(tmp_path, name):
    frahm.load_case("jacket-pipe").to_yaml(tmp_path / "brace.yaml")
    result = CliRunner().invoke(app, ["run", str(tmp_path / name)])
    assert result.exit_code == 2
    assert f"Did you mean '{tmp_path / 'brace.yaml'}'?" in result.stderr
