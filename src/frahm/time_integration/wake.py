"""Pipe, sinks and wake oscillator integrated together: the lock-in curve over the wind speed, upwards and downwards.

Wake oscillator: Facchinetti et al. (2004), doi 10.1016/j.jfluidstructs.2003.12.004.
"""

from __future__ import annotations

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import readable
from frahm.arrays import Floats, frozen, labelled
from frahm.case import Case, Pipe, load_case
from frahm.errors import ConvergenceError, Outcome, ParameterError, check_count, check_number
from frahm.loads import WakeOscillator
from frahm.systems import System, build_system
from frahm.time_integration import signals
from frahm.time_integration.batch import LEAST_STEPS, checked_tolerance, outcome_of
from frahm.time_integration.driven import Flow, drive, mechanics_of, table_of

if TYPE_CHECKING:
    import xarray as xr

_BLOCK = 80  # natural periods looked at together
_PER_PERIOD = 24  # samples, in the block that is read off
_SETTLED = 2e-3  # relative change of the size from block to block
WAKE_FLOOR = 1e-9  # of the diameter
WAKE_START = 0.1  # of q at the first speed, the pipe at rest
_WINDOW = (0.8, 1.3)  # of the resonant speed
_CHECKED_REYNOLDS = (300.0, 1.5e5)  # for which St = 0.2 is printed


@dataclass(frozen=True, eq=False)
class LockInCurve:
    """Lasting motions over the wind speed; row 0 with the wind rising step by step, row 1 with it falling.

    Attributes
    ----------
    speed : ndarray, shape (s,)
        Ascending [m/s].
    pipe_peak, pipe_rms, relative_peak : ndarray, shape (2, s)
        Largest and root mean square displacement of the pipe, largest of the first absorber [m]; NaN if the run failed.
    wake_peak : ndarray, shape (2, s)
        Largest |q| [-]; NaN if the run failed.
    frequency : ndarray, shape (2, s)
        Of the pipe, from its zero crossings [rad/s]; NaN if the run failed.
    settled : ndarray of bool, shape (2, s)
        Whether the size of the motion had stopped changing when it was read off.
    outcomes : tuple of tuple of Outcome
    """

    speed: Floats
    pipe_peak: Floats
    pipe_rms: Floats
    relative_peak: Floats
    wake_peak: Floats
    frequency: Floats
    settled: np.ndarray
    outcomes: tuple[tuple[Outcome, ...], ...]

    @property
    def largest(self) -> tuple[float, float]:
        """Largest displacement of the pipe [m] and its wind speed [m/s], of the runs that ended well; NaN if none."""
        place = int(np.argmax(np.fmax(self._known[0], self._known[1])))
        return float(np.fmax(*self.pipe_peak)[place]), float(self.speed[place])

    @property
    def hysteresis(self) -> Floats:
        """Speeds [m/s] at which the two directions differ by more than 1 % of the largest motion."""
        apart = np.abs(self.pipe_peak[0] - self.pipe_peak[1]) > 0.01 * np.max(self._known)
        return self.speed[apart]

    @property
    def _known(self) -> Floats:
        """Peaks of the pipe [m], those of failed runs below any other."""
        return np.where(np.isnan(self.pipe_peak), -np.inf, self.pipe_peak)


