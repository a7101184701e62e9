"""One writer of a store at a time, whatever the timing."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from frahm.errors import ParameterError

_LONGEST = 200  # bytes of a name, to which a little is added
_BUSY = (errno.EAGAIN, errno.EACCES, errno.EDEADLK)


@contextlib.contextmanager
def only_writer(path: Path) -> Iterator[None]:
    """Inside this block nobody else fills the store, is about to make it or replaces it.

    The lock is one of the system on a file beside the store, which may not be there yet. It ends with the process that
    holds it, however that ends. Where a file system knows no locks, the file being there is the lock.

    Parameters
    ----------
    path : Path
        Of the store, as it is known to everybody: no symbolic link.

    Raises
    ------
    ParameterError
        If somebody else writes the store, or nothing can be written beside it.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        holder = _taken(path)
    except (OSError, ValueError) as error:
        if isinstance(error, ParameterError):
            raise
        raise unwritable(path, error) from None
    with holder:
        yield


def beside(path: Path, what: str) -> Path:
    """Name of a file or folder that goes with a store and lies beside it."""
    name = path.name
    if len(os.fsencode(name)) > _LONGEST:
        name = hashlib.sha256(os.fsencode(name)).hexdigest()
    return path.with_name(f".{name}.{what}")


def unwritable(path: Path, error: Exception) -> ParameterError:
    """What to say of a store that cannot be written."""
    reason = getattr(error, "strerror", None) or str(error)
    return ParameterError("store", str(path), "a folder that can be written", hint=f"{reason}.")


def _taken(path: Path) -> contextlib.ExitStack:
    """The lock; it is given back when the stack closes."""
    with contextlib.ExitStack() as stack:
        file = beside(path, "lock")
        while True:
            handle = os.open(file, os.O_RDWR | os.O_CREAT, 0o666)
            try:
                free = _locked(handle)
            except OSError:  # a file system without locks
                os.close(handle)
                stack.callback(_remove, file)
                _take_by_file(path, stack)
                break
            if not free:
                os.close(handle)
                raise _busy(path)
            if _is_still(handle, file):
                stack.callback(_give_back, handle, file)
                break
            os.close(handle)  # who held it before has removed the file: lock the one that is there now
        return stack.pop_all()


def _locked(handle: int) -> bool:
    """Whether the lock of an open file is had now; an OSError if the file system knows none."""
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in _BUSY:
            return False
        raise
    return True


def _is_still(handle: int, file: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(handle), file.stat())
    except (FileNotFoundError, PermissionError):  # the second on Windows: removed, but still open somewhere
        return False


def _give_back(handle: int, file: Path) -> None:
    if sys.platform == "win32":  # what is open cannot be removed there, by nobody
        os.close(handle)
        _remove(file)
    else:
        _remove(file)
        os.close(handle)


def _take_by_file(path: Path, stack: contextlib.ExitStack) -> None:
    file = beside(path, "writer")
    try:
        os.close(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    except FileExistsError:
        raise _busy(path, f" This file system knows no locks: if no sweep runs, remove {file}.") from None
    stack.callback(_remove, file)


def _remove(file: Path) -> None:
    with contextlib.suppress(OSError):
        file.unlink(missing_ok=True)


def _busy(path: Path, more: str = "") -> ParameterError:
    hint = f"Another sweep is writing to it.{more}"
    return ParameterError("store", str(path), "a store nobody else writes to", hint=hint)
