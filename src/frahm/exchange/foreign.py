"""Tables and time series of other programs in: text with columns, MAT and netCDF files."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.arrays import labelled
from frahm.errors import ParameterError, nearest
from frahm.tables import Table, read_table_file
from frahm.units import si_value, to_si

if TYPE_CHECKING:
    import xarray as xr

# fmt: off
_OTHER_THAN_SECONDS = frozenset([
    "ns", "us", "µs", "μs", "ms", "msec", "millis", "millisecond", "milliseconds", "min", "mins", "minute", "minutes",
    "h", "hr", "hrs", "hour", "hours", "d", "day", "days",
])
# fmt: on


def read_time_series(path: str | Path, *, time: str | None = None, at: Mapping[str, float] | None = None) -> xr.Dataset:
    """Time series of another program, in SI units as far as units are given.

    Parameters
    ----------
    path : str or Path
        Text (.csv, .txt, .tsv, .tab, .dat, .asc) with columns apart by comma, semicolon, tab or blanks, names and units
        in one line (``x [mm]``), in two, or none at all, numbers with a decimal point or comma; a MAT file of version 5
        with vectors of one length; or a netCDF file (.nc, .nc4, .cdf) with variables over the time.
    time : str, optional
        Name of the column of the time; by default one called time or t, or with dates, or else the first.
    at : mapping of str to float, optional
        Of a netCDF file on a grid, the place: ``{"latitude": 57.1, "longitude": 2.3}`` in the units of the file; the
        nearest point of the grid is taken.

    Returns
    -------
    Dataset
        Over "time" [s], a variable for every other column; where no unit is given, its attribute `assumed` says so.
        Dates become seconds since the first one, which the attribute `start` of the time tells. Vectors of a MAT file
        that are shorter are named in the attribute `left_out`. Where a netCDF file has the components of the wind,
        `speed` [m/s] is added.

    Raises
    ------
    ParameterError
        If the file cannot be read, a cell is no number, or the time does not ascend; with the line.
    """
    table = read_table_file(path, at=at)
    clock = _time_column(table, time, str(path))
    values, unit = table.columns[clock], table.units[clock]
    name = table.names[clock]
    assumed = _seconds_assumed(name, str(path)) if not unit and clock not in table.starts else {}
    if unit not in ("", "s"):
        values = values * si_value(f"1 {unit}", "s", name=name)
    late = np.flatnonzero(~(np.isfinite(values[1:]) & (np.diff(values) > 0)))
    if values.size < 2 or not np.isfinite(values[0]) or late.size:
        where = table.place(int(late[0]) + 1) if late.size else None
        allowed = f"a time that ascends from sample to sample in the column {name!r}"
        raise ParameterError("file", str(path), allowed, where=where)
    more = assumed | ({"start": table.starts[clock]} if clock in table.starts else {})
    return _dataset("time", table, {"time": labelled("time", values, "time", "s", **more)}, path, clock)


def read_table(path: str | Path, *, at: Mapping[str, float] | None = None) -> xr.Dataset:
    """Table of another program, such as wind speeds with their probabilities: a variable for every column over "row".

    Formats and units are those of `read_time_series`.

    Parameters
    ----------
    path : str or Path
        Text with columns, a MAT file, or a netCDF file.
    at : mapping of str to float, optional
        Of a netCDF file on a grid, the place.

    Returns
    -------
    Dataset
        A variable for every column, in SI units where the file names a unit; a unit that is not known stays.

    Raises
    ------
    ParameterError
        If the file cannot be read; with its line if a cell is wrong.
    """
    return _dataset("row", read_table_file(path, at=at), {}, path)


def _dataset(dim: str, table: Table, coordinates: dict[str, Any], path: Any, left_out: int | None = None) -> xr.Dataset:
    import xarray as xr

    variables = {}
    for i, name in enumerate(table.names):
        if i != left_out:
            factor, si = to_si(table.units[i])
            more = {"start": table.starts[i]} if i in table.starts else {}
            variables[name] = labelled(dim, factor * table.columns[i], table.long_names.get(i) or name, si, **more)
    attributes = {"source": Path(path).name}
    if table.left_out:
        attributes["left_out"] = ", ".join(f"{name} of length {size}" for name, size in table.left_out.items())
    return xr.Dataset(variables, coordinates, attributes)


def _seconds_assumed(name: str, path: str) -> dict[str, str]:
    """What to say of a time without unit; refused where its name seems to tell another one than seconds."""
    others = [word for word in re.findall(r"[A-Z]?[a-zµμ]+|[A-Z]+", name) if word.lower() in _OTHER_THAN_SECONDS]
    if others:
        hint = f"Write the unit in brackets, as in 'time [{others[0]}]' or 'time [s]'."
        raise ParameterError("file", path, f"a unit of the time in the column {name!r}", hint=hint)
    return {"assumed": f"seconds: the column {name!r} gives no unit"}


def _time_column(table: Table, time: str | None, path: str) -> int:
    if time is not None:
        if time not in table.names:
            near = nearest(time, table.names)
            hint = f"Did you mean {near!r}?" if near else None
            raise ParameterError("time", time, "one of " + ", ".join(table.names), hint=hint)
        return table.names.index(time)
    if len(table.names) < 2:
        raise ParameterError("file", path, "a column of the time and at least one more")
    named = [i for i, name in enumerate(table.names) if name.lower() in ("time", "t")]
    return (named or list(table.starts) or [0])[0]
