"""Progress on a terminal, with how long it will take; nothing at all in a pipe."""

from __future__ import annotations

import contextlib
import math
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from frahm import readable

_WORTH_A_WORD = 20.0  # [s] from which on the length is said beforehand
_LEAST = 1.0  # [s] of work that say something on the pace


class Pace:
    """How long is left, from how long what is done has taken on this machine.

    Parameters
    ----------
    clock : callable
        Time [s].
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic):
        self._clock, self._weights = clock, [1.0]
        self._weighed, self._begun = False, math.nan
        self._first = 0.0  # share of what was done already when the work began, as where it goes on

    def weigh(self, weights: Sequence[float]) -> None:
        """Let the work begin now, and its steps have these weights; without any they are all alike."""
        self._weights, self._weighed, self._begun = [float(weight) for weight in weights], bool(weights), math.nan

    def left(self, done: int, total: int) -> float:
        """Time left [s] once `done` of `total` steps are done; NaN before that can be known."""
        share = self._share(done, total)
        if math.isnan(self._begun) or share < self._first:
            self._begun, self._first = self._clock(), share
        elapsed = self._clock() - self._begun
        if share <= self._first or elapsed < _LEAST:
            return math.nan
        return elapsed * (1 - share) / (share - self._first)

    def _share(self, done: int, total: int) -> float:
        if self._weighed:
            return min(1.0, sum(self._weights[:done]) / sum(self._weights))
        return done / total if total else 0.0


class Progress:
    """Steps as they are reported: title, number of steps done, number of steps; told to nobody in a pipe."""

    def __init__(self, shown: Any = None, pace: Pace | None = None):
        self._shown, self._pace = shown, pace or Pace()
        self._task = shown.add_task("", total=None, left="") if shown else None
        self._said = False

    def weigh(self, weights: Sequence[float]) -> None:
        """Say how the work is shared among the steps that follow."""
        self._pace.weigh(weights)

    def __call__(self, title: str, done: int, total: int) -> None:
        """Report that `done` of `total` steps are done and what is done next."""
        if self._shown is None:
            return
        left = self._pace.left(done, total)
        known = math.isfinite(left) and done < total
        words = f"about {_coarse(left)} left" if known and left >= _LEAST else ""
        self._shown.update(self._task, description=title, completed=done, total=total, left=words)
        if known and not self._said and left >= _WORTH_A_WORD:
            self._said = True
            self._shown.console.print(
                f"About {_coarse(left)} to go, by the first {done} of {total} steps on this machine.", highlight=False
            )


@contextlib.contextmanager
def shown_progress() -> Iterator[Progress]:
    """Give what steps are reported to."""
    if not sys.stderr.isatty():
        yield Progress()
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    columns = (
        BarColumn(bar_width=24), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("{task.fields[left]}"),
        TextColumn("{task.description}"),
    )  # fmt: skip
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        yield Progress(bar)


def _coarse(seconds: float) -> str:
    """A time as it is worth: no pace is known to more than a digit or two."""
    if seconds < 90:
        return f"{max(5, 5 * round(seconds / 5))} s"
    return f"{round(seconds / 60)} min" if seconds < 5400 else f"{seconds / readable.HOUR:.1f} h"
