"""Many trajectories at once: final states and what their last periods show, in memory that does not grow with time."""

from __future__ import annotations

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats, finite_array, frozen
from frahm.errors import Outcome, ParameterError, check_count, check_number
from frahm.lanes import address, lane_room
from frahm.systems import System, as_system, excitation_frequency
from frahm.time_integration.packed_system import Integers, Numbers, PackedSystems, pack_systems
from frahm.time_integration.propagate import Kept, Plan, Room, Runs, make_room, propagate
from frahm.time_integration.window import LEAST_PEAK, PEAK, ROWS, SQUARE

if TYPE_CHECKING:
    from frahm.case import Case

TOLERANCE = 1e-7
MOST_PERIODS = 10_000_000
LEAST_STEPS, STEPS_PER_PERIOD = 5e6, 500.0  # of the step limit: a few seconds, and far more than any motion needs
MOST_NUMBERS = 50_000_000  # kept in memory: 400 MB
_CHUNK = 64  # runs a thread takes at a time
_OUTCOMES = (Outcome.DONE, Outcome.DIVERGED, Outcome.STEP_LIMIT, Outcome.STEP_TOO_SMALL)


@dataclass(frozen=True, eq=False)
class BatchResult:
    """What became of N trajectories; rows of a failed one are NaN except its state and the turns it reached.

    Attributes
    ----------
    final_states : ndarray, shape (N, 2n)
        Last state (x_0, v_0, x_1, v_1, ...) [m, m/s].
    final_phase : ndarray, shape (N,)
        Phase of the forcing there [rad], in [0, 2 pi): with it and the state a further batch goes on.
    pipe_peak, relative_peak : ndarray, shape (N,)
        Largest |x| of the output and |z| of the first element over the window [m].
    pipe_least_peak, relative_least_peak : ndarray, shape (N,)
        Smallest of the peaks over consecutive stretches of one period, up to a step, of the window [m].
    pipe_rms, relative_rms : ndarray, shape (N,)
        Root mean square over the window [m].
    strobes : ndarray, shape (N, K, 2n)
        States at the last K whole periods, the final state last [m, m/s].
    outcomes : tuple of Outcome, length N
    turns : ndarray, shape (N,)
        Periods of the forcing reached [-].
    steps : ndarray of int, shape (N, 2)
        Accepted and rejected steps.
    frequency : ndarray, shape (N,)
        Excitation frequency [rad/s].
    systems : tuple of System
        One for all, or one per trajectory.
    periods, window : int
    tolerance : float
    """

    final_states: Floats
    final_phase: Floats
    pipe_peak: Floats
    relative_peak: Floats
    pipe_least_peak: Floats
    relative_least_peak: Floats
    pipe_rms: Floats
    relative_rms: Floats
    strobes: Floats
    outcomes: tuple[Outcome, ...]
    turns: Floats
    steps: Integers
    frequency: Floats
    systems: tuple[System, ...]
    periods: int
    window: int
    tolerance: float

    @property
    def ok(self) -> Any:
        """Which trajectories reached the end, shape (N,), bool."""
        return np.array([outcome.ok for outcome in self.outcomes])


