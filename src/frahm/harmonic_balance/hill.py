"""One Floquet exponent at a time, exactly, for hosts with many modes: Hill's determinant on the relative coordinates.

A disturbance e^{lam t} sum_k v_k e^{ik Omega t} of the elements' coordinates obeys, with P_m the Fourier coefficients
of the elements' slopes, S(lam + ik Omega) v_k + sum_l P_{k-l} v_l = 0, S being the dynamic stiffness of the whole host.

Hill's method in harmonic balance: von Groll and Ewins (2001), doi 10.1006/jsvi.2000.3298.
"""

from __future__ import annotations

import cmath
import math

import numpy as np

from frahm.compiled import kernel, separate_kernel
from frahm.harmonic_balance.kernels import element_force, fourier_tables, sample_count, stiffness

_BESIDE = 1e-15  # of Hill's matrix
_PAIR = 1e-6  # distance of a multiplier from the conjugate of another one, below which they are a pair


@separate_kernel
def refine_exponents(pb, H, odd, W, u, multipliers, count):
    """Replace the `count` largest multipliers of the (half) map by those of the complete host, in place.

    Each is the start of an inverse iteration with Rayleigh quotients on Hill's matrix; where that leads elsewhere or
    does not converge the value is kept. For forces whose dependence on the velocity is linear.
    """
    step = 2 if odd else 1
    h = H + 2 if odd else H + 1
    P = _slope_matrix(pb, H, odd, W, u, step, h + 1 if odd else 2 * h + 1)
    span = (math.pi if odd else 2.0 * math.pi) / W
    for index in range(count):
        if multipliers[index].imag < 0.0:
            if index > 0 and abs(multipliers[index - 1] - multipliers[index].conjugate()) < _PAIR:
                continue  # the conjugate of the one refined before
            for after in range(index + 1, multipliers.size):  # rounding decides which of a pair comes first
                if abs(multipliers[after] - multipliers[index].conjugate()) < _PAIR:
                    multipliers[index], multipliers[after] = multipliers[after], multipliers[index]
                    break
        start = cmath.log(multipliers[index]) / span
        good, lam = _eigenvalue_near(pb, P, start, W, step, h)
        for earlier in range(index):  # one that was found before: multipliers are too close to be told apart from here
            good = good and abs(cmath.exp(lam * span) - multipliers[earlier]) > 1e-9
        if good and abs(lam - start) < 0.02 * W:
            old = multipliers[index]
            value = cmath.exp(lam * span)
            if old.imag == 0.0:
                value = complex(value.real, 0.0)
            multipliers[index] = value
            for other in range(multipliers.size):
                if old.imag != 0.0 and abs(multipliers[other] - old.conjugate()) < _PAIR:
                    multipliers[other] = value.conjugate()


@kernel
def _slope_matrix(pb, H, odd, W, u, step, harmonics):
    """What the slopes of the elements along the orbit put into Hill's matrix (harmonics r, harmonics r)."""
    r = pb.M11.shape[0]
    co, si = fourier_tables(H, odd, sample_count(pb, H, odd))
    G, p = np.empty(H + 5, np.complex128), np.empty(2 * H + 1, np.complex128)
    q = np.empty(2 * H + 1, np.complex128)
    P = np.zeros((harmonics * r, harmonics * r), np.complex128)
    for e in range(pb.directions.shape[1]):
        element_force(pb, e, H, odd, W, u, co, si, G, p, q)
        for a in range(harmonics):
            for b in range(harmonics):
                m = (a - b) * step
                if abs(m) > 2 * H:
                    continue
                value = p[m] if m >= 0 else p[-m].conjugate()
                for i in range(r):
                    for j in range(r):
                        P[a * r + i, b * r + j] += pb.directions[i, e] * pb.directions[j, e] * value
    return P


@kernel
def _eigenvalue_near(pb, P, start, W, step, h):
    """Whether inverse iteration with Rayleigh quotients converges from an exponent, and to which."""
    n = P.shape[0]
    A, D = np.empty((n, n), np.complex128), np.zeros((n, n), np.complex128)
    lam, v, w = start, np.ones(n, np.complex128), np.ones(n, np.complex128)
    for i in range(n):  # a start that no symmetry makes orthogonal to the vector sought
        v[i] += 0.3 * math.sin(1.0 + i)
        w[i] += 0.3 * math.cos(1.0 + i)
    _assemble(pb, P, lam, W, step, h, A, D)
    for iteration in range(12):
        if iteration > 0:
            bottom = np.sum(w * (D @ v))
            if bottom == 0j:
                break
            change = np.sum(w * (A @ v)) / bottom
            lam -= change
            if abs(change) < 1e-6 * W:  # convergence is cubic: the next change would be below rounding
                return True, lam
            _assemble(pb, P, lam, W, step, h, A, D)
        near = A.copy()  # at an exponent itself the matrix is singular: a rounding beside it is as good
        size = np.max(np.abs(A)) * _BESIDE
        for i in range(n):
            near[i, i] += size
        v = np.linalg.solve(near, D @ v if iteration > 0 else v)
        w = np.linalg.solve(near.T.copy(), D.T @ w if iteration > 0 else w)
        v /= np.max(np.abs(v))
        w /= np.max(np.abs(w))
    return False, lam


@separate_kernel
def _assemble(pb, P, lam, W, step, h, A, D):
    """Hill's matrix A at the exponent lam, and its derivative D, diagonal but for the blocks of one harmonic."""
    r = pb.M11.shape[0]
    S, dS = np.empty((r, r), np.complex128), np.empty((r, r), np.complex128)
    force, dforce = np.empty(r, np.complex128), np.empty(r, np.complex128)
    A[:] = P
    for a in range(P.shape[0] // r):
        stiffness(pb, lam + 1j * ((a * step) - h) * W, S, dS, force, dforce)
        for i in range(r):
            for j in range(r):
                A[a * r + i, a * r + j] += S[i, j]
                D[a * r + i, a * r + j] = dS[i, j]
