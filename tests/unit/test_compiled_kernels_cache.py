"""Compiled code on disk is named after all sources it is made of: none may be missed."""

import ast
import os
import re
import stat
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest

import frahm
from frahm import compiled

ROOT = Path(frahm.__file__).parent
MODULES = sorted(
    path for path in ROOT.rglob("*.py") if re.search("@(separate_)?kernel", path.read_text(encoding="utf-8"))
)


def imported(path):
    """Modules of this package a file imports, by the language's own parser."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("frahm"):
            found.add(node.module)
            found |= {f"{node.module}.{name.name}" for name in node.names}
        elif isinstance(node, ast.Import):
            found |= {name.name for name in node.names if name.name.startswith("frahm")}
    return {name for name in found if compiled._source(name) is not None}


def reachable(path):
    waiting, seen = [path], set()
    while waiting:
        for name in imported(waiting.pop()) - seen:
            seen.add(name)
            file = ROOT.joinpath(*name.split(".")[1:])
            waiting.append(file.with_suffix(".py") if file.with_suffix(".py").is_file() else file / "__init__.py")
    return seen


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_imported_module_counts(path, monkeypatch):
    read = set()
    source = compiled._source
    monkeypatch.setattr(compiled, "_source", lambda name: read.add(name) or source(name))
    name = ".".join(("frahm", *path.relative_to(ROOT).with_suffix("").parts))
    compiled._digest.__wrapped__(name)
    assert reachable(path) <= read


def doubled(x):
    return 2.0 * x


@pytest.fixture
def kept(tmp_path, monkeypatch, caplog):
    """A function that is compiled anew, as in another process, every time it is called; and the file kept of it."""
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "place"))
    compiled._cache_root.cache_clear()

    def value(x=3.0):
        compiled._say.cache_clear()
        made = compiled.kernel(doubled)
        assert made(x) == 2.0 * x
        return sum(made.stats.cache_hits.values())

    assert value() == 0
    yield value, tmp_path / "place" / "frahm" / "kernels"
    compiled._cache_root.cache_clear()


def the_file(root):
    (file,) = root.rglob("*.kernel")
    return file


def test_a_kernel_is_compiled_once(kept):
    value, root = kept
    assert value() == 1
    the_file(root)


@pytest.mark.parametrize("damage", ["empty", "cut", "flip", "other"])
def test_a_damaged_kernel_is_compiled_again_once_and_said(kept, damage, caplog):
    value, root = kept
    whole = the_file(root).read_bytes()
    left = {"empty": b"", "cut": whole[: len(whole) // 2], "other": b"no kernel"}
    for place in range(0, len(whole), len(whole) // 40) if damage == "flip" else [0]:
        bad = bytearray(whole)
        bad[place] ^= 1 << place % 8
        the_file(root).write_bytes(left.get(damage, bytes(bad)))
        caplog.clear()
        assert value() == 0
        assert [r.levelname for r in caplog.records] == ["WARNING"]
        assert "damaged and is compiled again" in caplog.text
        caplog.clear()
        assert value() == 1
        assert not caplog.records


def test_a_kernel_is_never_taken_for_another_signature(kept):
    """Two processes that compile at once must not leave one with the code of the other."""
    value, root = kept
    of_reals = the_file(root)
    assert value(np.float32(3.0)) == 0
    (of_singles,) = set(root.rglob("*.kernel")) - {of_reals}
    of_singles.write_bytes(of_reals.read_bytes())
    assert value(np.float32(3.0)) == 0
    assert value(np.float32(3.0)) == 1


def test_a_kernel_that_cannot_be_kept_is_used_all_the_same(kept, monkeypatch, caplog):
    value, root = kept
    the_file(root).unlink()

    def full(path, content):
        raise frahm.ParameterError("file", str(path), "another disk", hint="No space left on device.")

    monkeypatch.setattr(compiled, "write_bytes", full)
    assert value() == 0
    assert "cannot be kept" in caplog.text
    assert "No space left on device" in caplog.text


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="folders have no owner by number there")
def test_what_another_user_left_is_not_loaded(kept, monkeypatch, caplog):
    _, root = kept
    own = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: own + 1)
    compiled._say.cache_clear()
    assert compiled.kernel(doubled)(3.0) == 6.0  # the folder was found before: now its file is another's
    assert "belongs to another user" in caplog.text
    compiled._cache_root.cache_clear()
    monkeypatch.setenv("XDG_CACHE_HOME", str(root.parent.parent))
    monkeypatch.setenv("HOME", str(root.parent.parent))
    assert compiled._cache_root() is None or not compiled._cache_root().is_relative_to(root.parent)


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="rights are different there")
def test_kernels_lie_where_nobody_else_can_enter(kept, monkeypatch, tmp_path):
    _, root = kept
    assert stat.S_IMODE(root.stat().st_mode) == 0o700
    root.chmod(0o777)
    compiled._cache_root.cache_clear()
    assert compiled._cache_root() == root
    assert stat.S_IMODE(root.stat().st_mode) == 0o700
    place = tmp_path / "linked"
    (place / "frahm").mkdir(parents=True)
    (place / "frahm" / "kernels").symlink_to(root)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(place))
    compiled._cache_root.cache_clear()
    assert compiled._cache_root() != place / "frahm" / "kernels"


def test_without_a_place_of_ones_own_nothing_is_kept_and_that_is_said(kept, monkeypatch, tmp_path, caplog):
    (tmp_path / "file").write_text("")
    monkeypatch.setattr(compiled, "_places", lambda: iter([tmp_path / "file"]))
    compiled._cache_root.cache_clear()
    compiled._say.cache_clear()
    made = compiled.kernel(doubled)
    assert made(3.0) == 6.0
    assert made._cache.cache_path is None
    assert caplog.text.count("compiled kernels are not kept") == 1


def test_the_shared_folder_for_temporary_files_is_no_place(monkeypatch):
    for name in ("NUMBA_CACHE_DIR", "LOCALAPPDATA", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)
    assert Path(tempfile.gettempdir()) not in set(compiled._places())


def test_what_other_sources_left_is_removed_after_a_month_and_nothing_else(kept):
    value, root = kept
    (own,) = root.iterdir()
    old, recent, foreign, left = (root / name for name in ("0" * 16, "1" * 16, "notes", "2" * 16 + ".gone-7"))
    for folder in (old, recent, foreign, left):
        folder.mkdir()
        (folder / "a.kernel").write_bytes(b"code")
    month = time.time() - 31 * 86_400
    for folder in (old, foreign, left, own):
        os.utime(folder, (month, month))
    compiled._mark_used.cache_clear()
    compiled._remove_unused.cache_clear()
    assert value() == 1  # what is loaded is in use
    assert own.stat().st_mtime > month + 1
    assert old.exists()
    assert value(np.float32(3.0)) == 0  # what is compiled makes room
    assert {folder.name for folder in root.iterdir()} == {own.name, recent.name, foreign.name}


def test_a_folder_another_process_removes_meanwhile_is_no_failure(kept, monkeypatch, caplog):
    value, root = kept
    old = root / ("0" * 16)
    old.mkdir()
    os.utime(old, (0, 0))
    monkeypatch.setattr(Path, "rename", lambda self, target: (_ for _ in ()).throw(PermissionError("in use")))
    compiled._remove_unused.cache_clear()
    compiled._remove_unused(root)
    assert old.exists()
    assert not caplog.records
    assert value() == 1


APART = """
import sys
from frahm.compiled import kernel, separate_kernel

