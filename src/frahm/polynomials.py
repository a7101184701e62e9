"""Roots of cubics and quartics in closed form, polished: compiled, because every map and every curve needs them."""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel

_SQRT3 = math.sqrt(3.0)


@kernel
def _polish(m, c, h):
    """Two Newton steps on m^3 + 2 c m^2 + m = h; at a double root the iterate is kept."""
    for _ in range(2):
        slope = (3.0 * m + 4.0 * c) * m + 1.0
        if slope == 0.0:
            break
        step = (((m + 2.0 * c) * m + 1.0) * m - h) / slope
        if abs(step) > 0.1 * abs(m):
            break
        m -= step
    return m


@kernel
def universal_roots(c, h):
    """Positive roots of m^3 + 2 c m^2 + m = h for -1 <= c <= 1, h > 0, ascending: their number, then three values."""
    P = 1.0 - 4.0 / 3.0 * c * c
    R = (16.0 / 27.0 * c * c - 2.0 / 3.0) * c - h
    half, third = 0.5 * R, P / 3.0
    D = half * half + third * third * third
    shift = 2.0 / 3.0 * c
    if D > 0.0 or P >= 0.0:
        u = np.cbrt(abs(half) + math.sqrt(max(D, 0.0)))
        if half > 0.0:
            u = -u
        m = (u - third / u if u != 0.0 else 0.0) - shift
        if m < 1e-3:  # cancellation against the shift: start from the linear solution instead
            m = h - 2.0 * c * h * h
        return 1, _polish(m, c, h), math.nan, math.nan
    amplitude = 2.0 * math.sqrt(-third)
    angle = math.acos(min(1.0, max(-1.0, 3.0 * R / (P * amplitude)))) / 3.0
    co, si = math.cos(angle), math.sin(angle)
    high = _polish(amplitude * co - shift, c, h)
    if c > 0.0:  # the two other real roots are negative
        return 1, high, math.nan, math.nan
    low = amplitude * 0.5 * (-co - _SQRT3 * si) - shift
    mid = amplitude * 0.5 * (-co + _SQRT3 * si) - shift
    return 3, _polish(low, c, h), _polish(mid, c, h), high


@kernel
def _largest_cubic_root(b, c, d):
    """Largest real root of w^3 + b w^2 + c w + d."""
    shift = b / 3.0
    P = c - b * shift
    R = (2.0 * shift * shift - c) * shift + d
    half, third = 0.5 * R, P / 3.0
    D = half * half + third * third * third
    if D >= 0.0:
        u = np.cbrt(abs(half) + math.sqrt(D))
        if half > 0.0:
            u = -u
        w = (u - third / u if u != 0.0 else 0.0) - shift
    else:
        amplitude = 2.0 * math.sqrt(-third)
        w = amplitude * math.cos(math.acos(min(1.0, max(-1.0, 3.0 * R / (P * amplitude)))) / 3.0) - shift
    for _ in range(3):
        slope = (3.0 * w + 2.0 * b) * w + c
        if slope == 0.0:
            break
        w -= (((w + b) * w + c) * w + d) / slope
    return w


@kernel
def quadratic_factors(c1, c2, c3, c4):
    """A, B, G, H of lam^4 + c1 lam^3 + c2 lam^2 + c3 lam + c4 = (lam^2 + A lam + B)(lam^2 + G lam + H), all real."""
    s = 0.25 * c1
    p = c2 - 6.0 * s * s
    q = c3 - 2.0 * c2 * s + 8.0 * s * s * s
    r = c4 - c3 * s + c2 * s * s - 3.0 * s * s * s * s
    w = _largest_cubic_root(2.0 * p, p * p - 4.0 * r, -q * q)
    alpha = math.sqrt(max(w, 0.0))
    if w > 1e-10 * (abs(p) + math.sqrt(abs(r))):
        split = q / alpha
    else:  # the same number where the quotient would lose it
        split = math.copysign(math.sqrt(max((p + w) * (p + w) - 4.0 * r, 0.0)), q)
    beta, gamma = 0.5 * (p + w - split), 0.5 * (p + w + split)
    # back to lam = y - s: (y^2 + alpha y + beta) with y = lam + s
    A, B = alpha + 2.0 * s, beta + s * (alpha + s)
    G, H = -alpha + 2.0 * s, gamma + s * (-alpha + s)
    for _ in range(2):  # Newton on the product's coefficients
        r1, r2 = A + G - c1, B + H + A * G - c2
        r3, r4 = A * H + B * G - c3, B * H - c4
        # unknown steps (a, b) of A, B with steps of G, H = (-r1 - a), (-r2 - b - G a - A (-r1 - a))
        m11, m12 = H - B - A * (G - A), G - A
        m21, m22 = -B * (G - A), H - B
        f1 = r3 + A * (-r2 + A * r1) - B * r1
        f2 = r4 + B * (-r2 + A * r1)
        det = m11 * m22 - m12 * m21
        if abs(det) < 1e-12 * (abs(m11 * m22) + abs(m12 * m21)) or abs(det) < 1e-280:
            break
        a = (-f1 * m22 + f2 * m12) / det
        b = (-f2 * m11 + f1 * m21) / det
        dG = -r1 - a
        dH = -r2 - b - G * a - A * dG
        A, B, G, H = A + a, B + b, G + dG, H + dH
    return A, B, G, H


@kernel
def _larger_real_part(A, B):
    disc = 0.25 * A * A - B
    return -0.5 * A if disc <= 0.0 else -0.5 * A + math.sqrt(disc)


@kernel
def growth_rate(c1, c2, c3, c4):
    """Largest real part [1/s] of the eigenvalues."""
    A, B, G, H = quadratic_factors(c1, c2, c3, c4)
    return max(_larger_real_part(A, B), _larger_real_part(G, H))
