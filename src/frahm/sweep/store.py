"""The store of a sweep: one zarr group, written so that it can be read and resumed whatever stops the writer."""

from __future__ import annotations

import contextlib
import json
import math
import os
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from frahm.errors import ParameterError, door
from frahm.files import put_in_place, write_text
from frahm.sweep.batch import Batch
from frahm.sweep.layout import (
    ALLOWED,
    HEAD,
    attributes_of,
    chunk_counts,
    chunk_is_there,
    chunk_part,
    chunk_shape,
    head_of,
    known_values,
    lay_out,
    write_chunks,
    write_reasons,
    wrong_descriptions,
)
from frahm.sweep.lock import beside, unwritable
from frahm.sweep.reasons import Reasons
from frahm.sweep.study import Study
from frahm.sweep.study_file import load_study
from frahm.sweep.variables import Status, variables_of

_LISTED = 4  # names in a sentence
_LOOKS = 3
_OF_THE_MACHINE = (OSError, MemoryError)  # nothing is known about the bytes then


def stored_study(folder: str | Path) -> Study:
    """The study that made a store.

    Raises
    ------
    ParameterError
        If the folder does not hold a sweep, or one that cannot be read.
    """
    attributes = attributes_of(Path(folder))
    try:
        with door("study", "that of the store", "a study"):
            return load_study(json.loads(attributes["study"]))
    except (ParameterError, KeyError) as error:
        hint = f"The study in it cannot be read: {error}."
        raise ParameterError("store", str(folder), ALLOWED, hint=hint) from None


def stored_version(folder: str | os.PathLike[str]) -> str:
    """The version of frahm that made a store."""
    return str(attributes_of(Path(folder))["frahm_version"])


