"""Responses at one frequency over the force: the curve of a response as all forces are multiplied by lambda.

Responses that merge as the force changes lie on one curve, which turns where they do. So a curve followed through one
of them leads to the others, wherever higher harmonics have moved its turns.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.continuation.dense import factorise, solve_factorised
from frahm.harmonic_balance.kernels import fourier_tables, residual_and_jacobian, sample_count, stiffness, unknowns

_ANGLE, _SHARPEST = 0.35, 0.6  # turn of the tangent aimed at in a step, and beyond which it is taken again [rad]
_TOLERANCE = 1e-6  # last Newton step, in scaled unknowns
_SHORTEST = 1e-6  # of the longest step
_HALVINGS = 8  # of a step in which the symmetry is lost
_BETWEEN = 32  # places of a step looked at for lambda = 1


@kernel
def follow_over_force(pb, odd, H, W, y0, normal, lo, hi, direction, x_scale, longest, most, out, breaks):
    """Follow the response near y0 = (X / x_scale, lambda) until lambda leaves [lo, hi], or it comes back.

    The first point lies in the plane through y0 across `normal`, along which, or against which, it goes on. Fills out
    (room, n) with starts X for the responses to F that it passes, and breaks (room, n + 1) with points (X / x_scale,
    lambda) near which a symmetric response loses its symmetry; an asymmetric one is followed until it is symmetric.
    Returns how many of both, and whether it was followed to its end; what finds no room counts as not followed.
    """
    n = unknowns(pb, H, odd)
    r = pb.M11.shape[0]
    y, t, new = y0.copy(), normal.copy(), np.zeros(n + 1)
    old, old_t = np.zeros(n + 1), np.zeros(n + 1)
    R, J, A = np.empty(n + 1), np.empty((n + 1, n + 1)), np.empty((n + 1, n + 1))
    pivots = np.empty(n + 1, np.int64)
    co, si = fourier_tables(H, odd, sample_count(pb, H, odd))
    F, dF = np.empty(r, np.complex128), np.empty(r, np.complex128)
    S, dS = np.empty((r, r), np.complex128), np.empty((r, r), np.complex128)
    stiffness(pb, 1j * W, S, dS, F, dF)
    ok, _ = _correct(pb, odd, H, W, y, t, np.dot(y, t), x_scale, F, co, si, R, J, A, pivots)
    if not ok:
        return 0, 0, False
    _tangent(A, pivots, n, t, new)
    t[:] = direction * new
    start, start_t = y.copy(), t.copy()
    full, full_R, full_J, even = _even_room(n, odd)
    tables = fourier_tables(H, False, sample_count(pb, H, False))
    side = _even_side(pb, H, W, y, x_scale, tables, full, full_R, full_J, even, pivots) if odd else 0
    ds, number, broken, count = 0.1 * longest, 0, 0, 0
    while count < most:
        old[:], old_t[:] = y, t
        for j in range(n + 1):
            y[j] += ds * t[j]
        ok, moved = _correct(pb, odd, H, W, y, t, np.dot(y, t), x_scale, F, co, si, R, J, A, pivots)
        along = 0.0
        if ok and moved < 0.5 * ds:
            along = _tangent(A, pivots, n, t, new)
        angle = math.acos(min(1.0, max(-1.0, along))) if along > 0.0 else math.pi
        if angle > _SHARPEST:
            y[:] = old
            ds *= 0.4
            if ds < _SHORTEST * longest:
                return number, broken, False
            continue
        number = _put_starts(old, t, y, new, n, x_scale, out, number)
        if number < 0:
            return out.shape[0], broken, False
        count += 1
        t[:] = new
        if odd:
            before = side
            side = _even_side(pb, H, W, y, x_scale, tables, full, full_R, full_J, even, pivots)
            if side * before < 0:
                if broken >= breaks.shape[0]:
                    return number, broken, False
                inner, lower, upper = breaks[broken], 0.0, 1.0
                for _ in range(_HALVINGS):
                    share = 0.5 * (lower + upper)
                    _put_between(old, old_t, y, t, share, inner)
                    _correct(pb, odd, H, W, inner, t, np.dot(inner, t), x_scale, F, co, si, R, J, A, pivots)
                    here = _even_side(pb, H, W, inner, x_scale, tables, full, full_R, full_J, even, pivots)
                    if here * before < 0:
                        upper = share
                    else:
                        lower = share
                broken += 1
        elif _even_product(pb, old, y) < 0.0:
            return number, broken, True
        if not lo < y[n] < hi or (count > 2 and np.dot(t, start_t) > 0.0 and _passes(old, y, start)):
            return number, broken, True
        ds = min(longest, ds * min(2.0, max(0.5, _ANGLE / max(angle, 1e-3))))
    return number, broken, False


@kernel
def _even_room(n, odd):
    """Arrays for the even harmonics beside n odd unknowns."""
    m = 2 * n if odd else 0
    return np.zeros(m + 1), np.empty(m + 1), np.empty((m + 1, m + 1)), np.empty((m // 2, m // 2))


@kernel
def even_block(pb, H, W, X, tables, full, R, J, even):
    """Fill even with the Jacobian of the even harmonics by themselves at a symmetric response X."""
    width = 2 * pb.M11.shape[0]
    count = X.size // width
    for m in range(count):
        full[width * (2 * m + 1) : width * (2 * m + 2)] = X[width * m : width * (m + 1)]
    residual_and_jacobian(pb, H, False, W, full, tables[0], tables[1], R, J)
    for a in range(count):
        for b in range(count):
            for i in range(width):
                for j in range(width):
                    even[width * a + i, width * b + j] = J[2 * width * a + i, 2 * width * b + j]


@kernel
def _even_side(pb, H, W, y, x_scale, tables, full, R, J, even, pivots):
    """Sign of the determinant for the even harmonics at a symmetric response: it changes where the symmetry is lost."""
    even_block(pb, H, W, y[: y.size - 1] * x_scale, tables, full, R, J, even)
    n = even.shape[0]
    if not factorise(even, pivots, n):
        return 0
    sign = 1
    for i in range(n):
        if (pivots[i] != i) != (even[i, i] < 0.0):
            sign = -sign
    return sign


@kernel
def _even_product(pb, a, b):
    """Scalar product of the even harmonics of two points with all harmonics."""
    width = 2 * pb.M11.shape[0]
    total = 0.0
    for start in range(0, a.size - 1, 2 * width):
        for j in range(start, start + width):
            total += a[j] * b[j]
    return total


@kernel
def _correct(pb, odd, H, W, y, normal, offset, x_scale, F, co, si, R, J, A, pivots):
    """Newton's method in the plane normal . y = offset; returns (converged, size of the first step)."""
    n = y.size - 1
    X = np.empty(n)
    first = previous = math.inf
    for iteration in range(7):
        for j in range(n):
            X[j] = y[j] * x_scale
        residual_and_jacobian(pb, H, odd, W, X, co, si, R, J)
        A[:n, n] = 0.0
        for i in range(F.size):
            part, row = (1.0 - y[n]) * F[i], 2 * (i if odd else F.size + i)
            R[row] += part.real
            R[row + 1] += part.imag
            A[row, n], A[row + 1, n] = -F[i].real, -F[i].imag
        R[n] = -offset
        for j in range(n + 1):
            A[n, j] = normal[j]
            R[n] += normal[j] * y[j]
        for i in range(n):
            biggest = abs(A[i, n])
            for j in range(n):
                A[i, j] = J[i, j] * x_scale
                biggest = max(biggest, abs(A[i, j]))
            for j in range(n + 1):
                A[i, j] /= biggest
            R[i] /= biggest
        if not factorise(A, pivots, n + 1):
            return False, first
        solve_factorised(A, pivots, n + 1, R)
        size = 0.0
        for j in range(n + 1):
            size += R[j] * R[j]
            y[j] -= R[j]
        size = math.sqrt(size)
        if iteration == 0:
            first = size
        if size < _TOLERANCE:
            return True, first
        if not size < 1e3 or (iteration > 1 and size > 2.0 * previous):
            return False, first
        previous = size
    return False, first


