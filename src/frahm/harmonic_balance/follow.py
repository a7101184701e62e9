"""A whole branch of the harmonic balance in one compiled call: pseudo-arclength continuation in Omega.

Predictor and corrector: Allgower and Georg (2003), doi 10.1137/1.9780898719154.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel, separate_kernel
from frahm.harmonic_balance.kernels import fourier_tables, sample_count, unknowns
from frahm.harmonic_balance.newton import correct, resize, tangent

LEFT, CLOSED, STEP_TOO_SMALL, TOO_LONG, NO_START, MIRRORED = 0, 1, 2, 3, 4, 5

_ANGLE = 0.3  # turn of the tangent aimed at per step [rad]
_SHARPEST = 0.5  # turn beyond which a step is taken again, shorter [rad]
_TOLERANCE = 3e-7  # last Newton step, in scaled unknowns: what remains is of the order of its square


@kernel
def follow(pb, odd, y0, H0, H_most, goal, direction, lo, hi, x_scale, w_scale, longest, ys, ts, Hs, truncations):
    """Follow the branch through y0 = (X, Omega) until it leaves [lo, hi] or closes, or turns into its mirror image.

    Fills ys, ts (points, size) with points and scaled unit tangents, Hs and truncations (points,); harmonics are added
    and dropped on the way so that the truncation stays below `goal`. Returns (number of points, how it ended).
    """
    step, size = 2 if odd else 1, ys.shape[1]
    J, A, pivots = np.empty((size, size)), np.empty((size, size)), np.empty(size, np.int64)
    y, t, t_new, old, normal = (np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size), np.zeros(size))
    H, n = H0, unknowns(pb, H0, odd)
    y[: n + 1] = y0[: n + 1]
    co, si = fourier_tables(H, odd, sample_count(pb, H, odd))
    normal[n] = 1.0
    ok, truncation, _ = correct(
        pb, H, odd, y, normal, y[n] / w_scale, x_scale, w_scale, co, si, J, A, pivots, _TOLERANCE, 12
    )
    if not ok:
        return 0, NO_START
    old[n] = direction
    tangent(A, pivots, n, old, t)
    _store(0, y, t, H, truncation, n, ys, ts, Hs, truncations)
    count, ds, previous_ds, quiet = 1, 0.2 * longest, 0.0, 0
    n_old = n
    while count < ys.shape[0]:
        # predictor: tangent and, once two points are known, the curvature of the branch
        offset = 0.0
        for j in range(n + 1):
            bend = 0.0
            if count > 1 and n == n_old:
                bend = 0.5 * (t[j] - ts[count - 2, j]) * ds / previous_ds
            scale = w_scale if j == n else x_scale
            y[j] = ys[count - 1, j] + (t[j] + bend) * ds * scale
            offset += t[j] * y[j] / scale
        ok, truncation, moved = correct(pb, H, odd, y, t, offset, x_scale, w_scale, co, si, J, A, pivots, _TOLERANCE, 7)
        along = 0.0
        if ok and moved < 0.5 * ds:
            along = tangent(A, pivots, n, t, t_new)
        angle = math.acos(min(1.0, max(-1.0, along))) if along != 0.0 else math.pi
        if not ok or angle > _SHARPEST or moved > 0.5 * ds:
            ds *= 0.4
            if ds < 1e-7 * longest:
                return count, STEP_TOO_SMALL
            continue
        if truncation > goal and H + 2 * step <= H_most:  # the point asks for more harmonics: take the last one anew
            H += 2 * step
            n = n_old = _resize_last(pb, odd, H, count, ys, ts, Hs)
            t[: n + 1] = ts[count - 1, : n + 1]
            co, si = fourier_tables(H, odd, sample_count(pb, H, odd))
            quiet = 0
            continue
        t[: n + 1] = t_new[: n + 1]
        closing = count > 3 and _passes(pb, odd, ys, ts, Hs, count, y, t, n, x_scale, w_scale)
        if closing:
            _store(count, ys[0], ts[0], Hs[0], truncations[0], unknowns(pb, Hs[0], odd), ys, ts, Hs, truncations)
            return count + 1, CLOSED
        _store(count, y, t, H, truncation, n, ys, ts, Hs, truncations)
        count += 1
        n_old = n
        previous_ds = ds
        ds = min(longest, ds * min(2.0, max(0.5, _ANGLE / max(angle, 1e-3))))
        if y[n] < lo or y[n] > hi:
            return count, LEFT
        if pb.odd and not odd and _even_product(pb, ys[count - 2], ys[count - 1], n) < 0.0:
            return count, MIRRORED
        quiet = quiet + 1 if truncation < 1e-3 * goal and goal < math.inf else 0  # a given number is kept
        if quiet > 3 and H - 2 * step >= 3:  # more harmonics than needed
            H -= 2 * step
            n = n_old = _resize_last(pb, odd, H, count, ys, ts, Hs)
            t[: n + 1] = ts[count - 1, : n + 1]
            co, si = fourier_tables(H, odd, sample_count(pb, H, odd))
            quiet = 0
    return count, TOO_LONG


@separate_kernel
def _store(i, y, t, H, truncation, n, ys, ts, Hs, truncations):
    ys[i] = 0.0
    ts[i] = 0.0
    ys[i, : n + 1] = y[: n + 1]
    ts[i, : n + 1] = t[: n + 1]
    Hs[i] = H
    truncations[i] = truncation


@kernel
def _resize_last(pb, odd, H, count, ys, ts, Hs):
    """Give the last two stored points another number of harmonics; returns their new number of unknowns."""
    for i in range(count - 1, max(count - 3, -1), -1):
        resize(pb, Hs[i], H, odd, ys[i])
        resize(pb, Hs[i], H, odd, ts[i])
        Hs[i] = H
    return unknowns(pb, H, odd)


@kernel
def _even_product(pb, a, b, n):
    """Scalar product of mean and even harmonics of two points: it changes its sign where the symmetry is regained."""
    width = 2 * pb.M11.shape[0]
    total = 0.0
    for start in range(0, n, 2 * width):
        for j in range(start, start + width):
            total += a[j] * b[j]
    return total


@kernel
def _passes(pb, odd, ys, ts, Hs, count, y, t, n, x_scale, w_scale):
    """Whether the chord from the last stored point to (y, t) passes through the first point."""
    n0, n1 = unknowns(pb, Hs[0], odd), unknowns(pb, Hs[count - 1], odd)
    chord, gap, dot, along = 0.0, 0.0, 0.0, 0.0
    for j in range(max(n, n0, n1) + 1):
        a = 0.0 if j >= n1 else ys[count - 1, j] / x_scale
        b = 0.0 if j >= n else y[j] / x_scale
        c = 0.0 if j >= n0 else ys[0, j] / x_scale
        if j == max(n, n0, n1):
            a, b, c = ys[count - 1, n1] / w_scale, y[n] / w_scale, ys[0, n0] / w_scale
        chord += (b - a) ** 2
        gap += (c - a) ** 2
        dot += (b - a) * (c - a)
    for j in range(min(n, n0)):
        along += t[j] * ts[0, j]
    along += t[n] * ts[0, n0]
    if chord == 0.0 or along < 0.7:
        return False
    position = dot / chord
    off = gap - dot * dot / chord
    return 0.0 <= position <= 1.0 and off < 0.01 * chord
