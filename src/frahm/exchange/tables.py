"""Comma-separated tables: a row of names, a row of units, then numbers with all their digits.

Lines that begin with # come first and hold what makes the table a dataset again. Variables over other dimensions stand
in files of their own beside it.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.errors import ParameterError
from frahm.exchange.layout import check_layout, dataset_of, layout_of
from frahm.files import file_text, write_text

if TYPE_CHECKING:
    import xarray as xr

_MARK = "# layout: "


def csv_text(dataset: xr.Dataset) -> str:
    """The table of the largest dimensions of a dataset."""
    return _text(dataset, _groups(dataset)[0])


def write_csv(dataset: xr.Dataset, path: Path) -> list[Path]:
    """Write the tables of a dataset: the largest as `path`, the others as `path` with their dimensions in the name."""
    groups = _groups(dataset)
    paths = [path, *(path.with_name(f"{path.stem}.{'-'.join(dims) or 'scalars'}{path.suffix}") for dims in groups[1:])]
    layout = layout_of(dataset)
    for target, dims in zip(paths, groups, strict=True):
        more = {"layout": layout, "files": [file.name for file in paths]} if target is path else None
        write_text(target, _text(dataset, dims, more))
    return paths


def read_csv(path: Path) -> xr.Dataset:
    """The dataset that `write_csv` wrote."""
    first = file_text(path).split("\n", 1)[:1]
    if not first or not first[0].startswith(_MARK):
        raise ParameterError("file", str(path), "a table that frahm wrote", hint="frahm.read_table reads any other.")
    head = json.loads(first[0].removeprefix(_MARK))
    layout = check_layout(head.get("layout"), str(path))
    columns: dict[str, list[str]] = {}
    for name in head["files"]:
        columns |= _columns(path.with_name(name))
    arrays = {name: _values(columns[name], facts["dtype"]) for name, facts in layout["variables"].items()}
    return dataset_of(layout, arrays)


def _groups(dataset: xr.Dataset) -> list[tuple[str, ...]]:
    """Sets of dimensions that variables share, the largest first; those of coordinates go with the first that fits."""
    sizes = dataset.sizes
    groups = {tuple(str(dim) for dim in v.dims) for v in dataset.variables.values()}

    def smallness(dims: tuple[str, ...]) -> tuple[Any, ...]:
        return -int(np.prod([sizes[dim] for dim in dims], dtype=int)), -len(dims), dims

    return sorted(groups, key=smallness) or [()]


def _text(dataset: xr.Dataset, dims: tuple[str, ...], more: Any = None) -> str:
    table = [(str(name), v) for name, v in dataset.variables.items() if tuple(map(str, v.dims)) == dims]
    shape = tuple(dataset.sizes[dim] for dim in dims)
    rows = int(np.prod(shape, dtype=int))
    places: list[tuple[str, str, list[Any]]] = []
    for axis, dim in enumerate(dims):
        if len(dims) == 1 and rows:
            break
        index = np.indices(shape)[axis].reshape(-1)
        values = dataset[dim].values[index] if dim in dataset.variables else index
        units = dataset[dim].attrs.get("units") or "" if dim in dataset.variables else ""
        places.append((f"at {dim}", str(units), values.tolist()))
    stream = io.StringIO()
    if more is not None:
        stream.write(_MARK + json.dumps(more, allow_nan=False) + "\n")
    for name, variable in table:
        if variable.attrs.get("long_name"):
            stream.write(f"# {name}: {variable.attrs['long_name']}\n")
    writer = csv.writer(stream, lineterminator="\n")
    columns = [*places, *((name, str(v.attrs.get("units") or ""), v.values.reshape(-1).tolist()) for name, v in table)]
    writer.writerow([name for name, _, _ in columns])
    writer.writerow([units for _, units, _ in columns])
    writer.writerows(zip(*(list(map(_cell, values)) for _, _, values in columns), strict=True))
    return stream.getvalue()


def _cell(value: Any) -> str:
    return str(int(value)) if isinstance(value, bool) else repr(value) if isinstance(value, float) else str(value)


def _columns(path: Path) -> dict[str, list[str]]:
    lines = iter(file_text(path, "a table that frahm wrote").splitlines(keepends=True))
    rows = list(csv.reader(_without_comments(lines)))
    names = rows[0] if rows else []
    return {name: [row[i] for row in rows[2:]] for i, name in enumerate(names)}


def _without_comments(lines: Iterator[str]) -> Iterator[str]:
    head = True
    for line in lines:
        head = head and line.startswith("#")
        if not head:
            yield line


def _values(cells: list[str], dtype: str) -> Any:
    if dtype == "str":
        return cells
    if dtype == "bool":
        return [cell == "1" for cell in cells]
    kind: type = float if dtype.startswith("float") else int
    return np.array([kind(cell) for cell in cells], dtype=dtype)
