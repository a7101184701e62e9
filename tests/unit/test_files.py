import json
import subprocess
import sys

import pytest

from frahm import ParameterError
from frahm.files import write_bytes, write_text


def test_a_file_is_replaced_in_one_step(tmp_path):
    target = tmp_path / "a.txt"
    write_text(target, "old\n")
    write_text(target, "neu: é\n")
    assert target.read_bytes() == "neu: é\n".encode()
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.txt"]


@pytest.mark.parametrize("error", [OSError, KeyboardInterrupt])
def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch, error):
    from pathlib import Path

    target = tmp_path / "a.txt"
    write_text(target, "old\n")

    def fail(self, other):
        raise error

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(ParameterError if error is OSError else error):
        write_text(target, "new\n")
    assert target.read_text() == "old\n"
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.txt"]


def test_a_place_that_cannot_be_written_is_named(tmp_path):
    with pytest.raises(ParameterError, match=r"missing.*No such file or directory"):
        write_text(tmp_path / "missing" / "a.txt", "text")
    with pytest.raises(ParameterError, match="null"):
        write_bytes("a\0b", b"")


def test_half_a_character_is_refused_and_nothing_is_written(tmp_path):
    with pytest.raises(ParameterError, match="whole characters"):
        write_text(tmp_path / "a.txt", "\ud800")
    assert not list(tmp_path.iterdir())


def test_a_written_file_can_be_read_by_others(tmp_path):
    plain, ours = tmp_path / "plain", tmp_path / "ours"
    plain.write_text("")
    write_text(ours, "")
    assert ours.stat().st_mode == plain.stat().st_mode


LIMITED = """
import json, resource, sys
import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from frahm import ParameterError, write_data
from frahm.plotting.style import save_figure

data = xr.Dataset({"a": ("x", np.random.default_rng(1).normal(size=4000), {"units": "m", "long_name": "a"})})
writers = {ending: lambda ending=ending: write_data(data, "out." + ending) for ending in ("nc", "mat", "csv", "json")}
writers["figure"] = lambda: save_figure(Figure(), "figure")
resource.setrlimit(resource.RLIMIT_FSIZE, (400, 400))
said = {}
for name, write in writers.items():
    try:
        write()
    except ParameterError as error:
        said[name] = str(error)
print(json.dumps(said))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="limits are set differently there")
def test_no_writer_dies_where_no_more_can_be_written(tmp_path):
    """Libraries that write to a file themselves end the process when the disk is full: HDF5 does."""
    done = subprocess.run([sys.executable, "-c", LIMITED], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    said = json.loads(done.stdout)
    assert set(said) == {"nc", "mat", "csv", "json", "figure"}
    assert all("File too large" in sentence for sentence in said.values()), said
    assert not list(tmp_path.iterdir())
