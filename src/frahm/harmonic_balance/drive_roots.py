"""The roots of a shared drive, compiled: see `shared_drive`, whose notation this is."""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.continuation.dense import factorise
from frahm.polynomials import cubic_roots

_SAME = 1e-9
_SOLVED = 1e-6  # of the drive: what a change of sign that is a root leaves
_INSIDE = 0.01  # of a step: how far inside an interval the slopes at its ends are taken
_NEAR = 0.3  # |lambda - 1| up to which its turns are told
_SOLUTIONS = 32  # for every combination of roots: room for solutions and turns


@kernel
def roots_of_drive(S, F, b, k, points):
    """All solutions of S U + k |U|^2 U = F with S = diag(p) + F b^T off the diagonal, on grids of so many points.

    Returns U (s, r) of the solutions; U (t, r) of the turns, ln lambda^2 and sign (t, 2) there; the sum of the signs of
    det J; whether there was room for all.
    """
    r = k.size
    p = np.empty(r, np.complex128)
    for i in range(r):
        p[i] = S[i, i] - F[i] * b[i]
    room = _SOLUTIONS * 3**r
    found, turning = np.empty((room, r), np.complex128), np.empty((room, r), np.complex128)
    sizes = np.empty((room, 2))
    number = np.zeros(2, np.int64)
    edges = _edges(p, F, b, k)
    y, U, slope = np.empty(points), np.empty((r, 3, points), np.complex128), np.empty((r, 3, points), np.complex128)
    counts, which = np.empty(r, np.int64), np.zeros(r, np.int64)
    value, rate = np.empty(points), np.empty(points)
    fits = True
    for m in range(edges.size - 1):
        lo, hi = edges[m], edges[m + 1]
        if hi - lo <= _SAME * hi:  # of equal elements: what lies between is rounding
            continue
        for i in range(r):
            counts[i] = cubic_roots(p[i], F[i] * 0.5 * (lo + hi), k[i])[0]
            which[i] = 0
        _tabulate(p, F, k, lo, hi, counts, y, U, slope)
        more = True
        while more:
            _combine(b, which, y, U, slope, value, rate)
            fits = _search(p, F, b, k, lo, hi, counts, which, value, rate, found, turning, sizes, number) and fits
            more = _next(counts, which)
    kept, degree = _distinct(S, k, found, number[0])
    return found[:kept].copy(), turning[: number[1]].copy(), sizes[: number[1]].copy(), degree, fits


@kernel
def _next(counts, which):
    """Go on to the next combination of roots; returns whether there is one."""
    for i in range(counts.size):
        which[i] += 1
        if which[i] < counts[i]:
            return True
        which[i] = 0
    return False


@kernel
def _edges(p, F, b, k):
    """0, the turning values of y ascending, and a value above which no combination is a solution."""
    r = k.size
    edges = np.zeros(2 * r + 2)
    number = 1
    for i in range(r):
        c = math.copysign(1.0, k[i]) * p[i].real / abs(p[i])
        if c > -math.sqrt(0.75):
            continue
        spread = math.sqrt(4.0 * c * c - 3.0)
        for side in (-1.0, 1.0):  # where a pair of roots of p U + k |U|^2 U = F y appears or vanishes
            N = (-2.0 * c + side * spread) / 3.0 * abs(p[i]) / abs(k[i])
            edges[number] = abs(p[i] + k[i] * N) * math.sqrt(N) / abs(F[i])
            number += 1
    edges[:number].sort()
    edges[number] = _largest_drive(p, F, b, k, edges[number - 1])
    return edges[: number + 1]


@kernel
def _largest_drive(p, F, b, k, beyond):
    """A value of y above which no combination is a solution: all U together stay below y - 1."""
    y = max(2.0, 2.0 * beyond)
    while True:
        growing, together = True, 0.0
        for i in range(k.size):
            count, small, middle, large = cubic_roots(p[i], F[i] * y, k[i])
            N = small if count == 1 else (middle if count == 2 else large)
            growing = growing and abs(p[i] + k[i] * N) >= abs(p[i])
            together += abs(b[i]) * math.sqrt(N)
        if growing and y - together > 1.0:
            return y
        y *= 2.0


