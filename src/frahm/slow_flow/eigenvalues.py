"""Eigenvalues of the slow flow from its characteristic polynomial, in closed form and polished."""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel


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
    if w > 0.0:
        alpha = math.sqrt(w)
        beta = 0.5 * (p + w - q / alpha)
        gamma = 0.5 * (p + w + q / alpha)
    else:
        root = math.sqrt(max(0.25 * p * p - r, 0.0))
        alpha, beta, gamma = 0.0, 0.5 * p - root, 0.5 * p + root
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
        if abs(det) < 1e-12 * (abs(m11 * m22) + abs(m12 * m21)) or det == 0.0:
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
