"""How frahm compiles: one decorator, so that flags and caching are the same everywhere.

Compiled code is kept on disk. numba renews it when the file of a kernel changes, but not when a kernel it calls does;
here the place on disk is named after the contents of the module and of every frahm module it imports, directly or
not, so what is loaded always belongs to the sources it is used with. It lies in the user's cache directory, which
also serves installations that cannot be written to.
"""

from __future__ import annotations

import functools
import hashlib
import os
import re
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba

# Contraction to fused multiply-add is allowed; NaN and infinity keep their meaning, because a NaN is how a kernel
# says "there is no such root".
_FLAGS = {"contract", "nsz", "arcp"}
_IMPORT = re.compile(r"^\s*from (frahm[\w.]*) import (?:\(([^)]*)\)|([^(\n]+))|^\s*import (frahm[\w.]*)", re.MULTILINE)
_ROOT = Path(__file__).resolve().parent


def kernel(function: Callable[..., Any]) -> Any:
    """Compile a function on first use, without the interpreter lock, and keep the machine code on disk."""
    config: Any = numba.config
    given = config.CACHE_DIR
    config.CACHE_DIR = str(_cache_root() / _digest(function.__module__)[:16])
    try:
        return numba.njit(cache=True, nogil=True, error_model="numpy", fastmath=_FLAGS)(function)
    finally:
        config.CACHE_DIR = given


@functools.lru_cache(maxsize=1)
def _cache_root() -> Path:
    """The first of the usual places that can be written to."""
    home = Path.home() / ("Library/Caches" if sys.platform == "darwin" else ".cache")
    named = [os.environ.get(name) for name in ("NUMBA_CACHE_DIR", "LOCALAPPDATA", "XDG_CACHE_HOME")]
    places = [Path(name) for name in named if name] + [home, Path(tempfile.gettempdir())]
    for place in places:
        root = place / "frahm" / "kernels"
        try:
            root.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=root):
                return root
        except OSError:
            continue
    return places[-1]


@functools.cache
def _digest(module: str) -> str:
    """Hash of the sources of a module and of all frahm modules it reaches."""
    seen: dict[str, str] = {}
    waiting = [module]
    while waiting:
        name = waiting.pop()
        source = _source(name)
        if name in seen or source is None:
            continue
        seen[name] = source
        for found in _IMPORT.finditer(source):
            package, listed, names, plain = found.groups()
            base = package or plain
            parts = (listed or names or "").split(",")
            waiting += [base, *(f"{base}.{part.split()[0]}" for part in parts if part.split())]
    text = "".join(f"{name}\n{seen[name]}" for name in sorted(seen))
    return hashlib.sha256(text.encode()).hexdigest()


@functools.cache
def _source(module: str) -> str | None:
    path = _ROOT.joinpath(*module.split(".")[1:])
    for file in (path.with_suffix(".py"), path / "__init__.py"):
        if file.is_file():
            return file.read_text(encoding="utf-8")
    return None
