"""`load_case`: the one door through which a case comes in."""

from __future__ import annotations

import functools
import os
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from frahm.case.case import Case
from frahm.case.documents import LARGEST, READERS, document_data, document_text
from frahm.case.problems import model_from_data
from frahm.case.table_files import files_beside
from frahm.case.yaml_text import read_yaml, yaml_text
from frahm.errors import ParameterError, check_choice

TEMPLATE_KINDS = ("mode", "tube", "table")  # of the pipe, as a newcomer would call them
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


def template_text(name: str, kind: str = "mode") -> str:
    """Commented YAML text of a case to start from, under the name given.

    Parameters
    ----------
    name : str
        Name of the case.
    kind : {"mode", "tube", "table"}
        What is known of the pipe: one mode of vibration, the tube and its supports, or a table of modes.

    Raises
    ------
    ParameterError
        If there is no such kind.
    """
    check_choice("kind", kind, TEMPLATE_KINDS)
    text = (resources.files("frahm.case") / "templates" / f"{kind}.yaml").read_text(encoding="utf-8")
    heading = yaml_text({"name": name}).rstrip("\n")
    return "\n".join(heading if line.startswith("name:") else line for line in text.splitlines()) + "\n"


@functools.cache
def _builtin(name: str) -> Case:
    data, lines = read_yaml(builtin_text(name))
    return _from_data(data, name, lines)


def _sources() -> str:
    return _SOURCES.format(", ".join(builtin_names()))


def _sections() -> str:
    """Names of the sections of a case, those that must be there first."""
    names = [name for name in Case.model_fields if name not in ("name", "title")]
    return ", ".join(sorted(names, key=lambda name: not Case.model_fields[name].is_required()))


def case_from_text(text: str, name: str) -> Case:
    """Case of the text of a YAML or TOML file, which of the two its `name` says.

    Raises
    ------
    ParameterError
        As `load_case`, with `name` as the file.
    """
    if Path(name).suffix.lower() not in READERS:
        raise ParameterError("case", name, _sources(), hint=f"The ending {Path(name).suffix!r} is not known.")
    if len(text.encode()) > LARGEST:
        raise ParameterError("case", name, f"a case file of at most {LARGEST // 1024} kB")
    return _from_text(text, name)


def _from_file(source: str | os.PathLike[str]) -> Case:
    return _from_text(document_text(source, "case", _sources(), builtin_names()), source)


def _from_text(text: str, source: str | os.PathLike[str]) -> Case:
    data, lines = document_data(text, source, "case", "pipe and wind")
    with files_beside(Path(source)):
        return _from_data(data, str(source), lines)


def _from_data(data: Any, source: str | None = None, lines: Mapping[str, int] | None = None) -> Case:
    return model_from_data(Case, data, "case", _sections(), source, lines)
