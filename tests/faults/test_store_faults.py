"""What can happen to the store of a sweep: several writers, damage on disk, a writer that is killed."""

import errno
import json
import os
import shutil
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import frahm
from frahm.cli import app
from frahm.sweep import layout, load_study, lock, opened, store, summary_of

AXES = {"kappa": [50, 100, 200, 400], "detuning": [-6.0, 0.0, 0.1]}
STUDY = load_study({"name": "one", "case": "jacket-pipe", "axes": AXES, "quantities": {"slow_flow": {}}})
OTHER = load_study({"name": "two", "case": "jacket-pipe", "axes": {"kappa": [70], "detuning": [0.05]},
                    "quantities": {"slow_flow": {}}})  # fmt: skip
POSIX = pytest.mark.skipif(sys.platform == "win32", reason="signals are sent differently there")


def files_of(path):
    return {str(file.relative_to(path)): file.read_bytes() for file in sorted(path.rglob("*")) if file.is_file()}


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A finished store of several chunks, points of which failed."""
    before, layout._CHUNK = layout._CHUNK, 6
    path = tmp_path_factory.mktemp("whole") / "s"
    with pytest.warns(frahm.SweepWarning, match="4 failed"):
        frahm.sweep(STUDY, store=path)
    yield path
    layout._CHUNK = before


@pytest.fixture
def damaged(whole, tmp_path):
    """A copy, to be damaged."""
    return Path(shutil.copytree(whole, tmp_path / "s"))


def test_of_two_sweeps_started_together_one_is_refused(tmp_path):
    """Whatever the timing, the store is that of one study, and the other is told."""
    references = []
    for study in (STUDY, OTHER):
        with pytest.warns(frahm.SweepWarning) if study is STUDY else threading.Lock():
            frahm.sweep(study, store=tmp_path / study.name)
        references.append(files_of(tmp_path / study.name))
    for trial in range(8):
        path, barrier, refused = tmp_path / f"store-{trial}", threading.Barrier(2), []

        def start(study, path=path, barrier=barrier, refused=refused):
            barrier.wait()
            try:
                frahm.sweep(study, store=path)
            except frahm.ParameterError as error:
                refused.append(str(error))

        with warnings.catch_warnings():
            warnings.simplefilter("ignore", frahm.SweepWarning)
            threads = [threading.Thread(target=start, args=(study,)) for study in (STUDY, OTHER)]
            [thread.start() for thread in threads]
            [thread.join() for thread in threads]
        (sentence,) = refused
        assert "Another sweep is writing to it" in sentence or "It holds another study" in sentence
        assert files_of(path) in references
        assert sorted(entry.name for entry in tmp_path.iterdir() if "-" in entry.name) == [
            f"store-{number}" for number in range(trial + 1)
        ]


RACE = """
import sys, time, warnings
from pathlib import Path
import frahm, xarray, zarr
from frahm.sweep import load_study
study = load_study({"name": "there", "case": "jacket-pipe", "axes": {"kappa": [70]},
                    "quantities": {"slow_flow": {"detuning": 0.05}}})
Path("ready").touch()
while not Path("go").exists():
    time.sleep(0.0005)
try:
    frahm.sweep(study, store="s")
except frahm.ParameterError as error:
    sys.exit(str(error))