def integrate_batch(
    case_or_system: Case | System | Sequence[Case | System],
    *,
    detuning: ArrayLike | None = None,
    frequency: ArrayLike | None = None,
    initial_states: ArrayLike | None = None,
    periods: int = 1000,
    window: int | None = None,
    strobes: int = 0,
    phase: ArrayLike = 0.0,
    force_scale: ArrayLike = 1.0,
    tolerance: float | None = None,
    workers: int | None = None,
) -> BatchResult:
    """Integrate many trajectories, each with its own step and error control.

    The result of a trajectory is the same to the last bit whatever runs beside it and however many threads there are.

    Parameters
    ----------
    case_or_system : Case, System, or a sequence of N of them
        Several systems must have the same number of coordinates and elements and laws of the same form.
    detuning, frequency : float or array_like, shape (N,)
        Exactly one of the two [rad/s].
    initial_states : array_like, shape (N, 2n) or (2n,)
        (x_0, v_0, x_1, v_1, ...) [m, m/s]; rest by default.
    periods : int
        Periods of the forcing to integrate.
    window : int
        Periods at the end over which peaks and rms are taken: 50, or all if there are fewer, by default; 0 for none.
    strobes : int
        How many states at whole periods to keep, counted from the end.
    phase : float or array_like, shape (N,)
        Phase of the forcing at the start [rad].
    force_scale : float or array_like, shape (N,)
        Factor on the forcing.
    tolerance : float, optional
        Local error per step relative to the size of the motion; 1e-7 by default.
    workers : int, optional
        Threads; by default one per core.

    Raises
    ------
    ParameterError
        For bad input. A trajectory that fails is a value: see `BatchResult.outcomes`.
    """
    systems = _systems(case_or_system)
    n = systems[0].size
    omega = _frequencies(systems, detuning, frequency)
    states = _states(initial_states, n)
    phases, scales = _vector("phase", phase), _vector("force_scale", force_scale)
    lengths = {"frequency": omega.size, "initial_states": len(states), "phase": phases.size, "force_scale": scales.size}
    count = _common_length({"case_or_system": len(systems), **lengths})
    periods = check_count("periods", periods, at_most=MOST_PERIODS)
    plan = plan_run(
        periods=float(periods),
        window=min(50, periods) if window is None else check_count("window", window, at_least=0, at_most=periods),
        first_sample=periods - check_count("strobes", strobes, at_least=0, at_most=periods) + 1,
        samples_per_period=1,
        tolerance=tolerance,
    )
    check_memory("strobes", strobes, count * strobes * 2 * n)
    runs = _runs(count, len(systems), omega, states, phases, scales)
    findings = run_plan(pack_systems(systems), runs, plan, strobes, workers)
    return _result(systems, omega * np.ones(count), runs, plan, findings)


def _runs(count: int, systems: int, omega: Floats, states: Floats, phases: Floats, scales: Floats) -> Runs:
    """Runs in the order of the kernel, each with its own system, frequency, state, phase and force."""
    return Runs(
        np.concatenate([states[:, 0::2], states[:, 1::2]], axis=1) * np.ones((count, 1)),
        np.arange(count) % systems,
        2 * np.pi / omega * np.ones(count),
        np.mod(phases / (2 * np.pi), 1.0) * np.ones(count),
        scales * np.ones(count),
    )


def plan_run(
    *, periods: float, window: int, first_sample: int, samples_per_period: int, tolerance: float | None
) -> Plan:
    """Checked plan with a step limit that grows with the length of the run."""
    tolerance = checked_tolerance(tolerance)
    whole = float(np.floor(periods))
    max_steps = LEAST_STEPS + STEPS_PER_PERIOD * periods
    return Plan(whole, periods - whole, float(window), first_sample, samples_per_period, tolerance, max_steps)


def checked_tolerance(tolerance: float | None) -> float:
    """Local error per step relative to the size of the motion; the default if none is given."""
    return TOLERANCE if tolerance is None else check_number("tolerance", tolerance, at_least=1e-14, at_most=1e-2)


