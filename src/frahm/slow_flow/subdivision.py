"""All Hopf points of the slow flow in a window, by subdivision with exclusion and uniqueness tests.

On the response curve C(u, n) = n |d0 + n s0|^2 - Q = 0 they are zeros of the Hurwitz determinant. Both are polynomials
of degree at most 4 in n = 3/4 kappa |Z|^2 and in u (u = Omega in the paper's form, Omega^2 in the averaged one). A
polynomial lies between its smallest and its largest Bernstein coefficient, so a box whose coefficients have one sign
holds no zero; a box on which the preconditioned pair is injective holds at most one, which
a contraction then finds. Every other box is halved. Nothing is read off a grid and nothing can be missed; a box that
stays undecided at the smallest size is reported as such, and so is a search that would need more than `MOST_BOXES`.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.arrays import Floats
from frahm.compiled import kernel
from frahm.slow_flow.kernels import AVERAGED, characteristic, hurwitz, linear_parts

MOST_BOXES = 200_000
_DEGREE = 4
_NOISE = 1e-13
_SMALLEST = 2.0**-44
STIFFEST = 1e6  # n over the sink's inertia e beyond which the sink is as good as fixed to the pipe
_STRIPS = 24


def bernstein(degree: int) -> tuple[Floats, Floats, Floats]:
    """Nodes on [0, 1] (degree + 1,), binomials, and the matrix from values at the nodes to Bernstein coefficients."""
    k = np.arange(degree + 1)
    nodes: Floats = 0.5 - 0.5 * np.cos(np.pi * k / degree)
    binomials = np.array([math.comb(degree, i) for i in k], dtype=float)
    values = binomials * nodes[:, None] ** k * (1 - nodes[:, None]) ** k[::-1]
    return nodes, binomials, np.asarray(np.linalg.inv(values), dtype=float)


_NODES, _BINOMIAL, _TO_BERNSTEIN = bernstein(_DEGREE)


@kernel
def frequency_of(form, u):
    """Omega [rad/s] from the polynomial variable u."""
    return math.sqrt(u) if form == AVERAGED else u


@kernel
def variable_of(form, W):
    """The polynomial variable u from Omega [rad/s]."""
    return W * W if form == AVERAGED else W


@kernel
def _sample(form, omega, xi1, xi2, k1, rho2, F, kappa, u0, du, n0, dn, C, T):
    """Values of the curve C and of the Hurwitz determinant T at 5 x 5 nodes of a box."""
    for i in range(_DEGREE + 1):
        u = u0 + du * _NODES[i]
        d2, d1, d0, s1, s0, e, _ = linear_parts(form, frequency_of(form, u), omega, xi1, xi2, k1, rho2)
        Q = 0.75 * kappa * e * e * F * F
        weight = u * u if form == AVERAGED else 1.0
        for j in range(_DEGREE + 1):
            n = n0 + dn * _NODES[j]
            w = d0 + n * s0
            C[i, j] = n * (w.real * w.real + w.imag * w.imag) - Q
            c1, c2, c3, c4 = characteristic(d2, d1, d0, s1, s0, n)
            T[i, j] = weight * hurwitz(c1, c2, c3, c4)


@kernel
def _to_bernstein(values, work):
    m = _DEGREE + 1
    for i in range(m):
        for j in range(m):
            total = 0.0
            for k in range(m):
                total += _TO_BERNSTEIN[i, k] * values[k, j]
            work[i, j] = total
    for i in range(m):
        for j in range(m):
            total = 0.0
            for k in range(m):
                total += work[i, k] * _TO_BERNSTEIN[j, k]
            values[i, j] = total


@kernel
def _one_sign(b):
    low, high = math.inf, -math.inf
    for i in range(_DEGREE + 1):
        for j in range(_DEGREE + 1):
            low, high = min(low, b[i, j]), max(high, b[i, j])
    noise = _NOISE * max(abs(low), abs(high))
    return low > noise or high < -noise


@kernel
def _value_and_slopes(b, s, t):
    """Value and both partial derivatives of a Bernstein form at (s, t) in the unit square."""
    m = _DEGREE + 1
    bs, ds, bt, dt = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    for i in range(m):
        low, high = _DEGREE - i, i
        bs[i] = _BINOMIAL[i] * s**high * (1.0 - s) ** low
        bt[i] = _BINOMIAL[i] * t**high * (1.0 - t) ** low
        ds[i] = _BINOMIAL[i] * (
            (high * s ** (high - 1) * (1.0 - s) ** low if high > 0 else 0.0)
            - (low * s**high * (1.0 - s) ** (low - 1) if low > 0 else 0.0)
        )
        dt[i] = _BINOMIAL[i] * (
            (high * t ** (high - 1) * (1.0 - t) ** low if high > 0 else 0.0)
            - (low * t**high * (1.0 - t) ** (low - 1) if low > 0 else 0.0)
        )
    f = fs = ft = 0.0
    for i in range(m):
        for j in range(m):
            f += b[i, j] * bs[i] * bt[j]
            fs += b[i, j] * ds[i] * bt[j]
            ft += b[i, j] * bs[i] * dt[j]
    return f, fs, ft


@kernel
def _contraction(C, T):
    """Preconditioner (2 x 2, flat) from the box's centre and the largest deviation of its product from identity."""
    _, cs, ct = _value_and_slopes(C, 0.5, 0.5)
    _, ts, tt = _value_and_slopes(T, 0.5, 0.5)
    det = cs * tt - ct * ts
    if det == 0.0:
        return 0.0, 0.0, 0.0, 0.0, math.inf
    a11, a12, a21, a22 = tt / det, -ct / det, -ts / det, cs / det
    dev11 = dev12 = dev21 = dev22 = 0.0
    for i in range(_DEGREE + 1):
        for j in range(_DEGREE + 1):
            if i < _DEGREE:
                c, t = _DEGREE * (C[i + 1, j] - C[i, j]), _DEGREE * (T[i + 1, j] - T[i, j])
                dev11 = max(dev11, abs(a11 * c + a12 * t - 1.0))
                dev21 = max(dev21, abs(a21 * c + a22 * t))
            if j < _DEGREE:
                c, t = _DEGREE * (C[i, j + 1] - C[i, j]), _DEGREE * (T[i, j + 1] - T[i, j])
                dev12 = max(dev12, abs(a11 * c + a12 * t))
                dev22 = max(dev22, abs(a21 * c + a22 * t - 1.0))
    return a11, a12, a21, a22, max(dev11 + dev12, dev21 + dev22)


