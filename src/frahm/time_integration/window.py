"""What a batch remembers of its last window: peaks, the smallest peak, the mean square. Memory: a few numbers a lane.

Each step is looked at where the Gauss-Lobatto rule with nine nodes looks, through the dense output of the step. Where a
velocity changes sign between two nodes, the peak is taken at the zero of the velocity, so that no peak is missed by
falling between nodes.
"""

from __future__ import annotations

import numpy as np

from frahm.compiled import kernel
from frahm.lanes import LANES, load, magnitude, maximum, store, where_at_most
from frahm.time_integration.stepper import blend

# Rows of the window, each for the output (even) and the first element's relative displacement (odd).
PEAK, LEAST_PEAK, SQUARE, CURRENT_PEAK, STRETCH = 0, 2, 4, 6, 8
ROWS = 9


def _gauss_lobatto(count: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Nodes and weights on [0, 1]."""
    legendre = np.polynomial.legendre.Legendre.basis(count - 1)
    nodes = np.concatenate([[-1.0], np.sort(legendre.deriv().roots().real), [1.0]])
    weights = 2.0 / (count * (count - 1) * legendre(nodes) ** 2)
    return tuple((0.5 + 0.5 * nodes).tolist()), tuple((0.5 * weights).tolist())


_NODES, _WEIGHTS = _gauss_lobatto(9)


@kernel
def clear_window(window, lane):
    """Forget what a lane has seen."""
    for row in range(ROWS):
        window[row * LANES + lane] = 0.0
    for row in (LEAST_PEAK, LEAST_PEAK + 1):
        window[row * LANES + lane] = np.inf


@kernel
def _project(monitor, which, m, dense, projected):
    """Dense coefficients of one monitored displacement (first eight) and its velocity (last eight)."""
    n = m // (2 * LANES)
    for q in range(8):
        x, v = load(dense, 0) * 0.0, load(dense, 0) * 0.0
        for i in range(n):
            row = load(monitor, (which * n + i) * LANES)
            x = x + row * load(dense, q * m + i * LANES)
            v = v + row * load(dense, q * m + (n + i) * LANES)
        store(projected, q * LANES, x)
        store(projected, (8 + q) * LANES, v)


@kernel
def _at(projected, first, s):
    p = first * LANES
    return blend(
        s, load(projected, p), load(projected, p + LANES), load(projected, p + 2 * LANES),
        load(projected, p + 3 * LANES), load(projected, p + 4 * LANES), load(projected, p + 5 * LANES),
        load(projected, p + 6 * LANES), load(projected, p + 7 * LANES),
    )  # fmt: skip


@kernel
def _peak_and_square(projected):
    """Largest |x| within the step and the mean of x^2 over it."""
    none = load(projected, 0) * 0.0
    x, v = _at(projected, 0, none), _at(projected, 8, none)
    peak, square = magnitude(x), _WEIGHTS[0] * x * x
    for node in range(1, 9):
        before, after = _NODES[node - 1], _NODES[node]
        x = _at(projected, 0, none + after)
        v_before, v = v, _at(projected, 8, none + after)
        square = square + _WEIGHTS[node] * x * x
        peak = maximum(peak, magnitude(x))
        # No sign change: the place falls outside the two nodes and the last node is looked at again.
        turning = where_at_most(v_before * v, 0.0, v_before / (v_before - v), 1.0)
        turning = where_at_most(0.0, turning, turning, 1.0)  # 0/0 at rest
        peak = maximum(peak, magnitude(_at(projected, 0, before + (after - before) * turning)))
    return peak, square


@kernel
def watch_window(window, watched, monitor, m, turns, dense, projected):
    """Add a step of `turns` [turns] in the lanes where `watched` is 1."""
    stretch = load(window, STRETCH * LANES) + turns * watched
    full = where_at_most(1.0 - 1e-9, stretch, 1.0, 0.0)
    for which in range(2):
        _project(monitor, which, m, dense, projected)
        peak, square = _peak_and_square(projected)
        peak, square = where_at_most(1.0, watched, peak, 0.0), where_at_most(1.0, watched, square, 0.0)
        current = maximum(load(window, (CURRENT_PEAK + which) * LANES), peak)
        least = load(window, (LEAST_PEAK + which) * LANES)
        at = PEAK + which
        store(window, at * LANES, maximum(load(window, at * LANES), peak))
        at = SQUARE + which
        store(window, at * LANES, load(window, at * LANES) + turns * square)
        at = LEAST_PEAK + which
        store(window, at * LANES, where_at_most(1.0, full, where_at_most(current, least, current, least), least))
        at = CURRENT_PEAK + which
        store(window, at * LANES, where_at_most(1.0, full, 0.0, current))
    store(window, STRETCH * LANES, where_at_most(1.0, full, 0.0, stretch))