@kernel
def _tangent(A, pivots, n, old, t):
    """Unit tangent t from the factors, along `old`; returns their cosine."""
    t[:] = 0.0
    t[n] = 1.0
    solve_factorised(A, pivots, n + 1, t)
    size, along = math.sqrt(np.dot(t, t)), np.dot(t, old)
    size = -size if along < 0.0 else size
    for j in range(n + 1):
        t[j] /= size
    return along / size


@kernel
def _put_starts(a, ta, b, tb, n, x_scale, out, number):
    """Add a start for every lambda = 1 on the cubic from a to b; returns how many there are then, or -1: no room."""
    chord = 0.0
    for j in range(n + 1):
        chord += (b[j] - a[j]) ** 2
    chord = math.sqrt(chord)
    before = a[n] - 1.0
    for step in range(1, _BETWEEN + 1):
        here = _between(a[n], chord * ta[n], b[n], chord * tb[n], step / _BETWEEN) - 1.0
        if before * here <= 0.0 and before != 0.0:
            if number >= out.shape[0]:
                return -1
            f = (step - here / (here - before)) / _BETWEEN
            for j in range(n):
                out[number, j] = x_scale * _between(a[j], chord * ta[j], b[j], chord * tb[j], f)
            number += 1
        before = here
    return number


@kernel
def _put_between(a, ta, b, tb, f, y):
    """Fill y with the point at the share f of the cubic from a to b."""
    chord = math.sqrt(np.sum((b - a) ** 2))
    for j in range(y.size):
        y[j] = _between(a[j], chord * ta[j], b[j], chord * tb[j], f)


@kernel
def _between(a, ta, b, tb, f):
    """Cubic with the values and slopes a, ta and b, tb at the ends."""
    return (
        (1.0 + 2.0 * f) * (1.0 - f) ** 2 * a
        + f * (1.0 - f) ** 2 * ta
        + f * f * (3.0 - 2.0 * f) * b
        - f * f * (1.0 - f) * tb
    )


@kernel
def _passes(a, b, start):
    """Whether the chord from a to b passes the start of the curve."""
    chord = gap = dot = 0.0
    for j in range(a.size):
        chord += (b[j] - a[j]) ** 2
        gap += (start[j] - a[j]) ** 2
        dot += (b[j] - a[j]) * (start[j] - a[j])
    return chord > 0.0 and 0.0 <= dot <= chord and gap - dot * dot / chord < 0.01 * chord
