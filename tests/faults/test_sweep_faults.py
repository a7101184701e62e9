"""Bad studies, foreign stores, schedulers that are not there: one message, exit code 2, nothing touched."""

import re

import pytest
from typer.testing import CliRunner

import frahm
from frahm.cli import app
from frahm.files import write_text
from frahm.sweep import summary_of

GOOD = """\
name: good
case: jacket-pipe
axes:
  kappa: {from: 50, to: 400, count: 3, spacing: log}
  xi2: [0.01, 0.02]
quantities:
  slow_flow:
    detuning: 0.02
seed: 1
"""
CASE = """\
pipe:
  {mass: heavy, frequency: 1, damping_ratio: 0.01, diameter: 1}
wind: {speed: 1, lift_coefficient: 1}
"""


def run(*arguments):
    return CliRunner().invoke(app, [*map(str, arguments)])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(*arguments):
    """The one message of a command that refuses its input."""
    result = run(*arguments)
    assert (result.exit_code, result.stdout) == (2, ""), result.output
    assert result.stderr.startswith("frahm: ")
    assert result.stderr.count("\n") == 1
    return result.stderr.removeprefix("frahm: ").rstrip("\n")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("kappa: {", "kapa: {", r"bad.yaml:4: axes.kapa: .*no such field here, only .*Did you mean 'kappa'"),
        ("from: 50", "form: 50", r"bad.yaml:4: axes.kappa.form: given 50; .*Did you mean 'from'"),
        ("from: 50", "from: -50", r"bad.yaml:4: axes.kappa.from: given -50; .*> 0"),
        ("from: 50", "from: 50 kg", r"axes.kappa.from: given '50 kg'; .*'kg' does not measure"),
        ("from: 50, ", "", r"bad.yaml:4: axes.kappa: .*a span that says from"),
        ("to: 400", "to: 50", r"axes.kappa.to: given 50; allowed: another value"),
        ("count: 3", "count: 1", r"axes.kappa.count: given 1; allowed: a whole number >= 2"),
        ("count: 3", "count: 3.5", r"axes.kappa.count: given 3.5; allowed: a whole number"),
        ("spacing: log", "spacing: cubic", r"axes.kappa.spacing: given 'cubic'; allowed: one of linear, log"),
        ("[0.01, 0.02]", "{from: 0, to: 0.1, count: 3, spacing: log}", r"axes.xi2.from: given 0; .*above zero"),
        ("[0.01, 0.02]", "[]", r"bad.yaml:5: axes.xi2: given \[\]; allowed: a list"),
        ("[0.01, 0.02]", "0.01", r"axes.xi2: given 0.01; allowed: a list"),
        ("[0.01, 0.02]", "[0.01, -1]", r"axes.xi2\[1\]: given -1; .*>= 0"),
        ("[0.01, 0.02]", "[0.01, 1e-2]", r"axes.xi2\[1\]: given 0.01; allowed: a value the axis does not have"),
        ("[0.01, 0.02]", "[0.01, .nan]", r"axes.xi2\[1\]: given nan; allowed: a finite number"),
        ("count: 3", "count: 90000", None),
        ("slow_flow:", "slowflow:", r"bad.yaml:7: quantities.slowflow: .*Did you mean 'slow_flow'"),
        ("detuning: 0.02", "detunning: 0.02", r"bad.yaml:8: quantities.slow_flow.detunning: .*Did you mean 'detuning'"),
        (
            "detuning: 0.02",
            "detuning: windwo",
            r"quantities.slow_flow.detuning: given 'windwo'; .*Did you mean 'window'",
        ),
        ("detuning: 0.02", "detuning: [0.1, -0.1]", r"quantities.slow_flow.detuning: .*lo < hi"),
        ("detuning: 0.02", "detuning: [-9, 1]", r"bad.yaml:3: axes: .*The first point says: detuning\[0\]: given -9"),
        ("seed: 1", "seed: -1", r"bad.yaml:9: seed: given -1"),
        ("seed: 1", "sed: 1", r"bad.yaml:9: sed: .*Did you mean 'seed'"),
        (
            "case: jacket-pipe",
            "case: jacket-pip",
            r"bad.yaml:2: case: given 'jacket-pip'; .*Did you mean 'jacket-pipe'",
        ),
        ("case: jacket-pipe", "case: gone.yaml", r"bad.yaml:2: case: given 'gone.yaml'; .*There is no such file"),
        ("case: jacket-pipe", "case: 7", r"bad.yaml:2: case: given 7"),
        ("case: jacket-pipe", "", r"bad.yaml:1: case: given nothing"),
        ("case: jacket-pipe", "case: two-sinks", r"axes: .*The first point says: .*slow"),
        ("seed: 1", "absorber: left", r"axes: .*The first point says: name: given 'left'; allowed: one of sink"),
        (GOOD, "[1, 2]", r"bad.yaml: study: given \[1, 2\]; allowed: a mapping with the sections case, axes"),
        (GOOD, "", r"bad.yaml: study: given 'an empty file'"),
        (GOOD, "axes: [", r"bad.yaml:\d+: study: given 'bad.yaml'; allowed: a study file. Not valid YAML"),
    ],
)
def test_a_bad_study_is_refused_with_line_and_field(folder, old, new, says):
    assert old in GOOD
    (folder / "bad.yaml").write_text(GOOD.replace(old, new))
    if says is None:
        says = r"bad.yaml:3: axes: given '8100000000 points'; allowed: at most 5000000"
        (folder / "bad.yaml").write_text(
            GOOD.replace("[0.01, 0.02]", "{from: 1, to: 2, count: 90000}").replace(old, new)
        )
    message = refused("sweep", "bad.yaml", "--store", "s")
    assert re.search(says, message), message
    assert [file.name for file in folder.iterdir()] == ["bad.yaml"]


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ({"axes": {}}, r"axes: given \{\}; allowed: at least one of pipe_frequency"),
        ({"axes": None}, r"axes: given \{\}; allowed: at least one"),
        ({"quantities": {}}, r"quantities: given \{\}; allowed: at least one of slow_flow"),
        ({"axes": {"detuning": [0.1]}, "quantities": {"response": {"detuning": 0.1}}},
         r"quantities.response.detuning: given 0.1; allowed: nothing, because the detuning is an axis"),
        ({"quantities": {"fatigue": {}}}, r"quantities.fatigue: .*the case has no section fatigue"),
        ({"case": "jacket-pipe-elastic", "axes": {"force": [1.0]}, "quantities": {"fatigue": None}},
         r"quantities.fatigue: .*does not depend on the axis force"),
        ({"case": "jacket-pipe-elastic", "axes": {"pipe_frequency": [5.0]}}, r"The first point says: pipe.frequency: "),
        ({"case": {"pipe": {"mass": -1}}}, r"case.pipe.mass: given -1"),
        ({"quantities": {"attractors": {"min_basin": 2}}}, r"quantities.attractors.min_basin: given 2; .*<= 1"),
        ({"name": ""}, r"name: given ''"),
    ],
)  # fmt: skip
def test_a_bad_dictionary_is_refused(data, says):
    good = {"case": "jacket-pipe", "axes": {"kappa": [100]}, "quantities": {"response": {}}}
    with pytest.raises(frahm.ParameterError, match=says):
        frahm.load_study({**good, **data})


