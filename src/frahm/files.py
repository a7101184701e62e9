"""Files that are there to be read, and files that appear complete or not at all."""

from __future__ import annotations

import contextlib
import json
import os
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from frahm.errors import ParameterError, nearest

_LARGEST_TEXT = 500_000_000  # bytes
_MOST_NEIGHBOURS = 2000


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
        return f"There is no folder {str(path.parent)!r}."
    near = nearest(path.name, [name for name in names if Path(name).suffix.lower() == path.suffix.lower()] or names)
    return "There is no such file." + (f" Did you mean {str(path.with_name(near))!r}?" if near else "")


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


@contextlib.contextmanager
def written_beside(path: str | Path) -> Iterator[Path]:
    """Give a temporary file beside `path` to write to; it takes the name `path` once the block ends well.

    Parameters
    ----------
    path : str or Path
        The file to appear. One that exists is replaced in one step.

    Yields
    ------
    Path
        The temporary file, with the same suffix. It is removed if the block raises.

    Raises
    ------
    ParameterError
        If `path` cannot be written.
    """
    target = Path(path)
    temporary: Path | None = None
    try:
        temporary = _new_file(target)
        temporary.chmod(0o666 & ~_umask())
        yield temporary
        temporary.replace(target)
    except OSError as error:
        allowed = "a file in a directory that can be written"
        raise ParameterError("file", str(path), allowed, hint=f"{error.strerror or error}.") from None
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Write UTF-8 text with unix line ends; the file appears complete or not at all."""
    with written_beside(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def _new_file(target: Path) -> Path:
    try:
        handle, name = tempfile.mkstemp(prefix=f".{target.stem[:40]}-", suffix=target.suffix, dir=target.parent)
    except ValueError as error:  # a name no system call takes
        raise OSError(str(error)) from None
    os.close(handle)
    return Path(name)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