@kernel
def other(x):
    return x - 1.0

@separate_kernel
def inner(x):
    return 2.0 * x

@kernel
def outer(x):
    return inner(x) + 1.0

if "other first" in sys.argv:  # the symbols of what is compiled later are others then: they count
    other(3.0), other(3), other(3j)
assert outer(3.0) == 7.0
calls = "inner" in outer.inspect_llvm().popitem()[1] if not outer.stats.cache_hits else True
print(sum(outer.stats.cache_hits.values()), sum(inner.stats.cache_hits.values()), calls)
"""


def test_a_separate_kernel_is_called_and_what_calls_it_is_kept_with_its_symbol(tmp_path):
    script, place = tmp_path / "apart.py", tmp_path / "place"
    script.write_text(APART)
    environment = os.environ | {"NUMBA_CACHE_DIR": str(place), "PYTHONHASHSEED": "0"}  # a symbol names a set of flags

    def run(*more):
        done = subprocess.run(
            [sys.executable, str(script), *more],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
            timeout=120,
        )
        return done.stdout.split()

    assert run() == ["0", "0", "True"]
    assert run() == ["1", "1", "True"]
    (kept_inner,) = place.rglob("*.inner-*.kernel")
    kept_inner.unlink()
    assert run("other first")[0] == "0"  # compiled again, for the code it would call is gone
    assert run("other first") == ["1", "1", "True"]
