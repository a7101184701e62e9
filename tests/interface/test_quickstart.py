"""What the quickstart says; the path it leads along is walked in page/test_newcomer.py."""

import re
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

import frahm
from frahm.cli import app

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "quickstart.md").read_text(encoding="utf-8")


def test_the_fields_of_the_page_are_those_of_a_case(tmp_path):
    """What it says to put in goes into the file that `frahm new` writes."""
    case = tmp_path / "my-pipe.yaml"
    assert CliRunner().invoke(app, ["new", str(case)]).exit_code == 0
    (snippet,) = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
    text = case.read_text(encoding="utf-8")
    for line in snippet.splitlines()[1:]:
        text, count = re.subn(rf"^{line.partition(':')[0]}:.*$", line, text, flags=re.MULTILINE)
        assert count == 1
    case.write_text(text, encoding="utf-8")
    assert CliRunner().invoke(app, ["check", str(case)]).exit_code == 0
    assert frahm.load_case(case).pipe.diameter == 0.762


def test_what_the_page_installs_without_make_there_is():
    (extras,) = re.findall(r'-e "\.\[([\w,]+)\]"', PAGE)
    there = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    assert set(extras.split(",")) <= set(there)


def test_a_typing_error_is_explained(tmp_path):
    case = tmp_path / "my-pipe.yaml"
    CliRunner().invoke(app, ["new", str(case)])
    case.write_text(case.read_text(encoding="utf-8").replace("diameter:", "diametre:"), encoding="utf-8")
    done = CliRunner().invoke(app, ["check", str(case)])
    assert done.exit_code == 2
    assert "diametre" in done.output
    assert "diameter" in done.output.replace("diametre", "")


def test_the_python_of_the_quickstart_works(capsys):
    (code,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(code, "quickstart.md", "exec"), {})
    said = capsys.readouterr().out
    assert said.count("saddle-node") == 4  # collocation (AUTO-07p): two of them of a detached branch
    assert float(re.search(r"from rest: ([\d.]+) m", said)[1]) == pytest.approx(0.0170, abs=2e-4)
