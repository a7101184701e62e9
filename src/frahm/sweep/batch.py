"""A batch of points: what one task of an executor computes, in this process or in another one."""

from __future__ import annotations

import functools
import json
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from threading import Event

import numpy as np

from frahm import __version__
from frahm.sweep.points import StudyPoint
from frahm.sweep.quantities import PointResult, computed, equilibria, is_closed_form
from frahm.sweep.reasons import kind_of_reason
from frahm.sweep.study import Study
from frahm.sweep.study_file import load_study
from frahm.sweep.variables import Status, at_window, variables_of_quantity

_LONGEST = 400
# Seconds a point takes, roughly: what makes a task worth its overhead and yet short enough to see progress.
_COSTS = {
    ("slow_flow", False): 2e-5, ("slow_flow", True): 3e-3, ("response", False): 0.03, ("response", True): 0.03,
    ("attractors", False): 0.5, ("attractors", True): 10.0, ("fatigue", False): 30.0,
}  # fmt: skip
_TASK, _LEAST = 1.5, 0.05  # seconds of a task; of a small study, too, enough to outweigh its overhead of a millisecond
_MOST = 20_000
_FEWEST_TASKS = 16


class OtherVersionError(RuntimeError):
    """A worker runs another version of frahm."""


@dataclass(frozen=True, eq=False)
class Batch:
    """Results at some points.

    Attributes
    ----------
    indices : ndarray of int, shape (points,)
        Numbers of the points finished.
    columns : dict
        Array of every variable, by name; shape (points,) or (points, 3).
    status : ndarray of int8, shape (points,)
        `Status` codes.
    sentences : tuple of str
        For every point why it failed or what is unverified; empty if nothing.
    """

    indices: np.ndarray
    columns: dict[str, np.ndarray]
    status: np.ndarray
    sentences: tuple[str, ...]


def batch_size(study: Study) -> int:
    """Number of points of a task: about a second of work; less in small studies, so that progress can be seen."""
    cost = sum(_COSTS[name, at_window(study, asked)] for name, asked in study.asked.items())
    share = max(-(-study.size // _FEWEST_TASKS), int(_LEAST / cost))
    return max(1, min(int(_TASK / cost), _MOST, share))


def evaluated(text: str, version: str, indices: Sequence[int], stopped: Event | None = None) -> Batch:
    """All quantities of a study at some points.

    Parameters
    ----------
    text : str
        The study as JSON, see `Study.text`: what crosses to other processes is text and numbers alone.
    version : str
        Version of frahm that asks.
    indices : sequence of int
        Numbers of the points.
    stopped : Event, optional
        Set to leave out the points not begun yet; in this process only.
    """
    if version != __version__:
        raise OtherVersionError(f"frahm {__version__} on the worker, {version} here")
    study = _study(text)
    if all(is_closed_form(study, name) for name in study.asked):
        return _at_once(study, np.array(indices, dtype=np.int64))
    done: list[tuple[StudyPoint, list[PointResult]]] = []
    for index in indices:
        if stopped is not None and stopped.is_set():
            break
        point = StudyPoint(study, int(index))
        done.append((point, [computed(name, [point])[0] for name in study.asked]))
    return _collected(study, done)


def _at_once(study: Study, indices: np.ndarray) -> Batch:
    """Closed forms: arrays in, arrays out."""
    (name,) = study.asked
    numbers, failures = equilibria(study, indices)
    columns, bad = {}, list(failures)
    for variable in variables_of_quantity(study, name):
        columns[variable.name] = numbers[variable.name.removeprefix(f"{name}_")].astype(variable.dtype)
        columns[variable.name][bad] = variable.blank
    status = np.full(indices.size, Status.VERIFIED, dtype="i1")
    status[bad] = Status.FAILED
    sentences = [""] * indices.size
    for row, failure in failures.items():
        _, sentences[row] = _judged(study, [PointResult(failure=failure)])
    return Batch(indices, columns, status, tuple(sentences))


@functools.lru_cache(maxsize=4)
def _study(text: str) -> Study:
    return load_study(json.loads(text))


def _collected(study: Study, done: list[tuple[StudyPoint, list[PointResult]]]) -> Batch:
    columns = {}
    for which, name in enumerate(study.asked):
        good = [row for row, (_, founds) in enumerate(done) if not founds[which].failure]
        for variable in variables_of_quantity(study, name):
            key = variable.name.removeprefix(f"{name}_")
            columns[variable.name] = variable.array(len(done))
            if good:
                columns[variable.name][good] = [done[row][1][which].numbers[key] for row in good]
    judged = [_judged(study, founds) for _, founds in done]
    return Batch(
        indices=np.array([point.index for point, _ in done], dtype=np.int64),
        columns=columns,
        status=np.array([status for status, _ in judged], dtype="i1"),
        sentences=tuple(sentence for _, sentence in judged),
    )


def _judged(study: Study, founds: list[PointResult]) -> tuple[Status, str]:
    """Status of a point and the sentence for it: failures first, then doubts."""
    if not any(found.failure or found.doubts for found in founds):
        return Status.VERIFIED, ""
    named = list(zip(study.asked, founds, strict=True))
    failures = [f"{name}: {found.failure}" for name, found in named if found.failure]
    doubts = [f"{name}: {doubt}" for name, found in named for doubt in found.doubts]
    sentence = re.sub(r"\s+", " ", " ".join(failures or _one_of_a_kind(doubts)))
    short = sentence if len(sentence) <= _LONGEST else sentence[: _LONGEST - 3] + "..."
    return Status.FAILED if failures else Status.UNVERIFIED, short


def _one_of_a_kind(sentences: list[str]) -> list[str]:
    """Sentences that differ in more than their numbers, the first of each kind."""
    kinds = Counter(kind_of_reason(sentence) for sentence in sentences)
    first = {kind_of_reason(sentence): sentence for sentence in reversed(sentences)}
    return [first[kind] + (f" And {count - 1} like it." if count > 1 else "") for kind, count in kinds.items()]