@kernel
def _place(lo, hi, s):
    """y at the share s of an interval: dense at both ends, as the square roots there want it."""
    return lo + 0.5 * (hi - lo) * (1.0 - math.cos(math.pi * s))


@kernel
def _roots_at(p, F, k, lo, hi, y, wanted):
    """Drive F y, all but at y, and |U|^2 of the `wanted` number of roots of p U + k |U|^2 U = F y."""
    at, share = y, 1e-15
    count, small, middle, large = cubic_roots(p, F * at, k)
    while count != wanted and share < 1.0:  # at a turning value rounding takes a pair away, or makes one
        at, share = y + share * (0.5 * (lo + hi) - y), 10.0 * share
        count, small, middle, large = cubic_roots(p, F * at, k)
    return F * at, small, middle, large


@kernel
def _tabulate(p, F, k, lo, hi, counts, y, U, slope):
    """Fill y (points,), and of every root U_i e^{-i theta} and its derivative by y, at places over an interval.

    At its ends the derivative, which may have no bound there, is that shortly inside.
    """
    last = y.size - 1
    for j in range(y.size):
        y[j] = _place(lo, hi, j / last)
        inside = _place(lo, hi, min(max(j / last, _INSIDE / last), 1.0 - _INSIDE / last))
        for i in range(k.size):
            drive, small, middle, large = _roots_at(p[i], F[i], k[i], lo, hi, y[j], counts[i])
            for c in range(counts[i]):
                U[i, c, j] = drive / (p[i] + k[i] * (small if c == 0 else (middle if c == 1 else large)))
            if inside != y[j]:
                drive, small, middle, large = _roots_at(p[i], F[i], k[i], lo, hi, inside, counts[i])
            for c in range(counts[i]):
                N = small if c == 0 else (middle if c == 1 else large)
                a, e = p[i] + 2.0 * k[i] * N, k[i] * (drive / (p[i] + k[i] * N)) ** 2
                below = (a * a.conjugate() - e * e.conjugate()).real
                top = a.conjugate() * F[i] - e * F[i].conjugate()
                slope[i, c, j] = top / below if below != 0.0 else 0j


@kernel
def _combine(b, which, y, U, slope, value, rate):
    """Fill value (points,) with lambda - 1 of a combination of roots, and rate with the sign of its slope by y."""
    for j in range(y.size):
        total, change = complex(y[j], 0.0), complex(1.0, 0.0)
        for i in range(which.size):
            total += b[i] * U[i, which[i], j]
            change += b[i] * slope[i, which[i], j]
        value[j] = abs(total) - 1.0
        rate[j] = total.real * change.real + total.imag * change.imag


@kernel
def _motion(p, F, b, k, lo, hi, counts, which, s, U):
    """Fill U (r,) with the motion of a combination at the share s, turned to the phase of the force; return lambda."""
    y = _place(lo, hi, s)
    total = complex(y, 0.0)
    for i in range(k.size):
        drive, small, middle, large = _roots_at(p[i], F[i], k[i], lo, hi, y, counts[i])
        N = small if which[i] == 0 else (middle if which[i] == 1 else large)
        U[i] = drive / (p[i] + k[i] * N)
        total += b[i] * U[i]
    size = abs(total)
    for i in range(k.size):
        U[i] *= size / total
    return size


@kernel
def _search(p, F, b, k, lo, hi, counts, which, value, rate, found, turning, sizes, number):
    """Add solutions and turns of one combination, number of both; returns whether there was room."""
    last = value.size - 1
    room = found.shape[0]
    for j in range(last):
        left, right = j / last, (j + 1) / last
        single = value[j] * value[j + 1] <= 0.0 and value[j] != 0.0
        near = min(abs(value[j]), abs(value[j + 1])) <= _NEAR
        if rate[j] * rate[j + 1] >= 0.0 or not (near or single):
            if single:
                if number[0] >= room:
                    return False
                number[0] += _put_crossing(
                    p, F, b, k, lo, hi, counts, which, left, right, value[j], value[j + 1], found[number[0]]
                )
            continue
        if number[1] >= room or number[0] + 1 >= room:
            return False
        sign = 1.0 if rate[j] < 0.0 else -1.0
        U = turning[number[1]]
        s = _summit(p, F, b, k, lo, hi, counts, which, left, right, sign, U)
        there = _motion(p, F, b, k, lo, hi, counts, which, s, U) - 1.0
        sizes[number[1], 0], sizes[number[1], 1] = 2.0 * math.log1p(there), sign
        number[1] += 1 if abs(there) <= _NEAR else 0
        for a, e, first, second in ((left, s, value[j], there), (s, right, there, value[j + 1])):
            if first * second <= 0.0 and first != 0.0:
                number[0] += _put_crossing(p, F, b, k, lo, hi, counts, which, a, e, first, second, found[number[0]])
    return True


