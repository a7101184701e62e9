"""Compiled screening of designs: every one-harmonic response of any structure with one absorber, in closed form.

The absorber (mass m, spring k1 z + k3 z^3 + k5 z^5, damper c) on a structure with the receptances of `host`::

    (d0 + n s0) Z = m Omega^2 u_F,    n = 3/4 k3 |Z|^2 + 5/8 k5 |Z|^4,   G = k1 + i Omega c,
    s0 = 1 - m Omega^2 a,             d0 = G s0 - m Omega^2

is without k5 a cubic in |Z|^2 (`polynomials.universal_roots`): all branches at once, however many modes the structure
has. Its scaled load h is in proportion to the squared force. Two further roots exist for loads between the extremes of
m^3 + 2 c m^2 + m, so that the force at which the upper pair appears is known at every frequency. A detached curve is
born where that force is least over the frequency, and lives until the force reaches an end of the range.

With k5 above 0 the squared load L(N) = |d0 + n s0|^2 N is of the fifth degree in N = |Z|^2. By Descartes' rule its
slope has two positive zeros at most, so that there are three roots at most here, too: one below the largest load on the
way, one between, one above the least load (`extremes`).
"""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.polynomials import growth_rate, universal_roots
from frahm.slow_flow.kernels import AVERAGED, ODD, characteristic, linear_parts, stability_class

_DEEPEST = 0.9  # of what is seen: a parabola that falls lower joins what does not belong together
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
def _load(N, k, q, D, R, S):
    """|d0 + n s0|^2 N with n = k N + q N^2, D = |d0|^2, R = Re(d0 conj s0), S = |s0|^2."""
    n = (k + q * N) * N
    return (D + n * (2.0 * R + n * S)) * N


@kernel
def load_slope(N, k, q, D, R, S):
    """Derivative of `_load` by N."""
    return D + N * (4.0 * k * R + N * (3.0 * k * k * S + 6.0 * q * R + N * (8.0 * k * q * S + N * 5.0 * q * q * S)))


@kernel
def _bend(N, k, q, R, S):
    """Derivative of `slope` by N; its one positive zero is where the slope is least, if R < 0."""
    return 4.0 * k * R + N * (6.0 * k * k * S + 12.0 * q * R + N * (24.0 * k * q * S + N * 20.0 * q * q * S))


@kernel
def _zero(kind, lo, hi, k, q, D, R, S, goal):
    """N between `lo` and `hi`, where _load - goal (0), slope (1) or _bend (2) changes its sign."""
    rising = kind != 1 or load_slope(hi, k, q, D, R, S) > 0.0
    for _ in range(60):
        N = 0.5 * (lo + hi)
        if kind == 0:
            value = _load(N, k, q, D, R, S) - goal
        elif kind == 1:
            value = load_slope(N, k, q, D, R, S)
        else:
            value = _bend(N, k, q, R, S)
        if (value > 0.0) == rising:
            hi = N
        else:
            lo = N
        if hi - lo < 1e-12 * hi:
            break
    return 0.5 * (lo + hi)


@kernel
def beyond(k, q, D, R, S, load):
    """N beyond all roots, and beyond what makes slope and bend negative."""
    N = load / max(D, 1e-300)
    while _load(N, k, q, D, R, S) <= load or load_slope(N, k, q, D, R, S) <= 0.0 or _bend(N, k, q, R, S) <= 0.0:
        N *= 2.0
    return N


@kernel
def extremes(k, q, D, R, S, most):
    """Whether the load has a largest and a least value on its way, and the N of both."""
    if R >= 0.0:
        return False, 0.0, 0.0
    least = _zero(2, 0.0, most, k, q, D, R, S, 0.0)
    if load_slope(least, k, q, D, R, S) >= 0.0:
        return False, 0.0, 0.0
    return True, _zero(1, 0.0, least, k, q, D, R, S, 0.0), _zero(1, least, most, k, q, D, R, S, 0.0)


@kernel
def _norms(d0, s0, drive):
    D = d0.real * d0.real + d0.imag * d0.imag
    R = d0.real * s0.real + d0.imag * s0.imag
    S = s0.real * s0.real + s0.imag * s0.imag
    return D, R, S, drive.real * drive.real + drive.imag * drive.imag


