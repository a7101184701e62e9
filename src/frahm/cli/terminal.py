"""Output that can always be printed, whatever letters the terminal or the file it goes to knows."""

from __future__ import annotations

import codecs
import contextlib
import io
import sys
import unicodedata
from typing import Any, TextIO, cast

import typer

from frahm.errors import printable

_HANDLER = "frahm.spelt"
_GREEK = ("GREEK SMALL LETTER ", "GREEK CAPITAL LETTER ")


class _Unheard:
    """The error stream, whether anybody listens or not: what is said on it decides nothing.

    Without it a message to a reader who is gone, or to a full disk, would stand in for the exit code it explains.
    """

    def __init__(self, stream: TextIO):
        self._stream = stream

    def write(self, text: str) -> int:
        """Write text, or lose it."""
        with contextlib.suppress(OSError):
            self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        """Write what is waiting, or lose it."""
        with contextlib.suppress(OSError):
            self._stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


def printable_streams() -> None:
    """Let the standard streams spell letters their encoding does not know, instead of failing at the first one.

    On Windows output that is redirected has an old code page; half a pair of surrogates no encoding knows. The error
    stream may also be closed at its other end.
    """
    codecs.register_error(_HANDLER, _spelt)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_HANDLER)
    if sys.stderr is not None:  # closed by the one who started the command
        sys.stderr = cast(TextIO, _Unheard(sys.stderr))


def say(text: str, *, err: bool = False) -> None:
    """Print text of a file: its lines, and nothing a terminal would take for a command."""
    typer.echo("\n".join(printable(line, None) for line in text.split("\n")), err=err)


def _spelt(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_spell, error.object[error.start : error.end])), error.end


def _spell(letter: str) -> str:
    """A letter in ASCII: Greek ones by their name, others without accents, what is left as an escape."""
    name = unicodedata.name(letter, "")
    if name.startswith(_GREEK):
        return name.split()[3].lower()
    plain = unicodedata.normalize("NFKD", letter).encode("ascii", "ignore").decode("ascii")
    return plain or letter.encode("unicode_escape").decode("ascii")
