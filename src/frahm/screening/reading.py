"""A table of members as rows of values, each with where it stands; what cannot be read of a row is said, row by row."""

from __future__ import annotations

import difflib
import hashlib
import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any

from frahm.errors import ParameterError, nearest
from frahm.screening.columns import BY_NAME, COLUMNS, MemberColumn, column_called, known_names, plain_name
from frahm.tables import Cells, are_units, name_and_unit, number_of, read_cells
from frahm.units import si_value, with_unit

EXAMPLE = "members-example"
ALLOWED = f"{EXAMPLE}, or a CSV or XLSX file"
_SEARCHED = 20  # rows in which the head is looked for
_ALIKE = 0.8  # from which on an unknown head is taken for a misspelt one
_MOST = 5000  # members
_FEWEST = 2  # known names that make a row the head
Value = str | float


@dataclass(frozen=True)
class MemberRow:
    """One row of the table.

    Attributes
    ----------
    place : str
        File and line.
    name : str
        Of the member; empty where the row has none.
    values : dict
        By the name of the column: text for a case, with its unit where it has one; what is empty is left out.
    problem : str
        Why the row cannot be read; empty if it can.
    """

    place: str
    name: str
    values: Mapping[str, Value] = field(default_factory=dict)
    problem: str = ""


@dataclass(frozen=True)
class MemberTable:
    """What a table of members says.

    Attributes
    ----------
    source : str
        Name of the file.
    rows : tuple of MemberRow
    columns : tuple of str
        Names of the columns read.
    ignored : tuple of str
        Heads of the columns that are none of a member, and were not read.
    """

    source: str
    rows: tuple[MemberRow, ...]
    columns: tuple[str, ...]
    ignored: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        """Name of the file without its folder."""
        return Path(self.source).name

    @property
    def digest(self) -> str:
        """SHA-256 of the values, whatever file they came in."""
        content = [[row.name, row.problem and row.place, dict(row.values)] for row in self.rows]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def read_members(table: Any) -> MemberTable:
    """The members of a table.

    Parameters
    ----------
    table : str, Path or sequence of mapping
        The built-in table, a CSV or XLSX file, or rows as dictionaries by the names of the columns.

    Raises
    ------
    ParameterError
        If there is no such file or it is damaged, a column is missing, twice there or misspelt, a unit is unknown, two
        members have one name, or there are no rows.
    """
    if isinstance(table, MemberTable):
        return table
    if isinstance(table, str) and table == EXAMPLE:
        with resources.as_file(resources.files("frahm.screening") / "builtin" / f"{EXAMPLE}.csv") as path:
            return _of_cells(read_cells(path, label=EXAMPLE))
    if isinstance(table, str | os.PathLike):
        if not Path(table).suffix and (near := nearest(str(table), [EXAMPLE])):
            raise ParameterError("members", str(table), ALLOWED, hint=f"Did you mean {near!r}?")
        return _of_cells(read_cells(table, allowed=ALLOWED))
    if hasattr(table, "to_dict") and hasattr(table, "columns"):
        table = table.to_dict(orient="records")
    if isinstance(table, Sequence) and all(isinstance(row, Mapping) for row in table):
        return _of_cells(_cells_of(table))
    raise ParameterError("members", table, ALLOWED + ", or a sequence of dictionaries, one a member")


def _cells_of(rows: Sequence[Mapping[Any, Any]]) -> Cells:
    """Dictionaries as a table, numbered from 1."""
    heads = list(dict.fromkeys(str(key) for row in rows for key in row))
    body = [tuple(_cell(row.get(head)) for head in heads) for row in rows]
    plain = tuple(head if name_and_unit(head)[1] else f"{head} [SI]" for head in heads)
    return Cells("row", tuple(range(len(rows) + 1)), (plain, *body), comma_is_decimal=True)


def _cell(value: Any) -> Value:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return str(value) if isinstance(value, str | bool) else float(value) if _is_real(value) else str(value)