@kernel
def _solve_in_box(C, T, a11, a12, a21, a22):
    """Zero of a contraction on the unit square: whether there is one inside, and where."""
    s = t = 0.5
    for _ in range(60):
        f, fs, ft = _value_and_slopes(C, s, t)
        g, gs, gt = _value_and_slopes(T, s, t)
        x, y = a11 * f + a12 * g, a21 * f + a22 * g
        if max(abs(x), abs(y)) < 0.05:  # close: Newton's own step
            det = fs * gt - ft * gs
            x, y = (f * gt - g * ft) / det, (g * fs - f * gs) / det
        snew, tnew = min(1.0, max(0.0, s - x)), min(1.0, max(0.0, t - y))
        moved = max(abs(snew - s), abs(tnew - t))
        left = max(abs(s - x - snew), abs(t - y - tnew))
        s, t = snew, tnew
        if moved < 1e-15:
            return left < 1e-12, s, t
    return max(abs(x), abs(y)) < 1e-9, s, t


@kernel
def hopf_points(form, omega, xi1, xi2, k1, rho2, F, kappa, W_lo, W_hi, out):
    """Fill `out` (rows of Omega, n, undecided 0/1) with the zeros of the determinant on the curve; their number.

    A negative number means that there was too much to do. Without any damping the determinant is zero everywhere, but
    no eigenvalue crosses.
    """
    if kappa == 0.0 or F == 0.0 or (xi1 == 0.0 and xi2 == 0.0):
        return 0
    m = _DEGREE + 1
    C, T, work = np.empty((m, m)), np.empty((m, m)), np.empty((m, m))
    u_lo, u_hi = variable_of(form, W_lo), variable_of(form, W_hi)
    n_hi = _n_bound(form, omega, xi1, xi2, k1, rho2, F, kappa, u_lo, u_hi)
    stack = np.empty((2048, 4))
    top, found, looked = 0, 0, 0
    height = abs(n_hi)
    for strip in range(_STRIPS):  # from large n to small, each strip a quarter of the one above it
        base = 0.25 * height if strip < _STRIPS - 1 else 0.0
        stack[top, 0], stack[top, 1] = u_lo, u_hi - u_lo
        stack[top, 2], stack[top, 3] = base if n_hi > 0.0 else -height, height - base
        height = base
        top += 1
    while top > 0:
        top -= 1
        looked += 1
        if looked > MOST_BOXES:
            return -1
        u0, du, n0, dn = stack[top, 0], stack[top, 1], stack[top, 2], stack[top, 3]
        _sample(form, omega, xi1, xi2, k1, rho2, F, kappa, u0, du, n0, dn, C, T)
        _to_bernstein(T, work)
        if _one_sign(T):
            continue
        _to_bernstein(C, work)
        if _one_sign(C):
            continue
        a11, a12, a21, a22, deviation = _contraction(C, T)
        tiny = du < _SMALLEST * abs(u0 + du) or dn < _SMALLEST * (abs(n0) + dn)
        if deviation < 0.7 or tiny:
            inside, s, t = True, 0.5, 0.5
            if deviation < 0.7:
                inside, s, t = _solve_in_box(C, T, a11, a12, a21, a22)
            if inside:
                W, n = frequency_of(form, u0 + s * du), n0 + t * dn
                new = True
                for k in range(found):
                    if abs(out[k, 0] - W) < 1e-9 * W and abs(out[k, 1] - n) < 1e-7 * abs(n):
                        new = False
                        if deviation < 0.7:
                            out[k, 2] = 0.0
                if new:
                    if found == out.shape[0]:
                        return -1
                    out[found, 0], out[found, 1] = W, n
                    out[found, 2] = 0.0 if deviation < 0.7 else 1.0
                    found += 1
            continue
        if top + 2 > stack.shape[0]:
            return -1
        _halve(C, T, stack, top, u0, du, n0, dn)
        top += 2
    return found