@dataclass(eq=False)
class Damage:
    """What of a store is not as it was written.

    Attributes
    ----------
    arrays : set of str
        Names of the arrays that lost something.
    chunks : set of int
        Chunks of points that say they are finished, or no longer say what they are.
    points : int
        How many points that is.
    descriptions : dict of str
        What the description of an array should be, by the name of the array.
    known : set of str
        Damaged arrays that the study itself says.
    """

    arrays: set[str] = field(default_factory=set)
    chunks: set[int] = field(default_factory=set)
    points: int = 0
    descriptions: dict[str, str] = field(default_factory=dict)
    known: set[str] = field(default_factory=set)

    def sentence(self, points: int) -> str:
        """What is damaged, and the way out; empty if nothing is."""
        names = sorted(self.arrays | self.known | set(self.descriptions))
        if not names:
            return ""
        listed = ", ".join(names[:_LISTED]) + (f" and {len(names) - _LISTED} more" if len(names) > _LISTED else "")
        counted = f"; {self.points} of {points} points" if self.points else ""
        return f"It is damaged ({listed}{counted}). Go on with --resume (resume=True): it is made whole again."


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
            group = _group(self.path, "r+")
            if self.reasons.changed:
                self._write_reasons()
            for name, values in (*self.columns.items(), ("reason", self.reason), ("status", self.status)):
                write_chunks(group[name], values, todo)
        self.changed -= set(todo)

    def finish(self) -> None:
        """Number the reasons in the order of the points, once all are known: it depends on nothing else then."""
        if self.pending.size or not self.reasons.unordered:
            return
        before = self.reason.copy()
        with _written(self.path):
            group = _group(self.path, "r+")
            self.reason[:] = self.reasons.ordered(self.reason)
            self._write_reasons()  # old and new codes differ in sign: both stand in the table meanwhile
            write_chunks(group["reason"], self.reason, sorted(self._chunks_of(np.flatnonzero(before != self.reason))))
            self.reasons.forget_provisional()
            self._write_reasons()

    def mend(self, damage: Damage) -> None:
        """Make a damaged store whole again; the points that lost something are as if they were not computed yet."""
        lost = self._points_of(damage.chunks)
        with _written(self.path):
            for name, text in damage.descriptions.items():
                (self.path / name).mkdir(exist_ok=True)
                write_text(self.path / name / HEAD, text)
            group = _group(self.path, "r+")
            for name, values in known_values(self.study) if damage.known else ():
                if name in damage.known:
                    write_chunks(group[name], values)
            self.status[lost] = Status.PENDING
            write_chunks(group["status"], self.status, sorted(damage.chunks))  # before the values they speak of
        self.reason[lost] = 0
        for variable in variables_of(self.study):
            self.columns[variable.name][lost] = variable.blank
        self.changed |= damage.chunks
        self.flush()

    def _points_of(self, chunks: Iterable[int]) -> np.ndarray:
        """Which points some chunks hold."""
        numbers = np.arange(self.study.size)
        places = np.unravel_index(numbers, self.study.shape)
        sizes = chunk_shape(self.study.shape)
        of = np.ravel_multi_index(
            tuple(place // size for place, size in zip(places, sizes, strict=True)), chunk_counts(self.study.shape)
        )
        return numbers[np.isin(of, list(chunks))]

    def _chunks_of(self, indices: np.ndarray) -> set[int]:
        """Numbers of the chunks that hold some points."""
        shape = self.study.shape
        places = np.unravel_index(indices, shape)
        chunks = tuple(place // size for place, size in zip(places, chunk_shape(shape), strict=True))
        return set(np.ravel_multi_index(chunks, chunk_counts(shape)).tolist())

    def _write_reasons(self) -> None:
        write_reasons(self.path, self.reasons.text)
        self.reasons.changed = False


def create_store(path: Path, study: Study) -> Store:
    """New store; the folder appears complete, and a sweep that stands there gives way. For the only writer."""
    room = beside(path, "new")
    try:
        with _written(path):
            room.mkdir()
            lay_out(room / "new", study)
            if path.exists():
                put_in_place(path, room / "old")
            put_in_place(room / "new", path)
    finally:
        shutil.rmtree(room, ignore_errors=True)
    return _blank(path, study)


def clear_beside(path: Path) -> None:
    """Remove what a writer that was killed while it made the store left beside it. For the only writer.

    Was it killed between the two renamings that put the new store in the place of the old one, the old one is still
    there.
    """
    room = beside(path, "new")
    if not room.is_dir():
        return
    with _written(path):
        if (room / "old").exists() and not path.exists():
            put_in_place(room / "old", path)
        shutil.rmtree(room)


def open_store(path: Path) -> Store:
    """The store of a sweep, all of it in memory; nothing on disk is touched.

    Raises
    ------
    ParameterError
        If it is not one, or is damaged.
    """
    store, damage = _read(path)
    hint = damage.sentence(store.study.size)
    if hint:
        raise ParameterError("store", str(path), ALLOWED, hint=hint)
    return store


def resumed_store(path: Path) -> tuple[Store, int]:
    """The store of a sweep, to go on with it, and how many of its points were damaged. For the only writer.

    What a writer that was killed left half done is removed, and what is damaged is mended.
    """
    for left in path.rglob("*.partial"):
        left.unlink(missing_ok=True)
    store, damage = _read(path)
    if damage.sentence(store.study.size):
        store.mend(damage)
    return store, damage.points


def check_complete(path: Path) -> None:
    """Raise a ParameterError if a chunk of a finished point, or of an axis, is lost; only the state of points is read.

    Changed bits are found by whoever reads the chunk: every one has its checksum.
    """
    store = _blank(path, stored_study(path))
    damage = Damage()
    _read_state(store, damage)
    _look_for_chunks(store, damage)
    hint = damage.sentence(store.study.size)
    if hint:
        raise ParameterError("store", str(path), ALLOWED, hint=hint)


def _blank(path: Path, study: Study) -> Store:
    columns = {variable.name: variable.array(study.size) for variable in variables_of(study)}
    status, reason = np.zeros(study.size, dtype="i1"), np.zeros(study.size, dtype="i4")
    return Store(path, study, columns, status, reason, Reasons(), set())


def _read(path: Path) -> tuple[Store, Damage]:
    """All that can be read of a store, and what cannot."""
    store, damage = _blank(path, stored_study(path)), Damage()
    damage.descriptions = wrong_descriptions(path, head_of(path))
    undecided = _read_state(store, damage)
    _look_for_chunks(store, damage)
    group = _group(path, "r")
    for name, values in store.columns.items():
        _note(damage, name, _read_chunks(path, group[name], values))
    for name in _known_names(store.study, group):
        if _read_chunks(path, group[name], np.empty(group[name].shape, group[name].dtype)):
            damage.known.add(name)
    _read_reasons(store, group, damage)
    lost = store._points_of(damage.chunks)
    damage.points = int(np.count_nonzero((store.status[lost] != Status.PENDING) | np.isin(lost, undecided)))
    return store, damage


def _read_state(store: Store, damage: Damage) -> np.ndarray:
    """Read the state of the points; returns those whose state cannot be read.

    It comes before all else, as it is written after all else: what a writer adds meanwhile does no harm then.
    """
    bad = _read_chunks(store.path, _group(store.path, "r")["status"], store.status)
    _note(damage, "status", bad)
    return store._points_of(bad) if bad else np.empty(0, dtype=int)


def _look_for_chunks(store: Store, damage: Damage) -> None:
    """Find chunks that are not there and should be: of finished points, and of what the study says."""
    group = _group(store.path, "r")
    finished = store._chunks_of(np.flatnonzero(store.status != Status.PENDING))
    for name in (*store.columns, "reason"):
        _note(damage, name, {chunk for chunk in finished if not chunk_is_there(store.path, group[name], chunk)})
    for name in _known_names(store.study, group):
        chunks = range(math.prod(group[name].cdata_shape))
        if not all(chunk_is_there(store.path, group[name], chunk) for chunk in chunks):
            damage.known.add(name)


def _read_reasons(store: Store, group: Any, damage: Damage) -> None:
    """Read the reasons of the points and the table of them, which a writer may be changing: it is looked at again."""
    unknown = np.empty(0, dtype=int)
    for _ in range(_LOOKS):
        _note(damage, "reason", _read_chunks(store.path, group["reason"], store.reason))
        store.reasons = Reasons.read(attributes_of(store.path)["reasons"], store.reason)
        unknown = np.flatnonzero(~np.isin(store.reason, [0, *store.reasons.sentences]))
        if not unknown.size:
            return
    _note(damage, "reason", store._chunks_of(unknown))


def _read_chunks(path: Path, array: Any, values: np.ndarray) -> set[int]:
    """Read an array; what is damaged is left as it is, and the numbers of its chunks are returned."""
    whole, bad = values.reshape(array.shape), set()
    with _readable(path):
        try:
            whole[...] = array[...]
        except _OF_THE_MACHINE:
            raise
        except Exception:  # the codecs raise what they like for bytes that are none of theirs
            for chunk in range(math.prod(array.cdata_shape)):
                part = chunk_part(array, chunk)
                try:
                    whole[part] = array[part]
                except _OF_THE_MACHINE:
                    raise
                except Exception:
                    bad.add(chunk)
    return bad


def _note(damage: Damage, name: str, chunks: set[int]) -> None:
    if chunks:
        damage.arrays.add(name)
        damage.chunks |= chunks


def _known_names(study: Study, group: Any) -> list[str]:
    return [*study.axes_given, *(name for name in ("seed",) if name in group)]


def _group(path: Path, mode: Literal["r", "r+"]) -> Any:
    import zarr

    return zarr.open_group(path, mode=mode, use_consolidated=True)


@contextlib.contextmanager
def _written(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise unwritable(path, error) from None


@contextlib.contextmanager
def _readable(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        hint = f"{error.strerror or error}."
        raise ParameterError("store", str(path), "a folder that can be read", hint=hint) from None
