"""Files that are there to be read, and files that appear complete or not at all."""

from __future__ import annotations

import contextlib
import json
import os
import secrets
import stat
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from frahm.errors import ParameterError, nearest

_LARGEST_TEXT = 500_000_000  # bytes
_MOST_NEIGHBOURS = 2000
_PAUSES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5)  # [s]


def existing_file(path: str | os.PathLike[str], allowed: str = "a file that exists", *, largest: int) -> Path:
    """Path of a regular file that is not too large; nothing is opened, so a pipe or a device cannot hang.

    Parameters
    ----------
    path : str or Path
        The file.
    allowed : str
        What may be given, as the end of the sentence "allowed: ...".
    largest : int
        Size of the file [bytes].

    Raises
    ------
    ParameterError
        If there is no such file, with the name of the one beside it that was probably meant; if it is no regular
        file, or too large.
    """
    found = Path(path)
    try:
        status = found.stat()
        if not stat.S_ISREG(status.st_mode):
            kind = "a folder" if stat.S_ISDIR(status.st_mode) else "no regular file"
            raise ParameterError("file", str(path), allowed, hint=f"It is {kind}.")
        if status.st_size > largest:
            size = f"{largest / 1e6:.3g} MB" if largest >= 1_000_000 else f"{largest / 1e3:.3g} kB"
            raise ParameterError("file", str(path), f"a file of at most {size}")
    except FileNotFoundError:
        raise ParameterError("file", str(path), allowed, hint=missing(found)) from None
    except OSError as error:
        raise ParameterError("file", str(path), allowed, hint=f"{error.strerror or error}.") from None
    except ValueError as error:
        if isinstance(error, ParameterError):
            raise
        raise ParameterError("file", str(path), allowed, hint=f"{error}.") from None
    return found


def missing(path: Path) -> str:
    """Say that a file is not there, and which one beside it was probably meant."""
    try:
        names = [entry.name for entry, _ in zip(os.scandir(path.parent), range(_MOST_NEIGHBOURS), strict=False)]
    except (OSError, ValueError):
        return f"There is no folder {str(path.parent)!r}." + _folder_beside(path.parent)
    near = nearest(path.name, [name for name in names if Path(name).suffix.lower() == path.suffix.lower()] or names)
    return "There is no such file." + (f" Did you mean {str(path.with_name(near))!r}?" if near else "")


def _folder_beside(folder: Path) -> str:
    """The folder beside one that is not there that was probably meant, as a question; empty if none is like it."""
    try:
        entries = [entry for entry, _ in zip(os.scandir(folder.parent), range(_MOST_NEIGHBOURS), strict=False)]
        near = nearest(folder.name, [entry.name for entry in entries if entry.is_dir()])
    except (OSError, ValueError):
        return ""
    return f" Did you mean {str(folder.with_name(near))!r}?" if near else ""


def file_text(path: str | os.PathLike[str], allowed: str = "a file that exists", largest: int = _LARGEST_TEXT) -> str:
    """Text of a regular UTF-8 file.

    Raises
    ------
    ParameterError
        As `existing_file`, or if the file is not text in UTF-8.
    """
    found = existing_file(path, allowed, largest=largest)
    try:
        return found.read_bytes().decode("utf-8-sig")
    except OSError as error:
        raise ParameterError("file", str(path), allowed, hint=f"{error.strerror or error}.") from None
    except UnicodeDecodeError:
        raise ParameterError("file", str(path), allowed, hint="It is not text in UTF-8.") from None


def json_or_nothing(path: str | os.PathLike[str]) -> Any:
    """Plain data of a JSON file; None if there is no such file or it holds no JSON."""
    try:
        return json.loads(file_text(path))
    except (ParameterError, ValueError, RecursionError):
        return None


_ALLOWED = "a file in a directory that can be written"


def write_bytes(path: str | Path, content: bytes | memoryview) -> None:
    """Write a file; it appears complete or not at all, and one that exists is replaced in one step.

    What is written is made in memory first: a library that itself writes to a disk that is full can end the process.

    Parameters
    ----------
    path : str or Path
        The file to appear.
    content : bytes or memoryview
        All of it.

    Raises
    ------
    ParameterError
        If `path` cannot be written.
    """
    target = Path(path)
    beside = target.with_name(f".{target.stem[:40]}-{secrets.token_hex(4)}{target.suffix}")
    try:
        with beside.open("xb") as stream:
            stream.write(content)
        put_in_place(beside, target)
    except BaseException as error:
        with contextlib.suppress(OSError, ValueError):
            beside.unlink(missing_ok=True)
        if not isinstance(error, OSError | ValueError):
            raise
        reason = getattr(error, "strerror", None) or str(error)
        raise ParameterError("file", str(path), _ALLOWED, hint=f"{reason}.") from None


def put_in_place(source: Path, target: Path) -> None:
    """Move a file or a folder to where it belongs; a file that stands there is replaced in one step."""
    patiently(lambda: source.replace(target))


def patiently(replacement: Callable[[], object]) -> None:
    """Do what replaces a file.

    Windows refuses while somebody has the file open, such as a search for viruses or a reader: a little patience helps
    there.
    """
    for pause in _PAUSES if sys.platform == "win32" else ():
        try:
            replacement()
        except PermissionError:
            time.sleep(pause)
        else:
            return
    replacement()


def write_text(path: str | Path, text: str) -> None:
    """Write UTF-8 text with unix line ends; the file appears complete or not at all.

    Raises
    ------
    ParameterError
        If `path` cannot be written, or the text has half a character.
    """
    try:
        content = text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise ParameterError("file", str(path), "text of whole characters", hint=f"{error}.") from None
    write_bytes(path, content)


def remove_file(path: Path) -> None:
    """Remove a file if it is there.

    Raises
    ------
    ParameterError
        If it cannot be removed.
    """
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise ParameterError("file", str(path), _ALLOWED, hint=f"{error.strerror}.") from None