def _is_real(value: Any) -> bool:
    try:
        return math.isfinite(float(value))
    except (TypeError, ValueError):
        return False


@dataclass(frozen=True)
class _Head:
    """A column that is read: where it stands, what it is, and the unit of its numbers."""

    place: int
    column: MemberColumn
    unit: str


def _of_cells(cells: Cells) -> MemberTable:
    start = _head_row(cells)
    names = [name_and_unit(str(cell).strip()) for cell in cells.rows[start]]
    while not names[-1][0]:  # a sign between columns at the end of the line
        names.pop()
    first = start + 1
    if first < len(cells.rows) and are_units([str(cell).strip() for cell in cells.rows[first]]):
        said = [str(cell).strip("[]() ") for cell in cells.rows[first]] + [""] * len(names)
        names = [(name, unit or said[i]) for i, (name, unit) in enumerate(names)]
        first += 1
    heads, ignored = _heads(cells.source, names)
    _check_complete(cells.source, heads, [name for name, _ in names])
    reader = _Rows(cells, heads, len(names))
    rows = tuple(reader.row(i) for i in range(first, len(cells.rows)))
    if not rows:
        raise ParameterError("members", cells.source, "a table with at least one member below its head")
    if len(rows) > _MOST:
        raise ParameterError("members", f"{len(rows)} rows", f"at most {_MOST} members")
    _check_names(rows)
    return MemberTable(cells.source, rows, tuple(head.column.name for head in heads), tuple(ignored))


def _head_row(cells: Cells) -> int:
    """The row with the names of the columns: the first with two of them."""
    for i, row in enumerate(cells.rows[:_SEARCHED]):
        if sum(column_called(name_and_unit(str(cell))[0]) is not None for cell in row) >= _FEWEST:
            return i
    needed = ", ".join(column.name for column in COLUMNS if column.required)
    raise ParameterError("members", cells.source, f"a table with the columns {needed} in its head",
                         hint="No row has these names: frahm new FILE --members writes a table that does.")  # fmt: skip


def _heads(source: str, names: Iterable[tuple[str, str]]) -> tuple[list[_Head], list[str]]:
    heads: list[_Head] = []
    ignored: list[str] = []
    for place, (name, unit) in enumerate(names):
        column = column_called(name)
        if column is None:
            if name:
                _check_spelling(source, name)
                ignored.append(name)
            continue
        if column in [head.column for head in heads]:
            raise ParameterError("members", name, f"the column {column.name} once", where=source)
        heads.append(_Head(place, column, _unit(source, column, unit)))
    return heads, ignored


def _check_spelling(source: str, name: str) -> None:
    """Refuse a head that is nearly one of a member: it would be left out silently."""
    close = difflib.get_close_matches(plain_name(name), known_names(), n=1, cutoff=_ALIKE)
    if close:
        hint = f"Did you mean {close[0]!r}? A column that is something else needs another name."
        raise ParameterError("members", name, "names of columns as frahm new FILE --members writes them",
                             where=source, hint=hint)  # fmt: skip


def _unit(source: str, column: MemberColumn, unit: str) -> str:
    """Unit of the numbers of a column; SI where a table in Python names none."""
    if unit == "SI":
        return column.unit
    if column.text or unit in ("", "-", "1"):
        return ""
    try:
        si_value(f"1 {unit}", column.unit)
    except ParameterError as error:
        raise ParameterError("members", f"{column.name} [{unit}]", with_unit(column.unit), where=source,
                             hint=error.hint) from None  # fmt: skip
    return unit


def _check_complete(source: str, heads: Sequence[_Head], given: Sequence[str]) -> None:
    there = [head.column.name for head in heads]
    missing = [column for column in COLUMNS if column.required and column.name not in there]
    beside = [("weibull scale", other) for other in ("weibull shape", "design life") if "weibull scale" in there]
    missing += [BY_NAME[other] for _, other in beside if other not in there]
    if not missing:
        return
    first = missing[0]
    others = [name for name in given if name and column_called(name) is None]
    near = nearest(first.name, [plain_name(name) for name in others])
    hint = (
        f"Is it the column {near!r}?"
        if near
        else f"Also known as {', '.join(first.aliases)}."
        if first.aliases
        else None
    )
    words = ", ".join(column.head for column in missing)
    raise ParameterError("members", source, f"a table with the column{'s' * (len(missing) > 1)} {words}", hint=hint)


