"""Output that can always be printed, whatever letters the terminal or the file it goes to knows."""

from __future__ import annotations

import codecs
import io
import sys
import unicodedata

import typer

from frahm.errors import printable

_HANDLER = "frahm.spelt"
_GREEK = ("GREEK SMALL LETTER ", "GREEK CAPITAL LETTER ")


def printable_streams() -> None:
    """Let the standard streams spell letters their encoding does not know, instead of failing at the first one.

    On Windows output that is redirected has an old code page; half a pair of surrogates no encoding knows.
    """
    codecs.register_error(_HANDLER, _spelt)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors=_HANDLER)


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
