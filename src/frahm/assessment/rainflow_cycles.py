"""Stress cycles of a history by rainflow counting, and the damage they do.

Convention: ASTM E1049-85 (2011), section 5.4.4, as the library `rainflow` counts: what does not close is counted as
half cycles. On the example of that standard (-2, 1, -3, 5, -1, 3, -4, 4, -2) the ranges are 3 (.5), 4 (.5), 4 (1),
6 (.5), 8 (1), 9 (.5), and the sum of n S^3 is 1094.0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import rainflow
from numpy.typing import ArrayLike

from frahm.arrays import Floats, finite_array, frozen
from frahm.errors import ParameterError
from frahm.published.dnv_rp_c203 import SNCurve

CONVENTION = "ASTM E1049, unclosed cycles counted as halves"


@dataclass(frozen=True, eq=False)
class Cycles:
    """Ranges of a history and how often each occurs.

    Attributes
    ----------
    ranges : ndarray, shape (m,)
        In the unit of the history.
    counts : ndarray, shape (m,)
        1 for a full cycle, 0.5 for a half one.
    """

    ranges: Floats
    counts: Floats

    def power_sum(self, exponent: float) -> float:
        """Sum of n S^m."""
        return float(self.counts @ self.ranges**exponent)

    def damage(self, curve: SNCurve, factor: float = 1.0) -> float:
        """Sum of n/N(factor S), Palmgren-Miner [-]; ranges in Pa."""
        return float(np.sum(self.counts / curve.cycles(factor * self.ranges)))


def rainflow_cycles(history: ArrayLike) -> Cycles:
    """Cycles of a history by rainflow counting, ASTM E1049 with half cycles.

    Parameters
    ----------
    history : array_like, shape (s,)
        Samples or turning points, in any unit.
    """
    values = finite_array("history", history, (-1,))
    found = [(size, count) for size, _, count, _, _ in rainflow.extract_cycles(values.tolist())]
    ranges, counts = np.array(found).T if found else (np.zeros(0), np.zeros(0))
    return Cycles(frozen(ranges), frozen(counts))


def turning_points(values: ArrayLike, slopes: ArrayLike, spacing: float) -> Floats:
    """First value, extremes and last value of a sampled history, the extremes between the samples too.

    Between samples the history is the cubic through values and slopes; 32 samples per period then give the peaks of a
    sine to 4e-6.

    Parameters
    ----------
    values, slopes : array_like, shape (s,)
        Samples and their time derivatives.
    spacing : float
        Time between samples [s].
    """
    x, v = finite_array("values", values, (-1,)), finite_array("slopes", slopes, (-1,)) * spacing
    if x.size != v.size:
        raise ParameterError("slopes", f"{v.size} of them", f"{x.size}, one per value")
    if x.size < 2:
        return x
    return _reversals(_with_extremes(x, v))


def _with_extremes(x: Floats, v: Floats) -> Floats:
    """Samples and, between them, the extremes of the cubic through values x and slopes v per step."""
    rise, first, last = np.diff(x), v[:-1], v[1:]
    # x(s) = x_0 + v_0 s + b s^2 + a s^3 on [0, 1]; its extremes are zeros of v_0 + 2 b s + 3 a s^2.
    a, b = first + last - 2 * rise, 3 * rise - 2 * first - last
    root = np.sqrt(np.maximum(b * b - 3 * a * first, 0.0))
    real = b * b - 3 * a * first > 0
    q = -(b + np.copysign(root, b))
    with np.errstate(divide="ignore", invalid="ignore"):
        places = np.sort(np.stack([q / (3 * a), first / q]), axis=0)
    inside = real & np.isfinite(places) & (places > 0) & (places < 1)
    s = np.where(inside, places, 0.0)
    extremes = np.where(inside, x[:-1] + s * (first + s * (b + s * a)), np.nan)
    ordered = np.column_stack([x[:-1], extremes[0], extremes[1]]).ravel()
    return np.append(ordered[np.isfinite(ordered)], x[-1])


def _reversals(values: Floats) -> Floats:
    """First value, those at which the direction changes, last value; plateaus count once."""
    moving = values[np.append(True, np.diff(values) != 0)]
    rises = np.diff(moving) > 0
    turns = np.flatnonzero(rises[1:] != rises[:-1]) + 1
    return moving[np.unique(np.concatenate([[0], turns, [moving.size - 1]]))]