@kernel
def _squares_of_quintic(k, q, d0, s0, drive):
    """All |Z|^2 with a part of the fifth power: their number, then three values, ascending."""
    D, R, S, load = _norms(d0, s0, drive)
    if load == 0.0:
        return 1, 0.0, math.nan, math.nan
    most = beyond(k, q, D, R, S, load)
    there, low, high = extremes(k, q, D, R, S, most)
    if not there:
        return 1, _zero(0, 0.0, most, k, q, D, R, S, load), math.nan, math.nan
    largest, least = _load(low, k, q, D, R, S), _load(high, k, q, D, R, S)
    if load >= largest:
        return 1, _zero(0, high, most, k, q, D, R, S, load), math.nan, math.nan
    first = _zero(0, 0.0, low, k, q, D, R, S, load)
    if load <= least:
        return 1, first, math.nan, math.nan
    # on the way down the load falls: its mirror image rises
    lo, hi = low, high
    for _ in range(60):
        N = 0.5 * (lo + hi)
        if _load(N, k, q, D, R, S) > load:
            lo = N
        else:
            hi = N
    return 3, first, 0.5 * (lo + hi), _zero(0, high, most, k, q, D, R, S, load)


@kernel
def squares(k, q, d0, s0, drive):
    """All |Z|^2: their number, then three values; k = 3/4 k3, q = 5/8 k5."""
    if q > 0.0:
        return _squares_of_quintic(k, q, d0, s0, drive)
    if k == 0.0:
        D = d0.real * d0.real + d0.imag * d0.imag
        return 1, (drive.real * drive.real + drive.imag * drive.imag) / D, math.nan, math.nan
    c, h, scale = _universal(k, d0, s0, drive)
    count, m1, m2, m3 = universal_roots(c, h)
    return count, m1 * scale, m2 * scale, m3 * scale


@kernel
def _onset_of(k, q, d0, s0, drive):
    """Factor on the force [-] at which the upper pair of roots appears; infinite where it never does."""
    if q == 0.0:
        c, h, _ = _universal(k, d0, s0, drive)
        return _onset(c, h)
    D, R, S, load = _norms(d0, s0, drive)
    if load == 0.0:
        return math.inf
    there, _, high = extremes(k, q, D, R, S, beyond(k, q, D, R, S, load))
    return math.sqrt(max(_load(high, k, q, D, R, S), 0.0) / load) if there else math.inf


@kernel
def _output(N, k, q, G, d0, s0, drive, b, x):
    """n and the squared |x| of the response with |Z|^2 = N."""
    n = (k + q * N) * N
    out = x + b * (G + n) * drive / (d0 + n * s0)
    return n, out.real * out.real + out.imag * out.imag


@kernel
def birth(onset, highest):
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
                birth = min(birth, max(least, _DEEPEST * onset[j]))
        start = end + 1
    return birth


@kernel
def births(frequency, a, u, absorber, designs, found):
    """Fill `found` (D,): least factor on the force at which a detached curve is born, over all rows of conditions."""
    R, W = frequency.shape
    onset, highest = np.empty(W), np.empty(W)
    for i in range(designs.shape[0]):
        m, k1, k3, damper, k5 = designs[i]
        found[i] = math.inf
        if k3 == 0.0 and k5 == 0.0:
            continue
        for r in range(R):
            spring, damping = absorber[r]
            k, q = 0.75 * spring * k3, 0.625 * spring * k5
            for j in range(W):
                _, d0, s0, drive = _balance(frequency[r, j], a[r, j], u[r, j], m, spring * k1, damping * damper)
                onset[j] = _onset_of(k, q, d0, s0, drive)
            found[i] = min(found[i], birth(onset, highest))


