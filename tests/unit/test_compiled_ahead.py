"""What another process compiles is what an analysis loads: the same kernels, under the same keys."""

import os
import subprocess
import sys
from typing import ClassVar

import pytest

from frahm import compiled
from frahm.cli import ahead
from frahm.time_integration.propagate import propagate

ANALYSIS = """
import frahm
from frahm.harmonic_balance.orbits import describe
from frahm.time_integration.propagate import propagate

frahm.frequency_response("jacket-pipe", detuning=(-0.01, 0.01))
frahm.find_attractors("jacket-pipe", detuning=0.3, samples=2)
print(*(sum(kernel.stats.cache_hits.values()) for kernel in (describe, propagate)))
print(*(sum(kernel.stats.cache_misses.values()) for kernel in (describe, propagate)))
"""


def test_an_analysis_compiles_nothing_of_what_was_compiled_ahead(tmp_path):
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    for script in ("from frahm.cli.ahead import compile_ahead; compile_ahead()", ANALYSIS):
        done = subprocess.run(
            [sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=True, timeout=600
        )
        assert done.stderr == ""
    hits, misses = (line.split() for line in done.stdout.splitlines())
    assert (hits, misses) == (["1", "1"], ["0", "0"])


class Helper:
    """A process that is started, and has to be ended."""

    log: ClassVar[list[str]] = []

    def __init__(self, *_, **__):
        self.log.append("started")

    def terminate(self):
        self.log.append("ended")

    def wait(self):
        self.log.append("gone")


@pytest.mark.parametrize(
    ("missing", "cores", "expected"),
    [(True, 2, ["started", "ended", "gone"]), (False, 2, []), (True, 1, []), (True, None, [])],
)
def test_another_process_compiles_only_what_is_missing_and_where_there_is_a_core_for_it(
    monkeypatch, missing, cores, expected
):
    monkeypatch.setattr(compiled, "is_to_be_kept", lambda kernel: missing)
    monkeypatch.setattr(os, "cpu_count", lambda: cores)
    monkeypatch.setattr(subprocess, "Popen", Helper)
    Helper.log.clear()
    with ahead.compiled_ahead():
        assert Helper.log == expected[:1]
    assert Helper.log == expected


def test_what_is_kept_is_known_and_what_cannot_be_kept_is_nothing_to_compile_ahead(monkeypatch, tmp_path):
    monkeypatch.setattr(propagate._cache, "folder", tmp_path)
    assert compiled.is_to_be_kept(propagate)
    (tmp_path / f"{propagate._cache.name}.abc.kernel").touch()
    assert not compiled.is_to_be_kept(propagate)
    monkeypatch.setattr(propagate._cache, "folder", None)
    assert not compiled.is_to_be_kept(propagate)
