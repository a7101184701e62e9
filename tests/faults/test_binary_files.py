"""Damaged and malicious MAT and netCDF files end in a message, never with the process that reads them."""

import io
import struct
import subprocess
import sys
import time
import zlib

import h5py
import numpy as np
import pytest
import scipy.io

import frahm
from frahm.untrusted import binary_content

TIME = np.linspace(0, 1, 50)


def mat_bytes(*, compressed):
    stream = io.BytesIO()
    content = {"t": TIME, "x": TIME**2, "log": {"a": TIME, "b": "text"}, "c": np.array(["one", 2.0], dtype=object)}
    scipy.io.savemat(stream, content, do_compression=compressed)
    return stream.getvalue()


def flipped(raw, place, bit):
    damaged = bytearray(raw)
    damaged[place] ^= 1 << bit
    return bytes(damaged)


# Found by flipping every bit: these end the process in the reader of MAT files, or raise errors of any type in it.
@pytest.mark.parametrize(
    ("compressed", "place", "bit"),
    [(False, 176, 0), (False, 176, 5), (False, 600, 4), (False, 584, 0), (True, 138, 1), (True, 141, 6)],
)
def test_a_flipped_bit_ends_in_a_message(tmp_path, compressed, place, bit):
    path = tmp_path / "a.mat"
    path.write_bytes(flipped(mat_bytes(compressed=compressed), place, bit))
    with pytest.raises(frahm.ParameterError, match=r"a\.mat.*damaged"):
        frahm.read_table(path)


def test_a_file_that_is_whole_comes_back_and_takes_less_than_a_second(tmp_path):
    path = tmp_path / "a.mat"
    path.write_bytes(mat_bytes(compressed=True))
    began = time.perf_counter()
    content = binary_content("mat", path)
    assert time.perf_counter() - began < 3  # 0.4 s where nothing else runs
    np.testing.assert_array_equal(content["x"].ravel(), TIME**2)
    np.testing.assert_array_equal(content["log"]["a"].ravel(), TIME)
    assert content["log"]["b"] == "text"
    assert content["c"][0] == "one"


def bomb(size):
    """MAT file of one vector of zeros, a thousandth of its size."""
    head = np.zeros(size, dtype=np.uint8)
    stream = io.BytesIO()
    scipy.io.savemat(stream, {"t": head}, do_compression=True)
    return stream.getvalue()


@pytest.mark.skipif(sys.platform != "linux", reason="memory is counted in other units")
def test_a_small_file_cannot_take_much_memory(tmp_path):
    one = zlib.compress(b"\0" * 2**26, 9)  # a block of 64 MB, repeated: 6 GB of 6 MB
    header = mat_bytes(compressed=True)[:128]
    element = (15).to_bytes(4, "little") + len(one).to_bytes(4, "little") + one
    (tmp_path / "bomb.mat").write_bytes(header + element * 96)
    code = (
        "import frahm, resource, sys\n"
        "try: frahm.read_table('bomb.mat')\n"
        "except frahm.ParameterError as error: assert 'larger than 500 MB' in str(error), error\n"
        "else: sys.exit('read')\n"
        # That of this process would start at the size of the one that started it.
        "own = next(int(line.split()[1]) for line in open('/proc/self/status') if line.startswith('VmHWM'))\n"
        "print(max(own, resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) < 300_000  # kB


def element(kind, content):
    return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)


def matrix(kind, shape, name, content):
    sizes = struct.pack(f"<{len(shape)}i", *shape)
    flags = element(6, struct.pack("<II", kind, 0))
    return element(14, flags + element(5, sizes) + element(1, name) + content)


def cell_of_empty_arrays(count):
    """MAT file of a short vector and of one compressed cell of very many arrays without an entry."""
    vector = matrix(6, (3, 1), b"time", element(9, struct.pack("<3d", 0, 1, 2)))
    cell = zlib.compress(matrix(1, (count, 1), b"c", matrix(6, (0, 0), b"", element(9, b"")) * count), 9)
    return mat_bytes(compressed=True)[:128] + vector + struct.pack("<II", 15, len(cell)) + cell


