"""What tests of several kinds share."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import settings

from searching import SEARCH
from validation_record import pytest_runtest_logreport, pytest_sessionfinish  # noqa: F401  (hooks)

# Every run tries the same examples, so that the suite says the same each time; `make fuzz` looks for new ones.
settings.register_profile("fixed", derandomize=True)
settings.register_profile(SEARCH, print_blob=True)
settings.load_profile("fixed")


@dataclasses.dataclass(frozen=True)
class FinishedRun:
    """One run of `frahm reproduce` in a process of its own, its output in pipes."""

    directory: Path
    exit_code: int
    stdout: str
    stderr: str
    seconds: float

    @property
    def claims(self):
        return {row["id"]: row for row in json.loads((self.directory / "claims.json").read_text(encoding="utf-8"))}


@pytest.fixture(scope="session")
def reproduction(tmp_path_factory):
    """The real run, done once even where several test processes ask for it."""
    base = tmp_path_factory.getbasetemp()
    room = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "reproduction"
    record = room / "record.json"
    try:
        room.mkdir()
    except FileExistsError:
        deadline = time.monotonic() + 300
        while not record.exists():
            assert time.monotonic() < deadline, "the run in the other test process did not end"
            time.sleep(0.2)
        return FinishedRun(room / "out", **json.loads(record.read_text(encoding="utf-8")))
    began = time.monotonic()
    command = [sys.executable, "-m", "frahm", "reproduce", "--out", str(room / "out")]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", timeout=280, check=False)
    kept = {"exit_code": done.returncode, "stdout": done.stdout, "stderr": done.stderr}
    kept["seconds"] = time.monotonic() - began
    (room / "record.part").write_text(json.dumps(kept), encoding="utf-8")
    (room / "record.part").replace(record)
    return FinishedRun(room / "out", **kept)
