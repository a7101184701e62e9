"""One implausible value, and the fields of a case with what is needed to judge them."""

from __future__ import annotations

import functools
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from frahm.case import Case, field_values


@dataclass(frozen=True)
class Implausible:
    """A value of a case that is let in, but that a practised engineer would ask about.

    Attributes
    ----------
    name : str
        Path of the field, such as ``pipe.diameter``.
    value : object
        What the case holds, in SI units.
    given : str
        The value as it was typed, or as a number with its SI unit.
    reason : str
        One or two sentences: the number it is judged by and where that comes from, and what may have been meant.
    """

    name: str
    value: Any
    given: str
    reason: str

    def __str__(self) -> str:
        return f"{self.name} = {self.given}: {self.reason}"


@dataclass(frozen=True, eq=False)
class Inputs:
    """The fields of a case by path."""

    case: Case

    @functools.cached_property
    def values(self) -> dict[str, Any]:
        """Every field of the case, as `field_values` lists them, by its path."""
        return {field.path: field for field in field_values(self.case)}

    def implausible(self, path: str, reason: str, units: Iterable[str] = ()) -> Implausible:
        """The field at a path with a reason; `units` are what may have been meant by a plain number."""
        field = self.values[path]
        unit = field.facts.unit
        number = _text(field.value)
        given = field.typed or (number + (f" {unit}" if unit else ""))
        meant = [f"{number} {other}" for other in units] if self.bare(path) else []
        question = f" Was {' or '.join(meant)} meant?" if meant else ""
        return Implausible(path, field.value, given, reason + question)

    def bare(self, path: str) -> bool:
        """Whether a field was given, and as a plain number."""
        field = self.values[path]
        return bool(field.given and field.typed is None and isinstance(field.value, float))


def _text(value: Any) -> str:
    if isinstance(value, tuple):
        return "[" + ", ".join(map(_text, value)) + "]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
