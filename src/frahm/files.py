"""Files that appear complete or not at all."""

from __future__ import annotations

import contextlib
import secrets
from pathlib import Path

from frahm.errors import ParameterError

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
        beside.replace(target)
    except BaseException as error:
        with contextlib.suppress(OSError, ValueError):
            beside.unlink(missing_ok=True)
        if not isinstance(error, OSError | ValueError):
            raise
        reason = getattr(error, "strerror", None) or str(error)
        raise ParameterError("file", str(path), _ALLOWED, hint=f"{reason}.") from None


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
