"""The verb `sweep`: a study, an executor and a store."""

from __future__ import annotations

import os
import time
import warnings
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ThreadPoolExecutor, wait
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import __version__
from frahm.errors import ParameterError, check_count
from frahm.sweep.batch import Batch, OtherVersionError, batch_size, evaluated
from frahm.sweep.layout import ALLOWED, HEAD, is_sweep
from frahm.sweep.lock import only_writer
from frahm.sweep.store import (
    Store,
    check_complete,
    clear_beside,
    create_store,
    resumed_store,
    stored_study,
    stored_version,
)
from frahm.sweep.study import Study
from frahm.sweep.study_file import load_study
from frahm.sweep.summary import SweepSummary, summary_of

if TYPE_CHECKING:
    import xarray as xr

Progress = Callable[[str, int, int], None]
_IN_FLIGHT = 256  # tasks submitted and not finished
_TRIES = 2  # of a task whose worker was lost
_LOST = 3  # tasks lost with nothing finished in between: the workers are gone
_GRACE = 10.0  # seconds that tasks in other processes may take to end after an interruption
_LOOK = 1.0  # seconds between two looks around where nothing happens
_EVERY = 0.25  # seconds between two writings, or more:
_SHARE = 0.05  # of the time that may go into them


class SweepWarning(UserWarning):
    """Some points of a sweep failed, are unverified or were not computed."""