def test_very_many_arrays_without_an_entry_are_refused(tmp_path):
    path = tmp_path / "cells.mat"
    path.write_bytes(cell_of_empty_arrays(120_000))
    with pytest.raises(frahm.ParameterError, match="more than 100000 arrays"):
        binary_content("mat", path)
    path.write_bytes(cell_of_empty_arrays(1000))
    assert len(binary_content("mat", path)["c"]) == 1000


def test_very_many_fields_of_structures_are_refused(tmp_path):
    path = tmp_path / "many.mat"
    names = element(5, struct.pack("<i", 8)) + element(1, b"a".ljust(8, b"\0") + b"b".ljust(8, b"\0"))
    empty = matrix(6, (0, 0), b"", element(9, b""))
    fields = matrix(2, (70_000, 1), b"s", names + empty * 140_000)
    path.write_bytes(mat_bytes(compressed=True)[:128] + fields)
    with pytest.raises(frahm.ParameterError, match="more than 100000 arrays"):
        binary_content("mat", path)


def test_numbers_stored_shorter_than_they_are_count_as_large_as_they_come(tmp_path):
    path = tmp_path / "short.mat"
    parts = element(2, bytes(1_000_000))  # of complex numbers: the file stores them as one byte each
    path.write_bytes(mat_bytes(compressed=True)[:128] + matrix(6 | 0x800, (1_000_000, 1), b"x", parts + parts))
    with pytest.raises(frahm.ParameterError, match="larger than 10 MB"):
        binary_content("mat", path, most_bytes=10_000_000)


def test_very_much_text_is_refused(tmp_path):
    path = tmp_path / "text.nc"
    with h5py.File(path, "w") as file:
        file.create_dataset("x", data=np.array([b"a long text of some forty letters in all"] * 500_000))
    with pytest.raises(frahm.ParameterError, match="more text"):
        binary_content("netcdf", path)


def test_an_array_that_is_only_declared_is_refused(tmp_path):
    with h5py.File(tmp_path / "huge.nc", "w") as file:
        file.create_dataset("x", shape=(10**12,), dtype="f8", chunks=(1000,))
    with pytest.raises(frahm.ParameterError, match="larger than 500 MB"):
        frahm.read_table(tmp_path / "huge.nc")
    with pytest.raises(frahm.ParameterError, match="larger than 500 MB"):
        frahm.read_data(tmp_path / "huge.nc")


def test_memory_is_bounded_where_no_size_is_declared(tmp_path):
    pytest.importorskip("resource")
    path = tmp_path / "many.mat"
    path.write_bytes(bomb(60_000_000))
    with pytest.raises(frahm.ParameterError, match=r"larger than 10 MB|more memory"):
        binary_content("mat", path, most_bytes=10_000_000)


@pytest.mark.parametrize(
    ("name", "raw"),
    [
        ("a.nc", b"CDF\x01" + b"\xff" * 300),
        ("a.nc", b"\x89HDF\r\n\x1a\n" + b"\xff" * 300),
        ("a.nc", b""),
        ("a.mat", b""),
    ],
)
def test_what_is_no_such_file_is_refused(tmp_path, name, raw):
    (tmp_path / name).write_bytes(raw)
    for read in (frahm.read_table, frahm.read_data):
        with pytest.raises(frahm.ParameterError, match=r"a\.(nc|mat)"):
            read(tmp_path / name)


def test_what_goes_wrong_in_the_program_itself_is_not_blamed_on_the_file(tmp_path, monkeypatch):
    path = tmp_path / "a.mat"
    path.write_bytes(mat_bytes(compressed=False))
    monkeypatch.setattr("frahm.untrusted._CHILD", str(tmp_path / "broken.py"))
    (tmp_path / "broken.py").write_text("undefined_name\n")
    with pytest.raises(RuntimeError, match="NameError"):
        frahm.read_table(path)
