"""What is different on Windows, as far as it can be played here: files held open, locks, ports, names, processes."""

import errno
import os
import sys
import types
from pathlib import Path

import pytest

import frahm
from frahm import files
from frahm.cli.folder import default_folder
from frahm.errors import ParameterError
from frahm.sweep import local, lock
from frahm.sweep.lock import only_writer


@pytest.fixture
def windows(monkeypatch):
    """The modules that ask for the platform hear of Windows; nobody else does."""
    for module in (files, local, lock):
        monkeypatch.setattr(module, "sys", types.SimpleNamespace(platform="win32"))
    return monkeypatch


def _held(monkeypatch, times):
    """Let the first replacements be refused, as while a reader has the file open."""
    refused, replace = [], Path.replace

    def slowly(self, target):
        if len(refused) < times and Path(target).name != "zarr.json":  # of a store nobody knows yet
            refused.append(target)
            raise PermissionError(errno.EACCES, "The process cannot access the file")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", slowly)
    monkeypatch.setattr(files, "_PAUSES", (0.001,) * 5)
    return refused


def test_a_file_that_is_open_somewhere_is_replaced_a_moment_later(windows, tmp_path):
    target = tmp_path / "summary.json"
    files.write_text(target, "old")
    refused = _held(windows, 3)
    files.write_text(target, "new")
    assert len(refused) == 3
    assert target.read_text(encoding="utf-8") == "new"


def test_a_file_that_stays_open_is_named_and_nothing_is_left_beside_it(windows, tmp_path):
    target = tmp_path / "summary.json"
    files.write_text(target, "old")
    _held(windows, 1000)
    with pytest.raises(ParameterError, match="cannot access the file"):
        files.write_text(target, "new")
    assert [(path.name, path.read_text(encoding="utf-8")) for path in tmp_path.iterdir()] == [("summary.json", "old")]


def test_elsewhere_a_refusal_is_final_at_once(monkeypatch, tmp_path):
    refused = _held(monkeypatch, 1)
    with pytest.raises(ParameterError):
        files.write_text(tmp_path / "a.txt", "new")
    assert len(refused) == 1


def test_a_store_takes_the_place_of_one_that_is_read(windows, tmp_path):
    study = {"name": "s", "case": "jacket-pipe", "axes": {"kappa": [50, 60]},
             "quantities": {"slow_flow": {"detuning": 0.0}}}  # fmt: skip
    with monkeypatched_lock(windows):
        frahm.sweep(study, store=tmp_path / "store")
        refused = _held(windows, 4)
        found = frahm.sweep(study, store=tmp_path / "store", force=True)
    assert len(refused) == 4
    assert found.sizes["kappa"] == 2


def monkeypatched_lock(monkeypatch):
    """The locks of Windows, made of those of this system."""
    import fcntl

    def locking(handle, mode, count):
        assert (mode, count) == (7, 1)
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise PermissionError(errno.EACCES, "Permission denied") from None

    monkeypatch.setitem(sys.modules, "msvcrt", types.SimpleNamespace(locking=locking, LK_NBLCK=7))
    return monkeypatch.context()


def test_one_writer_by_the_locks_of_windows(windows, tmp_path):
    store = tmp_path / "store"
    with monkeypatched_lock(windows):
        refused = pytest.raises(ParameterError, match="Another sweep is writing to it")
        with only_writer(store), refused, only_writer(store):
            pass
        with only_writer(store):
            pass
    assert not list(tmp_path.iterdir())


def test_a_lock_that_somebody_is_removing_is_made_anew(windows, tmp_path):
    looked, stat = [], Path.stat

    def deleted(self, **more):
        if self.name.endswith(".lock") and not looked:
            looked.append(self)
            raise PermissionError(errno.EACCES, "Access is denied")
        return stat(self, **more)

    with monkeypatched_lock(windows):
        windows.setattr(Path, "stat", deleted)
        with only_writer(tmp_path / "store"):
            pass
    assert looked


@pytest.mark.parametrize("name", ["con", "NUL", "Aux", "com1", "lpt9.case"])
def test_a_case_named_like_a_device_gets_a_folder(name):
    folder = default_folder(frahm.load_case(frahm.load_case("jacket-pipe").to_dict() | {"name": name}))
    assert folder.name.split(".")[0].lower() not in ("con", "nul", "aux", "com1", "lpt9")
    assert folder.name.endswith(name)


def test_no_more_processes_than_windows_can_wait_for(windows):
    with pytest.raises(ParameterError, match=r"<= 61"), local.processes(62):
        pass


def test_the_port_of_another_program_is_not_shared(windows):
    pytest.importorskip("dash")
    from frahm.web import server

    asked = []

    class Probe:
        def __enter__(self):
            return self

        def __exit__(self, *_):
            return False

        def setsockopt(self, *option):
            asked.append(option)

        def bind(self, address):
            raise OSError(errno.EADDRINUSE, "in use")

    windows.setattr(server, "sys", types.SimpleNamespace(platform="win32"))
    windows.setattr(server.socket, "socket", lambda *_: Probe())
    with pytest.raises(ParameterError, match="in use"):
        server._free_port(8050)
    assert not asked


def test_the_workers_of_the_page_read_utf_8_whatever_the_console_has():
    pytest.importorskip("dash")
    import json
    import subprocess

    job = {"name": "nothing\N{GREEK SMALL LETTER SIGMA}", "case": {}, "arguments": {}}
    done = subprocess.run(
        [sys.executable, "-m", "frahm.web.worker"], input=json.dumps(job, ensure_ascii=False).encode() + b"\n",
        capture_output=True, timeout=60, check=False,
        env=os.environ | {"PYTHONIOENCODING": "cp1252", "PYTHONUTF8": "0"},
    )  # fmt: skip
    assert b"surrog" not in done.stderr
    assert done.returncode == 0
