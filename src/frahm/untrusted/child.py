"""The other process: one binary file in, plain arrays out. It is run as a script and imports nothing of frahm."""

from __future__ import annotations

import contextlib
import json
import os
import struct
import sys
import zlib
from typing import Any, BinaryIO

_BLOCK = 1 << 20
_HEAD = 128  # bytes before the first element of a MAT file of version 5
_COMPRESSED = 15
_MOST_LEAVES = 100_000  # arrays, texts and the like: each takes far more memory than its bytes
_MOST_TEXT = 16_000_000  # bytes of text, which the other side takes apart into many small pieces
_DAMAGED = "It is damaged."
_COMPOUND = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"  # what files of the old kind, and encrypted ones, begin with
_MOST_ENTRIES, _MOST_ROWS, _WIDEST, _LONGEST, _HUGE = 2000, 20_000, 200, 1000, 1e300
_LAST_LINE = 1_048_576


class RefusedError(Exception):
    """A file that is not read, with the sentence that says why."""


class Message:
    """What goes back: a tree of text and numbers, and the arrays its leaves refer to."""

    def __init__(self, most_bytes: int = 0) -> None:
        self.arrays: list[Any] = []
        self._most, self._bytes, self._leaves = most_bytes, 0, 0

    def count(self) -> None:
        """One leaf more, of whatever kind."""
        self._leaves += 1
        if self._leaves > _MOST_LEAVES:
            raise RefusedError(f"It holds more than {_MOST_LEAVES} arrays, texts and attributes.")

    def array(self, values: Any) -> list[Any]:
        """A leaf that is an array of numbers; it may be larger than in the file, which can store it shorter."""
        self._bytes += values.nbytes
        if self._bytes > self._most:
            raise RefusedError(f"Its arrays are larger than {self._most // 1_000_000} MB.")
        self.arrays.append(values)
        return ["array", len(self.arrays) - 1]

    def send(self, stream: BinaryIO, head: dict[str, Any], longest: int = _BLOCK) -> None:
        """Write the length of the text, the text of at most `longest` bytes, and the bytes of the arrays."""
        import numpy as np

        arrays = [np.require(values, requirements="C") for values in self.arrays]
        text = json.dumps(head | {"arrays": [(values.dtype.str, values.shape) for values in arrays]}).encode("ascii")
        if len(text) > longest:
            raise RefusedError("It holds more text and structures than it may.")
        stream.write(len(text).to_bytes(8, "little"))
        stream.write(text)
        for values in arrays:
            stream.write(values.tobytes())
        stream.flush()


