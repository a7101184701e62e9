"""The JSON schema of a case file, for editors and forms."""

from __future__ import annotations

from typing import Any

from frahm.case.case import Case


def case_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of a case file: bounds, units, and text with a unit where it is let in."""
    schema = Case.model_json_schema(mode="validation")
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **schema,
        "title": "frahm case",
    }
