"""Binary files that anybody may have written, parsed in a process of their own with bounds on memory and time.

The libraries that read MAT and HDF5 files are native code: a damaged file can end the process that reads it, and a
small one, or a small workbook, can ask for any amount of memory. What comes back from the other process is plain: text,
numbers, and arrays as raw bytes, nothing that could be executed.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

from frahm.errors import ParameterError

MOST_BYTES = 500_000_000  # of all arrays in a file together
_SECONDS = 60.0
_CHILD = str(Path(__file__).with_name("child.py"))
_BASE = 2**30  # address space for the interpreter and the libraries themselves [bytes]
_KINDS = {"mat": "a MAT file of version 5", "netcdf": "a netCDF file", "xlsx": "a workbook (.xlsx)"}


def binary_content(kind: str, path: Path, *, most_bytes: int = MOST_BYTES) -> dict[str, Any]:
    """What a binary file holds.

    Parameters
    ----------
    kind : {"mat", "netcdf", "xlsx"}
        MAT of version 4 to 7; netCDF 3 or 4; a workbook.
    path : Path
        The file.
    most_bytes : int
        Of its arrays, uncompressed, together.

    Returns
    -------
    dict
        MAT: variables by name: arrays, text, lists for cells, dictionaries for structs, None for anything else.
        netCDF: "attrs" and "variables", each with "dims", "attrs" and "data", nothing decoded.
        Workbook: "sheet", the name of the first visible one that holds any cells, its "rows", text and numbers, and
        the "lines" they stand in, from 1.

    Raises
    ------
    ParameterError
        If the file is damaged, of another kind, or too large once unpacked, or takes too long.
    """
    allowed = _KINDS[kind]
    memory = _BASE + 4 * most_bytes
    command = [sys.executable, "-P", _CHILD, kind, str(path)]
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
        "PYTHONUTF8": "1",
        "OPENBLAS_NUM_THREADS": "1",  # each thread would reserve address space of its own
    }
    try:
        done = subprocess.run(
            [*command, str(most_bytes), str(memory), str(_SECONDS)], capture_output=True, stdin=subprocess.DEVNULL,
            timeout=_SECONDS, check=False, env=environment, creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        raise ParameterError("file", str(path), allowed, hint=f"Reading it took over {_SECONDS:g} s.") from None
    except ValueError as error:  # a name no system call takes
        raise ParameterError("file", str(path), allowed, hint=f"{error}.") from None
    if done.returncode == 1:  # the interpreter itself came to an end: a mistake of the program
        raise RuntimeError(f"reading {path} failed:\n{done.stderr.decode('utf-8', 'replace')[-4000:]}")
    if done.returncode:
        raise ParameterError("file", str(path), allowed, hint="It is damaged: what reads it broke down.")
    content = _unpacked(done.stdout)
    if "problem" in content:
        raise ParameterError("file", str(path), allowed, hint=content["problem"])
    return content["content"]


def _unpacked(raw: bytes) -> dict[str, Any]:
    """The message of the other process: the length of a JSON text, the text, and the bytes of its arrays."""
    size = int.from_bytes(raw[:8], "little")
    head = json.loads(raw[8 : 8 + size])
    arrays, start = [], 8 + size
    for dtype, shape in head.get("arrays", []):
        kind = np.dtype(dtype)
        if kind.kind not in "biufc":
            raise RuntimeError(f"an array of type {dtype} came back")
        count = int(np.prod(shape, dtype=np.int64))
        arrays.append(np.frombuffer(raw, kind, count, start).reshape(shape).copy())
        start += count * kind.itemsize
    return {key: _restored(head[key], arrays) for key in ("content", "problem") if key in head}


def _restored(value: Any, arrays: list[np.ndarray]) -> Any:
    """Every value comes as a pair of its kind and itself."""
    if not isinstance(value, list):
        return value
    kind, inner = value
    if kind == "array":
        return arrays[inner]
    if kind == "list":
        return [_restored(entry, arrays) for entry in inner]
    return {key: _restored(entry, arrays) for key, entry in inner.items()}
