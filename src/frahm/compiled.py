"""How frahm compiles: one decorator, so that flags and keeping are the same everywhere.

Compiled code is kept on disk, where it serves installations that cannot be written to as well. Its folder is named
after the contents of the module and of every frahm module it imports, directly or not, so what is loaded always
belongs to the sources it is used with. What is kept is run, so it must be this user's own and whole: the folder is the
user's alone, and every file begins with the hash of what follows.

numba puts the code of everything a kernel calls into the kernel and optimises it again, in every caller up to the top:
for the large ones that is most of the time it takes. A `separate_kernel` is called where it is instead. What has been
kept of a caller then belongs to the very code it calls: its name is kept with it, and loaded first.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import importlib
import logging
import os
import pickle
import re
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import llvmlite.binding
import numba
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.serialize import dumps

from frahm.errors import ParameterError
from frahm.files import write_bytes

# Contraction to fused multiply-add is allowed; NaN and infinity keep their meaning, because a NaN is how a kernel
# says "there is no such root".
_FLAGS = {"contract", "nsz", "arcp"}
_IMPORT = re.compile(r"^\s*from (frahm[\w.]*) import (?:\(([^)]*)\)|([^(\n]+))|^\s*import (frahm[\w.]*)", re.MULTILINE)
_UNUSED = 30 * 86_400.0  # [s] after which compiled code of other sources is removed
_FOLDER = re.compile(r"[0-9a-f]{16}(\.gone-\d+)?")
_ROOT = Path(__file__).resolve().parent


def kernel(function: Callable[..., Any]) -> Any:
    """Compile a function on first use, without the interpreter lock, and keep the machine code on disk."""
    compiled: Any = numba.njit(nogil=True, error_model="numpy", fastmath=_FLAGS)(function)
    root = _cache_root()
    compiled._cache = KeptKernel(function, None if root is None else root / _digest(function.__module__)[:16])
    return compiled


def separate_kernel(function: Callable[..., Any]) -> Any:
    """As `kernel`, for a large function: its callers call it, and do not take its code in to compile it again."""
    compiled = kernel(function)
    compiled._cache.separate = True
    return compiled


def is_to_be_kept(kernel: Any) -> bool:
    """Whether a kernel is still to be compiled, and can be kept then."""
    cache: KeptKernel = kernel._cache
    return cache.folder is not None and not any(cache.folder.glob(f"{cache.name}.*.kernel"))


class KeptKernel(NullCache):
    """The machine code of a function on disk, a file for every signature.

    numba's own cache takes a file for what it says it is: a damaged one ends every call, or is run. Nor does it say
    which signature a file is of, so two processes that compile at once can give one the code of the other.

    Parameters
    ----------
    function : callable
        What is compiled.
    folder : Path or None
        Where its files lie; made when there is something to keep. None: nothing is kept.

    Attributes
    ----------
    separate : bool
        Whether callers are not to take its code in.
    folder : Path or None
    name : str
        What the names of its files begin with.
    """

    def __init__(self, function: Callable[..., Any], folder: Path | None):
        self.folder = folder
        self.separate = False
        self._function = (function.__module__, function.__qualname__)
        code = function.__code__
        name = re.sub(r"[^\w.]", "", function.__qualname__)
        self.name = f"{function.__module__.rpartition('.')[2]}.{name}-{code.co_firstlineno}"
        self._made_of = (numba.__version__, sys.version_info[:2], hashlib.sha256(code.co_code).hexdigest())

    @property
    def cache_path(self) -> str | None:
        """The folder, for numba's statistics."""
        return None if self.folder is None else str(self.folder)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Compiled code of a signature; None, and a word in the log, if what is there cannot be used."""
        target_context.refresh()
        if self.folder is None:
            return None
        key = self._key(sig, target_context.codegen())
        try:
            content = _own_content(self._path(self.folder, key))
            if content is None:
                return None
            _mark_used(self.folder)
            calls, made = pickle.loads(_unsealed(key, content))
            if not _all_loaded(calls):
                return None
            found = CompileResult._rebuild(target_context, *made)
        except FileNotFoundError:
            return None
        except Exception:  # what is whole and can still not be loaded is as good as damaged
            _say(f"A compiled kernel kept in {_cache_root()} is damaged and is compiled again.")
            return None
        self._keep_apart(sig, found)
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep compiled code; if that cannot be, a word in the log: the code is there all the same."""
        try:
            self._save(sig, data)
        finally:
            self._keep_apart(sig, data)

    def _save(self, sig: Any, data: Any) -> None:
        if self.folder is None or data.library.has_dynamic_globals:  # addresses of this process stand in it
            return
        key = self._key(sig, data.codegen)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            content = dumps((_separate_calls(data.library), data._reduce()))
            write_bytes(self._path(self.folder, key), _sealed(key, content))
            _mark_used(self.folder)
            _remove_unused(self.folder.parent)
        except (OSError, ParameterError, RuntimeError) as error:  # the last: code whose making was interrupted
            _say(f"Compiled kernels cannot be kept in {_cache_root()}: {getattr(error, 'hint', None) or error}")

    def _keep_apart(self, sig: Any, made: Any) -> None:
        """Give callers a module without code to link: the symbol they find in the running program."""
        if self.separate:
            made.library._shared_module = llvmlite.binding.parse_assembly("")
            _SEPARATE[made.fndesc.mangled_name] = (*self._function, sig)

    def _key(self, sig: Any, codegen: Any) -> bytes:
        return repr((self.name, sig, codegen.magic_tuple(), self._made_of)).encode()

    def _path(self, folder: Path, key: bytes) -> Path:
        return folder / f"{self.name}.{hashlib.sha256(key).hexdigest()[:24]}.kernel"


