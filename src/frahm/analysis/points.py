"""The detunings that matter: where the exact equations are integrated."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from frahm import readable
from frahm.analysis.ranges import detached_ranges, ranges_without_stable_response, unstable_ranges
from frahm.analysis.section import Work
from frahm.loads import vortex_shedding

DESIGN_WIND = "design-wind"
_SAME = 1e-4  # of the natural frequency: detunings closer than this are one point


@dataclass(frozen=True)
class PointOfInterest:
    """A detuning [rad/s], a short key for files, why it matters, and the wind [m/s] that sheds there."""

    key: str
    reason: str
    detuning: float
    wind_speed: float = math.nan

    @property
    def place(self) -> str:
        """Where it is, for a sentence."""
        if math.isfinite(self.wind_speed):
            return f"at {readable.speed(self.wind_speed)}"
        return f"at detuning {self.detuning:.4g} rad/s"


def points_of_interest(work: Work) -> list[PointOfInterest]:
    """Detunings to integrate at, the design wind first; reasons that fall on one detuning are joined."""
    points: list[PointOfInterest] = []
    for new in _candidates(work):
        for i, old in enumerate(points):
            if abs(old.detuning - new.detuning) < _SAME * work.case.pipe.frequency:
                points[i] = replace(old, reason=f"{old.reason}; {new.reason}")
                break
        else:
            points.append(new)
    return [replace(point, wind_speed=_speed(work, point)) for point in points]


def _speed(work: Work, point: PointOfInterest) -> float:
    """Wind that sheds there [m/s]; the design wind is itself, though the range may leave it out."""
    if work.range.over_wind and point.key == DESIGN_WIND:
        return work.case.wind.speed
    return float(work.range.speed(work.case.pipe.frequency + point.detuning))


def _candidates(work: Work) -> Iterator[PointOfInterest]:
    case = work.case
    speed = f"{case.wind.speed:.4g} m/s"
    yield PointOfInterest(DESIGN_WIND, f"shedding frequency at {speed}", vortex_shedding(case).detuning)
    lo, hi = work.range.detuning
    if not work.range.over_wind or lo <= 0 <= hi:
        yield PointOfInterest("resonance", "natural frequency of the pipe", 0.0)
    if "response" not in work.done.data:
        return
    curve = work.done.data["response"]
    largest = _largest_stable(work)
    if largest is not None:
        yield PointOfInterest("largest-stable-peak", "largest stable response", largest)
    named = (
        ("no-stable-response", "middle of a range without a stable response", ranges_without_stable_response(curve)),
        ("unstable-range", "middle of a range with an unstable response", unstable_ranges(curve)),
        ("detached-branch", "middle of a range with a detached branch", detached_ranges(curve)),
    )
    for key, reason, ranges in named:
        for number, (lo, hi) in enumerate(ranges, start=1):
            yield PointOfInterest(f"{key}-{number}", f"{reason}, {_span(work, lo, hi)}", 0.5 * (lo + hi))


def _span(work: Work, lo: float, hi: float) -> str:
    """A range of detunings [rad/s], by the wind where the lift follows it."""
    if not work.range.over_wind:
        return f"[{lo:.4g}, {hi:.4g}] rad/s"
    speeds = work.range.speed(work.case.pipe.frequency + np.array([lo, hi]))
    return f"[{speeds[0]:.4g}, {speeds[1]:.4g}] m/s"


def _largest_stable(work: Work) -> float | None:
    curve = work.done.data["response"]
    stable = np.where(curve["stable"].values, curve["pipe_peak"].values, np.nan)
    return None if np.all(np.isnan(stable)) else float(curve["detuning"].values[np.nanargmax(stable)])