def test_a_mistake_in_the_file_of_the_case_is_shown_there(folder):
    (folder / "bad.yaml").write_text(GOOD.replace("jacket-pipe", "pipe.yaml"))
    (folder / "pipe.yaml").write_text(CASE)
    message = refused("sweep", "bad.yaml", "--store", "s")
    assert message.startswith("bad.yaml:2: case: given 'pipe.yaml'; allowed: a case without mistakes. ")
    assert "pipe.yaml:2: pipe.mass: given 'heavy'" in message


@pytest.mark.parametrize("source", [7, b"study.yaml", "missing.yaml", "folder", "study.txt"])
def test_what_is_no_study_is_refused(folder, source):
    (folder / "folder").mkdir()
    (folder / "study.txt").write_text(GOOD)
    with pytest.raises(frahm.ParameterError, match="study: given"):
        frahm.load_study(source)


@pytest.fixture
def finished(folder):
    write_text(folder / "good.yaml", GOOD)
    assert run("sweep", "good.yaml", "--store", "s").exit_code == 0
    return folder


def contents(folder):
    return {str(file): file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}


def test_a_finished_store_is_never_overwritten_unasked(finished):
    before = contents(finished)
    assert "It holds this study; go on with --resume" in refused("sweep", "good.yaml", "--store", "s")
    assert contents(finished) == before
    assert run("sweep", "good.yaml", "--store", "s", "--resume").exit_code == 0
    assert contents(finished) == before


def test_the_store_of_another_study_needs_force(finished):
    write_text(finished / "other.yaml", GOOD.replace("0.02]", "0.03]"))
    before = contents(finished)
    for more in ((), ("--resume",)):
        message = refused("sweep", "other.yaml", "--store", "s", *more)
        assert "It holds another study, 'good'" in message
        assert "--force" in message
    assert contents(finished) == before
    assert run("sweep", "other.yaml", "--store", "s", "--resume", "--force").exit_code == 0
    assert frahm.sweep.stored_study("s") == frahm.load_study("other.yaml")
    assert sorted(file.name for file in finished.iterdir()) == ["good.yaml", "other.yaml", "s"]


def test_the_store_of_another_version_is_not_gone_on_with(folder, monkeypatch):
    write_text(folder / "good.yaml", GOOD)
    with monkeypatch.context() as older:
        for module in ("layout", "sweeping", "batch"):
            older.setattr(f"frahm.sweep.{module}.__version__", "0.0.1")
        assert run("sweep", "good.yaml", "--store", "s").exit_code == 0
    assert "It holds a sweep by frahm 0.0.1" in refused("sweep", "good.yaml", "--store", "s", "--resume")


