"""The store of a sweep: one zarr group, written so that it can be read and resumed whatever stops the writer."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import tempfile
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from frahm import __version__
from frahm.case import field_table
from frahm.errors import ParameterError, door
from frahm.sweep.batch import Batch
from frahm.sweep.reasons import Reasons
from frahm.sweep.study import Axes, Study
from frahm.sweep.study_file import load_study
from frahm.sweep.variables import ROOTS, STATUS_CODES, Status, Variable, variables_of

SCHEMA = "frahm-sweep-1"
_CHUNK = 16_384  # points
_ALLOWED = "a folder that `frahm sweep` wrote"
_STATUS = Variable("status", "what became of the point", codes=STATUS_CODES, dtype="i1")
_REASON = Variable(
    "reason", "why the point failed or is unverified", codes="0 none, others: see the attribute reasons", dtype="i4"
)
_SEED = Variable("seed", "seed of the initial states sampled at this point", dtype="i8")


def is_sweep(folder: str | Path) -> bool:
    """Whether a folder holds the store of a sweep."""
    try:
        return _attributes(Path(folder)).get("schema") == SCHEMA
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return False


def stored_study(folder: str | Path) -> Study:
    """The study that made a store.

    Raises
    ------
    ParameterError
        If the folder does not hold a sweep, or one that cannot be read.
    """
    if not is_sweep(folder):
        raise ParameterError("store", str(folder), _ALLOWED)
    try:
        with door("study", "that of the store", "a study"):
            return load_study(json.loads(_attributes(Path(folder))["study"]))
    except ParameterError as error:
        hint = f"The study in it cannot be read: {error}."
        raise ParameterError("store", str(folder), _ALLOWED, hint=hint) from None


def stored_version(folder: str | os.PathLike[str]) -> str:
    """The version of frahm that made a store."""
    return str(_attributes(Path(folder))["frahm_version"])


def _attributes(folder: Path) -> dict[str, Any]:
    return dict(json.loads((folder / "zarr.json").read_text(encoding="utf-8"))["attributes"])


@dataclass(eq=False)
class Store:
    """A store that is being filled: all arrays in memory, the parts that changed written from time to time.

    What a point is known for is written before its status, every part of an array in one step: whatever stops the
    writer, a point that says it is finished is.
    """

    path: Path
    study: Study
    columns: dict[str, np.ndarray]
    status: np.ndarray
    reason: np.ndarray
    reasons: Reasons
    changed: set[int]

    @property
    def pending(self) -> np.ndarray:
        """Numbers of the points not finished."""
        return np.flatnonzero(self.status == Status.PENDING)

    def put(self, batch: Batch) -> None:
        """Take in the results of a batch."""
        if not batch.indices.size:
            return
        for name, values in batch.columns.items():
            self.columns[name][batch.indices] = values
        for index, sentence in zip(batch.indices, batch.sentences, strict=True):
            if sentence:
                self.reason[index] = self.reasons.code(sentence, int(index))
        self.changed |= self._chunks_of(batch.indices)
        self.status[batch.indices] = batch.status

    def flush(self) -> None:
        """Write what changed."""
        if not self.changed:
            return
        todo = sorted(self.changed)
        with _written(self.path):
            group = _group(self.path)
            if self.reasons.changed:
                self._write_reasons(group)
            for name, values in (*self.columns.items(), ("reason", self.reason), ("status", self.status)):
                for chunk in todo:
                    self._write(group[name], values, chunk)
        self.changed -= set(todo)

    def finish(self) -> None:
        """Number the reasons in the order of the points, once all are known: it depends on nothing else then."""
        if self.pending.size or not self.reasons.unordered:
            return
        before = self.reason.copy()
        with _written(self.path):
            group = _group(self.path)
            self.reason[:] = self.reasons.ordered(self.reason)
            self._write_reasons(group)  # old and new codes differ in sign: both stand in the table meanwhile
            for chunk in sorted(self._chunks_of(np.flatnonzero(before != self.reason))):
                self._write(group["reason"], self.reason, chunk)
            self.reasons.forget_provisional()
            self._write_reasons(group)

    def _chunks_of(self, indices: np.ndarray) -> set[int]:
        """Numbers of the chunks that hold some points."""
        shape = self.study.shape
        places = np.unravel_index(indices, shape)
        chunks = tuple(place // size for place, size in zip(places, chunk_shape(shape), strict=True))
        return set(np.ravel_multi_index(chunks, _chunk_counts(shape)).tolist())

    def _write_reasons(self, group: Any) -> None:
        group.attrs["reasons"] = self.reasons.text
        self.reasons.changed = False

    def _write(self, array: Any, values: np.ndarray, chunk: int) -> None:
        shape = self.study.shape
        whole = values.reshape(*shape, *values.shape[1:])
        places = np.unravel_index(chunk, _chunk_counts(shape))
        part = tuple(slice(i * c, (i + 1) * c) for i, c in zip(places, chunk_shape(shape), strict=True))
        array[part] = whole[part]


def chunk_shape(shape: tuple[int, ...]) -> tuple[int, ...]:
    """Chunks of whole runs of the fastest axes: points that are computed together are stored together."""
    sizes, room = [1] * len(shape), _CHUNK
    for axis in range(len(shape) - 1, -1, -1):
        if shape[axis] > room:
            sizes[axis] = max(1, room)
            break
        sizes[axis] = shape[axis]
        room //= shape[axis]
    return tuple(sizes)


def _chunk_counts(shape: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(-(-n // c) for n, c in zip(shape, chunk_shape(shape), strict=True))


def create_store(path: Path, study: Study) -> Store:
    """New store; the folder appears complete. A sweep that stands there gives way."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        beside = Path(tempfile.mkdtemp(prefix=f".{path.name[:40]}-", dir=path.parent))
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from None
    try:
        with _written(path):
            _lay_out(beside / "new", study)
            (beside / "new").chmod(0o777 & ~_umask())
            if path.exists():
                path.rename(beside / "old")
            (beside / "new").rename(path)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
    return _blank(path, study)


