"""What a point of a branch means: amplitudes, peaks, multipliers; and points between two points of a branch."""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel, separate_kernel
from frahm.harmonic_balance.floquet import map_multipliers
from frahm.harmonic_balance.kernels import fourier_tables, harmonics_of, output_harmonic, sample_count, unknowns
from frahm.harmonic_balance.newton import correct, tangent

_LOCATED = 1e-6  # of the frequency: half-width up to which a point where branches cross counts as located


@kernel
def peak_of(x, H, odd):
    """Largest |Re sum_k x_k e^{ik tau}| over a period: every high sample refined by Newton on the slope, bracketed."""
    N = max(24, (2 if odd else 4) * H + 8)
    first, step = (1, 2) if odd else (0, 1)
    h = (math.pi if odd else 2.0 * math.pi) / N
    size, best, at = np.empty(N), 0.0, 0
    for j in range(N):
        size[j] = abs(_value(x, H, first, step, h * j))
        if size[j] > best:
            best, at = size[j], j
    highest = best
    for j in range(N):
        if j != at and (size[j] < 0.8 * best or size[j] < size[j - 1] or size[j] < size[(j + 1) % N]):
            continue
        lo, hi, tau = h * (j - 1), h * (j + 1), h * j
        for _ in range(8):
            value, slope, curve = _series(x, H, first, step, tau)
            highest = max(highest, abs(value))
            if value < 0.0:
                slope, curve = -slope, -curve
            if slope > 0.0:
                lo = tau
            else:
                hi = tau
            move = -slope / curve if curve < 0.0 else math.inf
            if abs(move) < 1e-9:
                break
            tau = tau + move if lo < tau + move < hi else 0.5 * (lo + hi)
    return highest


@kernel
def _value(x, H, first, step, tau):
    value = 0.0
    c1, s1 = math.cos(step * tau), math.sin(step * tau)
    c, s = math.cos(first * tau), math.sin(first * tau)
    for k in range(first, H + 1, step):
        value += x[k].real * c - x[k].imag * s
        c, s = c * c1 - s * s1, s * c1 + c * s1
    return value


@kernel
def _series(x, H, first, step, tau):
    value = slope = curve = 0.0
    c1, s1 = math.cos(step * tau), math.sin(step * tau)
    c, s = math.cos(first * tau), math.sin(first * tau)
    for k in range(first, H + 1, step):
        re, im = x[k].real, x[k].imag
        a, b = re * c - im * s, re * s + im * c
        value += a
        slope -= k * b
        curve -= k * k * a
        c, s = c * c1 - s * s1, s * c1 + c * s1
    return value, slope, curve


@kernel
def output_series(pb, H, odd, W, u, row, x):
    """Harmonics x (H + 1,) of an output row; u (H + 5, r)."""
    first, step = (1, 2) if odd else (0, 1)
    x[:] = 0j
    for k in range(first, H + 1, step):
        x[k] = output_harmonic(pb, k, W, u[k], row)


@kernel
def describe(pb, va, odd, ys, Hs, columns, multipliers):
    """Fill columns (points, 5) with Omega, |X1|, |Z1|, max |x|, max |z| and multipliers (points, m) of the map."""
    for i in range(Hs.size):
        H = Hs[i]
        W = ys[i, unknowns(pb, H, odd)]
        u = np.empty((H + 5, pb.M11.shape[0]), np.complex128)
        harmonics_of(pb, H, odd, ys[i], u)
        x = np.empty(H + 1, np.complex128)
        columns[i, 0] = W
        for row in range(2):
            output_series(pb, H, odd, W, u, row, x)
            columns[i, 1 + row] = abs(x[1])
            columns[i, 3 + row] = peak_of(x, H, odd)
        map_multipliers(pb, va, H, odd, W, u, multipliers[i])


@kernel
def multipliers_along(pb, va, odd, ys, Hs, multipliers):
    """Multipliers (points, m) of the map alone."""
    for i in range(Hs.size):
        u = np.empty((Hs[i] + 5, pb.M11.shape[0]), np.complex128)
        harmonics_of(pb, Hs[i], odd, ys[i], u)
        map_multipliers(pb, va, Hs[i], odd, ys[i, unknowns(pb, Hs[i], odd)], u, multipliers[i])


@separate_kernel
def between(pb, odd, ya, ta, yb, tb, H, fraction, x_scale, w_scale, y, t):
    """Point y and scaled unit tangent t where the hyperplane across the chord from a to b cuts the branch.

    Both ends have the same number of harmonics H; the start is their Hermite interpolation. Returns convergence.
    """
    n = unknowns(pb, H, odd)
    size = n + 1
    J, A, pivots = np.empty((size, size)), np.empty((size, size)), np.empty(size, np.int64)
    normal = np.zeros(size)
    length = 0.0
    for j in range(size):
        scale = w_scale if j == n else x_scale
        normal[j] = (yb[j] - ya[j]) / scale
        length += normal[j] ** 2
    length = math.sqrt(length)
    f = fraction
    h00, h10 = (1.0 + 2.0 * f) * (1.0 - f) ** 2, f * (1.0 - f) ** 2
    h01, h11 = f * f * (3.0 - 2.0 * f), f * f * (f - 1.0)
    offset = 0.0
    for j in range(size):
        scale = w_scale if j == n else x_scale
        normal[j] /= length
        y[j] = h00 * ya[j] + h01 * yb[j] + length * scale * (h10 * ta[j] + h11 * tb[j])
        offset += normal[j] * (ya[j] + f * (yb[j] - ya[j])) / scale
    co, si = fourier_tables(H, odd, sample_count(pb, H, odd))
    ok, _, _ = correct(pb, H, odd, y, normal, offset, x_scale, w_scale, co, si, J, A, pivots, 1e-10, 8)
    if ok:
        tangent(A, pivots, n, normal, t)
    return ok