def test_a_folder_of_something_else_is_never_touched_even_by_force(folder):
    write_text(folder / "good.yaml", GOOD)
    (folder / "mine").mkdir()
    (folder / "mine" / "thesis.tex").write_text("all my work")
    (folder / "file").write_text("mine too")
    before = contents(folder)
    for more in ((), ("--force",), ("--resume", "--force")):
        assert "other files, which a sweep never touches" in refused("sweep", "good.yaml", "--store", "mine", *more)
        assert "It is a file" in refused("sweep", "good.yaml", "--store", "file", *more)
    assert contents(folder) == before


def test_a_damaged_store_is_named_and_made_whole_by_resumption(finished):
    before = contents(finished)
    for file in (finished / "s" / "status").rglob("*"):
        if file.is_file():
            file.write_bytes(b"{}")
    assert (
        "store: given 's'; allowed: a folder that `frahm sweep` wrote. It is damaged (status; 6 of 6 points)"
        in refused("show", "s")
    )
    result = run("sweep", "good.yaml", "--store", "s", "--resume")
    assert (result.exit_code, result.stderr) == (0, "frahm: 6 points were damaged and computed again.\n")
    assert contents(finished) == before


def test_a_store_somebody_writes_to_is_left_alone(finished):
    from pathlib import Path

    from frahm.sweep.lock import only_writer

    with only_writer(Path("s")):
        for how in ("--resume", "--force"):
            assert "Another sweep is writing to it" in refused("sweep", "good.yaml", "--store", "s", how)


def test_a_store_that_cannot_be_written_is_named(folder):
    write_text(folder / "good.yaml", GOOD)
    (folder / "file").write_text("")
    assert "file/s'; allowed: a folder that can be written" in refused("sweep", "good.yaml", "--store", "file/s")


def test_a_scheduler_that_is_not_there(folder, monkeypatch):
    monkeypatch.setattr("frahm.sweep.cluster._REACHED", 0.5)
    write_text(folder / "good.yaml", GOOD)
    for address in ("tcp://127.0.0.1:9", "nonsense", "127.0.0.1"):
        message = refused("sweep", "good.yaml", "--store", "s", "--scheduler", address)
        assert message.startswith(
            f"scheduler: given '{address}'; allowed: the address of a Dask scheduler that answers"
        )
    assert not (folder / "s").exists()


def test_a_scheduler_without_workers(folder, monkeypatch):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr("frahm.sweep.cluster._JOINED", 0.3)
    write_text(folder / "good.yaml", GOOD)
    with distributed.LocalCluster(n_workers=0, processes=False, dashboard_address=":0") as cluster:
        message = refused("sweep", "good.yaml", "--store", "s", "--scheduler", cluster.scheduler_address)
    assert "no worker has joined it within 0.3 s" in message


def test_processes_that_cannot_be(folder):
    write_text(folder / "good.yaml", GOOD)
    command = ("sweep", "good.yaml", "--store", "s", "--processes")
    assert refused(*command, 0).startswith("processes: given 0; allowed: a whole number >= 1")
    assert "nothing beside --scheduler" in refused(*command, 2, "--scheduler", "tcp://127.0.0.1:9")


def test_without_dask_the_extra_is_named(folder, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "distributed", None)
    write_text(folder / "good.yaml", GOOD)
    message = refused("sweep", "good.yaml", "--store", "s", "--scheduler", "tcp://127.0.0.1:8786")
    assert "pip install 'frahm[cluster]'" in message


def test_what_is_no_executor_is_refused(tmp_path):
    with pytest.raises(frahm.ParameterError, match="executor: given 4; allowed: a concurrent"):
        frahm.sweep({"case": "jacket-pipe", "axes": {"kappa": [1]}, "quantities": {"slow_flow": {}}},
                    store=tmp_path / "s", executor=4)  # fmt: skip


@pytest.mark.parametrize("error", [MemoryError("no room"), OSError("disk"), KeyboardInterrupt()])
@pytest.mark.parametrize("closed_form", [True, False])
def test_what_the_machine_lacks_is_no_failure_of_a_point(folder, monkeypatch, error, closed_form):
    write_text(folder / "good.yaml", GOOD if closed_form else GOOD.replace("slow_flow:", "response:"))
    study = frahm.load_study(folder / "good.yaml")

    def fail(*_, **__):
        raise error

    name = "_map" if closed_form else "periodic_responses"
    with monkeypatch.context() as short:
        short.setattr(f"frahm.sweep.quantities.{name}", fail)
        if isinstance(error, KeyboardInterrupt):
            with pytest.raises(KeyboardInterrupt):
                frahm.sweep(study, store=folder / "store")
        else:
            with pytest.warns(frahm.SweepWarning, match="points could not be computed"):
                frahm.sweep(study, store=folder / "store")
    assert summary_of(folder / "store").pending == 6
    frahm.sweep(study, store=folder / "store", resume=True)
    assert summary_of(folder / "store").pending == 0
