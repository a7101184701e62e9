"""Columns of a text file: what stands between them, their names and units, and their numbers, line by line."""

from __future__ import annotations

import contextlib
import csv
import datetime
import itertools
import math
import re
import sys
from array import array
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO, TypeVar

import numpy as np

from frahm.errors import ParameterError
from frahm.tables.cells import Cells
from frahm.tables.table import Table
from frahm.units import is_unit

_SAMPLE = 20  # lines that say how the table is laid out
_LONGEST = 1_000_000  # characters in a line
_COMMENT = re.compile(r"\s*[#%]")
_REMARK = re.compile(r'\s*"?#(\s|$)')  # where cells hold text a name may begin with the sign
_MINUS = "\N{MINUS SIGN}"
_NUMBER = re.compile(
    r"[-+]?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+)(?:e[-+]?[0-9]+)?|[-+]?(?:nan|inf|infinity)", re.ASCII | re.IGNORECASE
)
_DATE = re.compile(r"\d{4}-\d\d-\d\d(?:[T ]\d\d:\d\d.*)?", re.ASCII)
_HEAD = re.compile(r"([^\[\]()]*?)\s*(?:[\[(]\s*([^\[\]()]*?)\s*[\])])?")
Read = TypeVar("Read")
_SEPARATOR = re.compile(r"sep=(.)", re.IGNORECASE)  # a line that spreadsheets write above the table


def text_table(path: Path, label: str, largest: int) -> Table:
    """Table of a text file with columns apart by comma, semicolon, tab or blanks.

    Names and units stand in one line (``x [mm]``), in two, or nowhere. Numbers have a decimal point or, where the
    columns are not apart by commas, a decimal comma. A column of ISO dates becomes seconds since the first one.
    """
    return _decoded(path, label, lambda lines: _TableReader(label, lines).read())


def text_cells(path: Path, label: str, largest: int) -> Cells:
    """Cells of a text file as they stand, columns apart by comma, semicolon, tab or blanks."""
    return _decoded(path, label, lambda lines: _TableReader(label, lines).cells(), _REMARK)


def _decoded(
    path: Path, label: str, read: Callable[[Iterator[tuple[int, str]]], Read], comment: re.Pattern[str] = _COMMENT
) -> Read:
    """What is read of the lines of a file, in the first encoding that fits."""
    for encoding in _encodings(path):
        try:
            with path.open(encoding=encoding) as stream:
                return read(_numbered(stream, label, comment))
        except UnicodeDecodeError:
            continue
        except OSError as error:
            raise ParameterError("file", label, "a file that can be read", hint=f"{error.strerror or error}.") from None
    raise ParameterError("file", label, "a text file in UTF-8 or with one byte a letter")


def _encodings(path: Path) -> tuple[str, ...]:
    """UTF-8, or else what old programs write; spreadsheets write UTF-16 with a mark."""
    with path.open("rb") as stream:
        mark = stream.read(2)
    return ("utf-16",) if mark in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "cp1252", "latin-1")


def _numbered(stream: TextIO, label: str, comment: re.Pattern[str]) -> Iterator[tuple[int, str]]:
    """Lines with something in them, and their numbers."""
    for number in itertools.count(1):
        line = stream.readline(_LONGEST + 1)
        if not line:
            return
        if len(line) > _LONGEST:
            raise ParameterError("line", line, f"at most {_LONGEST} characters", where=f"{label}:{number}")
        if "\0" in line:
            raise ParameterError("file", label, "a text file", where=f"{label}:{number}", hint="It is not text.")
        text = line.strip(" \r\n")
        if text.strip(" \t;,") and not comment.match(text):
            yield number, text


