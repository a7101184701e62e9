"""Compiled closed forms of the slow flow: equilibria, characteristic polynomial, stability class.

Both forms of the theory are one pair of equations in the complex amplitudes X, Z (x1 = Re X e^{i Omega t},
z = Re Z e^{i Omega t}), with n = 3/4 kappa |Z|^2::

    p X' + a X = F + (g1 + n) Z
    q X' - e X + r Z' - e Z + (g2 + n) Z = 0

Eliminating X leaves (d0 + n s0) Z = e F at equilibrium, with d(lam) = (q lam - e) g1 + (p lam + a)(r lam - e + g2)
and s(lam) = (q lam - e) + (p lam + a); the characteristic polynomial is |d + 2 n s|^2 - n^2 |s|^2. Scaled by
n = m |d0|/|s0|, the equilibria are the positive roots of m^3 + 2 c m^2 + m = h with c the cosine between d0 and s0:
three of them only where c < -sqrt(3)/2.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.polynomials import universal_roots

PAPER, AVERAGED = 0, 1
NO_ROOT, STABLE, ODD, EVEN = -1, 0, 1, 2


@kernel
def coefficients(form, W, omega, xi1, xi2, k1, rho2):
    """Complex coefficients p, a, q, r, e, g1, g2 at excitation frequency W [rad/s]; k1 is a linear spring / m1."""
    if form == PAPER:
        sigma = W - omega
        p = 2j * omega
        a = complex(-2.0 * omega * sigma, omega * xi1)
        q = 2j * rho2 * omega
        r = complex(xi2, 2.0 * rho2 * omega)
        e = rho2 * omega * (omega + 2.0 * sigma)
        return p, a, q, r, e, complex(k1, omega * xi2), complex(k1, W * xi2)
    p = 2j * W
    a = complex((omega - W) * (omega + W), W * xi1)
    q = 2j * rho2 * W
    g = complex(k1, W * xi2)
    return p, a, q, q, rho2 * W * W, g, g


@kernel
def linear_parts(form, W, omega, xi1, xi2, k1, rho2):
    """d = d2 lam^2 + d1 lam + d0 and s = s1 lam + s0 (complex), with e and g2 for the manifold."""
    p, a, q, r, e, g1, g2 = coefficients(form, W, omega, xi1, xi2, k1, rho2)
    d0 = a * (g2 - e) - e * g1
    d1 = q * g1 + p * (g2 - e) + a * r
    return p * r, d1, d0, p + q, a - e, e, g2


@kernel
def _dot(u, v):
    return u.real * v.real + u.imag * v.imag


@kernel
def _norm2(u):
    return u.real * u.real + u.imag * u.imag


@kernel
def characteristic(d2, d1, d0, s1, s0, n):
    """delta_1 ... delta_4 of lam^4 + delta_1 lam^3 + ... (paper Eq. 23) on a response with n = 3/4 kappa |Z|^2."""
    w1 = d1 + 2.0 * n * s1
    w0 = d0 + 2.0 * n * s0
    scale = 1.0 / _norm2(d2)
    nn = n * n
    c3 = 2.0 * _dot(d2, w1)
    c2 = _norm2(w1) + 2.0 * _dot(d2, w0) - nn * _norm2(s1)
    c1 = 2.0 * (_dot(w1, w0) - nn * _dot(s1, s0))
    c0 = _norm2(w0) - nn * _norm2(s0)
    return c3 * scale, c2 * scale, c1 * scale, c0 * scale


@kernel
def hurwitz(c1, c2, c3, c4):
    """Routh-Hurwitz determinant delta_3 (delta_1 delta_2 - delta_3) - delta_1^2 delta_4: zero at a Hopf point."""
    return c3 * (c1 * c2 - c3) - c1 * c1 * c4


@kernel
def stability_class(c1, c2, c3, c4):
    """0 stable, 1 an odd number of unstable eigenvalues, 2 an even number (Routh-Hurwitz)."""
    if c4 < 0.0:
        return ODD
    if c1 > 0.0 and c1 * c2 - c3 > 0.0 and hurwitz(c1, c2, c3, c4) > 0.0:
        return STABLE
    return EVEN


@kernel
def equilibria(d0, s0, e, F, kappa):
    """All |Z|^2 of the equilibria, ascending: their number, then three values (NaN where there is none)."""
    k = 0.75 * kappa
    D, S = _norm2(d0), _norm2(s0)
    load = e * e * F * F
    if k == 0.0 or S == 0.0 or load == 0.0 or D == 0.0:
        if D > 0.0 and (k == 0.0 or S == 0.0 or load == 0.0):
            return 1, load / D, math.nan, math.nan
        if D == 0.0 and k != 0.0 and S > 0.0 and load > 0.0:
            return 1, np.cbrt(load / (k * k * S)), math.nan, math.nan
        return 0, math.nan, math.nan, math.nan
    absd, abss = math.sqrt(D), math.sqrt(S)
    ratio = abss / absd
    c = min(1.0, max(-1.0, math.copysign(1.0, k) * _dot(d0, s0) / (absd * abss)))
    count, m1, m2, m3 = universal_roots(c, abs(k) * load * ratio / D)
    scale = 1.0 / (abs(k) * ratio)
    return count, m1 * scale, m2 * scale, m3 * scale


@kernel
def pipe_amplitude(N, n, e, g2):
    """|X| on the manifold e X = (g2 + n - e) Z."""
    return math.sqrt(N * _norm2(g2 + n - e)) / abs(e)


@kernel
def map_into(form, omega, xi1, k1, rho2, F, W, kappa, xi2, pipe, relative, stability):
    """Fill pipe, relative (points, 3) and stability (points, 3): every root of every point with its class.

    W, kappa, xi2 are 1-D arrays of the full length or of length 1.
    """
    points = pipe.shape[0]
    stepW, stepk, stepx = int(W.size > 1), int(kappa.size > 1), int(xi2.size > 1)
    for i in range(points):
        kap = kappa[i * stepk]
        d2, d1, d0, s1, s0, e, g2 = linear_parts(form, W[i * stepW], omega, xi1, xi2[i * stepx], k1, rho2)
        count, N1, N2, N3 = equilibria(d0, s0, e, F, kap)
        for j in range(3):
            if j >= count:
                pipe[i, j] = math.nan
                relative[i, j] = math.nan
                stability[i, j] = NO_ROOT
                continue
            N = N1 if j == 0 else (N2 if j == 1 else N3)
            n = 0.75 * kap * N
            c1, c2, c3, c4 = characteristic(d2, d1, d0, s1, s0, n)
            pipe[i, j] = pipe_amplitude(N, n, e, g2)
            relative[i, j] = math.sqrt(N)
            stability[i, j] = stability_class(c1, c2, c3, c4)
