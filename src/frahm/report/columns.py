"""Columns of tables: the head of each beside what it shows and how that is written."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Column:
    """One column of a table.

    Attributes
    ----------
    head : str
    value : callable
        What it shows of a record.
    form : callable
        That as text ready to be read.
    """

    head: str
    value: Callable[[Any], Any]
    form: Callable[[Any], str] = str


def of(name: str) -> Callable[[Any], Any]:
    """What a record holds under a name."""
    return lambda record: record[name]


def yes_or_no(value: Any) -> str:
    """A truth in a table."""
    return "yes" if value else "no"


def heads(columns: Sequence[Column]) -> list[str]:
    """The head of a table."""
    return [column.head for column in columns]


def rows_of(columns: Sequence[Column], records: Iterable[Any]) -> list[tuple[str, ...]]:
    """A row of text for every record."""
    return [tuple(column.form(column.value(record)) for column in columns) for record in records]
