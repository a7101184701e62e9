"""Damage per time of one lasting motion: its stress history, rainflow counted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.assessment.detail import Detail
from frahm.assessment.rainflow_cycles import rainflow_cycles, turning_points
from frahm.attractors import Attractor
from frahm.errors import Outcome
from frahm.systems import System
from frahm.time_integration import TimeHistory, integrate

_FINE, _COARSE = 64, 32  # samples per period: for the orbit of a periodic motion, and for a long history
_CHUNK = 500  # periods of a history that does not repeat, at least
_BEATS = 10  # beats in a chunk, at least
_LONGEST = 32_000  # periods after which a rate that still changes is given up
SETTLED = 0.03  # relative difference of the rate between the two halves of a history
_FAILED = (Outcome.STEP_LIMIT, Outcome.STEP_TOO_SMALL)


@dataclass(frozen=True)
class MotionDamage:
    """Damage per time of a motion at one detail.

    Attributes
    ----------
    rate : float
        Palmgren-Miner damage per time [1/s]; NaN for a motion that cannot be integrated, infinite for one that escapes.
    largest_range : float
        Largest hot-spot stress range [Pa].
    scatter : float
        Relative difference of the rate between the halves of the history [-]; 0 for a periodic motion.
    periods : int
        Length of the history in periods of the excitation.
    """

    rate: float
    largest_range: float
    scatter: float
    periods: int

    @property
    def settled(self) -> bool:
        """Whether a longer history would not change the rate by more than a few per cent."""
        return bool(self.scatter <= SETTLED)


def motion_damage(system: System, attractor: Attractor, detail: Detail) -> MotionDamage:
    """Damage per time on an attractor.

    A periodic motion is counted over its closed orbit: every range is a full cycle. Any other is followed over at least
    1000 periods and ten beats, twice as long each time the rates of its halves differ by more than 3 %.
    """
    if attractor.outcome is Outcome.DIVERGED:
        return MotionDamage(float("inf"), float("inf"), 0.0, 0)
    if attractor.outcome in _FAILED:
        return MotionDamage(float("nan"), float("nan"), float("nan"), 0)
    if attractor.kind == "periodic":
        return _periodic(system, attractor, detail)
    return _modulated(system, attractor, detail)


def _periodic(system: System, attractor: Attractor, detail: Detail) -> MotionDamage:
    multiple = attractor.period_multiple
    history = integrate(
        system, frequency=attractor.frequency, periods=multiple, initial_state=attractor.representative_state,
        samples_per_period=_FINE,
    )  # fmt: skip
    if not history.outcome.ok:
        return MotionDamage(float("nan"), float("nan"), float("nan"), multiple)
    points = stress_points(history, detail)[:-1]  # the last value is the first one again
    first = int(np.argmax(points))
    closed = np.concatenate([points[first:], points[: first + 1]])
    cycles = rainflow_cycles(closed)
    duration = multiple * 2 * np.pi / attractor.frequency
    largest = detail.factor * float(np.max(cycles.ranges, initial=0.0))
    return MotionDamage(cycles.damage(detail.curve, detail.factor) / duration, largest, 0.0, multiple)


def _modulated(system: System, attractor: Attractor, detail: Detail) -> MotionDamage:
    W, state = attractor.frequency, attractor.representative_state
    period = 2 * np.pi / W
    beat = attractor.beat_period / period if np.isfinite(attractor.beat_period) else 0.0
    length = int(max(_CHUNK, np.ceil(min(_BEATS * beat, _LONGEST / 2))))
    parts: list[Floats] = []
    followed, rates = 0, [float("nan")]
    while True:
        history = integrate(system, frequency=W, periods=length, initial_state=state, samples_per_period=_COARSE)
        if not history.outcome.ok:
            return MotionDamage(float("nan"), float("nan"), float("nan"), followed)
        parts.append(stress_points(history, detail))
        state = np.column_stack([history.x[-1], history.v[-1]]).ravel()
        rates.append(rainflow_cycles(parts[-1]).damage(detail.curve, detail.factor) / (length * period))
        followed += length
        mean = 0.5 * (rates[-1] + rates[-2])
        scatter = abs(rates[-1] - rates[-2]) / mean if mean > 0 else 0.0
        if len(parts) > 1:
            if scatter <= SETTLED or 2 * followed > _LONGEST:
                break
            parts, length = [np.concatenate(parts)], followed
            rates = [float("nan"), rainflow_cycles(parts[0]).damage(detail.curve, detail.factor) / (followed * period)]
    cycles = rainflow_cycles(np.concatenate(parts))
    rate = cycles.damage(detail.curve, detail.factor) / (followed * period)
    return MotionDamage(rate, detail.factor * float(np.max(cycles.ranges, initial=0.0)), scatter, followed)


def stress_points(history: TimeHistory, detail: Detail) -> Floats:
    """Turning points of the nominal stress [Pa] of a history, the extremes between its samples too."""
    spacing = 2 * np.pi / history.frequency / history.samples_per_period
    return turning_points(history.x @ detail.row, history.v @ detail.row, spacing)


def largest_place(system: System, attractor: Attractor, sections: Floats, rows: Floats) -> tuple[float, Floats]:
    """Section where the stress range is largest, and the range at every section of the pipe [Pa], shape (s,).

    NaN if the motion cannot be integrated.
    """
    periods = max(attractor.period_multiple, 1) if attractor.kind == "periodic" else _CHUNK
    history = integrate(
        system, frequency=attractor.frequency, periods=periods, initial_state=attractor.representative_state,
        samples_per_period=_COARSE,
    )  # fmt: skip
    if not history.outcome.ok:
        return float("nan"), np.full(sections.shape, np.nan)
    stresses = history.x @ rows.T
    ranges = np.ptp(stresses, axis=0)
    return float(sections[np.argmax(ranges)]), np.asarray(ranges)
