"""Text files that people write, YAML or TOML, as plain data with the line of every path in it."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from frahm.case.toml_text import read_toml
from frahm.case.yaml_text import TextError, read_yaml
from frahm.errors import ParameterError, nearest
from frahm.files import missing

LARGEST = 256 * 1024
READERS: dict[str, Callable[[str], tuple[Any, dict[str, int]]]] = {
    ".yaml": read_yaml, ".yml": read_yaml, ".toml": read_toml,
}  # fmt: skip


def document_text(source: str | os.PathLike[str], what: str, sources: str, known: Sequence[str] = ()) -> str:
    """Text of a file, or the error that says why there is none.

    Parameters
    ----------
    source : str or Path
        The file.
    what : str
        What it should hold: "case" or "study".
    sources : str
        What may be given instead, as the end of the sentence "allowed: ...".
    known : sequence of str
        Names that could have been meant.
    """
    path, refuse = Path(source), functools.partial(ParameterError, what, str(source))
    try:
        if not str(source) or not path.exists():
            raise _no_such_file(str(source), what, sources, known)
        if path.is_dir():
            raise refuse(sources, hint="This is a directory.")
        if not path.is_file():
            raise refuse(sources, hint="This is not a regular file.")
        if path.suffix.lower() not in READERS:
            raise refuse(sources, hint=f"The ending {path.suffix!r} is not known.")
        with path.open("rb") as stream:
            raw = stream.read(LARGEST + 1)
    except OSError as error:
        raise refuse(sources, hint=f"{error.strerror or error}.") from None
    except ValueError as error:
        raise error if isinstance(error, ParameterError) else refuse(sources, hint=f"{error}.") from None
    if len(raw) > LARGEST:
        raise refuse(f"a {what} file of at most {LARGEST // 1024} kB", hint="This file is larger.")
    try:
        if b"\0" in raw:
            raise ValueError
        return raw.decode("utf-8-sig")
    except ValueError:
        raise refuse("a text file in UTF-8", hint="This file is not text in UTF-8.") from None


def document_data(text: str, source: str | os.PathLike[str], what: str, least: str) -> tuple[Any, dict[str, int]]:
    """Plain data of a text, and the line of every path; `least` says what must be in it."""
    try:
        data, lines = READERS[Path(source).suffix.lower()](text)
    except TextError as error:
        where = f"{source}:{error.line}" if error.line else str(source)
        raise ParameterError(what, Path(source).name, f"a {what} file", where=where, hint=_sentence(error)) from None
    if data is None or data == {}:
        raise ParameterError(what, "an empty file", f"a file with at least {least}", where=str(source))
    return data, lines


def check_mapping(data: Any, what: str, sections: str, source: str | None) -> dict[str, Any]:
    """Return plain data if it is a mapping with names as text."""
    if not isinstance(data, dict):
        raise ParameterError(what, data, f"a mapping with the sections {sections}", where=source)
    odd = next((key for key in data if not isinstance(key, str)), None)
    if odd is not None:
        raise ParameterError(what, odd, "names as text", where=source)
    return data


def place(source: str, lines: Mapping[str, int], path: str) -> str:
    """File and line of a field; for one that is missing, of the section it belongs to."""
    while path and path not in lines:
        cut = max(path.rfind("."), path.rfind("["), 0)
        path = path[:cut]
    line = lines.get(path)
    return f"{source}:{line}" if line else source


def _sentence(error: TextError) -> str:
    text = str(error).rstrip(".")
    return text[0].upper() + text[1:] + "."


def _no_such_file(source: str, what: str, sources: str, known: Sequence[str]) -> ParameterError:
    near, beside = nearest(Path(source).stem, known), missing(Path(source))
    meant = "Did you mean" in beside or not near
    return ParameterError(what, source, sources, hint=beside if meant else f"Did you mean {near!r}?")