@kernel
def _put_crossing(p, F, b, k, lo, hi, counts, which, left, right, below, above, U):
    """Fill U with the root between two places, by the Illinois method; returns 1 if it is one, or 0."""
    s, miss = right, above
    for _ in range(80):
        if miss == 0.0 or right == left:
            break
        s = (left * above - right * below) / (above - below)
        if not min(left, right) < s < max(left, right):
            s = 0.5 * (left + right)
        before = miss
        miss = _motion(p, F, b, k, lo, hi, counts, which, s, U) - 1.0
        if abs(miss) < 1e-15 or (abs(right - left) < 1e-15 and abs(miss) >= abs(before)):
            break
        if miss * above < 0.0:
            left, below = right, above
        else:
            below *= 0.5
        right, above = s, miss
    return 1 if abs(_motion(p, F, b, k, lo, hi, counts, which, s, U) - 1.0) < _SOLVED else 0


@kernel
def _summit(p, F, b, k, lo, hi, counts, which, left, right, sign, U):
    """Place between two others where sign times lambda is smallest, by golden sections."""
    share = 0.5 * (math.sqrt(5.0) - 1.0)
    a, c = right - share * (right - left), left + share * (right - left)
    at_a = sign * _motion(p, F, b, k, lo, hi, counts, which, a, U)
    at_c = sign * _motion(p, F, b, k, lo, hi, counts, which, c, U)
    for _ in range(40):
        if at_a < at_c:
            right, c, at_c = c, a, at_a
            a = right - share * (right - left)
            at_a = sign * _motion(p, F, b, k, lo, hi, counts, which, a, U)
        else:
            left, a, at_a = a, c, at_c
            c = left + share * (right - left)
            at_c = sign * _motion(p, F, b, k, lo, hi, counts, which, c, U)
    return 0.5 * (left + right)


@kernel
def _distinct(S, k, found, number):
    """Move the different ones of the solutions to the front; returns how many, and the sum of the signs of det J."""
    r = k.size
    kept = degree = 0
    J, pivots = np.empty((2 * r, 2 * r)), np.empty(2 * r, np.int64)
    for m in range(number):
        largest = 0.0
        for i in range(r):
            largest = max(largest, abs(found[m, i]))
        new = True
        for other in range(kept):
            away = 0.0
            for i in range(r):
                away = max(away, abs(found[m, i] - found[other, i]))
            if away < _SAME * largest:
                new = False
                break
        if new:
            for i in range(r):
                found[kept, i] = found[m, i]
            degree += _sign(S, k, found[kept], J, pivots)
            kept += 1
    return kept, degree


@kernel
def _sign(S, k, U, J, pivots):
    """Sign of det J of S U + k |U|^2 U by the real and imaginary parts of U."""
    r = k.size
    for i in range(r):
        for j in range(r):
            J[2 * i, 2 * j], J[2 * i, 2 * j + 1] = S[i, j].real, -S[i, j].imag
            J[2 * i + 1, 2 * j], J[2 * i + 1, 2 * j + 1] = S[i, j].imag, S[i, j].real
        N, e = 2.0 * k[i] * abs(U[i]) ** 2, k[i] * U[i] ** 2
        J[2 * i, 2 * i] += N + e.real
        J[2 * i, 2 * i + 1] += e.imag
        J[2 * i + 1, 2 * i] += e.imag
        J[2 * i + 1, 2 * i + 1] += N - e.real
    if not factorise(J, pivots, 2 * r):
        return 0
    sign = 1
    for i in range(2 * r):
        if pivots[i] != i:
            sign = -sign
        if J[i, i] < 0.0:
            sign = -sign
    return sign
