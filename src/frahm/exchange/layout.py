"""How a dataset is laid out, as plain data: what a text or MAT file needs beside the numbers to become one again."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.errors import ParameterError

if TYPE_CHECKING:
    import xarray as xr

FORMAT = "frahm-dataset-1"
_DTYPE = re.compile(r"str|bool|u?int(8|16|32|64)|float(16|32|64|128)|longdouble")


def layout_of(dataset: xr.Dataset) -> dict[str, Any]:
    """Dimensions, attributes and, by variable, dimensions, type, attributes and whether it is a coordinate."""
    return {
        "format": FORMAT,
        "dims": {str(name): int(size) for name, size in dataset.sizes.items()},
        "attrs": _plain(dataset.attrs),
        "variables": {
            str(name): {
                "dims": [str(dim) for dim in variable.dims],
                "dtype": _dtype_name(str(name), variable.dtype),
                "coord": name in dataset.coords,
                "attrs": _plain(variable.attrs),
            }
            for name, variable in dataset.variables.items()
        },
    }


def dataset_of(layout: Mapping[str, Any], arrays: Mapping[str, Any]) -> xr.Dataset:
    """The dataset of a layout and the arrays that go with it, in any shape of the right size."""
    import xarray as xr

    variables, coordinates = {}, []
    for name, facts in layout["variables"].items():
        shape = [layout["dims"][dim] for dim in facts["dims"]]
        data = _typed(arrays[name], facts["dtype"]).reshape(shape)
        variables[name] = (facts["dims"], data, _attributes(facts["attrs"]))
        if facts["coord"]:
            coordinates.append(name)
    return xr.Dataset(variables, attrs=_attributes(layout["attrs"])).set_coords(coordinates)


def check_layout(layout: Any, path: str) -> dict[str, Any]:
    """The layout, if it is one this version knows and can be meant."""
    known = isinstance(layout, dict) and layout.get("format") == FORMAT
    if not known or not _is_consistent(layout):
        hint = "Its layout contradicts itself." if known else "It is of another program."
        raise ParameterError("file", path, "a file that frahm wrote", hint=hint)
    return layout


def _is_consistent(layout: dict[str, Any]) -> bool:
    """Whether every part of a layout is of its type, and every name known."""
    dims, variables = layout.get("dims"), layout.get("variables")
    if not (isinstance(dims, dict) and isinstance(variables, dict) and isinstance(layout.get("attrs"), dict)):
        return False
    sizes = all(isinstance(size, int) and size >= 0 for size in dims.values())
    return sizes and all(
        isinstance(facts, dict)
        and isinstance(facts.get("dims"), list) and all(isinstance(d, str) and d in dims for d in facts["dims"])
        and isinstance(facts.get("dtype"), str) and _DTYPE.fullmatch(facts["dtype"]) is not None
        and isinstance(facts.get("attrs"), dict) and isinstance(facts.get("coord"), bool)
        for facts in variables.values()
    )  # fmt: skip


def _dtype_name(name: str, dtype: np.dtype[Any]) -> str:
    if dtype.kind in "OUS":
        return "str"
    if dtype.kind not in "biuf":
        raise ParameterError("dataset", f"{name} of type {dtype}", "variables of real numbers, truth values or text")
    return dtype.name


def _typed(values: Any, dtype: str) -> np.ndarray:
    if dtype == "str":
        return np.asarray([str(value) for value in np.ravel(np.asarray(values, dtype=object))], dtype=object)
    return np.asarray(values).astype(dtype)


def _plain(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    return {str(key): plain(value) for key, value in attributes.items()}


def plain(value: Any) -> Any:
    """Numbers, text and lists only; a number that is not finite is its name."""
    if isinstance(value, np.ndarray | list | tuple):
        array = np.asarray(value)
        return [plain(entry) for entry in array.tolist()] if array.ndim else plain(array[()])
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return {"number": str(value)}
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)


def _attributes(attributes: Mapping[str, Any]) -> dict[str, Any]:
    return {key: _attribute(value) for key, value in attributes.items()}


def _attribute(value: Any) -> Any:
    if isinstance(value, dict):
        return float(value["number"])
    if isinstance(value, list):
        return np.array([_attribute(entry) for entry in value])
    return value
