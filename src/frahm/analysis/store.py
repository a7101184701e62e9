"""An analysis on disk: case.yaml, summary.json and results.nc, each complete or not there at all."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from frahm.analysis.analysis import SCHEMA, CaseAnalysis
from frahm.analysis.section import Check
from frahm.case import load_case
from frahm.errors import ParameterError, door
from frahm.files import existing_file, file_text, remove_file, write_bytes, write_text
from frahm.tables.netcdf import netcdf_dataset
from frahm.untrusted import MOST_BYTES

if TYPE_CHECKING:
    import xarray as xr

CASE_FILE, SUMMARY_FILE, ARRAYS_FILE = "case.yaml", "summary.json", "results.nc"
_KINDS_COMPRESSED = "fiu"
_ALLOWED = f"a folder that `frahm run` wrote, with {SUMMARY_FILE} in it"


def save_analysis(analysis: CaseAnalysis, folder: str | Path) -> list[Path]:
    """Write the three files into an existing folder, the summary first, and return their paths.

    All of them are made in memory before anything is written; arrays of an earlier analysis go before its summary does,
    so that a disk that is full never leaves those of one beside the summary of another.

    Raises
    ------
    ParameterError
        If a file cannot be written.
    """
    folder = Path(folder)
    summary = json.dumps(analysis.summary(), indent=2, allow_nan=False, ensure_ascii=False) + "\n"
    arrays = _packed_arrays(analysis)
    remove_file(folder / ARRAYS_FILE)
    write_text(folder / SUMMARY_FILE, summary)
    if not _is_there(analysis, folder / CASE_FILE):  # a file its author commented stays as it is
        analysis.case.to_yaml(folder / CASE_FILE)
    write_bytes(folder / ARRAYS_FILE, arrays)
    return [folder / name for name in (CASE_FILE, SUMMARY_FILE, ARRAYS_FILE)]


def load_analysis(folder: str | Path, *, arrays: bool = True) -> CaseAnalysis:
    """Read what `save_analysis` wrote.

    Parameters
    ----------
    folder : str or Path
        The folder.
    arrays : bool
        Whether to read the arrays, too; without them `data` is empty and all numbers are there.

    Raises
    ------
    ParameterError
        If the folder does not hold an analysis, or a file of it cannot be read.
    """
    folder = Path(folder)
    summary = read_summary(folder)
    data = _read_arrays(folder / ARRAYS_FILE) if arrays else {}
    with door("DIR", str(folder), _ALLOWED, f"{SUMMARY_FILE} is damaged."):
        results = summary["results"]
        notes, interrupted = results.pop("notes"), results.pop("interrupted")
        return CaseAnalysis(
            case=load_case(summary["case"]),
            results=results,
            data=data,
            checks=tuple(Check(**check) for check in summary["checks"]),
            unverified=tuple(map(str, summary["unverified"])),
            notes=tuple(map(str, notes)),
            interrupted=bool(interrupted),
            version=str(summary["frahm"]),
        )


def missing_arrays(folder: str | Path) -> str:
    """A sentence if the arrays of an analysis are not there, as after a run whose disk was full; else empty."""
    path = Path(folder) / ARRAYS_FILE
    if path.exists():
        return ""
    return f"The arrays are missing (no such file: {path}): frahm run on {CASE_FILE} makes them again."


def read_summary(folder: str | Path) -> dict[str, Any]:
    """The summary of an analysis as plain data."""
    path = Path(folder) / SUMMARY_FILE
    try:
        summary = json.loads(file_text(path))
    except ParameterError as error:
        raise ParameterError("DIR", str(folder), _ALLOWED, hint=f"{path}: {error.hint}") from None
    except (ValueError, RecursionError):
        raise ParameterError("DIR", str(folder), _ALLOWED, hint=f"{path} is not valid JSON.") from None
    known = {"schema", "frahm", "case", "results", "checks", "unverified"}
    if not isinstance(summary, dict) or summary.get("schema") != SCHEMA or not known <= set(summary):
        raise ParameterError("DIR", str(folder), _ALLOWED, hint=f"{path} is not a summary of this version.")
    return summary


def joined(data: dict[str, xr.Dataset]) -> xr.Dataset:
    """All datasets as one: the name of each is put before its variables, dimensions and attributes."""
    import xarray as xr

    variables: dict[Any, Any] = {}
    attributes: dict[str, Any] = {"sections": ", ".join(data)}
    for section, dataset in data.items():
        bare = dataset.reset_coords()
        named = bare.rename({name: f"{section}.{name}" for name in {*bare.variables, *bare.dims}})
        variables |= named.variables
        attributes |= {f"{section}.{key}": value for key, value in dataset.attrs.items()}
    return xr.Dataset(variables, attrs=attributes)


def separated(whole: xr.Dataset) -> dict[str, xr.Dataset]:
    """The datasets that `joined` put together."""
    data = {}
    for section in filter(None, whole.attrs["sections"].split(", ")):
        prefix = f"{section}."
        part = whole[[name for name in whole.variables if str(name).startswith(prefix)]]
        names = {name: str(name).removeprefix(prefix) for name in {*part.variables, *part.dims}}
        attributes = {key.removeprefix(prefix): value for key, value in whole.attrs.items() if key.startswith(prefix)}
        data[section] = part.rename(names)
        data[section].attrs = attributes
    return data


def _is_there(analysis: CaseAnalysis, path: Path) -> bool:
    try:
        return path.is_file() and load_case(path).digest == analysis.case.digest
    except ParameterError:
        return False


def _packed_arrays(analysis: CaseAnalysis) -> bytes | memoryview:
    whole = joined(analysis.data).assign_attrs(
        frahm_version=analysis.version, case=analysis.case.name, case_digest=analysis.case.digest
    )
    packed = {"zlib": True, "complevel": 4, "shuffle": True}
    encoding = {name: packed for name, v in whole.variables.items() if v.ndim and v.dtype.kind in _KINDS_COMPRESSED}
    return whole.to_netcdf(engine="h5netcdf", encoding=encoding)


def _read_arrays(path: Path) -> dict[str, xr.Dataset]:
    allowed = f"a folder with {path.name} in it"
    try:
        whole = netcdf_dataset(existing_file(path, largest=MOST_BYTES))
    except ParameterError as error:
        hint = missing_arrays(path.parent) or error.hint
        raise ParameterError("DIR", str(path.parent), allowed, hint=hint) from None
    with door("DIR", str(path.parent), allowed, "It is damaged or not a results file."):
        return separated(whole)
