"""CSV and MAT in: tables a case refers to by file name, read beside the case file."""

from __future__ import annotations

import contextlib
import contextvars
import csv
import io
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from pydantic_core import PydanticCustomError

from frahm.case.quantities import refusal
from frahm.errors import ParameterError, nearest
from frahm.units import si_value

_LARGEST = 4 * 1024 * 1024
_MOST_ROWS = 100_000
_HEAD = re.compile(r"\s*([^\[\]()]*?)\s*(?:[\[(]\s*([^\[\]()]*?)\s*[\])])?\s*")
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


def csv_names(name: str) -> list[str]:
    """Names of the columns of a CSV file, without their units; to be called by validators."""
    lines = _lines(name)
    head = lines[0][1] if lines else ""
    cells = next(csv.reader([head], delimiter=_separator(head)), [])
    return [match[1].lower() if (match := _HEAD.fullmatch(cell.strip())) else cell for cell in cells]


def csv_rows(name: str, columns: Sequence[Column]) -> list[dict[str, float]]:
    """Rows of a CSV or MAT file as numbers in SI units, by column name; to be called by validators.

    Parameters
    ----------
    name : str
        File, relative to the folder of the case file. Comma or semicolon between cells, full stop in numbers, names
        of the columns in the first line, lines that start with # left out. A name that ends in .mat is a MAT file of
        version 5 with a vector for every column, in SI units.
    columns : sequence of Column
        The columns there may be.
    """
    if name.lower().endswith(".mat"):
        return _mat_rows(name, columns)
    lines = _lines(name)
    cells = [line for _, line in lines]
    reader = csv.reader(io.StringIO("\n".join(cells)), delimiter=_separator(cells[0] if cells else ""))
    table = [[cell.strip() for cell in row] for row in reader]
    if len(table) < 2 or len(table) > _MOST_ROWS:
        raise refusal(
            f"a CSV file with a head and 1 to {_MOST_ROWS} rows", hint=f"{name} has {max(len(table) - 1, 0)}."
        )
    factors = _factors(name, table[0], columns)
    rows = []
    for (number, _), row in zip(lines[1:], table[1:], strict=False):
        if len(row) != len(table[0]):
            raise refusal(f"{len(table[0])} cells in every row", hint=f"{name}:{number} has {len(row)}.")
        values = zip(factors, row, strict=True)
        rows.append({column: factor * _number(name, number, column, cell) for (column, factor), cell in values})
    return rows


def _mat_rows(name: str, columns: Sequence[Column]) -> list[dict[str, float]]:
    vectors = {title.lower(): values for title, values in _mat_vectors(name).items()}
    _factors(name, list(vectors), columns)
    lengths = {title: len(values) for title, values in vectors.items()}
    if len(set(lengths.values())) != 1 or not 1 <= max(lengths.values()) <= _MOST_ROWS:
        said = ", ".join(f"{title} has {count}" for title, count in lengths.items())
        raise refusal(f"vectors of one length, 1 to {_MOST_ROWS}", hint=f"{name}: {said}.")
    rows = [dict(zip(vectors, row, strict=True)) for row in zip(*vectors.values(), strict=True)]
    for number, row in enumerate(rows, 1):
        for title, value in row.items():
            _number(name, number, title, repr(value))
    return rows


def _mat_vectors(name: str) -> dict[str, list[float]]:
    """Numeric vectors of a MAT file, by name; anything else in it is left out."""
    import numpy as np
    import scipy.io

    allowed, path = "rows, or the name of a CSV file or of a MAT file of version 5", _folder.get() / name
    try:
        if path.stat().st_size > _LARGEST:
            raise refusal(f"a MAT file of at most {_LARGEST // 2**20} MB")
        content = scipy.io.loadmat(path)
    except NotImplementedError:
        raise refusal(allowed, hint=f"{name} is of version 7.3: in MATLAB, save it with the option -v7.") from None
    except PydanticCustomError:
        raise
    except (OSError, ValueError, TypeError, IndexError, scipy.io.matlab.MatReadError) as error:
        raise refusal(allowed, hint=f"{name}: {getattr(error, 'strerror', None) or error}.") from None
    found = {
        title: np.asarray(values, float).ravel().tolist()
        for title, values in content.items()
        if not title.startswith("__") and isinstance(values, np.ndarray) and values.dtype.kind in "iuf"
    }
    if not found:
        raise refusal(allowed, hint=f"{name} holds no vector of numbers.")
    return found


def _separator(head: str) -> str:
    return ";" if head.count(";") > head.count(",") else ","


def _lines(name: str) -> list[tuple[int, str]]:
    """Lines with something on them, and their numbers."""
    try:
        with beside(name).open("rb") as stream:
            raw = stream.read(_LARGEST + 1)
        if len(raw) > _LARGEST:
            raise refusal(f"a CSV file of at most {_LARGEST // 2**20} MB")
        text = raw.decode("utf-8-sig")
    except OSError as error:
        raise refusal("rows, or the name of a CSV file", hint=f"{name}: {error.strerror or error}.") from None
    except PydanticCustomError:
        raise
    except ValueError:
        raise refusal("a CSV file in UTF-8", hint=f"{name} is not text in UTF-8.") from None
    numbered = enumerate(text.splitlines(), start=1)
    return [(number, line) for number, line in numbered if line.strip() and not line.lstrip().startswith("#")]


def _factors(name: str, head: Sequence[str], columns: Sequence[Column]) -> list[tuple[str, float]]:
    """Name of every column of the file and the factor that brings it into SI units."""
    known = {column.name: column for column in columns}
    allowed = "columns " + ", ".join(f"{column.name}{'' if column.required else ' (optional)'}" for column in columns)
    found: list[tuple[str, float]] = []
    for cell in head:
        match = _HEAD.fullmatch(cell)
        title, unit = (match[1].lower(), match[2] or "") if match else (cell, "")
        if title not in known or title in dict(found):
            near = nearest(title, known) if title not in known else None
            hint = f" Did you mean {near!r}?" if near else ""
            raise refusal(allowed, hint=f"{name} has a column {cell!r}{'' if title not in known else ' twice'}.{hint}")
        column = known[title]
        if not unit and column.say_unit:
            raise refusal(allowed, hint=f"{name}: say the unit of {title}, as in '{title} [deg]'.")
        try:
            found.append((title, si_value(f"1 {unit}", column.unit) if unit and unit != "-" else 1.0))
        except ParameterError as error:
            raise refusal(allowed, hint=f"{name}: column {cell!r}: {error.hint or error.allowed}") from None
    missing = [column.name for column in columns if column.required and column.name not in dict(found)]
    if missing:
        raise refusal(allowed, hint=f"{name} has no column {' or '.join(missing)}.")
    return found


def _number(name: str, line: int, column: str, cell: str) -> float:
    try:
        value = float(cell)
        if math.isfinite(value):
            return value
    except ValueError:
        pass
    hint = " Write the full stop as decimal sign." if "," in cell else ""
    raise refusal("a finite number in every cell", hint=f"{name}:{line}: {column} is {cell!r}.{hint}")
