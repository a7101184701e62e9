"""What all sections of a case have in common."""

from __future__ import annotations

from typing import ClassVar

from pydantic import BaseModel, ConfigDict


class CaseSection(BaseModel):
    """A frozen part of a case that refuses names it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    is_default_kind: ClassVar[bool] = False  # of a section that comes in several kinds: what it is if no kind is said
