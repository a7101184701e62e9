"""What all sections of a case have in common."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict


class Section(BaseModel):
    """A frozen part of a case that refuses names it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True)
