"""Tables and time series of other programs in: CSV, tab- or blank-delimited text, and MAT of version 5."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.arrays import Floats, labelled
from frahm.errors import ParameterError, nearest
from frahm.exchange.mat import load_mat
from frahm.units import si_value

if TYPE_CHECKING:
    import xarray as xr

_MAT, _TEXT = ".mat", (".csv", ".txt", ".tsv", ".tab", ".dat", ".asc")
_SI = ("s", "m", "m/s", "m/s^2", "N", "Pa", "rad/s", "kg", "rad")
_NAME_AND_UNIT = re.compile(r"\s*(.*?)\s*(?:[\[(]([^\])]*)[\])])?\s*")
_LARGEST = 500_000_000


def read_time_series(path: str | Path, *, time: str | None = None) -> xr.Dataset:
    """Time series of another program, in SI units as far as units are given.

    Parameters
    ----------
    path : str or Path
        Text (.csv, .txt, .tsv, .tab, .dat, .asc) with columns apart by comma, semicolon, tab or blanks, names and units
        in one line (``x [mm]``), in two, or none at all; or a MAT file of version 5 with vectors of one length.
    time : str, optional
        Name of the column of the time; by default one called time or t, or else the first.

    Returns
    -------
    Dataset
        Over "time" [s], a variable for every other column.

    Raises
    ------
    ParameterError
        If the file cannot be read, a cell is no number, or the time does not ascend.
    """
    columns = _columns(Path(path))
    clock = _time_column(columns, time, str(path))
    values, unit = columns.pop(clock)
    if unit not in ("", "s"):
        values = values * si_value(f"1 {unit}", "s", name=clock)
    if values.size < 2 or not np.all(np.isfinite(values)) or not np.all(np.diff(values) > 0):
        raise ParameterError("file", str(path), f"a time that ascends from sample to sample in the column {clock!r}")
    return _dataset("time", columns, {"time": labelled("time", values, "time", "s")}, path)


def read_table(path: str | Path) -> xr.Dataset:
    """Table of another program, such as wind speeds with their probabilities: a variable for every column over "row".

    Formats and units are those of `read_time_series`.

    Parameters
    ----------
    path : str or Path
        Text with columns, or a MAT file.

    Returns
    -------
    Dataset
        A variable for every column, in SI units where the file names a unit.

    Raises
    ------
    ParameterError
        If the file cannot be read; with its line if a cell is wrong.
    """
    return _dataset("row", _columns(Path(path)), {}, path)


def _dataset(dim: str, columns: dict[str, tuple[Floats, str]], coordinates: dict[str, Any], path: Any) -> xr.Dataset:
    import xarray as xr

    variables = {}
    for name, (values, unit) in columns.items():
        factor, si = _si(unit)
        variables[name] = labelled(dim, factor * values, name, si)
    return xr.Dataset(variables, coordinates, {"source": Path(path).name})


def _si(unit: str) -> tuple[float, str]:
    """Factor to the SI unit, and that unit; a unit that is none of the usual ones stays as it is."""
    if unit in ("", "-", "1"):
        return 1.0, "1"
    for si in _SI:
        try:
            return si_value(f"1 {unit}", si), si
        except ParameterError:
            continue
    return (0.01, "1") if unit == "%" else (1.0, unit)


def _time_column(columns: dict[str, Any], time: str | None, path: str) -> str:
    if time is not None:
        if time not in columns:
            near = nearest(time, columns)
            hint = f"Did you mean {near!r}?" if near else None
            raise ParameterError("time", time, "one of " + ", ".join(columns), hint=hint)
        return time
    named = [name for name in columns if name.lower() in ("time", "t")]
    if not named and len(columns) < 2:
        raise ParameterError("file", path, "a column of the time and at least one more")
    return named[0] if named else next(iter(columns))


def _columns(path: Path) -> dict[str, tuple[Floats, str]]:
    """Columns of a file, with their units."""
    ending = path.suffix.lower()
    if ending != _MAT and ending not in _TEXT:
        raise ParameterError("file", str(path), "a name that ends in " + ", ".join((_MAT, *_TEXT)))
    if not path.is_file():
        raise ParameterError("file", str(path), "a file that exists")
    if path.stat().st_size > _LARGEST:
        raise ParameterError("file", str(path), f"a file of at most {_LARGEST // 1_000_000} MB")
    return _mat_columns(path) if ending == _MAT else _text_columns(path)


def _mat_columns(path: Path) -> dict[str, tuple[Floats, str]]:
    found = {name: value for name, value in load_mat(path).items() if not name.startswith("__")}
    structs = [value for value in found.values() if isinstance(value, np.ndarray) and value.dtype.names]
    for struct in structs if not any(_is_vector(value) for value in found.values()) else ():
        found |= {name: struct[0, 0][name] for name in struct.dtype.names}
    vectors = {name: np.ravel(value).astype(float) for name, value in found.items() if _is_vector(value)}
    lengths = [vector.size for vector in vectors.values()]
    if not lengths:
        raise ParameterError("file", str(path), "a MAT file with vectors of numbers")
    longest = max(lengths)
    return {name: (vector, "") for name, vector in vectors.items() if vector.size == longest}


def _is_vector(value: Any) -> bool:
    numeric = isinstance(value, np.ndarray) and value.dtype.kind in "biuf"
    return numeric and value.size > 1 and max(value.shape) == value.size


def _text_columns(path: Path) -> dict[str, tuple[Floats, str]]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        text = path.read_text(encoding="cp1252", errors="replace")
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and line.lstrip()[0] not in "#%"]
    if not lines:
        raise ParameterError("file", str(path), "a table with at least one row of numbers")
    delimiter = _delimiter([line for _, line in lines[:20]])
    rows = [(n, _cells(line, delimiter)) for n, line in lines]
    head = [cells for _, cells in rows[:3] if not _all_numbers(cells, delimiter)]
    head = head if all(not _all_numbers(cells, delimiter) for _, cells in rows[: len(head)]) else head[:1]
    width = len(rows[-1][1])
    names, units = _names_and_units(head, width)
    body = rows[len(head) :]
    table = np.array([_numbers(cells, width, delimiter, path, n) for n, cells in body], dtype=float)
    if table.size == 0:
        raise ParameterError("file", str(path), "a table with at least one row of numbers")
    return {name: (table[:, i], units[i]) for i, name in enumerate(names)}


def _delimiter(lines: Iterable[str]) -> str:
    """What stands between the columns: the first of tab, semicolon and comma that is in most lines, or else blanks."""
    kept = list(lines)
    return next((mark for mark in "\t;," if 2 * sum(mark in line for line in kept) > len(kept)), " ")


def _cells(line: str, delimiter: str) -> list[str]:
    cells = line.split() if delimiter == " " else next(csv.reader([line], delimiter=delimiter))
    return [cell.strip() for cell in cells]


def _number(cell: str, delimiter: str) -> float:
    return float(cell.replace(",", ".") if delimiter != "," else cell)


def _all_numbers(cells: list[str], delimiter: str) -> bool:
    try:
        for cell in cells:
            _number(cell, delimiter)
    except ValueError:
        return False
    return True


def _numbers(cells: list[str], width: int, delimiter: str, path: Path, line: int) -> list[float]:
    if len(cells) != width:
        raise ParameterError("row", f"{len(cells)} cells", f"{width} cells as in the last row", where=f"{path}:{line}")
    try:
        return [_number(cell, delimiter) for cell in cells]
    except ValueError:
        bad = next(cell for cell in cells if not _all_numbers([cell], delimiter))
        raise ParameterError("cell", bad, "a number", where=f"{path}:{line}") from None


def _names_and_units(head: list[list[str]], width: int) -> tuple[list[str], list[str]]:
    """Names and units of the columns, from at most two lines above the numbers."""
    given = (head[0] if head else [])[:width]
    given += [""] * (width - len(given))
    found = [_NAME_AND_UNIT.fullmatch(cell) for cell in given]
    names = [(match[1] if match else "") or f"column {i + 1}" for i, match in enumerate(found)]
    units = [(match[2] if match else "") or "" for match in found]
    if len(head) > 1:
        second = [cell.strip("[]() ") for cell in head[1]] + [""] * width
        units = [unit or second[i] for i, unit in enumerate(units)]
    for i, name in enumerate(names):
        if name in names[:i]:
            names[i] = f"{name} ({i + 1})"
    return names, units
