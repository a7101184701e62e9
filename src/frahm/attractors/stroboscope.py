"""The stroboscopic map: many states carried over whole periods of the forcing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.errors import Outcome
from frahm.systems import System
from frahm.time_integration.batch import interleaved, outcome_of, run_plan
from frahm.time_integration.packed_system import Integers, PackedSystems, pack_systems
from frahm.time_integration.propagate import Plan, Runs
from frahm.time_integration.window import LEAST_PEAK, PEAK, SQUARE

# Near a basin boundary errors add up over hundreds of periods: at 1e-7 shares of some systems were off by a tenth.
TOLERANCE = 1e-9
# A motion so stiff that it needs more is named, not waited for: this is 80 times what the pipe of the paper needs
# from a start at z = 3 m.
_LEAST_STEPS, _STEPS_PER_PERIOD = 4e5, 500.0


@dataclass(frozen=True, eq=False)
class Glimpse:
    """What a stretch of N trajectories shows.

    Attributes
    ----------
    states : ndarray, shape (N, 2n)
        Last states (x_0, v_0, ...) [m, m/s].
    codes : ndarray of int, shape (N,)
        How each ended, see `outcomes`.
    seen : ndarray, shape (N, 6)
        Peak, smallest peak of a period and rms [m] of the pipe (columns 0, 1, 2) and the first element (3, 4, 5).
    strobes : ndarray, shape (N, K, 2n)
        States at the last K whole periods.
    """

    states: Floats
    codes: Integers
    seen: Floats
    strobes: Floats

    @property
    def outcomes(self) -> list[Outcome]:
        """How each trajectory ended."""
        return [outcome_of(int(code)) for code in self.codes]


@dataclass(frozen=True, eq=False)
class Stroboscope:
    """A system at one excitation frequency, ready to be integrated over whole periods from phase 0.

    Attributes
    ----------
    system : System
    frequency : float
        Omega [rad/s].
    workers : int, optional
        Threads.
    """

    system: System
    frequency: float
    packed: PackedSystems
    workers: int | None = None

    @property
    def period(self) -> float:
        """Period of the forcing [s]."""
        return float(2 * np.pi / self.frequency)

    def run(
        self, states: Floats, periods: int, *, window: int = 0, strobes: int = 0, tolerance: float = TOLERANCE
    ) -> Glimpse:
        """Carry states (N, 2n) over whole periods; peaks and rms over the last `window`, states of the last `strobes`.

        The result of a trajectory does not depend on its company, nor on the number of threads.
        """
        count = len(states)
        runs = Runs(
            np.ascontiguousarray(np.concatenate([states[:, 0::2], states[:, 1::2]], axis=1)),
            np.zeros(count, dtype=np.int64),
            np.full(count, self.period),
            np.zeros(count),
            np.ones(count),
        )
        steps = _LEAST_STEPS + _STEPS_PER_PERIOD * periods
        plan = Plan(float(periods), 0.0, float(window), periods - strobes + 1, 1, tolerance, steps)
        findings = run_plan(self.packed, runs, plan, strobes, self.workers)
        return Glimpse(
            np.array(interleaved(runs.state)),
            findings.outcome,
            _seen(findings.window, window),
            np.array(interleaved(findings.samples)),
        )


def stroboscope(system: System, frequency: float, workers: int | None = None) -> Stroboscope:
    """Stroboscope of a system at Omega = `frequency` [rad/s]."""
    return Stroboscope(system, frequency, pack_systems((system,)), workers)


def _seen(window: Floats, periods: int) -> Floats:
    """Peak, smallest peak and rms of both displacements, shape (N, 6)."""
    columns = []
    for which in range(2):
        peak = window[:, PEAK + which]
        columns += [peak, np.fmin(window[:, LEAST_PEAK + which], peak)]
        columns.append(np.sqrt(window[:, SQUARE + which] / max(periods, 1)))
    return np.column_stack(columns)
