"""What the figures of the page draw, as arrays of at most a thousand points: no trace is ever thinned at its ends."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.plotting.lines import SHORT_NAMES, largest_finite, stretches
from frahm.response import ResponseCurve, SpecialPoint
from frahm.web.looks import EXACT_KINDS, QUANTITIES

MOST_POINTS = 1000


def curve_lines(
    curve: ResponseCurve, kinds: Iterable[tuple[bool, bool, bool]] = EXACT_KINDS
) -> list[dict[str, Floats]]:
    """Lines of a response curve, one entry for every kind: "x", "hz" and the quantities, NaN in the gaps.

    "x" is the wind speed [m/s] where every wind has its own lift, else the detuning [rad/s]; "hz" the frequency [Hz].
    """
    parts: dict[tuple[bool, bool, bool], list[slice]] = {key: [] for key in kinds}
    for part, stable in stretches(curve.stable, curve.piece, curve.branch):
        branch = curve.branch[part.start]
        asymmetric = curve.asymmetric[branch]
        parts[(curve.detached[branch] and not asymmetric, asymmetric, stable)].append(part)
    x = curve.detuning if curve.wind_speed is None else curve.wind_speed
    columns = {"x": x, "hz": curve.frequency / (2 * np.pi), **{name: getattr(curve, name) for name in QUANTITIES}}
    return [{name: _joined(values, found) for name, values in columns.items()} for found in parts.values()]


def _joined(values: Floats, parts: list[slice]) -> Floats:
    """Stretches with a gap between them; of many points every k-th and the last of each stretch."""
    if not parts:
        return np.empty(0)
    total = sum(part.stop - part.start for part in parts) + len(parts)
    every = -(-total // max(1, MOST_POINTS - 2 * len(parts)))
    pieces: list[Floats] = []
    for part in parts:
        kept = np.arange(part.start, part.stop)
        if every > 1:
            kept = np.append(kept[:-1:every], kept[-1])
        pieces += [values[kept], np.array([np.nan])]
    return np.concatenate(pieces[:-1])


def special_points(points: Iterable[SpecialPoint]) -> list[dict[str, Any]]:
    """Special points with their labels SN1, H1, ... in order of frequency."""
    count: dict[str, int] = {}
    found = []
    for point in points:
        short = SHORT_NAMES[point.kind]
        count[short] = count.get(short, 0) + 1
        found.append(
            {
                "label": f"{short}{count[short]}",
                "kind": point.kind,
                "x": point.detuning if point.wind_speed is None else point.wind_speed,
                "hz": point.frequency / (2 * math.pi),
                "pipe_peak": point.pipe_peak,
                "relative_peak": point.relative_peak,
                "located": point.status == "located",
            }
        )
    return found


def heights(curve: ResponseCurve) -> dict[str, float]:
    """Largest value of each quantity on a curve [m]."""
    return {name: largest_finite(getattr(curve, name)) for name in QUANTITIES}


def numbers(values: Any) -> list[float | None]:
    """Doubles as JSON carries them, without a digit lost; None in the gaps."""
    return [value if math.isfinite(value) else None for value in np.asarray(values, dtype=float).tolist()]
