"""Whether the tail of a motion repeats every period, is modulated for good, or has not settled."""

from __future__ import annotations

import dataclasses

import numpy as np

from frahm.arrays import Floats
from frahm.time_integration import TimeHistory

KINDS = ("periodic", "modulated", "unsettled")
PERIODIC_BELOW = 1e-3
STEADY_WITHIN = 0.3
_SHORTEST_TAIL = 20


def section_spread(history: TimeHistory) -> float:
    """Half range of the Poincare section over its largest state, the worse of displacement and velocity; 0 if periodic.

    Displacements and velocities of each coordinate are compared with the peak of that coordinate over the history.
    """
    section = history.poincare()
    spread = 0.0
    for i in range(history.x.shape[1]):
        for values, whole in (
            (section["displacement"].values[:, i], history.x[:, i]),
            (section["velocity"].values[:, i], history.v[:, i]),
        ):
            size = float(np.max(np.abs(whole), initial=0.0))
            if size > 0:
                spread = max(spread, float(np.ptp(values)) / 2 / size)
    return spread


def judge(tail: TimeHistory) -> tuple[str, float]:
    """Kind of the motion and the spread of its Poincare section over the second half of the tail.

    Periodic: the spread stays below 1e-3. Modulated: it is larger, and as large as over the first half (within 30 %).
    Anything else, or a tail of less than 20 periods, is unsettled.
    """
    spacing = tail.samples_per_period
    half = (tail.time.size - 1) // spacing // 2
    late = section_spread(tail.last(half)) if half else 0.0
    if not tail.outcome.ok or 2 * half < _SHORTEST_TAIL:
        return "unsettled", late
    if late < PERIODIC_BELOW:
        return "periodic", late
    early = section_spread(_first(tail, half * spacing + 1))
    steady = abs(late - early) <= STEADY_WITHIN * max(late, early)
    return ("modulated" if steady else "unsettled"), late


def envelope_of(values: Floats, per_period: int) -> tuple[Floats, Floats]:
    """Lowest and highest value of every whole period, shape (periods,)."""
    periods = (values.size - 1) // per_period
    rows = values[: periods * per_period].reshape(periods, per_period)
    return rows.min(axis=1), rows.max(axis=1)


def _first(history: TimeHistory, samples: int) -> TimeHistory:
    kept = slice(0, samples)
    return dataclasses.replace(
        history, time=history.time[kept], x=history.x[kept], v=history.v[kept], z=history.z[kept], w=history.w[kept]
    )
