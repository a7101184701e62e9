import json
import subprocess
import sys
import time
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

import frahm
from frahm.cli import app
from frahm.cli.guarded import GuardedGroup

FRAHM = [sys.executable, "-m", "frahm"]


def run(*arguments):
    return CliRunner().invoke(app, list(arguments))


def test_check_shows_values_units_and_what_follows():
    result = run("check", "jacket-pipe")
    assert result.exit_code == 0
    for text in (
        "247 kg",
        "0.78 Hz = 4.90088 rad/s",
        "762 mm = 0.762 m",
        "90742.86 N/m^3",
        "0.7972 Hz",
        "0.0867 m",
        "kappa 367.38",
        "rho2 0.02",
    ):
        assert text in result.stdout
    assert "(default)" not in result.stdout
    assert result.stderr == ""


def test_check_shows_values_as_typed_with_si_beside_them(tmp_path):
    """A value typed in SI units stands there once, in the one spelling of its unit and of powers of ten."""
    file = tmp_path / "a.yaml"
    file.write_text(
        "document: {revision: B}\n"
        "pipe: {kind: tube, diameter: 24 inch, wall: 0.5  inch, length: 28.0 m, damping_ratio: 0.15 %,\n"
        "  supports: [{at: 0, kind: clamped}, {at: 28, kind: pinned}]}\n"
        "wind: {speed: 12 m/s, viscosity: 1.5e-05 m**2/s, lift_coefficient: en1991}\n"
        "climate: {duration: 30 day, weibull: {scale: 20 knot, shape: 2}}\n"
        "analysis: {detuning: [-0.05 Hz, 0.3]}\n"
    )
    shown = dict(line.split(maxsplit=1) for line in run("check", str(file)).stdout.splitlines()[1:] if line.strip())
    expected = {
        "pipe.diameter": "24 inch = 0.6096 m", "pipe.wall": "0.5 inch = 0.0127 m", "pipe.length": "28.0 m",
        "pipe.damping_ratio": "0.15 % = 0.0015", "pipe.youngs_modulus": "2.06e11 Pa   (default)",
        "wind.viscosity": "1.5e-05 m^2/s", "climate.duration": "30 day = 2.592e6 s",
        "climate.weibull.scale": "20 knot = 10.2889 m/s", "pipe.supports[0].at": "0 m",
        "analysis.detuning": "[-0.05 Hz, 0.3] = [-0.314159, 0.3] rad/s", "document.revision": "B",
        "document.project": "none   (default)",
    }  # fmt: skip
    assert {path: shown[path] for path in expected} == expected


def test_check_and_every_verb_say_what_is_implausible(tmp_path):
    """On the error stream where there is work to do, in the text of check; the exit code stays."""
    file = tmp_path / "a.yaml"
    file.write_text(frahm.load_case("jacket-pipe").with_pipe(damping_ratio=0.15).to_yaml())
    result = run("check", str(file))
    assert result.exit_code == 0
    note = "note: pipe.damping_ratio = 0.15: Welded members have 0.0015"
    assert f"  {note}" in result.stdout
    assert "The case is valid; see the notes above." in result.stdout
    assert result.stderr == ""
    assert "nothing about it is implausible" in run("check", "jacket-pipe").stdout
    study = tmp_path / "study.yaml"
    study.write_text("case: a.yaml\naxes: {xi2: [0.01]}\nquantities: {slow_flow: {detuning: 0.0}}\n")
    done = run("sweep", str(study), "--store", str(tmp_path / "store"))
    assert (done.exit_code, done.stderr.count(f"frahm: {note}")) == (0, 1)


@pytest.mark.parametrize("verb", ["run", "design", "app"])
def test_the_notes_come_before_the_work(tmp_path, monkeypatch, verb):
    case = frahm.load_case("jacket-pipe").with_pipe(damping_ratio=0.15)
    case.to_yaml(tmp_path / "a.yaml")

    def stopped(*_, **__):
        raise KeyboardInterrupt

    for name in ("frahm.analysis.analyse", "frahm.design.design_absorber", "frahm.web.server.page_server"):
        monkeypatch.setattr(name, stopped)
    out = [] if verb == "app" else ["--out", str(tmp_path / "out")]
    done = run(verb, str(tmp_path / "a.yaml"), *out)
    assert done.exit_code == 130
    assert "frahm: note: pipe.damping_ratio = 0.15: Welded members" in done.stderr
    assert done.stdout == ""