def open_store(path: Path) -> Store:
    """The store of a sweep, all of it in memory; nothing on disk is touched."""
    study = stored_study(path)
    store = _blank(path, study)
    try:
        group = _group(path)
        for name, values in (*store.columns.items(), ("status", store.status), ("reason", store.reason)):
            values[...] = group[name][...].reshape(values.shape)
        store.reasons = Reasons.read(group.attrs["reasons"], store.reason)
    except Exception as error:  # the codecs raise what they like for bytes that are none of theirs
        hint = f"It is damaged: {type(error).__name__}: {error}."
        raise ParameterError("store", str(path), _ALLOWED, hint=hint) from None
    return store


def resumed_store(path: Path) -> Store:
    """The store of a sweep, to go on with it; what a writer that was killed left half done is removed."""
    for left in path.rglob("*.partial"):
        left.unlink(missing_ok=True)
    return open_store(path)


@contextlib.contextmanager
def only_writer(path: Path) -> Iterator[None]:
    """Inside this block no other process fills the store (where the system has such locks; they end with a process)."""
    try:
        import fcntl
    except ImportError:  # Windows
        yield
        return
    handle = os.open(path, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            hint = "Another sweep is writing to it."
            raise ParameterError("store", str(path), "a store nobody else writes to", hint=hint) from None
        except OSError:  # a file system without locks
            pass
        yield
    finally:
        os.close(handle)


def _blank(path: Path, study: Study) -> Store:
    columns = {variable.name: variable.array(study.size) for variable in variables_of(study)}
    status, reason = np.zeros(study.size, dtype="i1"), np.zeros(study.size, dtype="i4")
    return Store(path, study, columns, status, reason, Reasons(), set())


def _lay_out(path: Path, study: Study) -> None:
    import zarr

    attributes = {
        "title": study.title or study.name,
        "schema": SCHEMA,
        "study": study.text,
        "study_digest": study.digest,
        "frahm_version": __version__,
        "reasons": Reasons().text,
    }
    group = zarr.create_group(path, zarr_format=3, attributes=attributes)
    facts = field_table(Axes)
    for name, values in study.axes_given.items():
        more: dict[str, Any] = {"long_name": facts[name].title.lower(), "units": facts[name].unit or "1"}
        array = group.create_array(
            name, shape=(len(values),), dtype="f8", chunks=(len(values),), dimension_names=(name,), attributes=more
        )
        array[:] = np.array(values)
    for variable in (*variables_of(study), _REASON, _STATUS):
        _add(group, study, variable, fill=variable.blank if variable not in (_REASON, _STATUS) else 0)
    if "attractors" in study.asked or "fatigue" in study.asked:
        seeds = np.array([study.seed_at(index) for index in range(study.size)], dtype="i8")
        _add(group, study, _SEED, fill=0)[...] = seeds.reshape(study.shape)
    with warnings.catch_warnings():  # not yet part of the zarr 3 specification, and what xarray wants for a quick look
        warnings.filterwarnings("ignore", message="Consolidated metadata")
        zarr.consolidate_metadata(path)


def _add(group: Any, study: Study, variable: Variable, fill: float) -> Any:
    attributes: dict[str, Any] = variable.attributes if variable not in (_STATUS, _SEED) else _plain(variable)
    more = ((ROOTS,), (ROOTS,), ("root",)) if variable.roots else ((), (), ())
    return group.create_array(
        variable.name,
        shape=(*study.shape, *more[0]),
        chunks=(*chunk_shape(study.shape), *more[1]),
        dimension_names=(*study.axes_given, *more[2]),
        dtype=variable.dtype,
        fill_value=fill,
        attributes=attributes,
    )


def _plain(variable: Variable) -> dict[str, Any]:
    """Attributes of a variable that is known at every point."""
    return {key: text for key, text in variable.attributes.items() if key != "missing"}


def _group(path: Path) -> Any:
    import zarr

    return zarr.open_group(path, mode="r+")


@contextlib.contextmanager
def _written(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise _unwritable(path, error) from None


def _unwritable(path: Path, error: Exception) -> ParameterError:
    reason = getattr(error, "strerror", None) or str(error)
    return ParameterError("store", str(path), "a folder that can be written", hint=f"{reason}.")


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
