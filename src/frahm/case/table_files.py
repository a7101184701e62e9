"""Tables a case refers to by file name, read beside the case file."""

from __future__ import annotations

import contextlib
import contextvars
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from frahm.case.quantities import refusal
from frahm.errors import ParameterError, nearest, shown
from frahm.tables import Table, read_table_file
from frahm.units import si_value

_LARGEST = 4 * 1024 * 1024
_MOST_ROWS = 100_000
_ALLOWED = "rows, or the name of a text, MAT or netCDF file with a table"
_folder: contextvars.ContextVar[Path] = contextvars.ContextVar("_folder", default=Path())


@dataclass(frozen=True)
class Column:
    """A column of numbers.

    Attributes
    ----------
    name : str
        In the head of the file, where a unit may follow in brackets.
    unit : str
        SI unit the numbers come in as, and are taken to be in where the head names none.
    required : bool
        Whether the file must have it.
    say_unit : bool
        Whether the head must name the unit.
    """

    name: str
    unit: str
    required: bool = True
    say_unit: bool = False


@contextlib.contextmanager
def files_beside(path: Path) -> Iterator[None]:
    """Inside this block the names of tables are relative to the folder of `path`."""
    token = _folder.set(path.parent)
    try:
        yield
    finally:
        _folder.reset(token)


def beside(name: str | Path) -> Path:
    """Path of a file named in the file that is being read."""
    return _folder.get() / name


def table_names(name: str) -> list[str]:
    """Names of the columns of a table, in small letters; to be called by validators."""
    return [head.lower() for head in _table(name).heads]


def table_rows(name: str, columns: Sequence[Column]) -> list[dict[str, float]]:
    """Rows of a table as numbers in SI units, by column name; to be called by validators.

    Parameters
    ----------
    name : str
        Text, MAT or netCDF file, relative to the folder of the case file, with the names of the columns; see
        `frahm.tables`. The vectors of a MAT file are in SI units.
    columns : sequence of Column
        The columns there may be. A netCDF file may have others beside them.
    """
    table = _table(name)
    if len(table.columns[0]) > _MOST_ROWS:
        raise refusal(f"a table of 1 to {_MOST_ROWS} rows", hint=f"{name} has {len(table.columns[0])}.")
    found = _factors(name, table, columns)
    for index, (title, _) in found.items():
        wrong = np.flatnonzero(~np.isfinite(table.columns[index]))
        if wrong.size:
            value = float(table.columns[index][wrong[0]])
            hint = f"{table.place(int(wrong[0]))}: {title}: given {value!r}."
            raise refusal("a finite number in every cell", hint=hint)
    titles = [title for title, _ in found.values()]
    numbers = [(factor * table.columns[index]).tolist() for index, (_, factor) in found.items()]
    return [dict(zip(titles, row, strict=True)) for row in zip(*numbers, strict=True)]


def _table(name: str) -> Table:
    try:
        return read_table_file(beside(name), label=name, allowed=_ALLOWED, largest=_LARGEST)
    except ParameterError as error:
        hint = error.hint or ""
        if error.where:
            hint = f"{error.where}: {error.name}: given {shown(error.value)}. {hint}".rstrip()
        elif hint:
            hint = f"{name}: {hint}"
        raise refusal(error.allowed, hint=hint or None) from None


def _factors(name: str, table: Table, columns: Sequence[Column]) -> dict[int, tuple[str, float]]:
    """Name of every column that counts, and the factor that brings it into SI units, by its place in the table."""
    known = {column.name: column for column in columns}
    allowed = "columns " + ", ".join(f"{column.name}{'' if column.required else ' (optional)'}" for column in columns)
    found: dict[int, tuple[str, float]] = {}
    for index, (title, unit) in enumerate(_titles(table)):
        if title not in known and table.has_others:
            continue
        if title not in known or title in [given for given, _ in found.values()]:
            near = nearest(title, known) if title not in known else None
            hint = f" Did you mean {near!r}?" if near else ""
            raise refusal(allowed, hint=f"{name} has a column {title!r}{'' if title not in known else ' twice'}.{hint}")
        column = known[title]
        if not unit and column.say_unit:
            raise refusal(allowed, hint=f"{name}: say the unit of {title}, as in '{title} [deg]'.")
        try:
            found[index] = title, si_value(f"1 {unit}", column.unit) if unit not in ("", "-", "1") else 1.0
        except ParameterError as error:
            raise refusal(allowed, hint=f"{name}: column {title!r}: {error.hint or error.allowed}") from None
    missing = [column.name for column in columns if column.required and column.name not in dict(found.values())]
    if missing:
        others = ", ".join(f"{title} has {count}" for title, count in table.left_out.items())
        others = f" Left out, because {len(table.columns[0])} rows are the most: {others}." if others else ""
        raise refusal(allowed, hint=f"{name} has no column {' or '.join(missing)}.{others}")
    return found


def _titles(table: Table) -> Iterator[tuple[str, str]]:
    """Names in small letters and units of the columns; dates are the time, whatever they are called."""
    for index, (head, unit) in enumerate(zip(table.heads, table.units, strict=True)):
        yield ("time" if index in table.starts else head.lower()), unit
