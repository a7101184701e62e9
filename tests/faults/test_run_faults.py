"""What can go wrong around `frahm run`: one message, the exit code for it, and nothing half written."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

import frahm
from frahm.analysis import analyse, load_analysis, save_analysis
from frahm.analysis import analysis as analysis_module
from frahm.cli import app
from frahm.report import render_report

CASE = frahm.load_case("jacket-pipe").without_absorbers().with_name("bare").with_analysis(periods=1000)


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    folder = tmp_path_factory.mktemp("stored")
    save_analysis(analyse(CASE), folder)
    return folder


@pytest.fixture
def case(tmp_path):
    CASE.to_yaml(tmp_path / "bare.yaml")
    return str(tmp_path / "bare.yaml")


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def refused(result, *texts):
    assert result.exit_code == 2
    assert result.stderr.startswith("frahm: ")
    assert "Traceback" not in result.stderr
    for text in texts:
        assert text in result.stderr
    return True


def test_out_is_a_file(case, tmp_path):
    (tmp_path / "o").write_text("mine")
    assert refused(run("run", case, "--out", tmp_path / "o", "--force"), "It is a file.")
    assert refused(run("run", case, "--out", tmp_path / "o" / "p"), str(tmp_path / "o" / "p"))
    assert (tmp_path / "o").read_text() == "mine"


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="needs a place that nobody can write to")
def test_out_cannot_be_written(case):
    assert refused(run("run", case, "--out", "/proc/frahm-out"), "--out")


def test_a_folder_with_other_files_is_left_alone(case, tmp_path):
    folder = tmp_path / "o"
    folder.mkdir()
    (folder / "thesis.txt").write_text("mine")
    assert refused(run("run", case, "--out", folder), "other files", "--force")
    assert [entry.name for entry in folder.iterdir()] == ["thesis.txt"]
    assert run("run", case, "--out", folder, "--force").exit_code == 0
    assert (folder / "thesis.txt").read_text() == "mine"


def test_a_commented_case_beside_the_results_stays_as_it_is(tmp_path):
    text = "# my comment\n" + CASE.to_yaml()
    (tmp_path / "case.yaml").write_text(text)
    assert run("run", tmp_path / "case.yaml", "--out", tmp_path).exit_code == 0
    assert (tmp_path / "case.yaml").read_text() == text
    assert (tmp_path / "summary.json").exists()


FULL = """
import resource, sys
from frahm.cli import main
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv.pop(1)),) * 2)
main()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="limits are set differently there")
def test_a_full_disk_is_one_message_and_the_summary_is_kept(stored, case, tmp_path):
    """What no more can be written to is a limit on the size of files: on a disk with no room left it is the same."""
    room = (stored / "summary.json").stat().st_size + 1000
    assert room < (stored / "results.nc").stat().st_size
    folder = tmp_path / "o"
    shutil.copytree(stored, folder)  # of an analysis before: its arrays must not stay beside another summary
    command = [sys.executable, "-c", FULL, str(room), "run", case, "--out", str(folder)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    assert "results.nc" in done.stderr
    assert "File too large" in done.stderr
    assert {entry.name for entry in folder.iterdir()} == {"case.yaml", "summary.json"}
    shown, whole = run("show", folder), run("show", stored)
    assert (shown.exit_code, shown.stdout) == (0, whole.stdout)
    assert shown.stderr.count("\n") == 1
    assert "The arrays are missing" in shown.stderr
    assert whole.stderr == ""
    assert refused(run("report", folder), "The arrays are missing", "results.nc", "no such file")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
@pytest.mark.parametrize("command", ["schema", "check jacket-pipe", "--help", "check jacket-pip"])
def test_output_to_a_full_device_is_one_message(command):
    with open("/dev/full", "w") as full:
        called = [sys.executable, "-m", "frahm", *command.split()]
        done = subprocess.run(called, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (2, 1), done.stderr
    assert done.stderr.startswith("frahm: ")
    assert ("No space left on device" in done.stderr) == (command != "check jacket-pip")


@pytest.mark.skipif(sys.platform == "win32", reason="streams are closed differently there")
@pytest.mark.parametrize("how", ["closed", "nobody reads", *(["full"] if Path("/dev/full").exists() else [])])
@pytest.mark.parametrize(
    ("command", "code"), [("check nope.yaml", 2), ("check --nope", 2), ("nope", 2), ("check jacket-pipe", 0)]
)
def test_an_error_stream_that_takes_nothing_leaves_the_exit_code_as_it_is(tmp_path, how, command, code):
    called = [sys.executable, "-m", "frahm", *command.split()]
    if how == "closed":
        done = subprocess.run(["sh", "-c", 'exec "$@" 2>&-', "sh", *called], stdout=subprocess.DEVNULL, check=False)
    elif how == "full":
        with open("/dev/full", "w") as full:
            done = subprocess.run(called, stdout=subprocess.DEVNULL, stderr=full, check=False)
    else:
        reader, writer = os.pipe()
        os.close(reader)
        done = subprocess.run(called, stdout=subprocess.DEVNULL, stderr=writer, check=False)
        os.close(writer)
    assert done.returncode == code


def test_a_missing_case_leaves_nothing_behind(tmp_path):
    assert refused(run("run", "jacket-pip", "--out", tmp_path / "o"), "Did you mean 'jacket-pipe'")
    assert not (tmp_path / "o").exists()


DAMAGED = ("missing", "empty folder", "no json", "other json", "damaged arrays")


@pytest.mark.parametrize(
    ("command", "damage"), [*(("show", one) for one in DAMAGED), *(("report", one) for one in (*DAMAGED, "no arrays"))]
)
def test_damaged_results(stored, tmp_path, command, damage):
    folder = tmp_path / "o"
    if damage != "missing":
        folder.mkdir()
    if damage not in ("missing", "empty folder"):
        text = (stored / "summary.json").read_text()
        other = {"no json": text[:500], "other json": "[1]"}
        (folder / "summary.json").write_text(other.get(damage, text))
    if damage == "damaged arrays":
        (folder / "results.nc").write_bytes((stored / "results.nc").read_bytes()[:5000])
    assert refused(run(command, folder), str(folder), "results.nc" if "arrays" in damage else "frahm run")


def test_text_of_the_case_cannot_become_markup(stored):
    bad = '</script><script>alert("x")</script><img src=x onerror=alert(1)>'
    named = CASE.with_name("a <b> & c", bad)
    page = render_report(analyse(named.with_analysis(periods=50)), {})
    assert "<script>alert" not in page
    assert "<img src=x" not in page
    assert "a &lt;b&gt; &amp; c" in page


def test_an_interruption_keeps_what_was_finished_and_ends_in_130(case, tmp_path, monkeypatch):
    def stop(work):
        raise KeyboardInterrupt

    steps = (*analysis_module.STEPS[:2], analysis_module.Step("stopped", stop))
    monkeypatch.setattr(analysis_module, "STEPS", steps)
    result = run("run", case, "--out", tmp_path / "o")
    assert result.exit_code == 130
    assert "Interrupted" in result.stderr
    kept = load_analysis(tmp_path / "o")
    assert kept.interrupted
    assert kept.results["response"]["harmonic-balance"]["pipe_peak_max"] == pytest.approx(0.0867, abs=1e-4)
    assert run("report", tmp_path / "o").exit_code == 0
    assert "interrupted" in (tmp_path / "o" / "report.html").read_text()


@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent differently there")
def test_a_real_interruption_of_a_long_run(tmp_path):
    CASE.with_analysis(periods=1_000_000).to_yaml(tmp_path / "a.yaml")
    process = subprocess.Popen(
        [sys.executable, "-m", "frahm", "run", "a.yaml"], cwd=tmp_path, stderr=subprocess.PIPE, text=True
    )
    deadline = time.monotonic() + 60
    while not (tmp_path / "out" / "bare" / "case.yaml").exists():
        assert time.monotonic() < deadline
        time.sleep(0.05)
    time.sleep(2.5)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in said
    left = {entry.name for entry in (tmp_path / "out" / "bare").iterdir()}
    assert not [name for name in left if name.startswith(".")]
    if "summary.json" in left:
        assert json.loads((tmp_path / "out" / "bare" / "summary.json").read_text())["unverified"]