@dataclass(frozen=True, eq=False)
class WakeResponse:
    """Lock-in curve of a case with the wake oscillator, with and without its absorbers.

    Attributes
    ----------
    case : Case
    wake : WakeOscillator
        Constants of the wake.
    curve : LockInCurve
        Of the case.
    bare : LockInCurve
        Without absorbers; the same curve if the case has none.
    notes : tuple of str
        What a reader must know.
    tolerance : float
        Local error per step relative to the size of the motion.
    """

    __repr__ = readable.summary

    case: Case
    wake: WakeOscillator
    curve: LockInCurve
    bare: LockInCurve
    notes: tuple[str, ...]
    tolerance: float

    @property
    def unverified(self) -> tuple[str, ...]:
        """Sentences on points that failed or had not settled."""
        sentences = []
        for name, curve in (("with the absorbers", self.curve), ("without absorbers", self.bare)):
            open_ends = np.unique(curve.speed[~np.all(curve.settled, axis=0)])
            if open_ends.size:
                text = ", ".join(f"{speed:.4g}" for speed in open_ends[:8])
                more = f" and {open_ends.size - 8} more" if open_ends.size > 8 else ""
                sentences.append(f"The motion {name} had not settled at {text}{more} m/s.")
            failed = {outcome.value: None for row in curve.outcomes for outcome in row if not outcome.ok}
            sentences += [f"Some motions {name} failed: {reason}" for reason in failed]
            if curve is self.bare and curve is self.curve:
                break
        return tuple(dict.fromkeys(sentences))

    def to_dataset(self) -> xr.Dataset:
        """Both curves over direction (0 rising, 1 falling wind) and wind speed, labelled."""
        import xarray as xr

        from frahm import __version__

        dims = ("direction", "speed")
        variables: dict[str, Any] = {}
        for prefix, curve, which in (("", self.curve, ""), ("bare_", self.bare, " without absorbers")):
            variables |= {
                f"{prefix}pipe_peak": labelled(dims, curve.pipe_peak, f"largest pipe displacement{which}", "m"),
                f"{prefix}pipe_rms": labelled(dims, curve.pipe_rms, f"rms pipe displacement{which}", "m"),
                f"{prefix}wake_peak": labelled(dims, curve.wake_peak, f"largest wake variable q{which}", "1"),
                f"{prefix}frequency": labelled(dims, curve.frequency, f"frequency of the pipe{which}", "rad/s"),
                f"{prefix}settled": labelled(dims, curve.settled.astype(np.int8), f"1 if settled{which}", "1"),
            }
        if self.case.absorbers:
            variables["relative_peak"] = labelled(dims, self.curve.relative_peak, "largest absorber displacement", "m")
        constants = {f"wake_{name}": value for name, value in vars(self.wake).items()}
        return xr.Dataset(
            variables,
            {
                "speed": labelled("speed", self.curve.speed, "wind speed", "m/s"),
                "direction": labelled("direction", [0, 1], "0 with the wind rising, 1 with it falling", "1"),
            },
            {"case": self.case.name, "tolerance": self.tolerance, **constants, "frahm": __version__},
        )


