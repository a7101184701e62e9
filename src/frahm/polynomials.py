"""Roots of cubics and quartics in closed form, polished: compiled, because every map and every curve needs them."""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel

_SQRT3 = math.sqrt(3.0)
_ROUNDING = 2.0**-52
_FEW = 8.0 * _ROUNDING
REAL = 1e-7  # imaginary part of a root that is real but for rounding, of its modulus


@kernel
def _excess(m, c, h):
    return ((m + 2.0 * c) * m + 1.0) * m - h


@kernel
def _polish(m, c, h):
    """Two Newton steps on m^3 + 2 c m^2 + m = h, as long as they bring it nearer: at a double root they would not."""
    if m < 1e-3:  # what the closed form loses against the shift: start from the linear solution instead
        m = h - 2.0 * c * h * h
    excess = _excess(m, c, h)
    for _ in range(2):
        slope = (3.0 * m + 4.0 * c) * m + 1.0
        step = excess / slope if slope != 0.0 else math.inf
        nearer = _excess(m - step, c, h)
        if abs(step) > 0.1 * abs(m) or not abs(nearer) < abs(excess):
            break
        m, excess = m - step, nearer
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
        return 1, _polish(m, c, h), math.nan, math.nan
    amplitude = 2.0 * math.sqrt(-third)
    angle = math.acos(min(1.0, max(-1.0, 3.0 * R / (P * amplitude)))) / 3.0
    co, si = math.cos(angle), math.sin(angle)
    high = _polish(amplitude * co - shift, c, h)
    if c > 0.0:  # the two other real roots are negative
        return 1, high, math.nan, math.nan
    low = amplitude * 0.5 * (-co - _SQRT3 * si) - shift
    mid = amplitude * 0.5 * (-co + _SQRT3 * si) - shift
    mid = _polish(mid, c, h)
    return 3, _polish(low, c, h), min(mid, high), max(mid, high)


@kernel
def cubic_roots(S, F, k):
    """|Z|^2 of all solutions of S Z + k |Z|^2 Z = F, ascending: their number and three values."""
    D, load = abs(S) ** 2, abs(F) ** 2
    if k == 0.0 or load == 0.0 or D == 0.0:
        if D == 0.0 and k != 0.0 and load > 0.0:
            return 1, np.cbrt(load / (k * k)), math.nan, math.nan
        return (1 if D > 0.0 else 0), (load / D if D > 0.0 else math.nan), math.nan, math.nan
    c = math.copysign(1.0, k) * S.real / math.sqrt(D)
    count, m1, m2, m3 = universal_roots(c, abs(k) * load / D**1.5)
    scale = math.sqrt(D) / abs(k)
    return count, m1 * scale, m2 * scale, m3 * scale


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
    """A, B, G, H of lam^4 + c1 lam^3 + c2 lam^2 + c3 lam + c4 = (lam^2 + A lam + B)(lam^2 + G lam + H), all real.

    The factors multiply back to within a few roundings of every coefficient, measured by what the moduli of the roots
    would add up to. The closed form does so for most quartics; roots that gather, or differ much in size, spoil it,
    and are then taken off one by one, the smallest first (J. H. Wilkinson, Rounding errors in algebraic processes,
    1963: only in this order is deflation harmless). Roots are 0 or between 1e-60 and 1e60 in modulus.
    """
    A, B, G, H = _closed_factors(c1, c2, c3, c4)
    if _multiplies_back(A, B, G, H, c1, c2, c3, c4):
        return A, B, G, H
    z = _small_root(4, 1.0, c1, c2, c3, c4)
    x = z.real
    if not _is_root(x, 1.0, c1, c2, c3, c4):
        return _real_factors(-2.0 * x, x * x + z.imag * z.imag, c1, c2, c3, c4)
    b1 = c1 + x
    b2 = c2 + x * b1
    G, H, other = _cubic_factors(b1, b2, c3 + x * b2)
    return other - x, -x * other, G, H


@kernel
def _multiplies_back(A, B, G, H, c1, c2, c3, c4):
    """Whether the product of two quadratics is a quartic to a few roundings."""
    AG, AH, BG, BH = A * G, A * H, B * G, B * H
    return (
        abs(A + G - c1) <= _FEW * (abs(A) + abs(G))
        and abs(B + H + AG - c2) <= _FEW * (abs(B) + abs(H) + abs(AG))
        and abs(AH + BG - c3) <= _FEW * (abs(AH) + abs(BG))
        and abs(BH - c4) <= _FEW * abs(BH)
    )