def test_check_marks_what_was_left_out(tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("wind = {speed = 1, lift_coefficient = 1}\n"
                    "pipe = {mass = 1, frequency = 1, damping_ratio = 0, diameter = 1}\n")  # fmt: skip
    lines = run("check", str(file)).stdout.splitlines()
    marked = {line.split()[0] for line in lines if line.endswith("(default)")}
    assert {"pipe.length", "wind.air_density", "wind.strouhal", "absorbers", "analysis.seed"} <= marked
    assert not {"pipe.mass", "wind.speed"} & marked


def test_new_writes_a_case_that_checks(tmp_path):
    file = tmp_path / "my-pipe.yaml"
    assert run("new", str(file)).exit_code == 0
    assert run("check", str(file)).exit_code == 0
    assert frahm.load_case(file).name == "my-pipe"
    assert "# natural frequency" in file.read_text()


@pytest.mark.parametrize("kind", ["mode", "tube", "table"])
def test_new_writes_a_case_of_each_kind_of_pipe_that_checks_clean(tmp_path, kind):
    file = tmp_path / "mine.yaml"
    assert run("new", str(file), "--kind", kind).exit_code == 0
    done = run("check", str(file))
    assert (done.exit_code, done.stderr) == (0, "")
    assert "nothing about it is implausible" in done.stdout


@pytest.mark.parametrize(
    ("more", "says"),
    [(["--kind", "tub"], "Did you mean 'tube'"), (["--kind", "tube", "--study"], "--kind: given 'tube'")],
)
def test_new_refuses_other_kinds(tmp_path, more, says):
    done = run("new", str(tmp_path / "a.yaml"), *more)
    assert done.exit_code == 2
    assert says in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_new_never_replaces_a_file_unasked(tmp_path):
    file = tmp_path / "a.yaml"
    file.write_text("mine")
    result = run("new", str(file))
    assert (result.exit_code, file.read_text()) == (2, "mine")
    assert "--force" in result.stderr
    assert run("new", str(file), "--force").exit_code == 0
    assert file.read_text() != "mine"


@pytest.mark.parametrize("name", ["a.toml", "a", "missing/a.yaml", "folder.yaml"])
def test_new_refuses_other_places(tmp_path, name):
    (tmp_path / "folder.yaml").mkdir()
    result = run("new", str(tmp_path / name), "--force")
    assert result.exit_code == 2
    assert name in result.stderr
    assert [entry.name for entry in tmp_path.iterdir()] == ["folder.yaml"]


def test_cases_and_schema():
    assert run("cases").stdout.split()[:3] == ["jacket-pipe", "Jacket", "pipe"]
    assert json.loads(run("schema").stdout)["required"] == ["pipe", "wind"]


def test_version():
    assert run("--version").stdout == f"frahm {frahm.__version__}\n"


@pytest.mark.parametrize(("arguments", "near"), [(["chek", "x"], "check"), (["new", "a.yaml", "--froce"], "--force")])
def test_a_typo_is_answered_with_the_nearest_name(arguments, near):
    result = run(*arguments)
    assert result.exit_code == 2
    assert near in result.stderr


def test_interruption_ends_in_130():
    interrupted = typer.Typer(cls=GuardedGroup)

    @interrupted.command()
    def work():
        raise KeyboardInterrupt

    @interrupted.command()
    def rest():
        pass

    result = CliRunner().invoke(interrupted, ["work"])
    assert result.exit_code == 130
    assert "interrupted" in result.stderr


def test_bad_input_in_a_real_process(tmp_path):
    done = subprocess.run([*FRAHM, "check", "jacket-pip"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert "Did you mean 'jacket-pipe'" in done.stderr
    assert list(Path(tmp_path).iterdir()) == []


def test_help_is_quick_and_imports_nothing_heavy():
    code = (
        "import sys; sys.argv[1:] = ['--help']\n"
        "from frahm.cli import main\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "heavy = {'numpy', 'scipy', 'numba', 'pydantic', 'pint', 'xarray', 'matplotlib', 'sympy'} & set(sys.modules)\n"
        "assert not heavy, heavy"
    )
    start = time.perf_counter()
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "check" in done.stdout
    assert time.perf_counter() - start < 3.0  # on an idle machine 0.2 s; the list above is what keeps it so


def test_a_closed_pipe_is_no_traceback():
    done = subprocess.run(
        f"'{sys.executable}' -m frahm schema | head -1", shell=True, capture_output=True, text=True, check=False
    )
    assert done.stdout == "{\n"
    assert "Traceback" not in done.stderr
