"""`write_data` and `read_data`: one verb each, the ending of the file says which format."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.errors import ParameterError, door, nearest
from frahm.exchange.layout import check_layout, dataset_of, layout_of
from frahm.exchange.mat import read_mat, write_mat
from frahm.exchange.tables import read_csv, write_csv
from frahm.files import existing_file, file_text, write_bytes, write_text
from frahm.tables.netcdf import netcdf_dataset
from frahm.untrusted import MOST_BYTES

if TYPE_CHECKING:
    import xarray as xr


def write_data(result: Any, path: str | Path) -> list[Path]:
    """Write a result so that other programs can read it; the ending says how: .nc, .csv, .mat or .json.

    Parameters
    ----------
    result : Dataset, or a result with `to_dataset`
        A response curve, a time history, attractors, a map.
    path : str or Path
        netCDF 4; comma-separated with a row of units (variables over other dimensions in files beside it); MAT of
        version 5, a response curve with its branches and special points as struct arrays; JSON.

    Returns
    -------
    list of Path
        The files written, each complete or not at all; `read_data` of the first gives an equal dataset back.

    Raises
    ------
    ParameterError
        If the ending is not known, the file cannot be written, or cannot hold what is in the dataset.
    """
    target = Path(path)
    dataset = result.to_dataset() if hasattr(result, "to_dataset") and not hasattr(result, "data_vars") else result
    if not hasattr(dataset, "data_vars"):
        raise ParameterError("result", type(result).__name__, "an xarray.Dataset, or a result with to_dataset")
    writer, ending = _WRITERS[_ending(target)], target.suffix.lower()
    with door("result", type(result).__name__, f"a dataset that a file of the kind {ending} can hold"):
        return list(writer(dataset, target))


def read_data(path: str | Path) -> xr.Dataset:
    """Read what `write_data` wrote.

    Parameters
    ----------
    path : str or Path
        File that ends in .nc, .csv, .mat or .json.

    Returns
    -------
    Dataset
        Equal to the one that was written, units and long names included.

    Raises
    ------
    ParameterError
        If there is no such file, or it is not one that `write_data` wrote.
    """
    source = Path(path)
    reader = _READERS[_ending(source)]
    existing_file(source, largest=MOST_BYTES)
    with door("file", str(path), "a file that frahm wrote", "It is damaged, or of another program."):
        return reader(source)


def _ending(path: Path) -> str:
    ending = path.suffix.lower()
    if ending not in _WRITERS:
        near = nearest(ending, _WRITERS)
        hint = f"Did you mean {near!r}?" if near else None
        raise ParameterError("file", str(path), "a name that ends in " + ", ".join(_WRITERS), hint=hint)
    return ending


def _write_netcdf(dataset: xr.Dataset, path: Path) -> list[Path]:
    write_bytes(path, dataset.to_netcdf(engine="h5netcdf"))
    return [path]


def _write_json(dataset: xr.Dataset, path: Path) -> list[Path]:
    layout = layout_of(dataset)
    for name, facts in layout["variables"].items():
        facts["data"] = _strict(dataset[name].values)
    write_text(path, json.dumps(layout, allow_nan=False, ensure_ascii=False) + "\n")
    return [path]


def _read_json(path: Path) -> xr.Dataset:
    layout = check_layout(json.loads(file_text(path)), str(path))
    arrays = {}
    for name, facts in layout["variables"].items():
        if isinstance(facts["data"], list) != bool(facts["dims"]):
            raise ValueError(f"the data of {name} do not fit its dimensions")
        values = np.asarray(facts["data"], dtype=object)
        if facts["dtype"].startswith("float"):
            values = np.array([math.nan if v is None else float(v) for v in values.reshape(-1)]).reshape(values.shape)
        arrays[name] = values
    return dataset_of(layout, arrays)


def _strict(values: np.ndarray) -> Any:
    """Nested lists of strict JSON: NaN is null, infinity a text."""
    if values.dtype.kind != "f":
        return np.vectorize(str, otypes=[object])(values).tolist() if values.dtype.kind in "OUS" else values.tolist()
    cells = [None if math.isnan(v) else v if math.isfinite(v) else str(v) for v in values.reshape(-1).tolist()]
    return np.array(cells, dtype=object).reshape(values.shape).tolist()


_WRITERS = {".nc": _write_netcdf, ".csv": write_csv, ".mat": write_mat, ".json": _write_json}
_READERS = {".nc": netcdf_dataset, ".csv": read_csv, ".mat": read_mat, ".json": _read_json}