@kernel
def largest_responses(frequency, a, u, b, x, absorber, designs, limit, worst):
    """Fill `worst` (D,) [m]: largest |x| over all roots and conditions of `designs` (D, 5): m, k1, k3, c, k5, SI units.

    A design whose |x| exceeds `limit` [m] is left with what was seen of it so far.
    """
    R, W = frequency.shape
    bound = limit * limit
    for i in range(designs.shape[0]):
        m, k1, k3, damper, k5 = designs[i]
        square = 0.0
        for r in range(R):
            spring, damping = absorber[r]
            k, q = 0.75 * spring * k3, 0.625 * spring * k5
            for j in range(W):
                G, d0, s0, drive = _balance(frequency[r, j], a[r, j], u[r, j], m, spring * k1, damping * damper)
                count, N1, N2, N3 = squares(k, q, d0, s0, drive)
                for root in range(count):
                    N = N1 if root == 0 else (N2 if root == 1 else N3)
                    _, size = _output(N, k, q, G, d0, s0, drive, b[r, j], x[r, j])
                    square = max(square, size)
            if square > bound:
                break
        worst[i] = math.sqrt(square)


@kernel
def amplitude_tables(frequency, a, u, b, x, absorber, designs, found):
    """Fill `found` (D, R, W): largest |x| over all roots at every condition, in the unit of the output."""
    R, W = frequency.shape
    for i in range(designs.shape[0]):
        m, k1, k3, damper, k5 = designs[i]
        for r in range(R):
            spring, damping = absorber[r]
            k, q = 0.75 * spring * k3, 0.625 * spring * k5
            for j in range(W):
                G, d0, s0, drive = _balance(frequency[r, j], a[r, j], u[r, j], m, spring * k1, damping * damper)
                count, N1, N2, N3 = squares(k, q, d0, s0, drive)
                square = 0.0
                for root in range(count):
                    N = N1 if root == 0 else (N2 if root == 1 else N3)
                    _, size = _output(N, k, q, G, d0, s0, drive, b[r, j], x[r, j])
                    square = max(square, size)
                found[i, r, j] = math.sqrt(square)


@kernel
def screened(frequency, a, u, b, x, absorber, mode, designs, found, peaks):
    """Fill `peaks` (D, R) and `found` (D, 2) for `designs` (D, 5): m [kg], k1 [N/m], k3 [N/m^3], c [N s/m], k5 [N/m^5].

    `peaks` is the largest |x| [m] over all roots and frequencies in every row of conditions; the columns of `found` are
    the largest |Z| [m] and the largest growth rate [1/s] of the governing mode's slow flow, saddles left out. `mode`
    (R, 3) holds frequency, damping over mass and mass of the governing mode in every row.
    """
    R, W = frequency.shape
    for i in range(designs.shape[0]):
        m, k1, k3, damper, k5 = designs[i]
        largest, growth = 0.0, -math.inf
        for r in range(R):
            omega, xi1, mass = mode[r]
            spring, damping = absorber[r]
            k, q = 0.75 * spring * k3, 0.625 * spring * k5
            square = 0.0
            for j in range(W):
                G, d0, s0, drive = _balance(frequency[r, j], a[r, j], u[r, j], m, spring * k1, damping * damper)
                count, N1, N2, N3 = squares(k, q, d0, s0, drive)
                d2, d1, e0, s1, t0, _, _ = linear_parts(
                    AVERAGED, frequency[r, j], omega, xi1, damping * damper / mass, spring * k1 / mass, m / mass
                )
                for root in range(count):
                    N = N1 if root == 0 else (N2 if root == 1 else N3)
                    n, size = _output(N, k, q, G, d0, s0, drive, b[r, j], x[r, j])
                    square = max(square, size)
                    largest = max(largest, N)
                    # the slow flow feels N dn/dN where a cubic spring has n: the rest is as good as linear
                    steep = (k + 2.0 * q * N) * N
                    rest = (n - steep) / mass
                    c1, c2, c3, c4 = characteristic(d2, d1 + rest * s1, e0 + rest * t0, s1, t0, steep / mass)
                    if stability_class(c1, c2, c3, c4) != ODD:
                        growth = max(growth, growth_rate(c1, c2, c3, c4))
            peaks[i, r] = math.sqrt(square)
        found[i, 0], found[i, 1] = math.sqrt(largest), growth
