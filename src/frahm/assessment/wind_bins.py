"""Wind bins: where the damage is looked at, closer where it changes."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from frahm.arrays import Floats

_FINE = 0.005  # of a resonance's wind speed: where the first bins begin to widen
_EVEN = 0.5  # share of the first bins that is spread evenly
_POINTS = 4001
Look = Callable[[Sequence[float]], None]


def first_edges(low: float, high: float, count: int, resonances: Sequence[float]) -> Floats:
    """Ends of `count` bins between `low` and `high` [m/s], narrower towards each resonance."""
    U = np.linspace(low, high, _POINTS)
    density = np.full(_POINTS, 1.0 / (high - low))
    peaks = np.zeros(_POINTS)
    for speed in resonances:
        shape = 1 / np.hypot(U - speed, _FINE * speed)
        peaks += shape / np.trapezoid(shape, U)
    if len(resonances):
        density = _EVEN * density + (1 - _EVEN) * peaks / len(resonances)
    grown = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    edges = np.interp(np.linspace(0, grown[-1], count + 1), grown, U)
    edges[0], edges[-1] = low, high
    return edges


def refined(edges: Floats, count: int, look: Look, loss: Callable[[Floats], Floats]) -> Floats:
    """Ends of up to `count` bins: the bins with the largest loss are split in three, so that every middle is kept.

    Parameters
    ----------
    edges : ndarray, shape (b + 1,)
    count : int
    look : callable
        Looks at the middles it is given [m/s].
    loss : callable
        What each bin may miss, from the ends, once all middles have been looked at.
    """
    look(list(middles(edges)))
    while edges.size - 1 + 2 <= count:
        room = (count - (edges.size - 1)) // 2
        missed = loss(edges)
        # A third of the room at a time: the next losses know what has been seen meanwhile.
        worst = np.argsort(-missed)[: max(1, room // 3)]
        worst = worst[missed[worst] > 0]
        if not worst.size:
            break
        new = np.concatenate([[edges[i] + (edges[i + 1] - edges[i]) * t for t in (1 / 3, 2 / 3)] for i in worst])
        edges = np.sort(np.concatenate([edges, new]))
        look([float(middle) for middle in middles(edges)])
    return edges


def gaps(low: float, high: float, bands: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """What bands of wind speeds [m/s] leave of those between `low` and `high`, ascending."""
    left, at = [], low
    for first, last in sorted((min(band), max(band)) for band in bands):
        if min(first, high) > at:
            left.append((at, min(first, high)))
        at = max(at, last)
    return [*left, (at, high)] if at < high else left


def middles(edges: Floats) -> Floats:
    """Middles of bins, rounded so that the middle of a bin and of its middle third are one number."""
    return np.round(0.5 * (edges[1:] + edges[:-1]), 12)


def interpolated_damage(speeds: Floats, rates: Floats, edges: Floats, weights: Floats) -> float:
    """Sum of weight times rate with the rates linear between the middles: what sorting into bins is held against.

    Parameters
    ----------
    speeds, rates : ndarray, shape (b,)
        Middles of the bins [m/s] and the rates there.
    edges : ndarray, shape (b + 1,)
    weights : ndarray, shape (b,)
        Probability of each bin, taken as even inside it.
    """
    total = 0.0
    for i, weight in enumerate(weights):
        points = np.linspace(edges[i], edges[i + 1], 9)
        total += float(weight * np.mean(np.interp(0.5 * (points[1:] + points[:-1]), speeds, rates)))
    return total
