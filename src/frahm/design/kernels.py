"""Compiled screening of designs: every one-harmonic response of any structure with one absorber, in closed form.

The absorber (mass m, spring k1 z + k3 z^3, damper c) on a structure with the receptances of `host`::

    (d0 + n s0) Z = m Omega^2 u_F,    n = 3/4 k3 |Z|^2,   G = k1 + i Omega c,
    s0 = 1 - m Omega^2 a,             d0 = G s0 - m Omega^2

is a cubic in |Z|^2 (`polynomials.universal_roots`): all branches at once, however many modes the structure has. Its
scaled load h is in proportion to the squared force. Two further roots exist for loads between the extremes of
m^3 + 2 c m^2 + m, so that the force at which the upper pair appears is known at every frequency. A detached curve is
born where that force is least over the frequency, and lives until the force reaches an end of the range.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.polynomials import growth_rate, universal_roots
from frahm.slow_flow.kernels import AVERAGED, ODD, characteristic, linear_parts, stability_class

_CUSP = -0.5 * math.sqrt(3.0)


@kernel
def _onset(c, h):
    """Factor on the force [-] at which the upper pair of roots appears; infinite where it never does."""
    if c >= _CUSP:
        return math.inf
    m = (math.sqrt(4.0 * c * c - 3.0) - 2.0 * c) / 3.0
    load = m * ((m + 2.0 * c) * m + 1.0)
    return math.sqrt(max(load, 0.0) / h)


@kernel
def _balance(W, a, u, m, k1, damper):
    """G, d0, s0 and the drive m Omega^2 u_F of the one-harmonic balance."""
    wm = m * W * W
    s0 = 1.0 - wm * a
    G = complex(k1, W * damper)
    return G, G * s0 - wm, s0, wm * u


@kernel
def _universal(k, d0, s0, drive):
    """Cosine c, load h and the factor from m to |Z|^2 of the universal cubic; k = 3/4 k3 above 0."""
    D = d0.real * d0.real + d0.imag * d0.imag
    S = s0.real * s0.real + s0.imag * s0.imag
    ratio = math.sqrt(S / D)
    c = (d0.real * s0.real + d0.imag * s0.imag) / math.sqrt(D * S)
    load = drive.real * drive.real + drive.imag * drive.imag
    return min(1.0, max(-1.0, c)), k * load * ratio / D, 1.0 / (k * ratio)


@kernel
def _squares(k, d0, s0, drive):
    """All |Z|^2: their number, then three values."""
    if k == 0.0:
        D = d0.real * d0.real + d0.imag * d0.imag
        return 1, (drive.real * drive.real + drive.imag * drive.imag) / D, math.nan, math.nan
    c, h, scale = _universal(k, d0, s0, drive)
    count, m1, m2, m3 = universal_roots(c, h)
    return count, m1 * scale, m2 * scale, m3 * scale


@kernel
def _birth(onset, highest):
    """Least factor on the force at which a detached curve is born that still exists at the force given.

    `onset` (W,) holds the factors of `_onset` over the frequency, `highest` (W,) is room for work. A range too narrow
    to see its shape counts as a birth.
    """
    W = onset.size
    birth = math.inf
    start = 0
    while start < W:
        if onset[start] == math.inf:
            start += 1
            continue
        end = start
        while end + 1 < W and onset[end + 1] < math.inf:
            end += 1
        if end - start < 3:
            for j in range(start, end + 1):
                birth = min(birth, onset[j])
        # the highest barrier on the way to the right end; a range cut off by the grid ends at infinity
        barrier = math.inf if end == W - 1 else 0.0
        for j in range(end, start - 1, -1):
            barrier = max(barrier, onset[j])
            highest[j] = barrier
        barrier = math.inf if start == 0 else 0.0
        for j in range(start, end + 1):
            barrier = max(barrier, onset[j])
            merge = min(barrier, highest[j])
            inner = start < j < end and onset[j] <= onset[j - 1] and onset[j] < onset[j + 1]
            if inner and merge > 1.0 and merge > onset[j]:
                bend = onset[j - 1] - 2.0 * onset[j] + onset[j + 1]
                slope = 0.5 * (onset[j + 1] - onset[j - 1])
                least = onset[j] - (0.5 * slope * slope / bend if bend > 0.0 else 0.0)
                birth = min(birth, least)
        start = end + 1
    return birth


@kernel
def births(frequency, a, u, designs, found):
    """Fill `found` (D,): least factor on the force at which a detached curve is born, over all frequency errors."""
    R, W = frequency.shape
    onset, highest = np.empty(W), np.empty(W)
    for i in range(designs.shape[0]):
        m, k1, k3, damper = designs[i]
        found[i] = math.inf
        if k3 == 0.0:
            continue
        for r in range(R):
            for j in range(W):
                _, d0, s0, drive = _balance(frequency[r, j], a[r, j], u[r, j], m, k1, damper)
                c, h, _ = _universal(0.75 * k3, d0, s0, drive)
                onset[j] = _onset(c, h)
            found[i] = min(found[i], _birth(onset, highest))


@kernel
def largest_responses(frequency, a, u, b, x, designs, limit, worst):
    """Fill `worst` (D,) [m]: largest |x| over all roots and conditions of `designs` (D, 4): m, k1, k3, c in SI units.

    A design whose |x| exceeds `limit` [m] is left with what was seen of it so far.
    """
    R, W = frequency.shape
    bound = limit * limit
    for i in range(designs.shape[0]):
        m, k1, k3, damper = designs[i]
        k = 0.75 * k3
        square = 0.0
        for r in range(R):
            for j in range(W):
                G, d0, s0, drive = _balance(frequency[r, j], a[r, j], u[r, j], m, k1, damper)
                count, N1, N2, N3 = _squares(k, d0, s0, drive)
                for q in range(count):
                    n = k * (N1 if q == 0 else (N2 if q == 1 else N3))
                    out = x[r, j] + b[r, j] * (G + n) * drive / (d0 + n * s0)
                    square = max(square, out.real * out.real + out.imag * out.imag)
            if square > bound:
                break
        worst[i] = math.sqrt(square)


@kernel
def screened(frequency, a, u, b, x, mode, designs, found, peaks):
    """Fill `peaks` (D, R) and `found` (D, 2) for `designs` (D, 4): m [kg], k1 [N/m], k3 [N/m^3], c [N s/m].

    `peaks` is the largest |x| [m] over all roots and frequencies at every frequency error; the columns of `found` are
    the largest |Z| [m] and the largest growth rate [1/s] of the governing mode's slow flow, saddles left out. `mode`
    (R, 3) holds frequency, damping over mass and mass of the governing mode at every frequency error.
    """
    R, W = frequency.shape
    for i in range(designs.shape[0]):
        m, k1, k3, damper = designs[i]
        largest, growth = 0.0, -math.inf
        k = 0.75 * k3
        for r in range(R):
            omega, xi1, mass = mode[r]
            square = 0.0
            for j in range(W):
                G, d0, s0, drive = _balance(frequency[r, j], a[r, j], u[r, j], m, k1, damper)
                count, N1, N2, N3 = _squares(k, d0, s0, drive)
                d2, d1, e0, s1, t0, _, _ = linear_parts(
                    AVERAGED, frequency[r, j], omega, xi1, damper / mass, k1 / mass, m / mass
                )
                for q in range(count):
                    N = N1 if q == 0 else (N2 if q == 1 else N3)
                    n = k * N
                    out = x[r, j] + b[r, j] * (G + n) * drive / (d0 + n * s0)
                    square = max(square, out.real * out.real + out.imag * out.imag)
                    largest = max(largest, N)
                    c1, c2, c3, c4 = characteristic(d2, d1, e0, s1, t0, n / mass)
                    if stability_class(c1, c2, c3, c4) != ODD:
                        growth = max(growth, growth_rate(c1, c2, c3, c4))
            peaks[i, r] = math.sqrt(square)
        found[i, 0], found[i, 1] = math.sqrt(largest), growth
