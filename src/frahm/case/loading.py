"""`load_case`: the one door through which a case comes in."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from frahm.case.case import Case
from frahm.case.csv_text import files_beside
from frahm.case.problems import parameter_error
from frahm.case.toml_text import read_toml
from frahm.case.yaml_text import TextError, read_yaml, yaml_text
from frahm.errors import ParameterError, nearest

_LARGEST = 256 * 1024
_TEMPLATE = "jacket-pipe"
_READERS: dict[str, Callable[[str], tuple[Any, dict[str, int]]]] = {
    ".yaml": read_yaml, ".yml": read_yaml, ".toml": read_toml,
}  # fmt: skip
_SOURCES = "the name of a built-in case ({}), or a .yaml, .yml or .toml file"


def load_case(source: Any) -> Case:
    """Return the case of a built-in name, a file, or a dictionary.

    Parameters
    ----------
    source : str, Path, dict or Case
        Built-in name such as ``"jacket-pipe"``, YAML 1.2 or TOML file, nested dictionary, or a case. Numbers are
        SI, texts carry their unit (``"0.78 Hz"``).

    Returns
    -------
    Case
        Validated and frozen, in SI units.

    Raises
    ------
    ParameterError
        With file and line, path of the field, value given, what is allowed, and the nearest name for a typo.
    """
    if isinstance(source, Case):
        return source
    if isinstance(source, Mapping):
        return _from_data(dict(source))
    if not isinstance(source, str | os.PathLike) or isinstance(os.fspath(source), bytes):
        raise ParameterError("case", source, _sources() + ", a dictionary or a frahm.Case")
    if isinstance(source, str) and source in builtin_names():
        return _builtin(source)
    return _from_file(source)


@functools.cache
def builtin_names() -> tuple[str, ...]:
    """Names of the cases that come with frahm."""
    folder = resources.files("frahm.case") / "builtin"
    return tuple(sorted(entry.name.removesuffix(".yaml") for entry in folder.iterdir() if entry.name.endswith(".yaml")))


def builtin_text(name: str) -> str:
    """Commented YAML text of a built-in case."""
    if name not in builtin_names():
        raise ParameterError("case", name, "one of " + ", ".join(builtin_names()))
    return (resources.files("frahm.case") / "builtin" / f"{name}.yaml").read_text(encoding="utf-8")


def template_text(name: str) -> str:
    """Commented YAML text of a case to start from, under the name given."""
    heading = yaml_text({"name": name, "title": "Say here in one line what the case is"}).rstrip("\n")
    lines = builtin_text(_TEMPLATE).splitlines()
    return "\n".join(heading if line.startswith("name:") else line for line in lines if line[:6] != "title:") + "\n"


@functools.cache
def _builtin(name: str) -> Case:
    data, lines = read_yaml(builtin_text(name))
    return _from_data(data, name, lines)


def _sources() -> str:
    return _SOURCES.format(", ".join(builtin_names()))


def case_from_text(text: str, name: str) -> Case:
    """Case of the text of a YAML or TOML file, which of the two its `name` says.

    Raises
    ------
    ParameterError
        As `load_case`, with `name` as the file.
    """
    if Path(name).suffix.lower() not in _READERS:
        raise ParameterError("case", name, _sources(), hint=f"The ending {Path(name).suffix!r} is not known.")
    if len(text.encode()) > _LARGEST:
        raise ParameterError("case", name, f"a case file of at most {_LARGEST // 1024} kB")
    return _from_text(text, name)


def _from_file(source: str | os.PathLike[str]) -> Case:
    return _from_text(_text(source), source)


def _from_text(text: str, source: str | os.PathLike[str]) -> Case:
    try:
        data, lines = _READERS[Path(source).suffix.lower()](text)
    except TextError as error:
        where = f"{source}:{error.line}" if error.line else str(source)
        raise ParameterError("case", Path(source).name, "a case file", where=where, hint=_sentence(error)) from None
    if data is None or data == {}:
        raise ParameterError("case", "an empty file", "a file with at least pipe and wind", where=str(source))
    with files_beside(Path(source)):
        return _from_data(data, str(source), lines)


def _sentence(error: TextError) -> str:
    text = str(error).rstrip(".")
    return text[0].upper() + text[1:] + "."


def _text(source: str | os.PathLike[str]) -> str:
    """Text of a case file, or the error that says why there is none."""
    path, refuse = Path(source), functools.partial(ParameterError, "case", str(source))
    try:
        if not str(source) or not path.exists():
            raise _no_such_file(str(source))
        if path.is_dir():
            raise refuse(_sources(), hint="This is a directory.")
        if not path.is_file():
            raise refuse(_sources(), hint="This is not a regular file.")
        if path.suffix.lower() not in _READERS:
            raise refuse(_sources(), hint=f"The ending {path.suffix!r} is not known.")
        with path.open("rb") as stream:
            raw = stream.read(_LARGEST + 1)
    except OSError as error:
        raise refuse(_sources(), hint=f"{error.strerror or error}.") from None
    except ValueError as error:
        raise error if isinstance(error, ParameterError) else refuse(_sources(), hint=f"{error}.") from None
    if len(raw) > _LARGEST:
        raise refuse(f"a case file of at most {_LARGEST // 1024} kB", hint="This file is larger.")
    try:
        if b"\0" in raw:
            raise ValueError
        return raw.decode("utf-8-sig")
    except ValueError:
        raise refuse("a text file in UTF-8", hint="This file is not text in UTF-8.") from None


def _no_such_file(source: str) -> ParameterError:
    near = nearest(Path(source).stem, builtin_names())
    hint = f"Did you mean {near!r}?" if near else None
    if near is None and Path(source).suffix:
        hint = "There is no such file."
    return ParameterError("case", source, _sources(), hint=hint)


def _from_data(data: Any, source: str | None = None, lines: Mapping[str, int] | None = None) -> Case:
    if not isinstance(data, dict):
        allowed = "a mapping with the sections pipe, wind, absorbers, climate, fatigue, design, analysis"
        raise ParameterError("case", data, allowed, where=source)
    odd = next((key for key in data if not isinstance(key, str)), None)
    if odd is not None:
        raise ParameterError("case", odd, "names as text", where=source)
    try:
        return Case(**data)
    except ParameterError as error:
        if source is None or not isinstance(error.__cause__, ValidationError):
            raise error from None
        raise parameter_error(error.__cause__, Case, functools.partial(_place, source, lines or {})) from None


def _place(source: str, lines: Mapping[str, int], path: str) -> str:
    """File and line of a field; for one that is missing, of the section it belongs to."""
    while path and path not in lines:
        cut = max(path.rfind("."), path.rfind("["), 0)
        path = path[:cut]
    line = lines.get(path)
    return f"{source}:{line}" if line else source