@kernel
def _closed_factors(c1, c2, c3, c4):
    """The same by Ferrari's way over the resolvent cubic and two Newton steps, good where roots are well apart."""
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
def _small_root(n, a4, a3, a2, a1, a0):
    """A root among the smallest of a polynomial of degree n, 3 or 4 (a4 = 0 for 3), by Laguerre's method."""
    if a0 == 0.0:
        return 0j
    x = _radius(n, a4, a3, a2, a1, a0) * (0.6 + 0.8j)  # off the real axis: pairs can be reached as well
    for _ in range(60):
        p, slope, half_curve = complex(a4), 0j, 0j
        size, bound = abs(x), abs(a4)
        for a in (a3, a2, a1, a0):
            half_curve = half_curve * x + slope
            slope = slope * x + p
            p = p * x + a
            bound = bound * size + abs(p)
        if abs(p) <= _ROUNDING * bound or not math.isfinite(bound):
            break
        G = slope / p
        square = G * G
        root = np.sqrt((n - 1) * (n * (square - 2.0 * half_curve / p) - square))
        denominator = G + root if abs(G + root) >= abs(G - root) else G - root
        step = n / denominator
        if x - step == x:
            break
        x -= step
    return x


@kernel
def _radius(n, a4, a3, a2, a1, a0):
    """Radius of a circle that holds a root: from the largest that each coefficient lets the smallest root be."""
    radius = n * abs(a0 / a1) if a1 != 0.0 else math.inf
    if a2 != 0.0:
        radius = min(radius, math.sqrt(0.5 * n * (n - 1) * abs(a0 / a2)))
    if a3 != 0.0:
        radius = min(radius, np.cbrt((1.0 if n == 3 else 4.0) * abs(a0 / a3)))
    if a4 != 0.0:
        radius = min(radius, math.sqrt(math.sqrt(abs(a0 / a4))))
    return radius


@kernel
def _is_root(x, a4, a3, a2, a1, a0):
    """Whether a polynomial vanishes at a real number to a few roundings of its terms."""
    p, bound, size = a4, abs(a4), abs(x)
    for a in (a3, a2, a1, a0):
        p = p * x + a
        bound = bound * size + abs(a)
    return abs(p) <= 2.0 * _ROUNDING * bound


@kernel
def _cubic_factors(c1, c2, c3):
    """A, B, g of lam^3 + c1 lam^2 + c2 lam + c3 = (lam^2 + A lam + B)(lam + g)."""
    z = _small_root(3, 0.0, 1.0, c1, c2, c3)
    r = z.real
    if _is_root(r, 0.0, 1.0, c1, c2, c3):
        return c1 + r, c2 + r * (c1 + r), -r
    size = z.real * z.real + z.imag * z.imag  # of a pair: the third root is real
    r = -c3 / size
    for _ in range(4):
        slope = (3.0 * r + 2.0 * c1) * r + c2
        if slope == 0.0:
            break
        r -= (((r + c1) * r + c2) * r + c3) / slope
    if r * r < size:
        return c1 + r, c2 + r * (c1 + r), -r
    B = -c3 / r  # the larger root is taken off from the other end
    return (B - c2) / r, B, -r


@kernel
def _real_factors(A, B, c1, c2, c3, c4):
    """The quadratic that holds a pair and what is left of the quartic, by Bairstow's method; the best of its steps."""
    best, a, b, G, H = math.inf, A, B, 0.0, 0.0
    for _ in range(40):
        g = c1 - a
        h = c2 - b - a * g
        r1, r0 = c3 - a * h - b * g, c4 - b * h
        error = max(_share(r1, abs(a * h) + abs(b * g) + abs(c3)), _share(r0, abs(b * h) + abs(c4)))
        if error < best:
            best, A, B, G, H = error, a, b, g, h
        m11, m12, m21, m22 = b - h - a * (a - g), a - g, b * (g - a), b - h
        det = m11 * m22 - m12 * m21
        if error <= _ROUNDING or det == 0.0 or not math.isfinite(error):
            break
        a -= (r1 * m22 - r0 * m12) / det
        b -= (r0 * m11 - r1 * m21) / det
    return A, B, G, H


@kernel
def _share(part, whole):
    return abs(part) / whole if part != 0.0 else 0.0


@kernel
def _larger_real_part(A, B):
    """Larger real part of the roots of lam^2 + A lam + B, without the difference of nearly equal numbers."""
    disc = 0.25 * A * A - B
    if disc <= 0.0:
        return -0.5 * A
    return math.sqrt(disc) - 0.5 * A if A <= 0.0 else -B / (0.5 * A + math.sqrt(disc))


@kernel
def growth_rate(c1, c2, c3, c4):
    """Largest real part [1/s] of the eigenvalues."""
    A, B, G, H = quadratic_factors(c1, c2, c3, c4)
    return max(_larger_real_part(A, B), _larger_real_part(G, H))
