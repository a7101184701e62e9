"""The title block of a report, from the section `document` of a case."""

from __future__ import annotations

from frahm.case import Case, field_values


def document_rows(case: Case) -> list[tuple[str, str]]:
    """Title and text of every field of the title block that is filled in; none for a case without one."""
    return [
        (field.facts.title, str(field.value))
        for field in field_values(case)
        if field.path.startswith("document.") and field.value
    ]