@dataclass
class _TableReader:
    """Reads one table; only what is known about it is kept between the lines."""

    label: str
    lines: Iterator[tuple[int, str]]
    delimiter: str = " "
    heads: list[str] = field(default_factory=list)
    units: list[str] = field(default_factory=list)
    starts: dict[int, datetime.datetime] = field(default_factory=dict)
    mark: str = ""  # the decimal sign met so far

    def read(self) -> Table:
        """Read all lines."""
        sample = self._sample()
        rest = sample[self._read_heads(sample) :]
        numbers, places = array("d"), array("q")
        for number, line in itertools.chain(rest, self.lines):
            numbers.extend(self._row(number, line))
            places.append(number)
        if not places:
            raise ParameterError("file", self.label, "a table with at least one row of numbers")
        values = np.frombuffer(numbers, dtype=float).reshape(len(places), -1)
        return Table(
            self.label, tuple(self.heads), tuple(self.units), tuple(values.T), np.frombuffer(places, dtype=np.int64),
            {i: start.isoformat() for i, start in self.starts.items()},
        )  # fmt: skip

    def cells(self) -> Cells:
        """Read all lines as cells of text."""
        sample, lines, rows = self._sample(), [], []
        for number, line in itertools.chain(sample, self.lines):
            lines.append(number)
            rows.append(tuple(self._cells(number, line)))
        return Cells(self.label, tuple(lines), tuple(rows), comma_is_decimal=self.delimiter != ",")

    def _sample(self) -> list[tuple[int, str]]:
        """The first lines, and with them what stands between the columns."""
        sample = list(itertools.islice(self.lines, _SAMPLE))
        if sample and (asked := _SEPARATOR.fullmatch(sample[0][1])):
            self.delimiter, sample = asked[1], sample[1:]
        else:
            self.delimiter = _delimiter([line for _, line in sample])
        return sample

    def _read_heads(self, sample: Sequence[tuple[int, str]]) -> int:
        """Take names and units from the first lines; return how many of them there are."""
        rows = [self._cells(*entry) for entry in sample[:3]]
        if not rows:
            return 0
        count = 0 if any(map(_is_number, rows[0])) else 1 + (len(rows) > 1 and are_units(rows[1]))
        first = rows[count] if count < len(rows) else rows[0]
        head = rows[0] if count else [""] * len(first)
        width = max(len(head), 1)
        while width > 1 and not head[width - 1] and not "".join(first[width - 1 :]):
            width -= 1  # a delimiter at the end of the line
        self.heads, self.units = map(list, zip(*map(name_and_unit, head[:width]), strict=True))
        if count == 2:
            second = [cell.strip("[]() ") for cell in rows[1]] + [""] * width
            self.units = [unit or second[i] for i, unit in enumerate(self.units)]
        if count < len(rows):
            self._find_dates(sample[count][0], first[:width])
        return count

    def _find_dates(self, line: int, cells: Sequence[str]) -> None:
        for i, cell in enumerate(cells):
            if _DATE.fullmatch(cell):
                self.starts[i] = self._date(line, i, cell)
                self.units[i] = "s"

    def _row(self, number: int, line: str) -> list[float]:
        cells = line.split() if self.delimiter == " " else line.split(self.delimiter)
        # Nearly every line is of this kind: what float takes beyond the numbers allowed is ruled out beforehand.
        if len(cells) == len(self.heads) and self._is_plain(line):
            with contextlib.suppress(ValueError):
                row = list(map(float, cells))
                if math.isfinite(sum(row)):  # else a cell is too large for a number, or says nan or inf
                    self.mark = "." if "." in line else self.mark
                    return row
        return [self._number(number, i, cell) for i, cell in enumerate(self._of_width(number, line))]

    def _is_plain(self, line: str) -> bool:
        """Whether float reads the numbers of a line, and nothing it should not."""
        commas = self.mark == "," or (self.delimiter != "," and "," in line)
        return not (commas or self.starts or "_" in line) and line.isascii()

    def _of_width(self, number: int, line: str) -> list[str]:
        cells, width = self._cells(number, line), len(self.heads)
        if len(cells) > width and not "".join(cells[width:]):
            return cells[:width]
        if len(cells) != width:
            hint = None
            if self.delimiter == "," and len(cells) > width:
                hint = "Decimal commas need another sign between the columns, such as a semicolon."
            allowed = f"{width} cells in every row, as in the first one"
            raise ParameterError("row", f"{len(cells)} cells", allowed, where=f"{self.label}:{number}", hint=hint)
        return cells

    def _cells(self, number: int, line: str) -> list[str]:
        if self.delimiter == " ":
            return line.split()
        try:
            return [cell.strip() for cell in next(csv.reader([line], delimiter=self.delimiter))]
        except csv.Error as error:
            allowed = "cells that a CSV reader takes"
            raise ParameterError("row", line, allowed, where=f"{self.label}:{number}", hint=f"{error}.") from None

    def _number(self, line: int, column: int, cell: str) -> float:
        if column in self.starts:
            return (self._date(line, column, cell) - self.starts[column]).total_seconds()
        text = cell.replace(_MINUS, "-")
        comma = "," in text
        if not _NUMBER.fullmatch(text) or (comma and self.delimiter == ","):
            hint = "Write the full stop as decimal sign." if comma else None
            raise self._refusal(line, column, cell, "a number in every cell", hint)
        mark = "," if comma else "." if "." in text else ""
        if mark and self.mark and mark != self.mark:
            raise self._refusal(line, column, cell, "one decimal sign in the whole file",
                                f"Lines above have the sign {self.mark!r}.")  # fmt: skip
        self.mark = self.mark or mark
        value = float(text.replace(",", "."))
        if not math.isfinite(value) and any(map(str.isdigit, text)):  # nan and inf are said in words
            raise self._refusal(line, column, cell, f"a number of at most {sys.float_info.max:.2g} in size")
        return value

    def _date(self, line: int, column: int, cell: str) -> datetime.datetime:
        try:
            found = datetime.datetime.fromisoformat(cell)
        except ValueError:
            raise self._refusal(line, column, cell, "a date such as 2024-01-31T12:00:00") from None
        start = self.starts.get(column, found)
        if (found.tzinfo is None) != (start.tzinfo is None):
            raise self._refusal(line, column, cell, "a time zone in every date, or in none")
        return found

    def _refusal(self, line: int, column: int, cell: str, allowed: str, hint: str | None = None) -> ParameterError:
        name = self.heads[column] or f"column {column + 1}"
        return ParameterError(name, cell, allowed, where=f"{self.label}:{line}", hint=hint)


