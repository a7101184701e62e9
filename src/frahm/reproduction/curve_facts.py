"""What the claims ask of a response curve: ranges between special points, peaks, numbers of responses."""

from __future__ import annotations

import itertools
import math

import numpy as np

from frahm.response import ResponseCurve

Range = tuple[float, float]
NO_RANGE: Range = (math.nan, math.nan)


def unstable_range(curve: ResponseCurve) -> Range:
    """Range of detuning [rad/s] around or nearest to resonance that holds an unstable response; NaN if there is none.

    Its ends are special points of the curve, so that no grid limits them.
    """
    ranges = unstable_ranges(curve)
    return min(ranges, key=_distance_from_resonance) if ranges else NO_RANGE


def unstable_ranges(curve: ResponseCurve) -> list[Range]:
    """All ranges of detuning [rad/s] that hold an unstable response, ascending."""
    ends = (float(np.min(curve.detuning)), float(np.max(curve.detuning)))
    edges = sorted({*ends, *(point.detuning for point in curve.special_points)})
    ranges: list[Range] = []
    for low, high in itertools.pairwise(edges):
        between = (curve.detuning > low) & (curve.detuning < high)
        if np.all(curve.stable[between]):
            continue
        if ranges and ranges[-1][1] == low:
            low = ranges.pop()[0]
        ranges.append((low, high))
    return ranges


def several_responses(curve: ResponseCurve, side: str) -> Range:
    """Range of detuning [rad/s] between the outermost saddle-nodes "left" or "right" of resonance; NaN without any."""
    found = detunings(curve, side, "saddle-node")
    return (found[0], found[-1]) if found else NO_RANGE


def detunings(curve: ResponseCurve, side: str, kind: str | None = None) -> list[float]:
    """Detunings [rad/s] of the special points (of one kind) "left" or "right" of resonance, ascending."""
    sign = {"left": -1, "right": 1}[side]
    points = [p for p in curve.special_points if kind is None or p.kind == kind]
    return sorted(p.detuning for p in points if sign * p.detuning > 0)


def peak(curve: ResponseCurve) -> tuple[float, float]:
    """Largest pipe amplitude [m] on the curve and its detuning [rad/s]."""
    index = int(np.argmax(curve.pipe_amplitude))
    return float(curve.pipe_amplitude[index]), float(curve.detuning[index])


def relative_peak(curve: ResponseCurve) -> float:
    """Largest relative amplitude [m] on the curve."""
    return float(np.max(curve.relative_amplitude))


def falling(values: list[float]) -> bool:
    """Whether each value is less than the one before."""
    return all(later < earlier for earlier, later in itertools.pairwise(values))


def _distance_from_resonance(window: Range) -> float:
    low, high = window
    return 0.0 if low <= 0 <= high else min(abs(low), abs(high))
