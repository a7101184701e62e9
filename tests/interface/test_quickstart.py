"""What the quickstart tells a newcomer to type, typed."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from frahm.cli import app

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "quickstart.md").read_text(encoding="utf-8")
LINES = [line for block in re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL) for line in block.splitlines()]
COMMANDS = [shlex.split(line)[1:] for line in LINES if line.startswith(".venv/bin/frahm")]


def test_every_make_target_exists():
    targets = re.findall(r"^(\w+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)
    named = [line.split()[1] for line in LINES if line.startswith("make")]
    assert named == ["run"]
    assert set(named) <= set(targets)


def test_the_page_leads_from_a_new_case_to_a_design():
    assert [command[0] for command in COMMANDS] == ["app", "new", "check", "run", "show", "design"]


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command[0])
def test_every_command_exists(command):
    assert CliRunner().invoke(app, [command[0], "--help"]).exit_code == 0


def test_the_path_of_a_newcomer(tmp_path):
    """As typed, up to the design, but for a case that takes less time: the pipe without absorbers."""

    def typed(*words):
        done = subprocess.run(
            [sys.executable, "-m", "frahm", *words], cwd=tmp_path, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    new, check, run, show = (next(c for c in COMMANDS if c[0] == name) for name in ("new", "check", "run", "show"))
    typed(*new)
    case = tmp_path / new[1]
    typed(*check)
    text = case.read_text(encoding="utf-8")
    changed, count = re.subn(r"absorbers:\n(?:  .*\n)+", "absorbers: []\n", text)
    assert count == 1
    case.write_text(changed.replace("762 mm", "0.75 m"), encoding="utf-8")
    typed(*run)
    out = tmp_path / show[1]
    for name in ("report.html", "summary.json", "results.nc", "figures"):
        assert (out / name).exists(), name
    assert "0.75" in (out / "report.html").read_text(encoding="utf-8")
    assert "pipe" in typed(*show)


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
