"""MAT files of version 5, as MATLAB and Octave read them: a response curve with its branches as a struct array."""

from __future__ import annotations

import io
import itertools
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.errors import ParameterError
from frahm.exchange.layout import check_layout, dataset_of, layout_of
from frahm.files import write_bytes
from frahm.untrusted import binary_content

if TYPE_CHECKING:
    import xarray as xr

_LONGEST = 63
_SHORT = {
    "saddle-node": "SN", "hopf": "H", "neimark-sacker": "NS", "period-doubling": "PD", "branch-point": "BP",
}  # fmt: skip


def write_mat(dataset: xr.Dataset, path: Path) -> list[Path]:
    """Write `data`, `units` and `long_names`, structs with a field for every variable, and `layout`, a text.

    A response curve has two struct arrays more: `branches` (number, detached, asymmetric and the columns of the curve)
    and `special_points` (label such as SN1, kind and the place).
    """
    import scipy.io

    names = _names(dataset)
    layout = layout_of(dataset) | {"names": names}
    content: dict[str, Any] = {
        "data": {names[str(name)]: _matlab(v.values) for name, v in dataset.variables.items()},
        "units": {names[str(name)]: str(v.attrs.get("units") or "") for name, v in dataset.variables.items()},
        "long_names": {names[str(name)]: str(v.attrs.get("long_name") or "") for name, v in dataset.variables.items()},
        "layout": json.dumps(layout, allow_nan=False),
    }
    if {"branch", "detached", "special_kind"} <= set(dataset.variables):
        content |= {"branches": _branches(dataset), "special_points": _special_points(dataset)}
    stream = io.BytesIO()
    scipy.io.savemat(stream, content, long_field_names=True, oned_as="column", do_compression=True)
    write_bytes(path, stream.getvalue())
    return [path]


def read_mat(path: Path) -> xr.Dataset:
    """The dataset that `write_mat` wrote."""
    content = binary_content("mat", path)
    text, data = content.get("layout"), content.get("data")
    if not isinstance(text, str) or not isinstance(data, dict):
        hint = "frahm.read_table and frahm.read_time_series read any other."
        raise ParameterError("file", str(path), "a MAT file that frahm wrote", hint=hint)
    layout = check_layout(json.loads(text), str(path))
    arrays = {name: _values(data[layout["names"][name]]) for name in layout["variables"]}
    return dataset_of(layout, arrays)


def _values(values: Any) -> Any:
    """Numbers as they are; text as a list, nothing in it as MATLAB writes an empty text."""
    if isinstance(values, str):
        return [values]
    return [entry if isinstance(entry, str) else "" for entry in values] if isinstance(values, list) else values


def _names(dataset: xr.Dataset) -> dict[str, str]:
    """Names MATLAB allows, by name in the dataset."""
    names: dict[str, str] = {}
    for name in map(str, dataset.variables):
        plain = re.sub(r"\W", "_", name, flags=re.ASCII)
        plain = (plain if plain[:1].isalpha() else f"v_{plain}")[:_LONGEST]
        taken = set(names.values())
        others = (f"{plain[: _LONGEST - 6]}_{i}" for i in itertools.count(2))
        names[name] = next(choice for choice in itertools.chain([plain], others) if choice not in taken)
    return names


def _matlab(values: np.ndarray) -> Any:
    if values.dtype.kind in "OUS":
        return np.array([str(value) for value in values.reshape(-1)], dtype=object).reshape(values.shape)
    return values


def _branches(dataset: xr.Dataset) -> np.ndarray:
    columns = [str(n) for n, v in dataset.variables.items() if v.dims == ("point",) and n != "branch"]
    number, count = dataset["branch"].values, dataset.sizes["branch_number"]
    fields = ["number", "detached", "asymmetric", *columns]
    rows = np.empty(count, dtype=[(field, object) for field in fields])
    for i in range(count):
        on = number == i
        head = (float(i), bool(dataset["detached"].values[i]), bool(dataset["asymmetric"].values[i]))
        rows[i] = (*head, *(dataset[name].values[on] for name in columns))
    return rows


def _special_points(dataset: xr.Dataset) -> np.ndarray:
    columns = [str(n) for n, v in dataset.variables.items() if v.dims == ("special_point",) and n != "special_kind"]
    kinds = str(dataset.attrs["special_kind_names"]).split(", ")
    fields = ["label", "kind", *(name.removeprefix("special_") for name in columns)]
    rows = np.empty(dataset.sizes["special_point"], dtype=[(field, object) for field in fields])
    count: dict[str, int] = {}
    for i, code in enumerate(dataset["special_kind"].values):
        kind = kinds[int(code)]
        count[kind] = count.get(kind, 0) + 1
        rows[i] = (f"{_SHORT[kind]}{count[kind]}", kind, *(_scalar(dataset[name].values[i]) for name in columns))
    return rows


def _scalar(value: Any) -> Any:
    return bool(value) if isinstance(value, np.bool_) else float(value)