def run_plan(packed: PackedSystems, runs: Runs, plan: Plan, samples: int, workers: int | None) -> Kept:
    """Run all trajectories on threads; the kernel holds no lock while it works."""
    count, width = runs.state.shape
    findings = Kept(
        np.zeros(count, dtype=np.int64), np.zeros((count, 2), dtype=np.int64), np.zeros(count),
        np.zeros((count, ROWS)), np.empty((count, samples, width)),
    )  # fmt: skip

    def run_chunk(start: int) -> None:
        part = slice(start, start + _CHUNK)
        room, numbers = make_room(width // 2), Numbers(*(lane_room(table.shape[0]) for table in packed.tables))
        propagate(
            packed.structure, packed.tables, numbers, Numbers(*map(address, numbers)), room, Room(*map(address, room)),
            Runs(*(values[part] for values in runs)), plan, Kept(*(values[part] for values in findings)),
        )  # fmt: skip

    threads = (os.cpu_count() or 1) if workers is None else check_count("workers", workers, at_most=1024)
    starts = range(0, count, _CHUNK)
    if min(threads, len(starts)) == 1:
        for start in starts:
            run_chunk(start)
    else:
        with ThreadPoolExecutor(threads) as pool:
            list(pool.map(run_chunk, starts))
    return findings


def outcome_of(code: int) -> Outcome:
    """`Outcome` for a code of the kernel."""
    return _OUTCOMES[code]


def check_memory(name: str, value: Any, numbers: int) -> None:
    """Refuse a request that would not fit into memory."""
    if numbers > MOST_NUMBERS:
        raise ParameterError(
            name, value, f"at most {MOST_NUMBERS} numbers kept in all, here {numbers}",
            hint="Ask for fewer samples per period, fewer periods or fewer trajectories.",
        )  # fmt: skip


def _result(systems: tuple[System, ...], omega: Floats, runs: Runs, plan: Plan, findings: Kept) -> BatchResult:
    seen = findings.window.copy()
    seen[findings.outcome != 0] = np.nan
    if plan.window == 0:
        seen[:] = np.nan
    elif not all(system.elements for system in systems):
        seen[:, [PEAK + 1, LEAST_PEAK + 1, SQUARE + 1]] = np.nan
    # A window whose stretches all run over its end has one peak only.
    least = np.fmin(seen[:, LEAST_PEAK : LEAST_PEAK + 2], seen[:, PEAK : PEAK + 2])
    rms = np.sqrt(seen[:, SQUARE : SQUARE + 2] / max(plan.window, 1.0))
    return BatchResult(
        final_states=interleaved(runs.state),
        final_phase=frozen(2 * np.pi * np.mod(runs.phase + findings.turns, 1.0)),
        pipe_peak=frozen(seen[:, PEAK]),
        relative_peak=frozen(seen[:, PEAK + 1]),
        pipe_least_peak=frozen(least[:, 0]),
        relative_least_peak=frozen(least[:, 1]),
        pipe_rms=frozen(rms[:, 0]),
        relative_rms=frozen(rms[:, 1]),
        strobes=interleaved(findings.samples),
        outcomes=tuple(outcome_of(code) for code in findings.outcome),
        turns=frozen(findings.turns),
        steps=frozen(findings.steps, dtype=np.int64),
        frequency=frozen(omega),
        systems=systems,
        periods=int(plan.whole),
        window=int(plan.window),
        tolerance=plan.tolerance,
    )


def interleaved(states: Floats) -> Floats:
    """States (..., x_0 ... x_n-1, v_0 ... v_n-1) as (..., x_0, v_0, x_1, v_1, ...), read-only."""
    n = states.shape[-1] // 2
    return frozen(np.stack([states[..., :n], states[..., n:]], axis=-1).reshape(states.shape))


def _systems(given: Any) -> tuple[System, ...]:
    if isinstance(given, Sequence) and not isinstance(given, str | bytes):
        if not given:
            raise ParameterError("case_or_system", given, "at least one Case or System")
        return tuple(as_system(item) for item in given)
    return (as_system(given),)


def _frequencies(systems: tuple[System, ...], detuning: Any, frequency: Any) -> Floats:
    if (detuning is None) == (frequency is None):
        raise ParameterError("detuning, frequency", (detuning, frequency), "exactly one of the two")
    name, values = ("detuning", detuning) if frequency is None else ("frequency", frequency)
    values = _vector(name, values)
    count = _common_length({"case_or_system": len(systems), name: values.size})
    pairs = zip(np.resize(np.arange(len(systems)), count), np.resize(values, count), strict=True)
    if name == "frequency" and values.size and np.all(values > 0):
        return np.resize(values, count)
    return np.array([excitation_frequency(systems[s], **{name: value}) for s, value in pairs])


def _states(given: ArrayLike | None, n: int) -> Floats:
    if given is None:
        return np.zeros((1, 2 * n))
    shaped = np.asarray(given)
    return finite_array("initial_states", shaped[None] if shaped.ndim == 1 else shaped, (-1, 2 * n))


def _vector(name: str, values: ArrayLike) -> Floats:
    shaped = np.asarray(values)
    return finite_array(name, shaped[None] if shaped.ndim == 0 else shaped, (-1,))


def _common_length(lengths: dict[str, int]) -> int:
    count = max(lengths.values())
    for name, length in lengths.items():
        if length not in (1, count) or length == 0:
            raise ParameterError(name, f"{length} of them", f"one for all, or {count} as the longest of the others")
    return count