"""


def test_of_two_processes_started_together_one_is_refused(tmp_path):
    said = []
    there = subprocess.Popen([sys.executable, "-c", RACE], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while not (tmp_path / "ready").exists():
        assert time.monotonic() < deadline
        time.sleep(0.01)
    (tmp_path / "go").touch()
    try:
        frahm.sweep(OTHER, store=tmp_path / "s")
    except frahm.ParameterError as error:
        said.append(str(error))
    said.append(there.communicate(timeout=60)[1])
    assert (there.returncode != 0) + len(said) == 2, said
    assert "Another sweep is writing to it" in "".join(said) or "It holds another study" in "".join(said)
    data = xr.open_zarr(tmp_path / "s").load()
    assert json.loads(data.attrs["study"])["name"] == ("two" if there.returncode else "there")
    assert ("detuning" in data.dims) == bool(there.returncode)
    assert np.all(data.status == 1)


def test_a_store_under_another_name_has_the_same_writer(damaged):
    link = damaged.with_name("link")
    link.symlink_to(damaged)
    with lock.only_writer(damaged), pytest.raises(frahm.ParameterError, match="Another sweep is writing to it"):
        frahm.sweep(STUDY, store=link, resume=True)
    frahm.sweep(OTHER, store=link, force=True)
    assert link.is_symlink()
    assert store.stored_study(damaged) == OTHER


@pytest.mark.parametrize("how", ["system", "file"])
def test_a_lock_holds_and_ends(tmp_path, monkeypatch, how):
    if how == "file":  # a file system that knows no locks

        def without(handle):
            raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

        monkeypatch.setattr(lock, "_locked", without)
    for _ in range(2):
        with lock.only_writer(tmp_path / "s"):
            with (
                pytest.raises(frahm.ParameterError, match="Another sweep is writing to it"),
                lock.only_writer(tmp_path / "s"),
            ):
                pass
            with lock.only_writer(tmp_path / "t"):
                pass
        assert not list(tmp_path.iterdir())


def test_a_lock_that_a_killed_writer_left_can_be_removed(tmp_path, monkeypatch):
    def without(handle):
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr(lock, "_locked", without)
    left = lock.beside(tmp_path / "s", "writer")
    left.write_text("")
    with pytest.raises(frahm.ParameterError) as caught, lock.only_writer(tmp_path / "s"):
        pass
    assert f"remove {left}" in str(caught.value)


def test_a_lock_removed_by_its_last_holder_is_taken_anew(tmp_path, monkeypatch):
    """One that opened the file just before it was removed holds the lock of a file that is not there any more."""
    taken, calls = lock._locked, []

    def late(handle):
        if not calls:
            lock.beside(tmp_path / "s", "lock").unlink()
        calls.append(handle)
        return taken(handle)

    monkeypatch.setattr(lock, "_locked", late)
    with lock.only_writer(tmp_path / "s"), pytest.raises(frahm.ParameterError), lock.only_writer(tmp_path / "s"):
        pass
    assert len(calls) == 3


def flipped(file, at):
    content = bytearray(file.read_bytes())
    content[at % len(content)] ^= 1 << at % 8
    file.write_bytes(content)


def chunks(path):
    return [file for file in sorted(path.rglob("*")) if file.is_file() and file.name != "zarr.json"]


def test_every_chunk_there_is_lies_on_disk(whole):
    """Else one that is lost could not be told from one that holds nothing."""
    names = {str(file.relative_to(whole)) for file in chunks(whole)}
    assert {"slow_flow_pipe_peak/c/0/0", "status/c/1/0", "reason/c/1/0", "kappa/c/0", "detuning/c/0"} <= names
    data = xr.open_zarr(whole)
    counts = {name: int(np.prod([-(-n // c) for n, c in zip(v.shape, v.encoding["chunks"], strict=True)]))
              for name, v in data.variables.items()}  # fmt: skip
    assert len(names) == sum(counts.values())


def test_every_single_flipped_bit_is_found_and_mended(whole, damaged):
    rng = np.random.default_rng(5)
    files = chunks(damaged)
    for file in files:
        before, at = file.read_bytes(), int(rng.integers(1000))
        flipped(file, at)
        with pytest.raises(ValueError, match=r"(?i)checksum"):
            xr.open_zarr(damaged).load()
        with pytest.raises(frahm.ParameterError, match=rf"It is damaged \({file.relative_to(damaged).parts[0]}\b"):
            summary_of(damaged)
        file.write_bytes(before)
    for file in files:
        flipped(file, int(rng.integers(1000)))
    with pytest.warns(frahm.SweepWarning) as caught:
        frahm.sweep(STUDY, store=damaged, resume=True)
    assert str(caught[0].message) == "12 points were damaged and computed again."
    assert files_of(damaged) == files_of(whole)


@pytest.mark.parametrize("lost", ["chunk", "array", "axis", "status", "reason", "empty"])
def test_what_is_lost_is_found_and_mended(whole, damaged, lost):
    before = files_of(whole)
    if lost == "empty":
        (damaged / "slow_flow_pipe_peak" / "c" / "1" / "0").write_bytes(b"")
    elif lost == "chunk":
        (damaged / "slow_flow_pipe_peak" / "c" / "1" / "0").unlink()
    else:
        shutil.rmtree(damaged / {"array": "slow_flow_pipe_amplitude", "axis": "kappa"}.get(lost, lost))
    if lost != "status":  # without it no point says that it is finished
        with pytest.raises(frahm.ParameterError, match="It is damaged"):
            summary_of(damaged)
        with pytest.raises(ValueError, match="It is damaged" if lost != "empty" else "checksum"):
            opened(damaged).load()
    with pytest.warns(frahm.SweepWarning) as caught:
        frahm.sweep(STUDY, store=damaged, resume=True)
    said = " ".join(str(warning.message) for warning in caught)
    assert ("damaged and computed again" in said) == (lost not in ("axis", "status"))
    assert files_of(damaged) == before


def test_only_what_is_damaged_is_computed_again(whole, damaged, monkeypatch):
    from frahm.sweep import sweeping

    computed = []
    evaluated = sweeping.evaluated

    def told(text, version, indices, *more):
        computed.extend(indices)
        return evaluated(text, version, indices, *more)

    monkeypatch.setattr(sweeping, "evaluated", told)
    flipped(damaged / "slow_flow_pipe_peak" / "c" / "1" / "0", 3)
    with pytest.warns(frahm.SweepWarning, match="6 points were damaged and computed again"):
        frahm.sweep(STUDY, store=damaged, resume=True)
    assert sorted(computed) == [6, 7, 8, 9, 10, 11]


def test_a_damaged_point_is_never_finished_on_disk_while_its_values_are_blank(whole, damaged, monkeypatch):
    """Whatever stops the one that mends: the status goes first, then the values."""
    flipped(damaged / "slow_flow_pipe_peak" / "c" / "1" / "0", 3)

    def stopped(self):
        raise KeyboardInterrupt

    monkeypatch.setattr(store.Store, "flush", stopped)
    with pytest.raises(KeyboardInterrupt):
        frahm.sweep(STUDY, store=damaged, resume=True)
    assert xr.open_zarr(damaged).status.values[2:].ravel().tolist() == [0] * 6


def test_every_changed_character_of_the_description_is_found(whole, damaged):
    head = damaged / "zarr.json"
    text = head.read_text(encoding="utf-8")
    attributes = json.loads(text)["attributes"]
    for old, new in (("50.0", "51.0"), ('"units": "m"', '"units": "g"'), ("failed", "filled"), ("jacket", "jackal")):
        changed = text.replace(old, new) if old in text else text.replace(f"{old}", new)
        assert changed != text, old
        head.write_text(changed, encoding="utf-8")
        for look in (lambda: summary_of(damaged), lambda: opened(damaged),
                     lambda: frahm.sweep(STUDY, store=damaged, resume=True)):  # fmt: skip
            with pytest.raises(frahm.ParameterError, match=r"zarr.json.* damaged"):
                look()
    head.write_text(text[: len(text) // 2], encoding="utf-8")
    with pytest.raises(frahm.ParameterError, match=r"zarr.json cannot be read"):
        frahm.sweep(STUDY, store=damaged, force=True)
    head.write_text(text.replace("50.0", "51.0"), encoding="utf-8")
    with pytest.warns(frahm.SweepWarning):
        frahm.sweep(STUDY, store=damaged, force=True)
    assert files_of(damaged) == files_of(whole)
    assert attributes["frahm_version"] == frahm.__version__


def test_the_description_of_an_array_is_checked_and_mended(whole, damaged):
    for name in ("status", "kappa"):
        file = damaged / name / "zarr.json"
        file.write_text(file.read_text().replace("null", "0").replace("bytes", "bites"))
    with pytest.raises(frahm.ParameterError, match=r"It is damaged \(.*kappa"):
        summary_of(damaged)
    with pytest.warns(frahm.SweepWarning, match="failed"):
        frahm.sweep(STUDY, store=damaged, resume=True)
    assert files_of(damaged) == files_of(whole)


def test_show_and_resume_of_a_damaged_store_on_the_command_line(damaged):
    shutil.rmtree(damaged / "slow_flow_pipe_peak")
    result = CliRunner().invoke(app, ["show", str(damaged)])
    assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1)
    assert "It is damaged (slow_flow_pipe_peak; 12 of 12 points)" in result.stderr
    assert "--resume" in result.stderr


def test_a_store_of_an_older_form_is_named(damaged):
    head = damaged / "zarr.json"
    head.write_text(head.read_text().replace(layout.SCHEMA, "frahm-sweep-1"))
    for look in (lambda: summary_of(damaged), lambda: opened(damaged),
                 lambda: frahm.sweep(STUDY, store=damaged, resume=True)):  # fmt: skip
        with pytest.raises(frahm.ParameterError, match="frahm-sweep-1"):
            look()


def test_a_reader_beside_the_writer_never_sees_a_finished_point_without_values(whole, damaged, monkeypatch):
    """The state is read before the values, as it is written after them."""
    read = []
    first = store._read_chunks

    def told(place, array, *more):
        read.append(array.name.strip("/"))
        return first(place, array, *more)

    monkeypatch.setattr(store, "_read_chunks", told)
    summary_of(damaged)
    assert read[0] == "status"
    assert len(read) == len(set(read))


def test_a_disk_that_fails_is_not_the_failure_of_a_point(tmp_path, monkeypatch):
    """Such a point is left for another time: as its own failure it would be skipped by `resume`."""
    from frahm.sweep import quantities

    whole = quantities.slow_flow_map

    def breaks(*arguments, **more):
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(quantities, "slow_flow_map", breaks)
    with pytest.warns(frahm.SweepWarning, match="1 points could not be computed: OSError: .*Input/output error"):
        data = frahm.sweep(OTHER, store=tmp_path / "s")
    assert data.status.values.ravel().tolist() == [0]
    monkeypatch.setattr(quantities, "slow_flow_map", whole)
    assert frahm.sweep(OTHER, store=tmp_path / "s", resume=True).status.values.ravel().tolist() == [1]


@pytest.mark.parametrize("when", ["laid out", "gave way"])
def test_what_a_killed_creator_left_is_removed_and_nothing_is_lost(whole, damaged, monkeypatch, when):
    """Killed while it laid the new store out, or between the two renamings that replace an old one."""
    lay, move = store.lay_out, store.put_in_place

    def killed(function, *given):
        function(*given)
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(shutil, "rmtree", lambda *given, **more: None)  # one that is killed does not clean up
        if when == "laid out":
            patch.setattr(store, "lay_out", lambda *given: killed(lay, *given))
        else:
            patch.setattr(store, "put_in_place", lambda *given: killed(move, *given))
        with pytest.raises(KeyboardInterrupt):
            frahm.sweep(OTHER, store=damaged, force=True)
    assert damaged.exists() == (when == "laid out")
    assert len(list(damaged.parent.iterdir())) == 1 + damaged.exists()
    with pytest.raises(frahm.ParameterError, match="go on with --resume"):
        frahm.sweep(STUDY, store=damaged)
    assert [entry.name for entry in damaged.parent.iterdir()] == ["s"]
    assert files_of(damaged) == files_of(whole)


def test_an_interrupted_creator_leaves_nothing(tmp_path, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(store, "lay_out", interrupted)
    with pytest.raises(KeyboardInterrupt):
        frahm.sweep(STUDY, store=tmp_path / "s")
    assert not list(tmp_path.iterdir())
