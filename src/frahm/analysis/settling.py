"""Whether the tail of a motion repeats every period, is modulated for good, or has not settled."""

from __future__ import annotations

import dataclasses

import numpy as np

from frahm.arrays import Floats
from frahm.time_integration import TimeHistory

KINDS = ("periodic", "modulated", "unsettled", "chaotic")
PERIODIC_BELOW = 1e-3
STEADY_WITHIN = 0.3
_SHORTEST = 80
_HARDLY = 0.1


def section_spread(history: TimeHistory) -> float:
    """Half range of the Poincare section over its largest state, the worse of displacement and velocity; 0 if periodic.

    Displacements and velocities of each coordinate are compared with the peak of that coordinate over the history, of a
    coordinate that hardly moves with a tenth of the largest: what is left there may be rounding.
    """
    section = history.poincare()
    spread = 0.0
    for values, whole in (
        (section["displacement"].values, history.x),
        (section["velocity"].values, history.v),
    ):
        sizes = np.max(np.abs(whole), axis=0, initial=0.0)
        sizes = np.maximum(sizes, _HARDLY * np.max(sizes, initial=0.0))
        ranges = np.ptp(values, axis=0) / 2
        spread = max(spread, float(np.max(ranges[sizes > 0] / sizes[sizes > 0], initial=0.0)))
    return spread


def judge(history: TimeHistory) -> tuple[str, float]:
    """Kind of the motion, and the spread of its Poincare section over the last eighth of the history; NaN if it failed.

    Periodic: that spread is below 1e-3. Modulated: it is larger, and over the last quarter as large as over the second
    one (within 30 %), between which a transient decays. Anything else, or less than 80 periods, is unsettled.
    """
    if not history.outcome.ok:
        return "unsettled", float("nan")
    periods = (history.time.size - 1) // history.samples_per_period
    last = section_spread(_part(history, 7 * periods // 8, periods))
    if periods < _SHORTEST:
        return "unsettled", last
    if last < PERIODIC_BELOW:
        return "periodic", last
    early = section_spread(_part(history, periods // 4, periods // 2))
    late = section_spread(_part(history, 3 * periods // 4, periods))
    steady = abs(late - early) <= STEADY_WITHIN * max(late, early)
    return ("modulated" if steady else "unsettled"), last


def envelope_of(values: Floats, per_period: int) -> tuple[Floats, Floats]:
    """Lowest and highest value of every whole period, shape (periods,)."""
    periods = (values.size - 1) // per_period
    rows = values[: periods * per_period].reshape(periods, per_period)
    return rows.min(axis=1), rows.max(axis=1)


def _part(history: TimeHistory, first: int, last: int) -> TimeHistory:
    """From period `first` to period `last`."""
    kept = slice(first * history.samples_per_period, last * history.samples_per_period + 1)
    return dataclasses.replace(
        history, time=history.time[kept], x=history.x[kept], v=history.v[kept], z=history.z[kept], w=history.w[kept]
    )
