"""A table of numbers with names and units, whatever file it comes from."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from frahm.arrays import Floats
from frahm.errors import ParameterError
from frahm.files import existing_file

LARGEST = 500_000_000  # bytes


@dataclass(frozen=True, eq=False)
class Table:
    """Columns of numbers.

    Attributes
    ----------
    source : str
        Name of the file in messages.
    heads : tuple of str
        Name of each column, as the file has it; empty where it names none.
    units : tuple of str
        Unit of each column, as the file has it; empty where it names none.
    columns : tuple of ndarray
        The numbers, in the units of the file.
    lines : ndarray or None
        Line of each row; None for a file without lines.
    starts : dict
        For columns of dates: the date that is zero; the column itself is in s since then.
    long_names : dict
        What the file says about a column beside its name.
    left_out : dict
        Vectors of another length than most, by name: their lengths.
    has_others : bool
        Whether such files usually hold more columns than are asked for.
    """

    source: str
    heads: tuple[str, ...]
    units: tuple[str, ...]
    columns: tuple[Floats, ...]
    lines: np.ndarray | None = None
    starts: Mapping[int, str] = field(default_factory=dict)
    long_names: Mapping[int, str] = field(default_factory=dict)
    left_out: Mapping[str, int] = field(default_factory=dict)
    has_others: bool = False

    def place(self, row: int) -> str:
        """File, and line if it has lines, of a row."""
        return self.source if self.lines is None else f"{self.source}:{self.lines[row]}"

    @property
    def names(self) -> tuple[str, ...]:
        """A name of its own for each column."""
        found: list[str] = []
        for i, head in enumerate(self.heads):
            name = head or f"column {i + 1}"
            while name in found:
                name = f"{name} ({i + 1})"
            found.append(name)
        return tuple(found)


def read_table_file(
    path: str | os.PathLike[str],
    *,
    label: str | None = None,
    allowed: str = "a file that exists",
    largest: int = LARGEST,
    at: Mapping[str, float] | None = None,
) -> Table:
    """Table of a text, MAT or netCDF file.

    Parameters
    ----------
    path : str or Path
        Text (.csv, .txt, .tsv, .tab, .dat, .asc), MAT up to version 7 (.mat) or netCDF (.nc, .nc4, .cdf).
    label : str, optional
        Name of the file in messages; by default its path.
    allowed : str
        What may be given, as the end of the sentence "allowed: ...".
    largest : int
        Size of the file, and of its arrays once unpacked [bytes].
    at : mapping of str to float, optional
        Of a netCDF file on a grid: the place, such as ``{"latitude": 57.1, "longitude": 2.3}``.

    Raises
    ------
    ParameterError
        If there is no such file or it is no table; with the line of what is wrong.
    """
    from frahm.tables.mat import mat_table
    from frahm.tables.netcdf import netcdf_table
    from frahm.tables.text import text_table

    readers: dict[str, Callable[[Path, str, int], Table]] = {
        **dict.fromkeys((".csv", ".txt", ".tsv", ".tab", ".dat", ".asc"), text_table),
        ".mat": mat_table,
        **dict.fromkeys((".nc", ".nc4", ".cdf"), lambda path, label, largest: netcdf_table(path, label, largest, at)),
    }
    label, ending = label or str(path), Path(path).suffix.lower()
    if ending not in readers:
        raise ParameterError("file", label, "a name that ends in " + ", ".join(readers))
    if at is not None and readers[ending] in (text_table, mat_table):
        raise ParameterError("at", dict(at), "nothing, because only a netCDF file has a grid")
    try:
        return readers[ending](existing_file(path, allowed, largest=largest), label, largest)
    except ParameterError as error:
        if error.name == "file" and error.value == str(path) != label:
            raise ParameterError("file", label, error.allowed, hint=error.hint) from None
        raise