def main() -> None:
    """Read the file named on the command line and write what it holds to the standard output."""
    kind, path, most_bytes, memory, seconds = sys.argv[1:]
    stream = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever a library prints is no part of the answer
    _bound(int(memory), float(seconds))
    most = int(most_bytes)
    message = Message(most)
    try:
        content = {"mat": _mat, "netcdf": _netcdf, "xlsx": _xlsx}[kind](path, most, message)
        message.send(stream, {"content": ["mapping", content]}, min(most // 4, _MOST_TEXT))
    except RefusedError as refused:
        Message().send(stream, {"problem": str(refused)})
    except MemoryError:
        Message().send(stream, {"problem": "It asks for more memory than it may."})
    except RecursionError:
        Message().send(stream, {"problem": _DAMAGED})


def _bound(memory: int, seconds: float) -> None:
    """Bound memory and time of this process where the system can; the process that waits bounds the time anywhere."""
    try:
        import resource
    except ImportError:  # Windows: the sizes a file states are checked before anything is read
        return
    bounds = {"RLIMIT_AS": memory, "RLIMIT_CPU": int(seconds), "RLIMIT_CORE": 0, "RLIMIT_FSIZE": 0}
    for name, bound in bounds.items():
        with contextlib.suppress(AttributeError, ValueError, OSError):  # not every system knows every one of them
            resource.setrlimit(getattr(resource, name), (bound, bound))


@contextlib.contextmanager
def _library() -> Any:
    """Around calls of a library: a damaged file makes it raise anything at all."""
    try:
        yield
    except (RefusedError, MemoryError):
        raise
    except OSError as error:
        raise RefusedError(f"{error.strerror}." if error.strerror else _DAMAGED) from None
    except Exception as error:
        raise RefusedError(f"It is damaged ({type(error).__name__}).") from None


# --- MAT ------------------------------------------------------------------------------------------------------------


def _mat(path: str, most_bytes: int, message: Message) -> dict[str, Any]:
    import scipy.io

    with _library():
        _check_unpacked(path, most_bytes)
        try:
            found = scipy.io.loadmat(path, struct_as_record=True, chars_as_strings=True)
        except NotImplementedError:
            raise RefusedError("It is of version 7.3: in MATLAB, save it with the option -v7.") from None
    return {name: _leaf(value, message) for name, value in found.items() if not name.startswith("__")}


def _check_unpacked(path: str, most_bytes: int) -> None:
    """Refuse a file that unpacks to more than it may, without keeping what is unpacked."""
    total, allowed = 0, f"Its arrays are larger than {most_bytes // 1_000_000} MB."
    with open(path, "rb") as file:
        head = file.read(_HEAD)
        if os.path.getsize(path) > most_bytes:
            raise RefusedError(allowed)
        order = {b"IM": "<", b"MI": ">"}.get(head[126:128])
        if order is None:
            return  # of version 4, which does not compress, or no MAT file at all
        while len(tag := file.read(8)) == 8:
            kind, size = struct.unpack(f"{order}II", tag)
            end = file.tell() + size
            if kind == _COMPRESSED:
                total += _inflated(file, size, most_bytes - total)
            if total > most_bytes:
                raise RefusedError(allowed)
            file.seek(end)


def _inflated(file: BinaryIO, size: int, most: int) -> int:
    unpack, total, waiting = zlib.decompressobj(), 0, b""
    while total <= most:
        if not waiting:
            waiting = file.read(min(_BLOCK, size))
            size -= len(waiting)
            if not waiting:
                break
        total += len(unpack.decompress(waiting, _BLOCK))
        waiting = unpack.unconsumed_tail
        if unpack.eof:
            break
    return total


def _leaf(value: Any, message: Message) -> Any:
    """A variable as text, an array, a list or a mapping; None for what is none of them."""
    import numpy as np

    message.count()
    if isinstance(value, str):
        return value
    if not isinstance(value, np.ndarray):
        return None
    if value.dtype.names:
        rows = [_fields(row, message) for row in value.reshape(-1)]
        return rows[0] if len(rows) == 1 else ["list", rows]
    if value.dtype.kind in "biufc":
        return message.array(value)
    if value.dtype.kind == "U":
        return str(value.reshape(-1)[0]) if value.size == 1 else ["list", value.reshape(-1).tolist()]
    if value.dtype.kind == "O":
        return ["list", [_leaf(entry, message) for entry in value.reshape(-1)]]
    return None


def _fields(row: Any, message: Message) -> list[Any]:
    return ["mapping", {name: _leaf(row[name], message) for name in row.dtype.names}]


# --- netCDF ---------------------------------------------------------------------------------------------------------


def _netcdf(path: str, most_bytes: int, message: Message) -> dict[str, Any]:
    with _library(), open(path, "rb") as file:
        start = file.read(4)
    if start[:3] == b"CDF":
        return _netcdf3(path, most_bytes, message)
    if start[:4] == b"\x89HDF":
        return _netcdf4(path, most_bytes, message)
    raise RefusedError("It does not begin as a netCDF file does.")


def _netcdf3(path: str, most_bytes: int, message: Message) -> dict[str, Any]:
    import numpy as np
    import scipy.io

    with _library(), scipy.io.netcdf_file(path, mmap=False, maskandscale=False) as file:
        if os.path.getsize(path) > most_bytes:
            raise RefusedError(f"Its arrays are larger than {most_bytes // 1_000_000} MB.")
        variables = {}
        for name, variable in file.variables.items():
            values = np.asarray(variable.data)
            native = values.astype(values.dtype.newbyteorder("="))
            variables[name] = _variable(native, variable.dimensions, variable._attributes, message)
        return _whole(file._attributes, variables, message)


def _netcdf4(path: str, most_bytes: int, message: Message) -> dict[str, Any]:
    import h5netcdf
    import numpy as np

    with _library(), h5netcdf.File(path, "r", phony_dims="sort") as file:
        sizes = (int(np.prod(v.shape, dtype=object)) * v.dtype.itemsize for v in file.variables.values())
        if sum(sizes) > most_bytes:
            raise RefusedError(f"Its arrays are larger than {most_bytes // 1_000_000} MB.")
        variables = {
            name: _variable(np.asarray(variable[...]), variable.dimensions, dict(variable.attrs), message)
            for name, variable in file.variables.items()
        }
        return _whole(dict(file.attrs), variables, message)


def _whole(attributes: dict[str, Any], variables: dict[str, Any], message: Message) -> dict[str, Any]:
    return {"attrs": _attributes(attributes, message), "variables": ["mapping", variables]}


def _variable(values: Any, dims: Any, attributes: dict[str, Any], message: Message) -> list[Any]:
    message.count()
    data = None
    if values.dtype.kind in "biufc":
        data = message.array(values)
    elif values.dtype.kind in "OSU":
        data = ["list", [_text(entry) for entry in values.reshape(-1).tolist()]]
    shape = ["list", list(values.shape)]
    return ["mapping", {"dims": ["list", list(map(str, dims))], "shape": shape, "data": data,
                        "attrs": _attributes(attributes, message)}]  # fmt: skip


def _attributes(attributes: dict[str, Any], message: Message) -> list[Any]:
    return ["mapping", {str(name): _attribute(value, message) for name, value in attributes.items()}]


def _attribute(value: Any, message: Message) -> Any:
    import numpy as np

    message.count()
    array = np.asarray(value)
    if array.dtype.kind in "biufc":
        return message.array(array)
    entries = [_text(entry) for entry in array.reshape(-1).tolist()]
    return ["list", entries] if array.ndim else entries[0]


# --- workbooks ------------------------------------------------------------------------------------------------------


def _xlsx(path: str, most_bytes: int, message: Message) -> dict[str, Any]:
    _check_packed(path, most_bytes)
    import openpyxl

    with _library():
        book = openpyxl.load_workbook(path, read_only=True, data_only=True, keep_links=False)
        for sheet in book.worksheets:
            if sheet.sheet_state != "visible":
                continue
            sheet.reset_dimensions()  # what a file says of its own size need not be true
            lines, rows = _rows(sheet)
            if rows:
                return {"sheet": str(sheet.title), "lines": ["list", lines], "rows": ["list", rows]}
    raise RefusedError("It has no sheet with anything in it.")


def _check_packed(path: str, most_bytes: int) -> None:
    """Refuse a workbook that is encrypted, damaged, or unpacks to more than it may."""
    import zipfile

    with _library(), open(path, "rb") as file:
        if file.read(8) == _COMPOUND:
            raise RefusedError("It is protected by a password, or of the old kind .xls: save it as .xlsx without one.")
        with zipfile.ZipFile(file) as packed:
            entries = packed.infolist()
            # No more than the size stated is ever unpacked.
            if len(entries) > _MOST_ENTRIES or sum(entry.file_size for entry in entries) > most_bytes:
                raise RefusedError(f"Unpacked it is larger than {most_bytes // 1_000_000} MB.")


def _rows(sheet: Any) -> tuple[list[int], list[Any]]:
    """Rows with something in them, without the empty cells at their end, and where they stand."""
    lines, rows = [], []
    for number, row in enumerate(sheet.iter_rows(values_only=True), start=1):
        cells = [_cell(value) for value in row[:_WIDEST]]
        while cells and cells[-1] == "":
            cells.pop()
        if cells:
            lines.append(number)
            rows.append(["list", cells])
        if len(rows) > _MOST_ROWS or number > _LAST_LINE:
            raise RefusedError(f"It has more than {_MOST_ROWS} rows, or one beyond the last a sheet can have.")
    return lines, rows


def _cell(value: Any) -> Any:
    """A number, or text without blanks around it."""
    if value is None:
        return ""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value) if abs(value) < _HUGE else str(value)[:_LONGEST]
    return str(value).strip()[:_LONGEST]


def _text(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


if __name__ == "__main__":
    main()
