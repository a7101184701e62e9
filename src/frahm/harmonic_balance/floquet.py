"""Floquet multipliers from the variational equation about a periodic orbit, integrated by Taylor series.

M dx'' + (C + sum_e n_e q_e(t) n_e^T) dx' + (K + sum_e n_e p_e(t) n_e^T) dx = 0 with p_e and q_e the slopes of the
element's force by displacement and velocity along the orbit. On each step they are polynomials through Chebyshev points
and the solution a power series; where laws are no polynomials the steps are as short as the slopes ask for. For an odd
orbit half a period suffices: with the symmetry (x, t) -> (-x, t + T/2) the half map -Phi(T/2) has the multipliers'
square roots; +1 is a saddle-node, -1 a loss of symmetry, a complex pair a Neimark-Sacker point.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.absorbers.packed import law_force_and_slopes, polynomial_and_slopes
from frahm.compiled import kernel, separate_kernel
from frahm.harmonic_balance.hill import refine_exponents
from frahm.polynomials import quadratic_factors
from frahm.tolerances import TINY

_NODES = 9
_ORDER = 14
_LANES = 4
_ADVANCE = 1.2  # fastest motion per step [rad]
_TURN = 2.0  # highest harmonic per step [rad]
_RESOLVED = 1e-9  # last Chebyshev coefficients of a slope, relative to its largest value, times the share of the step
_MOST_STEPS = 50_000  # of a period: what is slower is not followed
_SHORTEST = 1e-4  # step, as a share of the first one
_POINTS = 0.5 - 0.5 * np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
_TO_POWERS = np.linalg.inv(_POINTS[:, None] ** np.arange(_NODES))
_TO_CHEBYSHEV = np.linalg.inv(np.polynomial.chebyshev.chebvander(2 * _POINTS - 1, _NODES - 1))


@separate_kernel
def monodromy(pb, va, H, odd, W, u, Phi):
    """Fundamental matrix Phi (2n, 2n) over half a period (odd orbits) or a whole one; states (x, v).

    u (H + 5, r) are the harmonics of the relative coordinates. False, and NaN, if that takes more than `_MOST_STEPS`.
    """
    n, E = va.K.shape[0], va.feel.shape[0]
    m = 2 * n
    span = (math.pi if odd else 2.0 * math.pi) / W
    slope = np.empty(E)
    _steepest(pb, H, odd, u, slope)
    square = va.fastest**2
    for e in range(E):
        square += va.hardest[e] * slope[e]
    turn = W * _reach(H, u) * max(1.0, 0.5 * (pb.degree - 1))  # the slope of a power p has harmonics up to (p - 1) H
    steps = math.ceil(max(span * math.sqrt(square) / _ADVANCE, span * turn / _TURN, 3.0))
    if not steps <= _MOST_STEPS:
        Phi[:] = math.nan
        return False
    h = span / steps
    adaptive = pb.degree == 0
    Phi[:] = 0.0
    for i in range(m):
        Phi[i, i] = 1.0
    X, V, Z = np.zeros((_ORDER + 1, n, _LANES)), np.zeros((_ORDER + 1, n, _LANES)), np.zeros((_ORDER + 1, E, _LANES))
    slopes, values, p = np.zeros((E, E)), np.empty((E, E, _NODES)), np.empty((E, E, _NODES))
    rates, rate, q = np.zeros((E, _NODES)), np.zeros(E), np.zeros((E, _NODES))
    Y = np.zeros((_ORDER if pb.rates else 0, E, _LANES))
    soft = np.any(va.flexibility != 0.0)
    base, done, length = h, 0.0, 1.0  # in steps of the length `base`
    while done < steps:
        length = min(length, steps - done)
        h = base * length
        for j in range(_NODES):
            tau = W * base * (done + length * _POINTS[j])
            for e in range(E):
                z = element_displacement(pb, e, H, odd, u, tau)
                code = pb.codes[e]
                if adaptive:
                    w = element_velocity(pb, e, H, odd, W, u, tau) if pb.rates else 0.0
                    _, slopes[e, e], rates[e, j] = law_force_and_slopes(code[0], code[1], code[2], pb.table, z, w)
                else:
                    _, slopes[e, e], _ = polynomial_and_slopes(code[1], code[2], pb.table, z, 0.0)
            felt = _behind(slopes, va.flexibility) if soft else slopes
            for e in range(E):
                for f in range(0 if soft else e, E if soft else e + 1):
                    values[e, f, j] = felt[e, f]
        if adaptive:
            tail = _unresolved(va, values, rates, slope, rate, h)
            if tail * length > _RESOLVED and length > _SHORTEST:
                length *= 0.5
                continue
        if pb.rates:
            for e in range(E):
                for i in range(_NODES):
                    q[e, i] = np.sum(_TO_POWERS[i] * rates[e])
        for e in range(E):
            for f in range(0 if soft else e, E if soft else e + 1):
                for i in range(_NODES):
                    total = 0.0
                    for j in range(_NODES):
                        total += _TO_POWERS[i, j] * values[e, f, j]
                    p[e, f, i] = total
        for start in range(0, m, _LANES):  # a few columns at a time, so that they fill a vector register
            width = min(_LANES, m - start)
            for i in range(n):
                for c in range(width):
                    X[0, i, c], V[0, i, c] = Phi[i, start + c], Phi[n + i, start + c]
            _taylor_step(va, soft, p, q, h, X, V, Z, Y)
            for i in range(n):
                for c in range(width):
                    x, v = X[_ORDER, i, c], V[_ORDER, i, c]
                    for k in range(_ORDER - 1, -1, -1):
                        x += X[k, i, c]
                        v += V[k, i, c]
                    Phi[i, start + c], Phi[n + i, start + c] = x, v
        done += length
        if adaptive and tail * length < 1e-2 * _RESOLVED:
            length = min(2.0 * length, 1.0)
    return True


@kernel
def _unresolved(va, values, rates, steepest, fastest, h):
    """Last Chebyshev coefficients of slopes and rates on a step, relative to their largest values so far.

    Infinite if the step [s] is too long for the power series of the motion.
    """
    worst, square, rate = 0.0, va.fastest * va.fastest, 0.0
    for e in range(steepest.size):
        for j in range(_NODES):
            steepest[e] = max(steepest[e], abs(values[e, e, j]))
            fastest[e] = max(fastest[e], abs(rates[e, j]))
    for e in range(steepest.size):
        square += va.hardest[e] * np.max(np.abs(values[e, e]))
        rate += va.hardest[e] * np.max(np.abs(rates[e]))
        for i in range(_NODES - 2, _NODES):
            worst = max(worst, abs(np.sum(_TO_CHEBYSHEV[i] * values[e, e])) / max(steepest[e], TINY))
            worst = max(worst, abs(np.sum(_TO_CHEBYSHEV[i] * rates[e])) / max(fastest[e], TINY))
    return math.inf if h * math.sqrt(square) > _ADVANCE or h * rate > _ADVANCE else worst


@kernel
def _behind(slopes, flexibility):
    """Slopes felt through a static flexibility in series with the elements."""
    E = slopes.shape[0]
    if E == 1:
        return slopes / (1.0 + flexibility[0, 0] * slopes[0, 0])
    return slopes @ np.linalg.inv(np.eye(E) + flexibility @ slopes)


@kernel
def element_displacement(pb, e, H, odd, u, tau):
    """z_e at the phase tau [rad] from the harmonics u (H + 5, r)."""
    first, step = (1, 2) if odd else (0, 1)
    c1, s1 = math.cos(tau), math.sin(tau)
    c, s = (c1, s1) if odd else (1.0, 0.0)
    if odd:
        c1, s1 = c1 * c1 - s1 * s1, 2.0 * c1 * s1
    z = 0.0
    for k in range(first, H + 1, step):
        for i in range(u.shape[1]):
            z += pb.directions[i, e] * (u[k, i].real * c - u[k, i].imag * s)
        c, s = c * c1 - s * s1, s * c1 + c * s1
    return z


@kernel
def element_velocity(pb, e, H, odd, W, u, tau):
    """w_e at the phase tau [rad] from the harmonics u (H + 5, r)."""
    first, step = (1, 2) if odd else (0, 1)
    w = 0.0
    for k in range(first, H + 1, step):
        c, s = k * W * math.cos(k * tau), k * W * math.sin(k * tau)
        for i in range(u.shape[1]):
            w -= pb.directions[i, e] * (u[k, i].real * s + u[k, i].imag * c)
    return w


@kernel
def _reach(H, u):
    """Highest harmonic that matters for the course of the slope within a step."""
    largest = 0.0
    for k in range(H + 1):
        for i in range(u.shape[1]):
            largest = max(largest, abs(u[k, i]))
    reach = 1
    for k in range(H + 1):
        for i in range(u.shape[1]):
            if abs(u[k, i]) > 1e-4 * largest:
                reach = k
    return reach


@kernel
def _steepest(pb, H, odd, u, slope):
    """Largest slope of every element along the orbit, seen at the samples of harmonic balance."""
    for e in range(slope.size):
        slope[e] = 0.0
        for j in range(2 * H + 6):
            z = element_displacement(pb, e, H, odd, u, math.pi * (1.0 if odd else 2.0) * j / (2 * H + 6))
            _, here, _ = law_force_and_slopes(pb.codes[e, 0], pb.codes[e, 1], pb.codes[e, 2], pb.table, z, 0.0)
            slope[e] = max(slope[e], abs(here))


@kernel
def _taylor_step(va, soft, p, q, h, X, V, Z, Y):
    """Power series of some columns over one step, in the time scaled to the step: term k is the k-th summand.

    Elements feel each other's slopes only where they hang on something `soft`.
    """
    n, E = va.K.shape[0], va.feel.shape[0]
    rates = Y.shape[0] > 0
    for k in range(_ORDER):
        factor = h / (k + 1.0)
        if rates:
            for e in range(E):
                Y[k, e, :] = 0.0
                for j in range(n):
                    for c in range(_LANES):
                        Y[k, e, c] += va.feel[e, j] * V[k, j, c]
        for e in range(E):
            for c in range(_LANES):
                Z[k, e, c] = 0.0
            for j in range(n):
                feel = va.feel[e, j]
                if feel != 0.0:
                    for c in range(_LANES):
                        Z[k, e, c] += feel * X[k, j, c]
        for i in range(n):
            for c in range(_LANES):
                X[k + 1, i, c] = factor * V[k, i, c]
                V[k + 1, i, c] = 0.0
            for j in range(n):
                stiff, damp = va.K[i, j] * factor, va.C[i, j] * factor
                if stiff != 0.0 or damp != 0.0:
                    for c in range(_LANES):
                        V[k + 1, i, c] -= stiff * X[k, j, c] + damp * V[k, j, c]
        for e in range(E):  # the element's force once, then pushed on every coordinate
            for c in range(_LANES):
                Z[_ORDER, e, c] = 0.0
            for f in range(0 if soft else e, E if soft else e + 1):
                for m in range(min(k, _NODES - 1) + 1):
                    weight = p[e, f, m] * factor
                    for c in range(_LANES):
                        Z[_ORDER, e, c] += weight * Z[k - m, f, c]
            if rates:
                for m in range(min(k, _NODES - 1) + 1):
                    weight = q[e, m] * factor
                    for c in range(_LANES):
                        Z[_ORDER, e, c] += weight * Y[k - m, e, c]
            for i in range(n):
                push = va.push[i, e]
                if push != 0.0:
                    for c in range(_LANES):
                        V[k + 1, i, c] -= push * Z[_ORDER, e, c]


@separate_kernel
def shifted_eigenvalues(B, out):
    """Eigenvalues of the real matrix B into out: closed form for 4 x 4, LAPACK otherwise."""
    if B.shape[0] != 4:
        out[:] = np.linalg.eigvals(B.astype(np.complex128))
        for i in range(out.size):
            if abs(out[i].imag) < 1e-10 * (1.0 + abs(out[i].real)):  # the complex solver's rounding
                out[i] = complex(out[i].real, 0.0)
        return
    # Faddeev-LeVerrier
    A = B.copy()
    c1 = -(A[0, 0] + A[1, 1] + A[2, 2] + A[3, 3])
    for i in range(4):
        A[i, i] += c1
    A = B @ A
    c2 = -(A[0, 0] + A[1, 1] + A[2, 2] + A[3, 3]) / 2.0
    for i in range(4):
        A[i, i] += c2
    A = B @ A
    c3 = -(A[0, 0] + A[1, 1] + A[2, 2] + A[3, 3]) / 3.0
    for i in range(4):
        A[i, i] += c3
    A = B @ A
    c4 = -(A[0, 0] + A[1, 1] + A[2, 2] + A[3, 3]) / 4.0
    a, b, g, d = quadratic_factors(c1, c2, c3, c4)
    _pair(a, b, out, 0)
    _pair(g, d, out, 2)


@kernel
def _pair(a, b, out, at):
    disc = 0.25 * a * a - b
    if disc < 0.0:
        root = math.sqrt(-disc)
        out[at], out[at + 1] = complex(-0.5 * a, root), complex(-0.5 * a, -root)
    else:
        big = -0.5 * a - math.copysign(math.sqrt(disc), a)
        out[at] = complex(big, 0.0)
        out[at + 1] = complex(b / big if big != 0.0 else 0.0, 0.0)


@separate_kernel
def map_multipliers(pb, va, H, odd, W, u, out):
    """Eigenvalues of the half map -Phi(T/2) (odd orbits) or of Phi(T), sorted by descending modulus.

    All are infinite where a disturbance grows beyond what numbers hold: "unstable" is all that is known there. All are
    NaN where a period takes too many steps.
    """
    m = 2 * va.K.shape[0]
    Phi = np.empty((m, m))
    if not monodromy(pb, va, H, odd, W, u, Phi):
        out[:] = complex(math.nan, 0.0)
        return
    if not np.all(np.isfinite(Phi)):
        out[:] = complex(math.inf, 0.0)
        return
    trace = 0.0
    for i in range(m):
        trace += Phi[i, i]
        for j in range(m):
            if odd:
                Phi[i, j] = -Phi[i, j]
    shift = math.copysign(1.0, -trace if odd else trace)  # where multipliers gather, far above all natural frequencies
    for i in range(m):
        Phi[i, i] -= shift
    shifted_eigenvalues(Phi, out)
    if not np.all(np.isfinite(out)):
        out[:] = complex(math.inf, 0.0)
        return
    for i in range(m):
        out[i] += shift
    _sort_by_modulus(out)
    if np.any(va.flexibility != 0.0):
        refine_exponents(pb, H, odd, W, u, out, 2)
        _sort_by_modulus(out)


@kernel
def _sort_by_modulus(out):
    for i in range(1, out.size):
        value = out[i]
        j = i - 1
        while j >= 0 and abs(out[j]) < abs(value):
            out[j + 1] = out[j]
            j -= 1
        out[j + 1] = value
