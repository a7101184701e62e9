"""Curves f(x, y) = 0 in a rectangle: linked by marching squares, then every vertex located by bisection."""

from __future__ import annotations

from collections.abc import Callable

import contourpy
import numpy as np

from frahm.arrays import Floats

_HALVINGS = 60


def zero_curves(function: Callable[[Floats, Floats], Floats], x: Floats, y: Floats) -> list[Floats]:
    """Zero curves of a function on a rectangular grid.

    Parameters
    ----------
    function : callable
        f(x, y) for arrays of equal shape; NaN where it is not defined.
    x, y : ndarray
        Grid lines, ascending.

    Returns
    -------
    list of ndarray, shape (points, 2)
        Connected curves. Every vertex lies on a grid line and satisfies f = 0 to rounding; curves that fit between
        neighbouring grid lines are not seen.
    """
    X, Y = np.meshgrid(x, y)
    values = function(X, Y)
    masked = np.ma.masked_invalid(values)
    lines = contourpy.contour_generator(x=x, y=y, z=masked, name="serial").lines(0.0)
    return [_located(function, np.asarray(line), x, y) for line in lines if len(line) > 1]


def _located(function: Callable[[Floats, Floats], Floats], line: Floats, x: Floats, y: Floats) -> Floats:
    """Move every vertex along the grid edge it lies on to the zero of the function itself."""
    px, py = line[:, 0].copy(), line[:, 1].copy()
    i, j = np.abs(x - px[:, None]).argmin(axis=1), np.abs(y - py[:, None]).argmin(axis=1)
    on_x_line = np.abs(px - x[i]) / np.ptp(x) <= np.abs(py - y[j]) / np.ptp(y)
    px, py = np.where(on_x_line, x[i], px), np.where(on_x_line, py, y[j])
    moving = np.where(on_x_line, py, px)
    below = np.where(on_x_line, _floor(y, moving), _floor(x, moving))
    lo = np.where(on_x_line, y[below], x[below])
    hi = np.where(on_x_line, y[below + 1], x[below + 1])

    def along(value: Floats) -> Floats:
        return function(np.where(on_x_line, px, value), np.where(on_x_line, value, py))

    bracketed, zero = bisected(along, lo, hi)
    moving = np.where(bracketed, zero, moving)
    return np.column_stack([np.where(on_x_line, px, moving), np.where(on_x_line, moving, py)])


def bisected(function: Callable[[Floats], Floats], lo: Floats, hi: Floats) -> tuple[np.ndarray, Floats]:
    """Where the function of every element changes its sign between two values, and whether it does."""
    f_lo = function(lo)
    bracketed = f_lo * function(hi) <= 0
    for _ in range(_HALVINGS):
        mid = 0.5 * (lo + hi)
        left = np.signbit(function(mid)) == np.signbit(f_lo)
        lo, hi = np.where(left, mid, lo), np.where(left, hi, mid)
    return bracketed, np.asarray(0.5 * (lo + hi))


def _floor(lines: Floats, value: Floats) -> np.ndarray:
    return np.clip(np.searchsorted(lines, value, side="right") - 1, 0, lines.size - 2)
