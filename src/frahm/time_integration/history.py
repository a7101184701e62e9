"""One trajectory, sampled: `integrate` and the `TimeHistory` it returns."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from frahm import readable
from frahm.arrays import Floats, finite_array, frozen, labelled
from frahm.errors import ConvergenceError, Outcome, ParameterError, check_choice, check_count, check_number
from frahm.systems import System, as_system, detuning_of, excitation_frequency
from frahm.time_integration import signals
from frahm.time_integration.batch import MOST_PERIODS, check_memory, outcome_of, plan_run, run_plan
from frahm.time_integration.packed_system import pack_systems
from frahm.time_integration.propagate import Runs
from frahm.time_integration.signals import Peaks

if TYPE_CHECKING:
    import xarray as xr

    from frahm.case import Case


@dataclass(frozen=True, eq=False)
class TimeHistory:
    """A trajectory at samples equally spaced in the phase of the forcing.

    Of a run that failed, the samples up to there are kept, and what is made of them one by one (envelope, Poincare
    section, datasets) carries its `outcome`; what stands for the whole of it (peaks, rms, spectrum) is NaN.

    Attributes
    ----------
    time : ndarray, shape (s,)
        [s]; the forcing is cos(Omega time).
    x, v : ndarray, shape (s, n)
        Displacements [m] and velocities [m/s] of the coordinates.
    z, w : ndarray, shape (s,)
        Displacement [m] and velocity [m/s] of the first element, x2 - x1 for a sink; NaN without elements.
    frequency : float
        Omega [rad/s].
    outcome : Outcome
        How the run ended; if it failed, the samples end where it did.
    steps : tuple of int
        Accepted and rejected steps.
    system : System
    initial_state : ndarray, shape (2n,)
        (x_0, v_0, x_1, v_1, ...) [m, m/s].
    periods : float
        Periods of the forcing asked for.
    samples_per_period : int
    tolerance : float
        Local error per step relative to the size of the motion.
    """

    __repr__ = readable.summary

    time: Floats
    x: Floats
    v: Floats
    z: Floats
    w: Floats
    frequency: float
    outcome: Outcome
    steps: tuple[int, int]
    system: System
    initial_state: Floats
    periods: float
    samples_per_period: int
    tolerance: float

    @property
    def x1(self) -> Floats:
        """Displacement of coordinate 0 [m], shape (s,)."""
        return self.x[:, 0]

    @property
    def x2(self) -> Floats:
        """Displacement of coordinate 1 [m], shape (s,)."""
        if self.system.size < 2:
            raise ParameterError("x2", f"a system of {self.system.size} coordinate", "a system of two or more")
        return self.x[:, 1]

    @property
    def pipe(self) -> Floats:
        """Displacement of the output [m], shape (s,)."""
        return self.x @ self.system.output

    @property
    def rms(self) -> float:
        """Root mean square of the output [m] over the samples kept (whole periods if any); NaN if the run failed."""
        return self.outcome.known(signals.rms(self.pipe, self.samples_per_period))

    @property
    def relative_rms(self) -> float:
        """Root mean square of z [m]; NaN if the run failed."""
        return self.outcome.known(signals.rms(self.z, self.samples_per_period))

    def last(self, periods: float) -> TimeHistory:
        """The same history, the last `periods` periods only."""
        count = check_number("periods", periods, above=0) * self.samples_per_period
        kept = slice(max(0, self.time.size - 1 - round(min(count, self.time.size))), None)
        return dataclasses.replace(
            self, time=self.time[kept], x=self.x[kept], v=self.v[kept], z=self.z[kept], w=self.w[kept]
        )

    def peaks(self, last: float | None = None) -> Peaks:
        """Largest |x| of the output and |z| [m] over the last `last` periods (all by default), between samples too.

        NaN if the run failed; `outcome` says how.
        """
        part = self if last is None else self.last(last)
        spacing = 2 * np.pi / self.frequency / self.samples_per_period
        pipe, relative = (part.pipe, part.v @ self.system.output), (part.z, part.w)
        return Peaks(*(self.outcome.known(signals.peak(*motion, spacing)) for motion in (pipe, relative)))

    def spectrum(self, window: str = "hann") -> xr.Dataset:
        """One-sided amplitude spectrum: a cosine of amplitude 1 gives 1 at its frequency.

        Parameters
        ----------
        window : {"hann", "boxcar"}
            Hann keeps lines apart that do not fit the length of the history; boxcar is exact for those that do.

        Returns
        -------
        xarray.Dataset
            `pipe_amplitude` and `relative_amplitude` [m] over `frequency_hz`; NaN if the run failed.
        """
        check_choice("window", window, ("hann", "boxcar"))
        spacing = 2 * np.pi / self.frequency / self.samples_per_period
        pipe, relative = (self.outcome.known(1.0) * values for values in (self.pipe, self.z))
        return signals.spectrum(pipe, relative, spacing, self.samples_per_period, window, self._attributes())

    def envelope(self) -> xr.Dataset:
        """Amplitude [m] and phase [rad] of the first harmonic period by period: x = amplitude cos(Omega t + phase)."""
        return signals.envelope(self.time, self.pipe, self.z, self.samples_per_period, self._attributes())

    def poincare(self) -> xr.Dataset:
        """States once a period, at forcing phase 0."""
        first = -round(float(self.time[0] * self.frequency / (2 * np.pi) * self.samples_per_period))
        return self._dataset(slice(first % self.samples_per_period, None, self.samples_per_period), "period")

    def to_dataset(self) -> xr.Dataset:
        """All samples, labelled."""
        return self._dataset(slice(None), "time")

    def _dataset(self, kept: slice, dim: str) -> xr.Dataset:
        import xarray as xr

        variables = {
            "displacement": labelled((dim, "coordinate"), self.x[kept], "displacement of a coordinate", "m"),
            "velocity": labelled((dim, "coordinate"), self.v[kept], "velocity of a coordinate", "m/s"),
            "pipe_displacement": labelled(dim, self.pipe[kept], "displacement of the pipe", "m"),
            "relative_displacement": labelled(dim, self.z[kept], "displacement of the first element", "m"),
            "relative_velocity": labelled(dim, self.w[kept], "velocity of the first element", "m/s"),
        }
        coordinates = {
            "time": labelled(dim, self.time[kept], "time", "s"),
            "coordinate": labelled("coordinate", np.arange(self.system.size), "coordinate", "1"),
        }
        return xr.Dataset(variables, coordinates, self._attributes())

    def _attributes(self) -> dict[str, object]:
        from frahm import __version__

        return {
            "system": self.system.name,
            "frequency": self.frequency,
            "detuning": float(detuning_of(self.system, self.frequency)),
            "initial_state": np.array(self.initial_state),
            "periods": self.periods,
            "samples_per_period": self.samples_per_period,
            "tolerance": self.tolerance,
            "outcome": self.outcome.name,
            "frahm": __version__,
        }


def integrate(
    case_or_system: Case | System,
    *,
    detuning: float | None = None,
    frequency: float | None = None,
    periods: float = 1000,
    initial_state: ArrayLike | None = None,
    samples_per_period: int = 64,
    tolerance: float | None = None,
    throw: bool = False,
) -> TimeHistory:
    """Integrate the equations of motion, with error control throughout.

    Dormand-Prince 8(5,3), compiled; samples by its dense output of order 7.

    Parameters
    ----------
    case_or_system : Case or System
    detuning, frequency : float
        Exactly one of the two [rad/s].
    periods : float
        Periods of the forcing, at most 1e7.
    initial_state : array_like, shape (2n,), optional
        (x_0, v_0, x_1, v_1, ...), absolute [m, m/s]; rest by default.
    samples_per_period : int
        Samples kept per period of the forcing.
    tolerance : float, optional
        Local error per step relative to the size of the motion; 1e-7 by default.
    throw : bool
        Raise if the run fails, instead of returning what was computed with its `outcome`.

    Returns
    -------
    TimeHistory
        Time [s], displacements [m] and velocities [m/s] of every coordinate; how it ended is its `outcome`.

    Raises
    ------
    ParameterError
        For bad input.
    ConvergenceError
        If the run fails and `throw` is true.
    """
    system = as_system(case_or_system)
    omega = excitation_frequency(system, detuning=detuning, frequency=frequency)
    periods = check_number("periods", periods, above=0, at_most=MOST_PERIODS)
    per_period = check_count("samples_per_period", samples_per_period, at_most=10**6)
    n = system.size
    state = frozen(np.zeros(2 * n)) if initial_state is None else finite_array("initial_state", initial_state, (2 * n,))
    count = int(np.floor(periods * per_period * (1 + 1e-14))) + 1
    check_memory("periods, samples_per_period", (periods, samples_per_period), count * 2 * n)
    plan = plan_run(periods=periods, window=0, first_sample=0, samples_per_period=per_period, tolerance=tolerance)
    runs = Runs(
        np.concatenate([state[0::2], state[1::2]])[None], np.zeros(1, dtype=np.int64),
        np.array([2 * np.pi / omega]), np.zeros(1), np.ones(1),
    )  # fmt: skip
    findings = run_plan(pack_systems([system]), runs, plan, count, 1)
    outcome = outcome_of(findings.outcome[0])
    if throw and not outcome.ok:
        raise ConvergenceError(f"{outcome.value} Reached {findings.turns[0]:g} of {periods:g} periods.")
    samples = findings.samples[0]
    reached = count if outcome.ok else int(np.sum(np.all(np.isfinite(samples), axis=1)))
    x, v = samples[:reached, :n], samples[:reached, n:]
    direction = system.elements[0].direction if system.elements else np.full(n, np.nan)
    return TimeHistory(
        time=_view(np.arange(reached) * (2 * np.pi / (omega * per_period))), x=_view(x), v=_view(v),
        z=_view(x @ direction), w=_view(v @ direction), frequency=omega, outcome=outcome,
        steps=(int(findings.steps[0, 0]), int(findings.steps[0, 1])), system=system, initial_state=state,
        periods=periods, samples_per_period=per_period, tolerance=plan.tolerance,
    )  # fmt: skip


def _view(values: Any) -> Floats:
    values.flags.writeable = False
    return np.asarray(values)