def _delimiter(lines: Sequence[str]) -> str:
    """What stands between the columns: the first of tab, semicolon and comma that is in most lines, or else blanks.

    Commas are decimal signs where what stands between blanks is a number, always.
    """
    found = next((mark for mark in "\t;," if 2 * sum(mark in line for line in lines) > len(lines)), " ")
    rows = [line.split() for line in lines[1:]] if found == "," else []
    return " " if rows and all(len(row) > 1 and all(map(_NUMBER.fullmatch, row)) for row in rows[-1:]) else found


def name_and_unit(head: str) -> tuple[str, str]:
    """Name and unit of a head such as ``length [m]`` or ``length (m)``; the unit is empty where it names none."""
    match = _HEAD.fullmatch(head)
    return (match[1], match[2] or "") if match else (head, "")


def number_of(cell: str, *, comma: bool) -> float | None:
    """Number of a cell of text, `comma` saying whether a comma may be its decimal sign; None if it is none."""
    text = cell.replace(_MINUS, "-")
    if not _NUMBER.fullmatch(text) or ("," in text and not comma):
        return None
    return float(text.replace(",", "."))


def _is_number(cell: str) -> bool:
    return bool(_NUMBER.fullmatch(cell.replace(_MINUS, "-")) or _DATE.fullmatch(cell))


def are_units(cells: Sequence[str]) -> bool:
    """Whether a second line says the units: each is one, nothing, or in brackets."""
    said = [cell for cell in cells if cell not in ("", "-", "1")]
    return bool(said) and all(cell[0] + cell[-1] in ("[]", "()") or is_unit(cell) for cell in said)
