"""The detunings that matter: where the exact equations are integrated."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from frahm.analysis.ranges import detached_ranges, ranges_without_stable_response, unstable_ranges
from frahm.analysis.section import Work
from frahm.loads import vortex_shedding

_SAME = 1e-4  # of the natural frequency: detunings closer than this are one point


@dataclass(frozen=True)
class PointOfInterest:
    """A detuning [rad/s], a short key for files, why it matters, and the wind [m/s] that sheds there."""

    key: str
    reason: str
    detuning: float
    wind_speed: float = math.nan


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
    speeds = work.range.speed(work.case.pipe.frequency + np.array([point.detuning for point in points]))
    return [replace(point, wind_speed=float(speed)) for point, speed in zip(points, speeds, strict=True)]


def _candidates(work: Work) -> Iterator[PointOfInterest]:
    case = work.case
    speed = f"{case.wind.speed:.4g} m/s"
    yield PointOfInterest("design-wind", f"shedding frequency at {speed}", vortex_shedding(case).detuning)
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
            yield PointOfInterest(f"{key}-{number}", f"{reason} [{lo:.4g}, {hi:.4g}] rad/s", 0.5 * (lo + hi))


def _largest_stable(work: Work) -> float | None:
    curve = work.done.data["response"]
    stable = np.where(curve["stable"].values, curve["pipe_peak"].values, np.nan)
    return None if np.all(np.isnan(stable)) else float(curve["detuning"].values[np.nanargmax(stable)])
