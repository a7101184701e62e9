"""All saddle-nodes of the slow flow in a window: where two of the equilibria n = 3/4 kappa |Z|^2 meet.

The equilibria at a frequency are the roots of a cubic in n, A n^3 + B n^2 + C n = Q with A = |s0|^2, B = 2 d0.s0,
C = |d0|^2; two of them meet where its discriminant vanishes, which is a polynomial of degree at most 14 in u (u = Omega
in the paper's form, Omega^2 in the averaged one). A polynomial lies between its smallest and its largest Bernstein
coefficient: an interval whose coefficients have one sign holds no zero, one whose coefficients rise or fall throughout
holds at most one. Every other interval is halved. The work does not depend on how narrow the resonance is, as it would
if both u and n were searched: without damping its two flanks meet nowhere.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.slow_flow.kernels import linear_parts
from frahm.slow_flow.subdivision import STIFFEST, bernstein, frequency_of, variable_of

MOST_INTERVALS = 100_000
_DEGREE = 14
_NODES, _, _TO_BERNSTEIN = bernstein(_DEGREE)
_NOISE = 4e-16 * float(np.max(np.sum(np.abs(_TO_BERNSTEIN), axis=1)))  # of the terms: what rounding does
_ROUNDED = 8e-15  # of the terms: what rounding does to one value
_ALL_NOISE = 10.0  # times that: an interval on which nothing is larger cannot be decided
_SMALLEST = 2.0**-44
_STRIP = 2.0  # ratio of the ends of the intervals begun with


@kernel
def double_root(c, h):
    """The turning point of m^3 + 2 c m^2 + m whose value is nearer to h."""
    spread = math.sqrt(max(4.0 * c * c - 3.0, 0.0))
    low, high = (-2.0 * c - spread) / 3.0, (-2.0 * c + spread) / 3.0
    miss_low = abs(((low + 2.0 * c) * low + 1.0) * low - h)
    miss_high = abs(((high + 2.0 * c) * high + 1.0) * high - h)
    return low if miss_low < miss_high else high


@kernel
def _discriminant(form, omega, xi1, xi2, k1, rho2, F, kappa, u):
    """Discriminant of the cubic at u, and the sum of its terms without their signs."""
    _, _, d0, _, s0, e, _ = linear_parts(form, frequency_of(form, u), omega, xi1, xi2, k1, rho2)
    A, C = s0.real * s0.real + s0.imag * s0.imag, d0.real * d0.real + d0.imag * d0.imag
    B = 2.0 * (d0.real * s0.real + d0.imag * s0.imag)
    cross = d0.real * s0.imag - d0.imag * s0.real  # B^2 - 4 A C = -4 cross^2, without the difference
    Q = 0.75 * kappa * e * e * F * F
    apart = 4.0 * (cross * C) ** 2
    value = Q * (4.0 * B * B * B - 18.0 * A * B * C - 27.0 * A * A * Q) - apart
    return value, apart + abs(Q) * (4.0 * abs(B) ** 3 + 18.0 * A * abs(B) * C + 27.0 * A * A * abs(Q))


@kernel
def _coefficients(form, omega, xi1, xi2, k1, rho2, F, kappa, u, du, values, bernstein):
    """Bernstein coefficients over [u, u + du], and what rounding may make of them."""
    size = 0.0
    for i in range(_DEGREE + 1):
        values[i], terms = _discriminant(form, omega, xi1, xi2, k1, rho2, F, kappa, u + du * _NODES[i])
        size = max(size, terms)
    for i in range(_DEGREE + 1):
        total = 0.0
        for k in range(_DEGREE + 1):
            total += _TO_BERNSTEIN[i, k] * values[k]
        bernstein[i] = total
    return _NOISE * size


@kernel
def _is_told(values, noise):
    """Whether values at the nodes of a short interval show every zero in it: none is within the noise, or comes near.

    On it the polynomial is all but a parabola, which falls below its smallest node by less than a quarter of the
    difference of the differences there.
    """
    for i in range(_DEGREE + 1):
        bend = 0.0
        if 0 < i < _DEGREE:
            bend = abs(values[i + 1] - 2.0 * values[i] + values[i - 1])
        if abs(values[i]) <= noise + 0.25 * bend:
            return False
    return True


@kernel
def _zero_between(form, omega, xi1, xi2, k1, rho2, F, kappa, a, b):
    """The zero in [a, b], at whose ends the signs differ."""
    rises = _discriminant(form, omega, xi1, xi2, k1, rho2, F, kappa, b)[0] > 0.0
    for _ in range(80):
        middle = 0.5 * (a + b)
        if middle <= a or middle >= b:
            break
        if (_discriminant(form, omega, xi1, xi2, k1, rho2, F, kappa, middle)[0] > 0.0) == rises:
            b = middle
        else:
            a = middle
    return 0.5 * (a + b)


@kernel
def _height(form, omega, xi1, xi2, k1, rho2, F, kappa, u):
    """The n at which two equilibria meet at u; 0 if it is negative or beyond what a sink can be."""
    _, _, d0, _, s0, e, _ = linear_parts(form, frequency_of(form, u), omega, xi1, xi2, k1, rho2)
    absd, abss = abs(d0), abs(s0)
    if absd == 0.0 or abss == 0.0:
        return 0.0
    c = math.copysign(1.0, kappa) * (d0.real * s0.real + d0.imag * s0.imag) / (absd * abss)
    h = 0.75 * abs(kappa) * (e * F) ** 2 * abss / absd**3
    n = double_root(c, h) * absd / abss
    return math.copysign(n, kappa) if c < 0.0 and n <= STIFFEST * abs(e) else 0.0


@kernel
def _keep(form, omega, xi1, xi2, k1, rho2, F, kappa, u, undecided, width, out, found):
    """Add a zero, unless it is the one before; their number, or -1 if there is no more room."""
    n = _height(form, omega, xi1, xi2, k1, rho2, F, kappa, u)
    if n == 0.0:
        return found
    W = frequency_of(form, u)
    near = (1e-9 + 2.0 * width) * W
    if found > 0 and abs(out[found - 1, 0] - W) < near and (undecided or out[found - 1, 2] > 0.0 or width == 0.0):
        out[found - 1, 2] = min(out[found - 1, 2], 1.0 if undecided else 0.0)
        return found
    if found == out.shape[0]:
        return -1
    out[found, 0], out[found, 1], out[found, 2] = W, n, 1.0 if undecided else 0.0
    return found + 1


@kernel
def saddle_nodes(form, omega, xi1, xi2, k1, rho2, F, kappa, W_lo, W_hi, out):
    """Fill `out` (rows of Omega, n, undecided 0/1), ascending; their number, negative if there was too much to do."""
    if kappa == 0.0 or F == 0.0:
        return 0
    values, bernstein = np.empty(_DEGREE + 1), np.empty(_DEGREE + 1)
    stack = np.empty((512, 2))
    u_lo, u_hi = variable_of(form, W_lo), variable_of(form, W_hi)
    found, looked, begin = 0, 0, u_lo
    while begin < u_hi:
        end = min(u_hi, _STRIP * begin) if begin > 0.0 else u_hi
        stack[0, 0], stack[0, 1], top = begin, end - begin, 1
        begin = end
        while top > 0:
            top -= 1
            u, du = stack[top, 0], stack[top, 1]
            looked += 1
            if looked > MOST_INTERVALS:
                return -1
            noise = _coefficients(form, omega, xi1, xi2, k1, rho2, F, kappa, u, du, values, bernstein)
            low, high = np.min(bernstein), np.max(bernstein)
            if low > noise or high < -noise:
                continue
            steps_low, steps_high = math.inf, -math.inf
            for i in range(_DEGREE):
                step = bernstein[i + 1] - bernstein[i]
                steps_low, steps_high = min(steps_low, step), max(steps_high, step)
            if steps_low > noise or steps_high < -noise:
                first, last = values[0], values[_DEGREE]
                if (first > 0.0) != (last > 0.0):
                    zero = _zero_between(form, omega, xi1, xi2, k1, rho2, F, kappa, u, u + du)
                    found = _keep(form, omega, xi1, xi2, k1, rho2, F, kappa, zero, False, 0.0, out, found)
            elif du < _SMALLEST * (u + du) or max(-low, high) < _ALL_NOISE * noise:
                if _is_told(values, _ROUNDED * noise / _NOISE):
                    for i in range(_DEGREE):
                        if found >= 0 and (values[i] > 0.0) != (values[i + 1] > 0.0):
                            left, right = u + du * _NODES[i], u + du * _NODES[i + 1]
                            zero = _zero_between(form, omega, xi1, xi2, k1, rho2, F, kappa, left, right)
                            found = _keep(form, omega, xi1, xi2, k1, rho2, F, kappa, zero, False, 0.0, out, found)
                else:
                    middle, width = u + 0.5 * du, du / (u + du)
                    found = _keep(form, omega, xi1, xi2, k1, rho2, F, kappa, middle, True, width, out, found)
            else:
                if top + 2 > stack.shape[0]:
                    return -1
                stack[top, 0], stack[top, 1] = u + 0.5 * du, 0.5 * du  # the lower half is looked at first
                stack[top + 1, 0], stack[top + 1, 1] = u, 0.5 * du
                top += 2
            if found < 0:
                return -1
    return found
