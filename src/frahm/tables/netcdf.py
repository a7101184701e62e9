"""Time series of a netCDF file as a table: those of a station, or of one place of the grid of a reanalysis."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.errors import ParameterError, check_number, door, nearest
from frahm.tables.table import Table
from frahm.untrusted import MOST_BYTES, binary_content

if TYPE_CHECKING:
    import xarray as xr

# Names of the components of the wind to the east and to the north where no standard name says what they are.
_COMPONENTS = {"eastward_wind": ("u10", "u100", "u"), "northward_wind": ("v10", "v100", "v")}


def netcdf_dataset(path: Path, label: str | None = None, most_bytes: int = MOST_BYTES, **decoding: Any) -> xr.Dataset:
    """Dataset of a netCDF file, decoded by the conventions for climate and forecast data.

    Parameters
    ----------
    path : Path
        netCDF 3 or 4.
    label : str, optional
        Name of the file in messages.
    most_bytes : int
        Of all arrays together.
    **decoding
        Of `xarray.decode_cf`.

    Raises
    ------
    ParameterError
        If the file is damaged, too large, or no netCDF file.
    """
    import xarray as xr

    found = binary_content("netcdf", path, most_bytes=most_bytes)
    with door("file", label or str(path), "a netCDF file", "It is damaged, or not as the conventions ask."):
        variables = {
            name: (facts["dims"], _data(facts), {key: _scalar(value) for key, value in facts["attrs"].items()})
            for name, facts in found["variables"].items()
            if facts["data"] is not None
        }
        attributes = {key: _scalar(value) for key, value in found["attrs"].items()}
        try:
            return xr.decode_cf(xr.Dataset(variables, attrs=attributes), **decoding).load()
        except ImportError:  # of a package that knows the calendars of climate models
            hint = "Its dates are not of the Gregorian calendar."
            raise ParameterError("file", label or str(path), "a netCDF file with usual dates", hint=hint) from None


def netcdf_table(path: Path, label: str, largest: int, at: Mapping[str, float] | None) -> Table:
    """Every variable over the one dimension that is left at a place, the coordinate of the dimension first.

    The speed of the wind is added as `speed`: from its two components, or where it has another name.
    """
    whole = netcdf_dataset(path, label, largest, decode_timedelta=False)
    with door("file", label, "a netCDF file with values over one dimension, such as the time"):
        found = _at_place(whole, at or {}, label).squeeze()
        long = [str(dim) for dim, size in found.sizes.items() if size > 1]
        if len(long) != 1:
            raise _undecided(found, long, label)
        names = [name for name in found.variables if found[name].dims == (long[0],)]
        names.sort(key=lambda name: name != long[0])
        columns = {str(name): found[name] for name in names if found[name].dtype.kind in "biufM"}
        if not columns:
            raise ParameterError("file", label, "a netCDF file with numbers over its dimension")
        return _table(columns | _speed(columns), label)


def _table(columns: Mapping[str, xr.DataArray], label: str) -> Table:
    starts, values, units = {}, [], []
    for i, column in enumerate(columns.values()):
        data, unit = column.values, str(column.attrs.get("units", ""))
        if data.dtype.kind == "M":
            starts[i], unit = str(data[0]), "s"
            data = (data - data[0]) / np.timedelta64(1, "s")
        values.append(np.asarray(data, dtype=float))
        units.append(unit)
    names = {i: str(column.attrs.get("long_name", "")) for i, column in enumerate(columns.values())}
    return Table(label, tuple(columns), tuple(units), tuple(values), starts=starts, long_names=names, has_others=True)


def _at_place(whole: xr.Dataset, at: Mapping[str, float], label: str) -> xr.Dataset:
    """The values at the point of the grid next to a place."""
    for name, value in at.items():
        if name not in whole.dims or name not in whole.coords:
            known = [str(dim) for dim in whole.dims if dim in whole.coords]
            near = nearest(str(name), known)
            hint = f"Did you mean {near!r}?" if near else None
            raise ParameterError("at", name, f"a dimension of {label}: " + ", ".join(known), hint=hint)
        axis = np.asarray(whole[name].values, dtype=float)
        spacing = float(np.max(np.abs(np.diff(axis)))) if axis.size > 1 else 0.0
        lo, hi = float(axis.min()) - spacing / 2, float(axis.max()) + spacing / 2
        place = check_number(f"at.{name}", value)
        if axis.size > 1 and not lo <= place <= hi:
            raise ParameterError(f"at.{name}", value, f"a place on the grid, {axis.min():g} ... {axis.max():g}")
        whole = whole.isel({name: int(np.argmin(np.abs(axis - place)))})
    return whole


def _undecided(found: xr.Dataset, long: list[str], label: str) -> ParameterError:
    spans = ", ".join(f"{dim} of {found.sizes[dim]}" for dim in long) or "none with two values"
    hint = f"It has these dimensions: {spans}."
    hint += " Say the place: frahm.read_time_series(path, at={...})." if long else ""
    return ParameterError("file", label, "a netCDF file with values over one dimension, such as the time", hint=hint)


def _speed(columns: Mapping[str, xr.DataArray]) -> dict[str, xr.DataArray]:
    """Speed of the wind under this name: as the file has it, or from its two components if there are just two."""
    kinds = {name: str(column.attrs.get("standard_name", "")) for name, column in columns.items()}
    named = [name for name, kind in kinds.items() if kind == "wind_speed"]
    if "speed" in columns or len(named) > 1:
        return {}
    if named:
        return {"speed": columns[named[0]]}
    parts = []
    for standard, usual in _COMPONENTS.items():
        found = [name for name, kind in kinds.items() if kind == standard] or [
            name for name in usual if name in columns
        ]
        if len(found) != 1:
            return {}
        parts.append(columns[found[0]])
    east, north = parts
    if east.attrs.get("units") != north.attrs.get("units"):
        return {}
    speed = east.copy(data=np.hypot(east.values, north.values))
    speed.attrs = {
        "units": east.attrs.get("units", ""),
        "long_name": f"speed of the wind from {east.name}, {north.name}",
    }
    return {"speed": speed}


def _data(facts: Mapping[str, Any]) -> np.ndarray:
    data = facts["data"]
    return data if isinstance(data, np.ndarray) else np.array(data, dtype=object).reshape(facts["shape"])


def _scalar(value: Any) -> Any:
    return value[()] if isinstance(value, np.ndarray) and not value.ndim else value
