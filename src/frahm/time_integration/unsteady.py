"""The pipe in a wind that changes: its shedding frequency and lift follow every gust."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from frahm import readable
from frahm.arrays import Floats, finite_array, frozen, labelled
from frahm.case import Case, load_case
from frahm.errors import ConvergenceError, Outcome, ParameterError, check_count, check_number
from frahm.loads import WakeOscillator, scruton_number, skop_griffin_number, wind_excitation
from frahm.loads.record import WindRecord, as_record, constant_record, turbulent_record
from frahm.loads.vortex import check_speeds
from frahm.systems import build_system
from frahm.time_integration.batch import TOLERANCE, check_memory, checked_tolerance
from frahm.time_integration.driven_history import DrivenHistory, integrate_record
from frahm.time_integration.wake import check_wake, wake_excitation

if TYPE_CHECKING:
    import xarray as xr

_DEFAULT_DURATION = 600.0  # [s], over which wind speeds are averaged
_GUST_PERIODS = 2.0  # shedding periods the fastest gust kept lasts: vortices cannot follow faster ones
_ROUNDING = 1e-14  # a span of whole samples may fall short by rounding
_FORCED_NOTES = (
    "Shedding frequency and lift follow the wind without delay and in phase along the pipe; a gust that is short "
    "against the shedding period, or does not cover the pipe, does less.",
    "The motion does not hold the shedding to itself here: where vortices lock in, gusts detune them less, and the "
    "pipe moves more than in this result. What gusts take off is no margin to design on.",
)


@dataclass(frozen=True, eq=False)
class UnsteadyResponse:
    """What a pipe does in unsteady wind, with and without its absorbers, and in steady wind of the same mean.

    Attributes
    ----------
    case : Case
    record : WindRecord
        The wind.
    speed, frequency, lift : ndarray, shape (s,)
        Wind speed [m/s], shedding frequency [rad/s] and lift of a pipe of the length of the case [N] at the samples.
    history, steady : DrivenHistory
        The case in the record, and in steady wind of its mean speed.
    bare, bare_steady : DrivenHistory
        The same without absorbers.
    resonant_speed : float
        Wind speed whose shedding meets the natural frequency [m/s]; NaN if the tables do not reach it.
    resonant_amplitude : float
        Amplitude of the pipe without absorbers in steady wind of that speed [m], in closed form: with a wake oscillator
        that of Eq. 35 of Facchinetti et al.
    time_constant : float
        1/(zeta omega) of the pipe without absorbers [s], in closed form.
    build_up_time : float
        The same from an integrated build-up in steady resonant wind [s]; NaN if it was not done.
    since : float
        Half of the duration [s]: rms values are of the time after it.
    notes : tuple of str
        What a reader must know.
    samples_per_period : int
        Samples kept per natural period.
    tolerance : float
        Local error per step relative to the size of the motion.
    """

    __repr__ = readable.summary

    case: Case
    record: WindRecord
    speed: Floats
    frequency: Floats
    lift: Floats
    history: DrivenHistory
    steady: DrivenHistory
    bare: DrivenHistory
    bare_steady: DrivenHistory
    resonant_speed: float
    resonant_amplitude: float
    time_constant: float
    build_up_time: float
    since: float
    notes: tuple[str, ...]
    samples_per_period: int
    tolerance: float

    @property
    def outcome(self) -> Outcome:
        """Finished if all four runs did, otherwise how the first one that failed ended."""
        runs = (self.history, self.steady, self.bare, self.bare_steady)
        return next((run.outcome for run in runs if not run.outcome.ok), Outcome.DONE)

    @property
    def duration(self) -> float:
        """Length of the motions asked for [s]."""
        return (self.speed.size - 1) * self._spacing

    @property
    def _spacing(self) -> float:
        return 2 * math.pi / self.case.pipe.frequency / self.samples_per_period

    @property
    def reduction_by_absorbers(self) -> float:
        """1 - rms with absorbers over rms without, in the record [-]."""
        return 1 - _ratio(self.history.pipe_rms(self.since), self.bare.pipe_rms(self.since))

    @property
    def reduction_by_gusts(self) -> tuple[float, float]:
        """1 - rms in the record over rms in steady wind of the same mean, with and without absorbers [-].

        Negative where the gusts do harm: a mean wind beside resonance moves the pipe less than one that sweeps over it.
        """
        pairs = ((self.history, self.steady), (self.bare, self.bare_steady))
        with_them, without = (1 - _ratio(a.pipe_rms(self.since), b.pipe_rms(self.since)) for a, b in pairs)
        return with_them, without

    def to_dataset(self) -> xr.Dataset:
        """Histories of wind and motions over time, labelled; NaN after a run that failed."""
        import xarray as xr

        from frahm import __version__

        size = self.speed.size
        names = {
            "pipe_displacement": (self.history.pipe, "displacement of the pipe"),
            "bare_pipe_displacement": (self.bare.pipe, "displacement of the pipe without absorbers"),
            "steady_pipe_displacement": (self.steady.pipe, "displacement of the pipe in steady wind"),
            "bare_steady_pipe_displacement": (
                self.bare_steady.pipe, "displacement of the pipe without absorbers in steady wind",
            ),
        }  # fmt: skip
        if self.history.system.elements:
            names["relative_displacement"] = (self.history.z, "displacement of the first element")
        return xr.Dataset(
            {
                "wind_speed": labelled("time", self.speed, "wind speed", "m/s"),
                "frequency": labelled("time", self.frequency, "shedding frequency Omega", "rad/s"),
                "lift": labelled("time", self.lift, "amplitude of the lift", "N"),
                **{name: labelled("time", _filled(x, size), text, "m") for name, (x, text) in names.items()},
            },
            {"time": labelled("time", self._spacing * np.arange(size), "time", "s")},
            {
                "case": self.case.name, "record": self.record.source, "tolerance": self.tolerance,
                "outcome": self.outcome.name, "time_constant": self.time_constant,
                "build_up_time": self.build_up_time, "resonant_amplitude": self.resonant_amplitude,
                "samples_per_period": self.samples_per_period, "frahm": __version__,
            },
        )  # fmt: skip


def unsteady_response(
    case: Any,
    *,
    record: Any = None,
    duration: float | None = None,
    seed: int | None = None,
    wake: WakeOscillator | None = None,
    initial_state: ArrayLike | None = None,
    samples_per_period: int = 32,
    tolerance: float | None = None,
    throw: bool = False,
) -> UnsteadyResponse:
    """Integrate the pipe of a case in unsteady wind, with and without its absorbers.

    Shedding frequency and lift follow the wind at every instant: phase = int Omega(U(t)) dt, and the force is
    F_L(U(t)) cos phase. That holds for gusts much longer than a shedding period, and knows no lock-in; a wake
    oscillator does.

    Parameters
    ----------
    case : Case, str, Path or dict
        A case, or whatever `frahm.load_case` reads.
    record : WindRecord, str, Path or (time, speed), optional
        The wind; a text is a CSV file with the columns time and speed. By default the record of the case, otherwise its
        turbulence around its wind speed.
    duration : float, optional
        Time to integrate [s]; by default all of a record, 600 s of turbulence.
    seed : int, optional
        Of the synthetic turbulence; by default the seed of the analysis.
    wake : WakeOscillator, optional
        Drives the pipe in place of the harmonic lift, and locks in to its motion; the pipe must be given as one mode.
    initial_state : array_like, shape (2n,), optional
        (x_0, v_0, x_1, v_1, ...) with absorbers; the pipe without them starts from the part that is its own. Rest by
        default.
    samples_per_period : int
        Samples kept per natural period of the pipe.
    tolerance : float, optional
        Local error per step relative to the size of the motion; 1e-7 by default.
    throw : bool
        Raise if a run fails, instead of returning what was computed with its `outcome`.

    Returns
    -------
    UnsteadyResponse
        Motions with and without absorbers, in the unsteady wind and in steady wind of the same mean [m].

    Raises
    ------
    ParameterError
        For bad input; if there is neither record nor turbulence; if the record is shorter than the duration; if the
        Strouhal number or the lift coefficient is not given at one of its speeds.
    ConvergenceError
        If a run fails and `throw` is true.
    """
    case = load_case(case)
    wind = _wind(case, record, duration, seed)
    span = wind.duration if duration is None else min(duration, wind.duration)
    _check_winds(case, wind, span, wake)
    tolerance = checked_tolerance(tolerance)
    per_period = check_count("samples_per_period", samples_per_period, at_least=8, at_most=10**4)
    work = _Integration(case, wind, span, per_period, tolerance, wake)
    runs = work.runs(initial_state)
    failed = next((run.outcome for run in runs if not run.outcome.ok), None)
    if throw and failed is not None:
        raise ConvergenceError(failed.value)
    return work.response(runs)


@dataclass(frozen=True, eq=False)
class _Integration:
    """What is integrated: a case in the first `span` seconds of a wind, and how closely."""

    case: Case
    wind: WindRecord
    span: float
    per_period: int
    tolerance: float
    wake: WakeOscillator | None

    @property
    def spacing(self) -> float:
        """Of the samples [s]."""
        return 2 * math.pi / self.case.pipe.frequency / self.per_period

    @property
    def count(self) -> int:
        """Samples, the initial state included."""
        return math.floor(self.span / self.spacing * (1 + _ROUNDING)) + 1

    def runs(self, initial_state: ArrayLike | None) -> tuple[DrivenHistory, ...]:
        """Motions with absorbers in the wind and in steady wind of its mean, and both without."""
        alone = self.case.without_absorbers()
        system, bare = build_system(self.case), build_system(alone)
        check_memory("duration", self.span, self.count * (2 * system.size + 2) * 4)
        n = 2 * system.size
        state = np.zeros(n) if initial_state is None else finite_array("initial_state", initial_state, (n,))
        calm = constant_record(_mean(self.wind, self.span), max(self.span, self.spacing))
        pipes = ((self.case, system, state), (alone, bare, state[: 2 * bare.size]))
        return tuple(
            integrate_record(record, *pipe, self.spacing, self.count, self.tolerance, self.wake)
            for pipe in pipes
            for record in (self.wind, calm)
        )

    def response(self, runs: tuple[DrivenHistory, ...]) -> UnsteadyResponse:
        """The motions with the wind that made them, and the closed forms they are judged by."""
        case, wake = self.case, self.wake
        times = self.wind.time[0] + self.spacing * np.arange(self.count)
        speed = np.interp(times, self.wind.time, self.wind.speed)
        if wake is None:
            law = wind_excitation(case)
            frequency, lift = law.frequency(speed), law.lift(speed)
            resonant, amplitude, measured = _resonance(case)
        else:
            frequency, lift = wake_excitation(case, wake, speed)
            resonant, amplitude, measured = *_wake_resonance(case, wake), math.nan
        rate = case.pipe.damping_ratio * case.pipe.frequency
        return UnsteadyResponse(
            case=case, record=self.wind, speed=frozen(speed), frequency=frozen(frequency), lift=frozen(lift),
            history=runs[0], steady=runs[1], bare=runs[2], bare_steady=runs[3],
            resonant_speed=resonant, resonant_amplitude=amplitude, time_constant=1 / rate if rate else math.inf,
            build_up_time=measured, since=0.5 * self.span, notes=_notes(case, self.wind, self.span, wake),
            samples_per_period=self.per_period, tolerance=self.tolerance,
        )  # fmt: skip


def _check_winds(case: Case, wind: WindRecord, span: float, wake: WakeOscillator | None) -> None:
    if wake is None:
        check_speeds(case, "record", *_extremes(wind, span))
    else:
        check_wake(case, wake)


def _wind(case: Case, record: Any, duration: float | None, seed: int | None) -> WindRecord:
    if duration is not None:
        check_number("duration", duration, above=0, unit="s")
    if record is None and case.wind.record:
        record = np.array(case.wind.record).T
    if record is not None:
        if seed is not None:
            raise ParameterError("seed", seed, "nothing, because the wind is a record")
        found = as_record(record)
        if duration is not None and duration > found.duration * (1 + 1e-12):
            raise ParameterError("duration", duration, f"at most {found.duration:g} s, the length of the record")
        return found
    gusts = case.wind.turbulence
    if gusts is None:
        raise ParameterError("record", None, "a wind record, or a case with wind.record or wind.turbulence")
    law = wind_excitation(case)
    shedding = float(law.frequency(case.wind.speed)) / (2 * math.pi)
    return turbulent_record(
        case.wind.speed, gusts.intensity, gusts.length_scale, _DEFAULT_DURATION if duration is None else duration,
        highest_frequency=shedding / _GUST_PERIODS, spectrum=gusts.spectrum,
        seed=case.analysis.seed if seed is None else seed,
    )  # fmt: skip


def _extremes(record: WindRecord, span: float) -> tuple[float, float]:
    end = record.time[0] + span
    inside = np.append(record.speed[record.time <= end], np.interp(end, record.time, record.speed))
    return float(inside.min()), float(inside.max())


def _mean(record: WindRecord, span: float) -> float:
    """Time average of the speed over the first `span` seconds."""
    end = record.time[0] + span
    kept = record.time < end
    time = np.append(record.time[kept], end)
    return float(np.trapezoid(np.append(record.speed[kept], np.interp(end, record.time, record.speed)), time) / span)


def _wake_resonance(case: Case, wake: WakeOscillator) -> tuple[float, float]:
    """Speed of resonance and the amplitude of Eq. 35 of Facchinetti et al."""
    pipe = case.pipe
    speed = pipe.frequency / (2 * math.pi) * pipe.diameter / wake.strouhal
    Ks = scruton_number(pipe.mass / pipe.length, pipe.damping_ratio, pipe.diameter, case.wind.air_density)
    return speed, pipe.diameter * wake.lock_in_amplitude(skop_griffin_number(Ks, wake.strouhal))


def _resonance(case: Case) -> tuple[float, float, float]:
    """Resonant speed, amplitude of the governing mode there, and the time constant of an integrated build-up."""
    speeds = wind_excitation(case).speeds_of(case.pipe.frequency)
    speed = float(speeds.min()) if speeds.size else math.nan
    zeta, omega = case.pipe.damping_ratio, case.pipe.frequency
    low, high = wind_excitation(case).speed_range
    if math.isnan(speed) or not low <= speed <= high:
        return math.nan, math.nan, math.nan
    here = case.without_absorbers().with_wind(speed=speed)
    system = build_system(here)
    if zeta == 0:
        return speed, math.inf, math.nan
    amplitude = float(system.forcing[0]) / (2 * case.pipe.mass * zeta * omega**2)
    if amplitude == 0 or zeta < 1e-6 or zeta > 0.05:  # too slow to integrate, or over before a few periods are
        return speed, amplitude, math.nan
    periods = round(1.5 / (2 * math.pi * zeta))
    spacing = 2 * math.pi / omega * periods
    run = integrate_record(constant_record(speed, 3 * spacing), here, system, np.zeros(2 * system.size), spacing, 3,
                           TOLERANCE)  # fmt: skip
    if not run.outcome.ok:
        return speed, amplitude, math.nan
    # x = A (1 - e^-t/tau) sin: the ratio of two sizes, one time apart and twice it, knows neither A nor the phase.
    size = np.hypot(run.x[:, 0], run.v[:, 0] / omega)
    ratio = float(size[2] / size[1]) - 1
    return speed, amplitude, spacing / -math.log(ratio) if 0 < ratio < 1 else math.nan


def _notes(case: Case, record: WindRecord, span: float, wake: WakeOscillator | None) -> tuple[str, ...]:
    notes = list(record.notes)
    if wake is not None:
        notes.append(
            f"The wake oscillator has St = {wake.strouhal:g} and C_L0 = {wake.lift_coefficient:g}; it was made for "
            "steady flow, and a gust acts on all of the pipe at once."
        )
    else:
        notes += _FORCED_NOTES
    if span * case.pipe.damping_ratio * case.pipe.frequency < 3:
        notes.append("The record is shorter than three time constants of the pipe: its motion has not built up fully.")
    return tuple(notes)


def _ratio(value: float, reference: float) -> float:
    return value / reference if reference > 0 else math.nan


def _filled(values: Floats, size: int) -> Floats:
    filled = np.full(size, np.nan)
    filled[: values.size] = values
    return filled