def sweep(
    study: Any,
    *,
    store: str | os.PathLike[str],
    executor: Executor | None = None,
    resume: bool = False,
    force: bool = False,
    batch: int | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Compute quantities at every point of a study into a store on disk; nothing that happens at a point ends it.

    Parameters
    ----------
    study : Study, str, Path or dict
        See `load_study`.
    store : str or Path
        Folder of the zarr store; it opens with ``xarray.open_zarr(store)``, during the sweep too.
    executor : concurrent.futures.Executor, optional
        Where the points are computed: any executor whose tasks are functions of a module, such as a
        ``ProcessPoolExecutor`` or ``dask.distributed.Client(...).get_executor(pure=False)``; by default threads, one
        per core. The result does not depend on it. It is not shut down.
    resume : bool
        Go on with a store of the same study where it stopped.
    force : bool
        Replace a store of another study, or of this one.
    batch : int, optional
        Points of a task; by default about a second of work. The result does not depend on it.
    progress : callable, optional
        Called with a title, the number of points finished and the number of points.

    Returns
    -------
    xarray.Dataset
        Backed by the store: one dimension per axis; `status` says what became of a point (0 pending, 1 verified,
        2 unverified, 3 failed), `reason` why, by the attribute `reasons`. Frequencies in rad/s, peaks in m.

    Raises
    ------
    ParameterError
        For a bad study, and for a store that holds something else or may not be overwritten.
    KeyboardInterrupt
        As it comes; what was finished is in the store, and `resume` goes on from there.

    Warns
    -----
    SweepWarning
        Once, if points failed, are unverified or were not computed; once, if some were damaged on disk.
    """
    study = load_study(study)
    if executor is not None and not isinstance(executor, Executor):
        raise ParameterError("executor", executor, "a concurrent.futures.Executor, or None for threads")
    path = _real(Path(store))
    points = batch_size(study) if batch is None else check_count("batch", batch)
    report = progress or (lambda title, done, total: None)
    with only_writer(path):
        clear_beside(path)
        filled, damaged = _claimed(study, path, resume=resume, force=force)
        lost = _Filling(filled, points, report).run(executor)
        summary = summary_of(path)
    for sentence in _grouped(summary, lost, damaged):
        warnings.warn(sentence, SweepWarning, stacklevel=2)
    return opened(path)


def opened(path: str | os.PathLike[str]) -> xr.Dataset:
    """The dataset of a store, read on demand.

    Raises
    ------
    ParameterError
        If the folder does not hold a sweep, or something of a finished point or an axis is lost. What is read later
        raises a ValueError where it was changed on disk: every part of every array has its checksum.
    """
    import xarray as xr

    check_complete(Path(path))
    try:
        return xr.open_zarr(path, chunks=None)
    except ValueError as error:  # the axes are read at once
        hint = f"It is damaged: {error} Go on with --resume (resume=True): it is made whole again."
        raise ParameterError("store", str(path), ALLOWED, hint=hint) from None


def _real(path: Path) -> Path:
    """The store itself, so that it has one lock whatever it is called; a path that is no link stays as it was given."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def _claimed(study: Study, path: Path, *, resume: bool, force: bool) -> tuple[Store, int]:
    """A new store where there is none or one may be replaced, else the one that is there; and its damaged points."""
    if path.exists() and not is_sweep(path):
        if not path.is_dir():
            raise ParameterError("store", str(path), "a folder", hint="It is a file.")
        if any(path.iterdir()):
            hint = f"Its {HEAD} cannot be read. {_FOREIGN}" if (path / HEAD).exists() else _FOREIGN
            raise ParameterError("store", str(path), "a new folder, or a store of this study", hint=hint)
        path.rmdir()
    if not path.exists() or (force and not (resume and _same(study, path))):
        return create_store(path, study), 0
    if not _same(study, path):
        hint = f"It holds {_described(path)}. Choose another folder, or replace it with --force (force=True)."
        raise ParameterError("store", str(path), "a new folder, or a store of this study", hint=hint)
    if not resume:
        hint = "It holds this study; go on with --resume (resume=True), or begin anew with --force (force=True)."
        raise ParameterError("store", str(path), "a new folder", hint=hint)
    return resumed_store(path)


_FOREIGN = "It holds other files, which a sweep never touches."


def _same(study: Study, path: Path) -> bool:
    return stored_version(path) == __version__ and stored_study(path).digest == study.digest


def _described(path: Path) -> str:
    version = stored_version(path)
    if version != __version__:
        return f"a sweep by frahm {version}, this is {__version__}"
    return f"another study, {stored_study(path).name!r}"


class _Filling:
    """Tasks out, batches in, the store written from time to time."""

    def __init__(self, store: Store, points: int, report: Progress):
        self.store, self.report = store, report
        self.text = store.study.text
        self.waiting = deque(_batches(store.pending, points))
        self.running: dict[Future[Batch], tuple[np.ndarray, int]] = {}
        self.done = store.study.size - int(store.pending.size)
        self.lost: dict[str, int] = {}
        self.in_a_row = 0
        self.written, self.pause = time.monotonic(), 0.0

    def run(self, executor: Executor | None) -> dict[str, int]:
        """Compute all pending points; returns how many could not be, by the sentence that says why."""
        if executor is not None:
            self._work(executor, None)
        elif self.waiting:
            stopped = Event()
            with ThreadPoolExecutor(os.cpu_count() or 1, thread_name_prefix="frahm-sweep") as threads:
                self._work(threads, stopped)
        self.store.finish()
        return self.lost

    def _work(self, executor: Executor, stopped: Event | None) -> None:
        title = f"points of {self.store.study.name}"
        self.report(title, self.done, self.store.study.size)
        try:
            while self.waiting or self.running:
                self._submit(executor, stopped)
                finished, _ = wait(self.running, timeout=_LOOK, return_when=FIRST_COMPLETED)
                for future in finished:
                    if future in self.running:  # giving up takes the others out
                        self._take(future)
                self._write_if_due()
                self.report(title, self.done, self.store.study.size)
        except BaseException:
            self._stop(stopped)
            raise
        finally:
            self.store.flush()

    def _submit(self, executor: Executor, stopped: Event | None) -> None:
        while self.waiting and len(self.running) < _IN_FLIGHT:
            indices, tries = self.waiting.popleft()
            more = () if stopped is None else (stopped,)
            try:
                future = executor.submit(evaluated, self.text, __version__, indices.tolist(), *more)
            except RuntimeError as error:  # a pool that is broken or shut down
                self._give_up(indices, error)
                continue
            self.running[future] = indices, tries

    def _take(self, future: Future[Batch]) -> None:
        indices, tries = self.running.pop(future)
        try:
            batch = future.result()
        except OtherVersionError as error:
            raise ParameterError("executor", str(error), f"workers with frahm {__version__}") from None
        except (Exception, CancelledError) as error:  # of the worker, not of a point: those are values
            if tries < _TRIES:
                self.waiting.append((indices, tries + 1))
            else:
                self._give_up(indices, error)
            return
        self.in_a_row = 0
        self.store.put(batch)
        self.done += batch.indices.size

    def _give_up(self, indices: np.ndarray, error: BaseException) -> None:
        sentence = f"{type(error).__name__}: {error}".split("\n")[0][:300]
        self.lost[sentence] = self.lost.get(sentence, 0) + int(indices.size)
        self.in_a_row += 1
        if self.in_a_row >= _LOST:
            for rest, _ in (*self.waiting, *self.running.values()):
                self.lost[sentence] += int(rest.size)
            for future in self.running:
                future.cancel()
            self.waiting.clear()
            self.running.clear()

    def _write_if_due(self) -> None:
        if time.monotonic() - self.written < self.pause:
            return
        began = time.monotonic()
        self.store.flush()
        self.written = time.monotonic()
        self.pause = max(_EVERY, (self.written - began) / _SHARE)

    def _stop(self, stopped: Event | None) -> None:
        """Take back what was not begun, and keep what is finished; own threads end with the point they are at."""
        if stopped is not None:
            stopped.set()
        begun = [future for future in self.running if not future.cancel()]
        finished, _ = wait(begun, timeout=_GRACE if stopped is None else None)
        for future in finished:
            if future.exception() is None:
                self.store.put(future.result())


def _batches(pending: np.ndarray, points: int) -> Iterator[tuple[np.ndarray, int]]:
    for start in range(0, pending.size, points):
        yield pending[start : start + points], 1


def _grouped(summary: SweepSummary, lost: dict[str, int], damaged: int) -> Iterator[str]:
    """One sentence for everything that is not as it should be, and one for what was mended; none if all is well."""
    if damaged:
        yield f"{damaged} points were damaged and computed again."
    troubles = [*summary.troubles, *(f"{count} points could not be computed: {why}" for why, count in lost.items())]
    if troubles or summary.pending:
        yield " ".join([f"{summary.counts}.", *troubles])