def _check_names(rows: Sequence[MemberRow]) -> None:
    seen: dict[str, str] = {}
    for row in rows:
        if row.name and row.name in seen:
            raise ParameterError("name", row.name, "a name no other member has", where=row.place,
                                 hint=f"The member at {seen[row.name]} has it, too.")  # fmt: skip
        seen.setdefault(row.name, row.place)


@dataclass
class _Rows:
    """Reads the rows below the head; the decimal sign met first holds for the whole file."""

    cells: Cells
    heads: Sequence[_Head]
    width: int
    mark: str = ""

    def row(self, index: int) -> MemberRow:
        """One row, or why it cannot be read."""
        found, place = list(self.cells.rows[index]), self.cells.place(index)
        while len(found) > self.width and found[-1] == "":
            found.pop()
        named = next((head.place for head in self.heads if head.column.name == "name"), 0)
        name = _named(found[named]) if named < len(found) else ""
        try:
            if len(found) > self.width or (len(found) < self.width and not self.cells.sheet):
                more = len(found) > self.width and not self.cells.comma_is_decimal
                hint = "Decimal commas need semicolons between the columns." if more else None
                raise ParameterError("row", f"{len(found)} cells", f"{self.width}, as in the head", hint=hint)
            if not name:
                raise ParameterError("name", "", "a name in every row")
            return MemberRow(place, name, dict(self._values(found)))
        except ParameterError as error:
            return MemberRow(place, name, problem=str(error))

    def _values(self, found: Sequence[Value]) -> Iterator[tuple[str, Value]]:
        for head in self.heads:
            cell = found[head.place] if head.place < len(found) else ""
            cell = cell.strip() if isinstance(cell, str) else cell
            if cell in ("", "-") and not head.column.required:
                continue
            if cell == "":
                raise ParameterError(head.column.name, "nothing", "a value in every row")
            yield head.column.name, self._value(head, cell)

    def _value(self, head: _Head, cell: Value) -> Value:
        """Text or a number for the case, a number with its unit."""
        column = head.column
        number = cell if isinstance(cell, float) else self._number(column, cell)
        if number is None:
            return _worded(column, str(cell))
        if column.text and column.name != "ends":
            return _named(cell)
        if column.name == "ends" or (not column.unit and not head.unit):
            return number
        if not head.unit:
            hint = f"Say the unit in the head, as in {column.head!r}, or in the cell."
            raise ParameterError(column.name, cell, with_unit(column.unit), hint=hint)
        return number if head.unit == column.unit else f"{number:.15g} {head.unit}"

    def _number(self, column: MemberColumn, text: str) -> float | None:
        number = number_of(text, comma=self.cells.comma_is_decimal)
        if number is None or not math.isfinite(number):
            return None
        mark = "," if "," in text else "." if "." in text else ""
        if mark and self.mark and mark != self.mark:
            hint = f"Rows above have the sign {self.mark!r}."
            raise ParameterError(column.name, text, "one decimal sign in the whole table", hint=hint)
        self.mark = self.mark or mark
        return number


def _worded(column: MemberColumn, text: str) -> Value:
    """A cell that is no number: words, or a number with a unit of its own."""
    if column.text or column.name in ("strouhal", "lift coefficient"):
        return text
    if column.name == "modes":
        raise ParameterError(column.name, text, "a whole number")
    plain = text.replace(",", ".", 1) if "." not in text else text
    si_value(plain, column.unit, name=column.name)
    return plain


def _named(cell: Value) -> str:
    """A name that a spreadsheet may take for a number."""
    return f"{cell:.15g}" if isinstance(cell, float) else str(cell).strip()