@separate_kernel
def _critical(pb, va, odd, H, y, t, rank, multipliers):
    """Test function at a point: dOmega/ds for rank < 0, otherwise log of the rank-th largest multiplier modulus."""
    n = unknowns(pb, H, odd)
    u = np.empty((H + 5, pb.M11.shape[0]), np.complex128)
    harmonics_of(pb, H, odd, y, u)
    map_multipliers(pb, va, H, odd, y[n], u, multipliers)
    return t[n] if rank < 0 else math.log(abs(multipliers[rank]))


@kernel
def locate(pb, va, odd, ya, ta, Ha, yb, tb, Hb, rank, x_scale, w_scale, y, t, multipliers):
    """Root of a test function on the branch between a and b by the Illinois method.

    y, t receive the point, `multipliers` those of the map there. Returns (converged, H, half-width in Omega).
    """
    H = max(Ha, Hb)
    n = unknowns(pb, H, odd)
    a, b = np.zeros(n + 1), np.zeros(n + 1)
    sa, sb = np.zeros(n + 1), np.zeros(n + 1)
    _copy(pb, odd, ya, ta, Ha, H, a, sa)
    _copy(pb, odd, yb, tb, Hb, H, b, sb)
    fa = _critical(pb, va, odd, H, a, sa, rank, multipliers)
    fb = _critical(pb, va, odd, H, b, sb, rank, multipliers)
    lo, hi = 0.0, 1.0
    if fa * fb > 0.0:
        return False, H, 0.0
    last, f_last, W_lo, W_hi = a[n], fa, a[n], b[n]
    for _ in range(60):
        middle = 0.5 * (lo + hi) if fa == fb else (lo * fb - hi * fa) / (fb - fa)
        if not between(pb, odd, a, sa, b, sb, H, middle, x_scale, w_scale, y, t):
            half = _close_in(pb, va, odd, a, sa, b, sb, H, lo, middle, hi, rank, x_scale, w_scale, y, t, multipliers)
            half += 1e-12 * last
            return half < _LOCATED * last, H, half
        f = _critical(pb, va, odd, H, y, t, rank, multipliers)
        moved = abs(y[n] - last)
        rest = moved * abs(f) / abs(f - f_last) if f != f_last else 0.0  # what one more secant step would move
        last, f_last = y[n], f
        if abs(f) < 1e-7 and rest < 1e-11 * last:
            return True, H, rest + 1e-12 * last
        if f * fb < 0.0:
            lo, fa, W_lo = hi, fb, W_hi
        else:
            fa *= 0.5
        hi, fb, W_hi = middle, f, y[n]
    half = max(abs(W_lo - last), abs(W_hi - last)) + 1e-12 * last  # beside a crossing rounding keeps it from less
    return half < _LOCATED * last, H, half


@kernel
def _close_in(pb, va, odd, a, sa, b, sb, H, lo, middle, hi, rank, x_scale, w_scale, y, t, multipliers):
    """Half-width in Omega of an interval around a root at the share `middle` of a step, where Newton's method fails.

    Where branches cross the equations are singular: the interval between `lo` and `hi` closes in on the place from both
    sides, as near as one can get; y, t receive the nearer end. Infinite if there is nothing to close in from.
    """
    n = unknowns(pb, H, odd)
    ends, tangents, f, at = np.empty((2, y.size)), np.empty((2, y.size)), np.empty(2), np.empty(2)
    length, half, sign = 0.0, math.inf, 0.0
    for j in range(n + 1):
        length += ((b[j] - a[j]) / (w_scale if j == n else x_scale)) ** 2
    reach = (lo - middle) if abs(lo - middle) > abs(hi - middle) else (middle - hi)  # towards the side of lo
    for power in range(40):
        held = True
        for side in range(2):
            at[side] = lo if side == 0 else hi
            if power > 0:
                at[side] = min(1.0, max(0.0, middle + 0.5**power * (reach if side == 0 else -reach)))
            held = held and between(pb, odd, a, sa, b, sb, H, at[side], x_scale, w_scale, ends[side], tangents[side])
            if held:
                f[side] = _critical(pb, va, odd, H, ends[side], tangents[side], rank, multipliers)
        if not held or f[0] * f[1] > 0.0 or (sign != 0.0 and f[0] * sign < 0.0):
            continue  # nearer to the crossing, or where a further change of the step lies outside
        sign = f[0]
        width = abs(ends[0, n] - ends[1, n])
        if rank < 0:  # Omega turns between the ends: its slopes say how far beyond both
            width = max(width, (abs(f[0]) + abs(f[1])) * abs(at[1] - at[0]) * math.sqrt(length) * w_scale)
        if width < half:
            half, near = width, 0 if abs(f[0]) < abs(f[1]) else 1
            y[:], t[:] = ends[near], tangents[near]
    return half


@separate_kernel
def _copy(pb, odd, y, t, H, H_new, y_new, t_new):
    n = unknowns(pb, H, odd)
    m = unknowns(pb, H_new, odd)
    y_new[: min(n, m)] = y[: min(n, m)]
    t_new[: min(n, m)] = t[: min(n, m)]
    y_new[m], t_new[m] = y[n], t[n]


@kernel
def same_harmonics(pb, odd, y, t, H, H_new, y_new, t_new):
    """Copy a point and its tangent to another number of harmonics."""
    y_new[:] = 0.0
    t_new[:] = 0.0
    _copy(pb, odd, y, t, H, H_new, y_new, t_new)
