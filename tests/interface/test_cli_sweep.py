"""frahm sweep as people use it: template, terminal, pipe, interruption, kill, resumption, a Dask scheduler."""

import os
import pty
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import frahm
from frahm.cli import app
from frahm.sweep import is_sweep

FRAHM = [sys.executable, "-m", "frahm"]
SMALL = """\
case: jacket-pipe
axes:
  kappa: {from: 60, to: 400, count: 4, spacing: log}
  xi2: [0.006, 0.02, 0.05]
quantities:
  response: {detuning: [-0.1, 0.1]}
"""
LONG = """\
name: long
case: jacket-pipe
axes:
  kappa: {from: 20, to: 900, count: 30, spacing: log}
  xi2: {from: 0.004, to: 0.06, count: 40}
quantities:
  slow_flow: {detuning: [-0.3, 0.3]}
"""
FAILING = """\
case: jacket-pipe
axes:
  detuning: [-6, 0, 0.1]
quantities:
  slow_flow: {}
"""


def alike(one, other):
    """Equal but for last digits: a process that compiled the kernels rounds otherwise than one that found them."""
    xr.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-9)
    assert one.attrs == other.attrs


def run(*arguments):
    return CliRunner().invoke(app, [*map(str, arguments)])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_template_runs_and_shows_what_it_found(folder):
    said = run("new", "first.yaml", "--study")
    assert (said.exit_code, said.stdout.split("then: ")[1]) == (0, "frahm sweep first.yaml --store first.zarr\n")
    began = time.process_time()
    result = run(*said.stdout.split("then: frahm ")[1].split())
    assert time.process_time() - began < 60
    assert (result.exit_code, result.stderr) == (0, "")
    assert "45 points: 45 verified." in result.stdout
    data = xr.open_zarr("first.zarr").load()
    lines = run("show", "first.zarr").stdout.splitlines()
    assert lines[0] == "first: Peaks of the jacket pipe over stiffness and damping of its sink"
    assert "  kappa  9 values, 25 1/(m^2 s^2) to 400 1/(m^2 s^2)" in lines
    head = next(i for i, line in enumerate(lines) if "response_stable_pipe_peak" in line)
    for line, place in ((lines[head + 1], data.response_stable_pipe_peak.argmin(...)),
                        (lines[head + 2], data.response_stable_pipe_peak.argmax(...))):  # fmt: skip
        point = data.isel(place)
        assert f"{point.response_stable_pipe_peak.item():#.4g} m" in line
        assert f"kappa {point.kappa.item():.6g} 1/(m^2 s^2), xi2 {point.xi2.item():.6g} 1/s" in line


def test_points_that_failed_end_with_code_3_and_are_named(folder):
    (folder / "s.yaml").write_text(FAILING)
    result = run("sweep", "s.yaml", "--store", "s")
    assert result.exit_code == 3
    assert "3 points: 2 verified, 1 failed." in result.stdout
    assert result.stderr.startswith(
        "frahm: 3 points: 2 verified, 1 failed. 1 failed, at detuning -6 rad/s: slow_flow: "
    )
    assert result.stderr.count("\n") == 1
    assert "1 failed, at detuning -6 rad/s: slow_flow: detuning: given" in run("show", "s").stdout
    assert run("sweep", "s.yaml", "--store", "s", "--resume").exit_code == 3


def started(*arguments):
    return subprocess.Popen([*FRAHM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def finished_points(path):
    return int(np.count_nonzero(xr.open_zarr(path).status.values)) if is_sweep(path) else 0


def wait_for(path, points, process):
    deadline = time.monotonic() + 120
    while finished_points(path) < points:
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < deadline
        time.sleep(0.2)


def test_killed_interrupted_and_resumed_a_sweep_is_the_same(folder):
    (folder / "long.yaml").write_text(LONG)
    command = ("sweep", "long.yaml", "--store", "long.zarr")
    killed = started(*command)
    wait_for("long.zarr", 1, killed)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    after_kill = finished_points("long.zarr")
    assert 0 < after_kill < 1200

    interrupted = started(*command, "--resume")
    wait_for("long.zarr", after_kill + 1, interrupted)
    interrupted.send_signal(signal.SIGINT)
    said, errors = interrupted.communicate(timeout=60)
    assert interrupted.returncode == 130
    after = finished_points("long.zarr")
    assert after_kill < after < 1200
    assert said == ""
    assert errors.splitlines() == [
        f"frahm: interrupted. 1200 points: {after} verified, {1200 - after} not computed.",
        "frahm: go on with: frahm sweep long.yaml --store long.zarr --resume",
    ]
    shown = run("show", "long.zarr")
    assert f"{1200 - after} not computed" in shown.stdout

    assert run(*command, "--resume").exit_code == 0
    whole = frahm.sweep("long.yaml", store="whole.zarr", batch=173)
    alike(xr.open_zarr("long.zarr").load(), whole.load())


def test_progress_is_shown_on_a_terminal_only(folder):
    (folder / "s.yaml").write_text(FAILING.replace("-6", "-0.1"))
    main, terminal = pty.openpty()
    done = subprocess.run([*FRAHM, "sweep", "s.yaml", "--store", "s"], stdout=subprocess.PIPE, stderr=terminal,
                          check=False, env={**os.environ, "TERM": "xterm"})  # fmt: skip
    os.close(terminal)
    shown = b""
    while True:
        try:
            part = os.read(main, 4096)
        except OSError:
            break
        if not part:
            break
        shown += part
    os.close(main)
    assert done.returncode == 0
    assert b"points of study" in shown


@pytest.fixture(scope="module")
def local(tmp_path_factory):
    """The store of the threads of this machine."""
    path = tmp_path_factory.mktemp("local")
    (path / "s.yaml").write_text(SMALL)
    return frahm.sweep(path / "s.yaml", store=path / "s").load()


def test_a_dask_cluster_in_this_process_gives_the_same(folder, local):
    distributed = pytest.importorskip("distributed")
    (folder / "s.yaml").write_text(SMALL)
    with (
        distributed.LocalCluster(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=":0") as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        found = frahm.sweep("s.yaml", store="s", executor=client.get_executor(pure=False), batch=2)
        xr.testing.assert_identical(found.load(), local)


def test_workers_behind_an_address_give_the_same(folder, local):
    distributed = pytest.importorskip("distributed")
    (folder / "s.yaml").write_text(SMALL)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=":0"
    ) as cluster:
        address = cluster.scheduler_address
        assert address.startswith("tcp://127.0.0.1:")
        result = run("sweep", "s.yaml", "--store", "s", "--scheduler", address)
    assert (result.exit_code, result.stderr) == (0, "")
    alike(xr.open_zarr("s").load(), local)