_SEPARATE: dict[str, tuple[str, str, Any]] = {}  # by symbol: module, name and signature of a kernel that is there


def _separate_calls(library: Any) -> dict[str, tuple[str, str, Any]]:
    """The separate kernels that compiled code calls, by symbol."""
    called = (found.name for found in library._final_module.functions if found.is_declaration)
    return {name: _SEPARATE[name] for name in called if name in _SEPARATE}


def _all_loaded(calls: dict[str, tuple[str, str, Any]]) -> bool:
    """Whether the kernels called are there under the same symbols; they are loaded if need be."""
    for symbol, (module, name, sig) in calls.items():
        if symbol not in _SEPARATE:
            getattr(importlib.import_module(module), name).compile(sig)
        if symbol not in _SEPARATE:  # compiled again since, under another symbol
            return False
    return True


def _sealed(key: bytes, payload: bytes) -> bytes:
    return hashlib.sha256(key + payload).digest() + payload


def _unsealed(key: bytes, content: bytes) -> bytes:
    size = hashlib.sha256().digest_size
    if hashlib.sha256(key + content[size:]).digest() != content[:size]:
        raise ValueError("the hash is that of something else")
    return content[size:]


def _own_content(path: Path) -> bytes | None:
    """Bytes of a file of this user; those of anybody else are never loaded, because loading runs them."""
    with path.open("rb") as stream:
        if not _is_own(os.fstat(stream.fileno())):
            _say(f"A compiled kernel kept in {_cache_root()} belongs to another user and is not used.")
            return None
        return stream.read()


@functools.lru_cache(maxsize=1)
def _cache_root() -> Path | None:
    """The first of the usual places that is this user's alone and can be written to; None if there is none."""
    for place in _places():
        root = place / "frahm" / "kernels"
        try:
            root.mkdir(mode=0o700, parents=True, exist_ok=True)
            if _made_private(root):
                with tempfile.TemporaryFile(dir=root):
                    return root
        except OSError:
            continue
    _say(
        "No folder of this user alone can be written to, so compiled kernels are not kept and every start takes"
        " minutes; NUMBA_CACHE_DIR can name one."
    )
    return None


def _places() -> Iterator[Path]:
    for name in ("NUMBA_CACHE_DIR", "LOCALAPPDATA", "XDG_CACHE_HOME"):
        if os.environ.get(name):
            yield Path(os.environ[name]).absolute()
    try:
        yield Path.home() / ("Library/Caches" if sys.platform == "darwin" else ".cache")
    except RuntimeError:  # a user without a home
        return


def _made_private(folder: Path) -> bool:
    """Whether a folder is this user's; nobody else may enter it then."""
    found = folder.lstat()
    if not stat.S_ISDIR(found.st_mode) or not _is_own(found):
        return False
    if found.st_mode & 0o077:
        folder.chmod(0o700)
    return True


def _is_own(found: os.stat_result) -> bool:
    """Whether it is of this user; on Windows the user's folders are closed to others by the system."""
    return not hasattr(os, "geteuid") or found.st_uid == os.geteuid()


@functools.cache
def _mark_used(folder: Path) -> None:
    """Let a folder bear the time of its last use, once a process; where that cannot be, it is removed sooner."""
    with contextlib.suppress(OSError):
        os.utime(folder)


@functools.cache
def _remove_unused(root: Path) -> None:
    """Remove what was compiled from other sources and not used for a month, once a process that compiles.

    A folder is renamed before it is emptied, so that no process finds half of it; one that still reads from it goes on.
    """
    with contextlib.suppress(OSError):
        for folder in list(root.iterdir()):
            with contextlib.suppress(OSError):
                found = folder.lstat()
                old = time.time() - found.st_mtime > _UNUSED
                if not (_FOLDER.fullmatch(folder.name) and stat.S_ISDIR(found.st_mode) and _is_own(found) and old):
                    continue
                gone = folder if ".gone-" in folder.name else folder.with_name(f"{folder.name}.gone-{os.getpid()}")
                folder.rename(gone)
                shutil.rmtree(gone, ignore_errors=True)


@functools.cache
def _say(sentence: str) -> None:
    """A word in the log, once."""
    logging.getLogger("frahm").warning(sentence)


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
