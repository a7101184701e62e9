"""One motion of a pipe in the wind of a record, by its lift or by a wake oscillator."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats, frozen
from frahm.case import Case
from frahm.errors import Outcome
from frahm.loads import WakeOscillator, WindExcitation, WindRecord, wind_excitation
from frahm.systems import System, build_system
from frahm.time_integration import signals
from frahm.time_integration.batch import LEAST_STEPS, STEPS_PER_PERIOD, outcome_of
from frahm.time_integration.driven import Flow, drive, mechanics_of, table_of
from frahm.time_integration.wake import WAKE_FLOOR, WAKE_START, wake_flow
from frahm.tolerances import TINY

_FLOOR = 1e-6  # of the static deflection: the size of a pipe at rest


@dataclass(frozen=True, eq=False)
class DrivenHistory:
    """A trajectory in unsteady wind at equally spaced times.

    Of a run that failed, the samples up to there are kept; its peaks and rms are NaN.

    Attributes
    ----------
    time : ndarray, shape (s,)
        From the start of the record [s].
    x, v : ndarray, shape (s, n)
        Displacements [m] and velocities [m/s] of the coordinates.
    z : ndarray, shape (s,)
        Displacement of the first element [m]; NaN without elements.
    phase : ndarray, shape (s,)
        Phase of the shedding, the integral of Omega dt [rad]; NaN with a wake oscillator.
    q : ndarray, shape (s,)
        Wake variable [-]; NaN without a wake oscillator.
    outcome : Outcome
        How the run ended; if it failed, the samples end where it did.
    steps : tuple of int
        Accepted and rejected steps.
    system : System
    """

    time: Floats
    x: Floats
    v: Floats
    z: Floats
    phase: Floats
    q: Floats
    outcome: Outcome
    steps: tuple[int, int]
    system: System

    @property
    def pipe(self) -> Floats:
        """Displacement of the pipe [m], shape (s,)."""
        return self.x @ self.system.output

    @property
    def pipe_peak(self) -> float:
        """Largest displacement of the pipe [m]; NaN if the run failed."""
        return self.outcome.known(signals.peak(self.pipe, self.v @ self.system.output, self._spacing))

    @property
    def relative_peak(self) -> float:
        """Largest displacement of the first element [m]; NaN without elements, or if the run failed."""
        if not self.system.elements:
            return math.nan
        return self.outcome.known(signals.peak(self.z, self.v @ self.system.elements[0].direction, self._spacing))

    def pipe_rms(self, since: float = 0.0) -> float:
        """Root mean square of the pipe [m] from the time `since` [s] on; NaN if the run failed."""
        kept = self.pipe[self.time >= since - 0.5 * self._spacing]
        return self.outcome.known(float(np.sqrt(np.mean(kept**2)))) if kept.size else math.nan

    @property
    def _spacing(self) -> float:
        return float(self.time[1] - self.time[0]) if self.time.size > 1 else 1.0


def integrate_record(
    record: WindRecord,
    case: Case,
    system: System,
    state: Floats,
    spacing: float,
    count: int,
    tolerance: float,
    wake: WakeOscillator | None = None,
) -> DrivenHistory:
    """One trajectory of a system, made from a case, in the wind of a record.

    Parameters
    ----------
    record : WindRecord
    case : Case
        Gives shedding and lift.
    system : System
        Its forcing is the lift at the wind speed of the case.
    state : ndarray, shape (2n,)
        (x_0, v_0, x_1, v_1, ...).
    spacing : float
        Of the samples [s].
    count : int
        Samples, the initial state included.
    tolerance : float
        Local error per step relative to the size of the motion.
    wake : WakeOscillator, optional
        In place of the harmonic lift.
    """
    omega, n = system.reference_frequency, system.size
    start = np.concatenate([state[0::2], state[1::2], [0.0, 0.0]])
    if wake is None:
        flow, shape = _flow(case, system, record)
        mechanics = mechanics_of(system, shape)
        push = float(np.max(np.abs(mechanics.forcing))) * float(np.max(record.speed)) ** 2
        least = max(_FLOOR * push * float(np.max(flow.lift[:, 1])) / omega**2, TINY)
    else:
        flow, mechanics = wake_flow(case, wake), mechanics_of(system, np.eye(n)[0])
        least, start[2 * n] = WAKE_FLOOR * case.pipe.diameter, WAKE_START
    samples = np.empty((count, start.size))
    knots, speeds = _with_kinks(record, wind_excitation(case))
    steps = LEAST_STEPS + (STEPS_PER_PERIOD * spacing * omega / (2 * math.pi) + 4) * count + 4 * knots.size
    code, taken, accepted, rejected = drive(
        mechanics, flow, knots, speeds, spacing, omega, least, tolerance, steps, start, samples,
    )  # fmt: skip
    x, v = frozen(samples[:taken, :n]), frozen(samples[:taken, n : 2 * n])
    direction = system.elements[0].direction if system.elements else np.full(n, np.nan)
    driver, nothing = samples[:taken, 2 * n], np.full(taken, np.nan)
    return DrivenHistory(
        time=frozen(spacing * np.arange(taken)), x=x, v=v, z=frozen(x @ direction),
        phase=frozen(driver if wake is None else nothing),
        q=frozen(nothing if wake is None else driver), outcome=outcome_of(code), steps=(int(accepted), int(rejected)),
        system=system,
    )  # fmt: skip


def _with_kinks(record: WindRecord, law: WindExcitation) -> tuple[Floats, Floats]:
    """Times and speeds of a record, with those where a table over the Reynolds number bends: no step crosses them."""
    t, U = record.time, record.speed
    times, speeds = [np.array(t)], [np.array(U)]
    for kink in law.kinks(float(U.min()), float(U.max())):
        i = np.flatnonzero((U[:-1] - kink) * (U[1:] - kink) < 0)
        times.append(t[i] + (kink - U[i]) / (U[i + 1] - U[i]) * (t[i + 1] - t[i]))
        speeds.append(np.full(i.size, kink))
    knots, first = np.unique(np.concatenate(times), return_index=True)
    return knots, np.concatenate(speeds)[first]


def _flow(case: Case, system: System, record: WindRecord) -> tuple[Flow, Floats]:
    """What the wind does, and the force on the coordinates per unit of U^2 C_L [N s^2/m^2]."""
    law = wind_excitation(case)
    shift = math.log(case.wind.viscosity / case.pipe.diameter)  # ln U = ln Re + shift
    strouhal = table_of(law.strouhal.knots + shift, law.strouhal.values)
    lift = table_of(law.lift_coefficient.knots + shift, law.lift_coefficient.values)
    # The lift of the case at its own wind may be zero where the table has another: any other speed shares the shape.
    speeds = np.append(record.speed[record.speed > 0], case.wind.speed)
    forces = law.lift(speeds)
    strongest = float(speeds[int(np.nanargmax(forces))])
    reference = system if strongest == case.wind.speed else build_system(case.with_wind(speed=strongest))
    scale = strongest**2 * float(law.lift_coefficient.value(law.reynolds_number(strongest)))
    shape = np.array(reference.forcing) / scale if scale else np.zeros(system.size)
    return Flow(False, 2 * math.pi / case.pipe.diameter, 1.0, strouhal, lift, 0.0, 0.0, 0.0), shape
