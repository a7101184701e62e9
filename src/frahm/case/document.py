"""The section `document` of a case: what stands in the title block of its report."""

from __future__ import annotations

import datetime
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field

from frahm.case.quantities import FieldType, Label, refusal
from frahm.case.section import CaseSection


@dataclass(frozen=True)
class Date(FieldType):
    """A day of the calendar as text, 2026-03-31; empty for none."""

    @property
    def allowed(self) -> str:
        """What is let in."""
        return "a date as year-month-day, such as 2026-03-31"

    def read(self, value: Any) -> str:
        """The date as text; a date of TOML or of Python is let in too."""
        if value == "":
            return ""
        if isinstance(value, datetime.date) and not isinstance(value, datetime.datetime):
            return value.isoformat()
        try:
            # The written form only: fromisoformat also takes 20260331 and 2026-W14-2.
            return datetime.datetime.strptime(value, "%Y-%m-%d").date().isoformat()
        except (TypeError, ValueError):
            raise refusal(self.allowed) from None

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        return {"anyOf": [{"type": "string", "format": "date"}, {"const": ""}]}


class Document(CaseSection):
    """Title block: whose document this is, which revision of it, and who answers for it. All of it may be left out."""

    project: Annotated[str, Label()] = Field(default="", title="Project", description="Name of the project.")
    number: Annotated[str, Label()] = Field(default="", title="Document number", description="In the project.")
    revision: Annotated[str, Label()] = Field(default="", title="Revision", description="Letter or number, as text.")
    date: Annotated[str, Date()] = Field(default="", title="Date", description="Of the revision, as year-month-day.")
    prepared: Annotated[str, Label()] = Field(default="", title="Prepared by", description="Who made the calculation.")
    checked: Annotated[str, Label()] = Field(default="", title="Checked by", description="Who checked it.")
    approved: Annotated[str, Label()] = Field(default="", title="Approved by", description="Who approved it.")