def wake_response(
    case: Any,
    *,
    wind: tuple[float, float] | None = None,
    speeds: int = 41,
    wake: WakeOscillator | None = None,
    most_periods: int = 4000,
    tolerance: float | None = None,
    throw: bool = False,
) -> WakeResponse:
    """Lock-in curve of a pipe with the wake oscillator of Facchinetti et al. coupled to it and to its absorbers.

    At every wind speed the motion starts from the last one of the speed before, once with the wind rising and once with
    it falling, so that hysteresis shows. The pipe carries the fluid damping of the wake model beside its own.

    Parameters
    ----------
    case : Case, str, Path or dict
        A case, or whatever `frahm.load_case` reads; its pipe must be given as one mode.
    wind : (float, float), optional
        Window of wind speeds [m/s]; by default 0.8 to 1.3 of the speed of resonance f D / St.
    speeds : int
        Wind speeds in the window.
    wake : WakeOscillator, optional
        Constants; by default those published, which were fitted together: not St and C_L of the case
        (`WakeOscillator.of_case` takes these).
    most_periods : int
        Natural periods after which a motion that has not settled is read off all the same, and named.
    tolerance : float, optional
        Local error per step relative to the size of the motion; 1e-7 by default.
    throw : bool
        Raise if an integration fails, instead of keeping it as a value with its outcome.

    Returns
    -------
    WakeResponse
        Peaks [m] over the wind speed [m/s], rising and falling.

    Raises
    ------
    ParameterError
        For bad input, or a pipe that is not one mode.
    ConvergenceError
        If an integration fails and `throw` is true.
    """
    case = load_case(case)
    wake = WakeOscillator() if wake is None else wake
    check_wake(case, wake)
    axis = np.linspace(*_window(case, wake, wind), check_count("speeds", speeds, at_least=2, at_most=10**5))
    tolerance = checked_tolerance(tolerance)
    blocks = max(2, check_count("most_periods", most_periods, at_least=2 * _BLOCK, at_most=10**7) // _BLOCK)
    systems = [build_system(case), build_system(case.without_absorbers())] if case.absorbers else [build_system(case)]
    tasks = [(case, system, wake, order, tolerance, blocks) for system in systems for order in (axis, axis[::-1])]
    with ThreadPoolExecutor(max_workers=len(tasks)) as pool:
        found = list(pool.map(lambda task: _sweep(*task), tasks))
    curves = [_curve(axis, found[i], found[i + 1]) for i in range(0, len(found), 2)]
    failed = next((o for curve in curves for row in curve.outcomes for o in row if not o.ok), None)
    if throw and failed is not None:
        raise ConvergenceError(failed.value)
    return WakeResponse(case, wake, curves[0], curves[-1], _notes(case, wake, axis), tolerance)


def _window(case: Case, wake: WakeOscillator, wind: Any) -> tuple[float, float]:
    if wind is None:
        resonance = case.pipe.frequency / (2 * math.pi) * case.pipe.diameter / wake.strouhal
        return _WINDOW[0] * resonance, _WINDOW[1] * resonance
    try:
        lo, hi = wind
    except (TypeError, ValueError):
        raise ParameterError("wind", wind, "two wind speeds (lo, hi) [m/s]") from None
    lo = check_number("wind[0]", lo, above=0, unit="m/s")
    hi = check_number("wind[1]", hi, above=0, unit="m/s")
    if not lo < hi:
        raise ParameterError("wind", (lo, hi), "two wind speeds (lo, hi) with lo < hi [m/s]")
    return lo, hi


def check_wake(case: Case, wake: Any) -> None:
    """Refuse what is no wake oscillator, and pipes it is not made for."""
    if not isinstance(wake, WakeOscillator):
        raise ParameterError("wake", wake, "a frahm.WakeOscillator")
    if not isinstance(case.pipe, Pipe):
        allowed = "a pipe of kind mode: the wake oscillator is one of a rigid pipe"
        raise ParameterError("pipe.kind", case.pipe.kind, allowed)


def wake_excitation(case: Case, wake: WakeOscillator, speed: Floats) -> tuple[Floats, Floats]:
    """Shedding frequency [rad/s] and lift of the pipe at rest [N] at wind speeds [m/s]."""
    pipe = case.pipe
    pressure = 0.5 * case.wind.air_density * pipe.diameter * pipe.length
    return 2 * math.pi * wake.strouhal / pipe.diameter * speed, pressure * wake.lift_coefficient * speed**2


def wake_flow(case: Case, wake: WakeOscillator) -> Flow:
    """The wake of a rigid pipe: the force 1/4 rho U^2 D C_L0 q and the damping gamma Omega rho D^2, per length."""
    D, rho, length = case.pipe.diameter, case.wind.air_density, case.pipe.length
    turns = 2 * math.pi / D
    return Flow(
        wake=True, turns=turns, pressure=0.25 * rho * D * wake.lift_coefficient * length,
        strouhal=table_of([0.0], [wake.strouhal]), lift=table_of([0.0], [wake.lift_coefficient]),
        fluid_damping=wake.stall * turns * wake.strouhal * rho * D**2 * length, coupling=wake.coupling / D,
        nonlinearity=wake.nonlinearity,
    )  # fmt: skip


def _sweep(
    case: Case, system: System, wake: WakeOscillator, order: Floats, tolerance: float, blocks: int
) -> list[tuple[float, float, float, float, float, bool, Outcome]]:
    """What the motion does at wind speeds taken one after the other."""
    first = np.zeros(system.size)
    first[0] = 1.0
    mechanics, flow = mechanics_of(system, first), wake_flow(case, wake)
    state = _start(system)
    return [_lasting(case, system, mechanics, flow, float(speed), state, tolerance, blocks) for speed in order]


def _start(system: System) -> Floats:
    """At rest, the wake barely moving."""
    state = np.zeros(2 * system.size + 2)
    state[2 * system.size] = WAKE_START
    return state


def _lasting(
    case: Case, system: System, mechanics: Any, flow: Flow, speed: float, state: Floats, tolerance: float, blocks: int
) -> tuple[float, float, float, float, float, bool, Outcome]:
    """Let the motion settle at one speed, and read it off; `state` is carried on."""
    n, omega = system.size, system.reference_frequency
    period, least = 2 * math.pi / omega, WAKE_FLOOR * case.pipe.diameter
    wind, knots = np.array([speed, speed]), np.array([0.0, 1e300])
    size, settled = math.inf, False
    once = np.empty((_BLOCK + 1, state.size))
    for _ in range(blocks - 1):
        code, _, _, _ = drive(mechanics, flow, knots, wind, period, omega, least, tolerance, LEAST_STEPS, state, once)
        if code:
            break
        new = float(np.max(np.hypot(once[:, 0], once[:, n] / omega)))
        settled, size = abs(new - size) <= _SETTLED * new, new
        if settled:
            break
    fine = np.empty((_BLOCK * _PER_PERIOD + 1, state.size))
    spacing = period / _PER_PERIOD
    code, taken, _, _ = drive(mechanics, flow, knots, wind, spacing, omega, least, tolerance, LEAST_STEPS, state, fine)
    outcome, fine = outcome_of(code), fine[:taken]
    if not outcome.ok:
        state[:] = _start(system)  # the next speed knows nothing of this one
        return math.nan, math.nan, math.nan, math.nan, math.nan, False, outcome
    x, v, q, rate = fine[:, 0], fine[:, n], fine[:, 2 * n], fine[:, 2 * n + 1]
    relative = math.nan
    if system.elements:
        direction = system.elements[0].direction
        relative = signals.peak(fine[:, :n] @ direction, fine[:, n : 2 * n] @ direction, spacing)
    rms = float(np.sqrt(np.mean(x**2)))
    return (
        signals.peak(x, v, spacing), rms, relative, signals.peak(q, rate, spacing), _frequency(x, spacing),
        settled, outcome,
    )  # fmt: skip


def _frequency(x: Floats, spacing: float) -> float:
    """From the upward zero crossings [rad/s]; NaN if there are fewer than two."""
    up = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    if up.size < 2:
        return math.nan
    ends = up[[0, -1]] - x[up[[0, -1]]] / (x[up[[0, -1]] + 1] - x[up[[0, -1]]])
    return float(2 * math.pi * (up.size - 1) / ((ends[1] - ends[0]) * spacing))


def _curve(axis: Floats, up: list[Any], down: list[Any]) -> LockInCurve:
    rows = (up, down[::-1])

    def values(i: int, dtype: Any = float) -> Any:
        return frozen([[point[i] for point in row] for row in rows], dtype)

    outcomes = tuple(tuple(point[6] for point in row) for row in rows)
    return LockInCurve(
        frozen(axis), values(0), values(1), values(2), values(3), values(4), values(5, dtype=bool), outcomes
    )


def _notes(case: Case, wake: WakeOscillator, axis: Floats) -> tuple[str, ...]:
    notes = []
    if wake == WakeOscillator():
        notes.append(
            "The wake has the published constants, which were fitted together: "
            f"St = {wake.strouhal:g} and C_L0 = {wake.lift_coefficient:g}, not those of the case."
        )
    Re = axis[[0, -1]] * case.pipe.diameter / case.wind.viscosity
    if Re[0] < _CHECKED_REYNOLDS[0] or Re[1] > _CHECKED_REYNOLDS[1]:
        notes.append(
            f"Part of the window lies beyond the Reynolds numbers St = 0.2 is printed for, 300 ... 1.5e5: "
            f"here {Re[0]:.3g} ... {Re[1]:.3g}."
        )
    return tuple(notes)
