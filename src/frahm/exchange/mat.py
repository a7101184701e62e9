"""MAT files of version 5, as MATLAB and Octave read them: a response curve with its branches as a struct array."""

from __future__ import annotations

import io
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.errors import ParameterError
from frahm.exchange.layout import check_layout, dataset_of, layout_of
from frahm.files import write_bytes

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
        "units": {names[str(name)]: str(v.attrs.get("units", "")) for name, v in dataset.variables.items()},
        "long_names": {names[str(name)]: str(v.attrs.get("long_name", "")) for name, v in dataset.variables.items()},
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
    content = load_mat(path)
    try:
        layout = check_layout(json.loads(str(np.squeeze(content["layout"]))), str(path))
        data = content["data"][0, 0]
    except (KeyError, ValueError, IndexError):
        hint = "frahm.read_table and frahm.read_time_series read any other."
        raise ParameterError("file", str(path), "a MAT file that frahm wrote", hint=hint) from None
    arrays = {}
    for name, facts in layout["variables"].items():
        values = data[layout["names"][name]]
        arrays[name] = (
            [np.squeeze(cell)[()] if np.size(cell) else "" for cell in np.ravel(values)]
            if (facts["dtype"] == "str")
            else values
        )
    return dataset_of(layout, arrays)


def load_mat(path: Path) -> dict[str, Any]:
    """Variables of a MAT file."""
    import scipy.io

    allowed = "a MAT file of version 5"
    try:
        return dict(scipy.io.loadmat(path, struct_as_record=True))
    except NotImplementedError:
        hint = "It is of version 7.3: in MATLAB, save it with the option -v7."
        raise ParameterError("file", str(path), allowed, hint=hint) from None
    except (OSError, ValueError, TypeError, IndexError, scipy.io.matlab.MatReadError) as error:
        raise ParameterError("file", str(path), allowed, hint=f"{getattr(error, 'strerror', None) or error}.") from None


def _names(dataset: xr.Dataset) -> dict[str, str]:
    """Names MATLAB allows, by name in the dataset."""
    names: dict[str, str] = {}
    for name in map(str, dataset.variables):
        plain = re.sub(r"\W", "_", name)
        plain = (plain if plain[:1].isalpha() else f"v_{plain}")[:_LONGEST]
        while plain in names.values():
            plain = f"{plain[: _LONGEST - 2]}_2" if not plain.endswith("_2") else f"{plain[: _LONGEST - 2]}_x"
        names[name] = plain
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