@kernel
def _halve(C, T, stack, top, u0, du, n0, dn):
    """Put both halves of a box on the stack, cut across the direction in which the functions vary more."""
    along_u = along_n = 0.0
    scale_c, scale_t = np.max(np.abs(C)), np.max(np.abs(T))
    for i in range(_DEGREE + 1):
        for j in range(_DEGREE + 1):
            if i < _DEGREE:
                along_u = max(along_u, abs(C[i + 1, j] - C[i, j]) / scale_c, abs(T[i + 1, j] - T[i, j]) / scale_t)
            if j < _DEGREE:
                along_n = max(along_n, abs(C[i, j + 1] - C[i, j]) / scale_c, abs(T[i, j + 1] - T[i, j]) / scale_t)
    cut_u = along_u >= along_n
    for half in range(2):
        stack[top + half, 0] = u0 + 0.5 * half * du if cut_u else u0
        stack[top + half, 1] = 0.5 * du if cut_u else du
        stack[top + half, 2] = n0 if cut_u else n0 + 0.5 * half * dn
        stack[top + half, 3] = dn if cut_u else 0.5 * dn


@kernel
def _n_bound(form, omega, xi1, xi2, k1, rho2, F, kappa, u_lo, u_hi):
    """Bound on n over the window, with the sign of kappa: m (m - 1)^2 <= h gives m <= 1 + h^(1/3)."""
    bound = 0.0
    for i in range(65):
        u = u_lo + (u_hi - u_lo) * i / 64
        _, _, d0, _, s0, e, _ = linear_parts(form, frequency_of(form, u), omega, xi1, xi2, k1, rho2)
        S = abs(s0)
        if S > 0.0:
            here = abs(d0) / S + np.cbrt(abs(0.75 * kappa) * e * e * F * F / (S * S))
            bound = max(bound, min(here, STIFFEST * abs(e)))
    # |s0| is smallest, and the bound largest, where the pipe is in resonance with the sink's mass locked to it
    W = omega / math.sqrt(1.0 + rho2) if form == AVERAGED else omega
    if W > 0.0 and u_lo <= variable_of(form, W) <= u_hi:
        _, _, d0, _, s0, e, _ = linear_parts(form, W, omega, xi1, xi2, k1, rho2)
        S = abs(s0)
        here = STIFFEST * abs(e)
        if S > 0.0:
            here = min(here, abs(d0) / S + np.cbrt(abs(0.75 * kappa) * e * e * F * F / (S * S)))
        bound = max(bound, here)
    return math.copysign(2.0 * bound, kappa)
