"""`load_study`: the one door through which a study comes in."""

from __future__ import annotations

import os
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Any

from frahm.case.documents import document_data, document_text
from frahm.case.problems import model_from_data
from frahm.case.table_files import files_beside
from frahm.case.yaml_text import yaml_text
from frahm.errors import ParameterError
from frahm.sweep.study import Study

_SOURCES = "a .yaml, .yml or .toml file of a study"
_SECTIONS = "case, axes, quantities"


def load_study(source: Any) -> Study:
    """Return the study of a file or a dictionary.

    Parameters
    ----------
    source : str, Path, dict or Study
        YAML 1.2 or TOML file, nested dictionary, or a study. Numbers are SI, texts carry their unit (``"0.78 Hz"``).

    Returns
    -------
    Study
        Validated and frozen, in SI units.

    Raises
    ------
    ParameterError
        With file and line, path of the field, value given, what is allowed, and the nearest name for a typo.
    """
    if isinstance(source, Study):
        return source
    if isinstance(source, Mapping):
        return _from_data(dict(source))
    if not isinstance(source, str | os.PathLike) or isinstance(os.fspath(source), bytes):
        raise ParameterError("study", source, f"{_SOURCES}, a dictionary or a frahm.Study")
    data, lines = document_data(document_text(source, "study", _SOURCES), source, "study", "case, axes and quantities")
    with files_beside(Path(source)):
        return _from_data(data, str(source), lines)


def study_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of a study file."""
    schema = Study.model_json_schema(mode="validation")
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "frahm study"}


def study_template(name: str) -> str:
    """Commented YAML text of a small study to start from, under the name given."""
    text = (resources.files("frahm.sweep") / "template.yaml").read_text(encoding="utf-8")
    heading = yaml_text({"name": name}).rstrip("\n")
    return "\n".join(heading if line.startswith("name:") else line for line in text.splitlines()) + "\n"


def _from_data(data: Any, source: str | None = None, lines: Mapping[str, int] | None = None) -> Study:
    return model_from_data(Study, data, "study", _SECTIONS, source, lines)
