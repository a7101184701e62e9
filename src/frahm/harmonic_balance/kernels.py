"""Compiled residual and Jacobian of harmonic balance on the elements' relative coordinates.

u(t) = Re sum_k u_k e^{ik Omega t} over k = first, first + step, ..., H (odd harmonics: first 1, step 2; all: 0, 1).
The unknown vector holds Re u_k, Im u_k of every coordinate, harmonic by harmonic; the imaginary part of harmonic 0
is kept at zero by an equation of its own. Time samples cover half a period for odd harmonics, a whole one otherwise,
dense enough for polynomial forces to be balanced without aliasing; forces of other laws are sampled sixteen times per
period of the highest harmonic, which leaves the aliasing far below the truncation.

Alternating frequency-time evaluation: Cameron and Griffin (1989), doi 10.1115/1.3176036; for the method see Krack and
Gross (2019), doi 10.1007/978-3-030-14023-6.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.absorbers.packed import law_force_and_slopes, polynomial_and_slopes
from frahm.compiled import kernel, separate_kernel

_FEWEST_SAMPLES = 200  # per period, for laws that are no polynomials


@kernel
def harmonic_count(H, odd):
    """Number of harmonics kept up to H."""
    return (H + 1) // 2 if odd else H + 1


@kernel
def unknowns(pb, H, odd):
    """Length of the unknown vector."""
    return 2 * pb.M11.shape[0] * harmonic_count(H, odd)


@kernel
def sample_count(pb, H, odd):
    """Number of time samples: enough for G_k up to k = H + 4 to be free of aliasing from degree * H."""
    full = (pb.degree + 1) * H + 6 if pb.degree > 0 else max(16 * H + 6, _FEWEST_SAMPLES)
    return full // 2 + 1 if odd else full + 1


@kernel
def inverse(c):
    """1/c without the guards against overflow that a general complex division carries; 0 for 0.

    c = 0 is a structure that moves freely at harmonic 0: nothing acts through that pole.
    """
    size = c.real * c.real + c.imag * c.imag
    scale = 1.0 / size if size > 0.0 else 0.0
    return complex(c.real * scale, -c.imag * scale)


@kernel
def forcing_factor(pb, W):
    """Factor on the forcing at Omega = W, and its derivative: 1, or a piecewise cubic, beyond it as W^2."""
    last = pb.forcing.shape[0] - 1
    if last < 0:
        return 1.0, 0.0
    lo, hi = pb.forcing[0, 0], pb.forcing[last, 0]
    inside = min(max(W, lo), hi)
    row, above = 0, last
    while above - row > 1:
        middle = (row + above) // 2
        if pb.forcing[middle, 0] <= inside:
            row = middle
        else:
            above = middle
    x = inside - pb.forcing[row, 0]
    c0, c1, c2, c3 = pb.forcing[row, 1], pb.forcing[row, 2], pb.forcing[row, 3], pb.forcing[row, 4]
    value = c0 + x * (c1 + x * (c2 + x * c3))
    if inside != W:
        return value * (W / inside) ** 2, 2.0 * value * W / inside**2
    return value, c1 + x * (2.0 * c2 + 3.0 * x * c3)


@kernel
def stiffness(pb, s, S, dS, force, dforce):
    """S(s) and dS/ds (r, r), condensed harmonic force and its derivative (r,); the force counts at harmonic 1 only."""
    r = pb.M11.shape[0]
    for i in range(r):
        force[i] = pb.force_u[i]
        dforce[i] = 0.0
        for j in range(r):
            S[i, j] = s * (s * pb.M11[i, j] + pb.C11[i, j]) + pb.K11[i, j]
            dS[i, j] = 2.0 * s * pb.M11[i, j] + pb.C11[i, j]
    for q in range(pb.poles.size):
        g = inverse(s - pb.poles[q])
        for i in range(r):
            a = s * (s * pb.a2[q, i] + pb.a1[q, i]) + pb.a0[q, i]
            da = 2.0 * s * pb.a2[q, i] + pb.a1[q, i]
            ag = a * g
            dag = (da - ag) * g
            force[i] -= ag * pb.force_y[q]
            dforce[i] -= dag * pb.force_y[q]
            for j in range(r):
                b = s * (s * pb.b2[q, j] + pb.b1[q, j]) + pb.b0[q, j]
                db = 2.0 * s * pb.b2[q, j] + pb.b1[q, j]
                S[i, j] -= ag * b
                dS[i, j] -= dag * b + ag * db
    if pb.forcing.shape[0] > 0:
        factor, slope = forcing_factor(pb, s.imag)
        for i in range(r):
            dforce[i] = factor * dforce[i] - 1j * slope * force[i]  # dOmega/ds = -i
            force[i] = factor * force[i]


@kernel
def stiffnesses(pb, s):
    """S (N, r, r) and condensed harmonic force (N, r) at N values of s."""
    r = pb.M11.shape[0]
    S, force = np.empty((s.size, r, r), np.complex128), np.empty((s.size, r), np.complex128)
    dS, dforce = np.empty((r, r), np.complex128), np.empty(r, np.complex128)
    for j in range(s.size):
        stiffness(pb, s[j], S[j], dS, force[j], dforce)
    return S, force


@kernel
def output_harmonic(pb, k, W, u, row):
    """Harmonic k of an output row from the relative coordinates u (r,) of that harmonic."""
    s = 1j * k * W
    value = 0j
    factor = forcing_factor(pb, W)[0] if k == 1 else 0.0
    for i in range(u.size):
        value += pb.out_u[row, i] * u[i]
    for q in range(pb.poles.size):
        drive = factor * pb.force_y[q]
        for i in range(u.size):
            drive -= (s * (s * pb.b2[q, i] + pb.b1[q, i]) + pb.b0[q, i]) * u[i]
        value += pb.out_y[row, q] * drive * inverse(s - pb.poles[q])
    return value


@kernel
def harmonics_of(pb, H, odd, X, out):
    """Copy the unknown vector into complex harmonics out (H + 5, r); entries not kept are zero."""
    r = pb.M11.shape[0]
    out[:] = 0j
    first, step = (1, 2) if odd else (0, 1)
    for m in range(harmonic_count(H, odd)):
        for i in range(r):
            out[first + m * step, i] = complex(X[2 * (m * r + i)], X[2 * (m * r + i) + 1])


@kernel
def fourier_tables(H, odd, N):
    """cos and sin of k tau_j, shape (H + 5, N)."""
    span = math.pi if odd else 2.0 * math.pi
    co, si = np.empty((H + 5, N)), np.empty((H + 5, N))
    for j in range(N):
        tau = span * j / N
        c1, s1 = math.cos(tau), math.sin(tau)
        c, s = 1.0, 0.0
        for k in range(H + 5):
            if k % 16 == 0:  # restart the recurrence before rounding adds up
                c, s = math.cos(k * tau), math.sin(k * tau)
            co[k, j], si[k, j] = c, s
            c, s = c * c1 - s * s1, s * c1 + c * s1
    return co, si


@separate_kernel
def element_force(pb, e, H, odd, W, u, co, si, G, p, q):
    """Harmonics of one element's force: G (H + 5,) with Re sum G_k e^{ik tau}, and of its slopes: p, q (2 H + 1,).

    p_m = mean of dg/dz e^{-im tau} and q_m of dg/dw, which is filled only if a force depends on the velocity
    (`pb.rates`). Only harmonics of the right parity are filled for odd sets.
    """
    N = co.shape[1]
    r = pb.M11.shape[0]
    first, step = (1, 2) if odd else (0, 1)
    z = np.zeros(N)
    for k in range(first, H + 1, step):
        re = im = 0.0
        for i in range(r):
            re += pb.directions[i, e] * u[k, i].real
            im += pb.directions[i, e] * u[k, i].imag
        for j in range(N):
            z[j] += re * co[k, j] - im * si[k, j]
    g, slope = np.empty(N), np.empty(N)
    mstep = 2 if odd else 1
    if pb.rates:
        w, rate = np.zeros(N), np.empty(N)
        add_velocity(pb, e, H, odd, W, u, co, si, w)
        for j in range(N):
            g[j], slope[j], rate[j] = law_force_and_slopes(
                pb.codes[e, 0], pb.codes[e, 1], pb.codes[e, 2], pb.table, z[j], w[j]
            )
        _mean_harmonics(rate, H, mstep, co, si, q)
    elif pb.degree > 0:
        for j in range(N):
            g[j], slope[j], _ = polynomial_and_slopes(pb.codes[e, 1], pb.codes[e, 2], pb.table, z[j], 0.0)
    else:
        for j in range(N):
            g[j], slope[j], _ = law_force_and_slopes(
                pb.codes[e, 0], pb.codes[e, 1], pb.codes[e, 2], pb.table, z[j], 0.0
            )
    for k in range(first, H + 5, step):
        re = im = 0.0
        for j in range(N):
            re += g[j] * co[k, j]
            im -= g[j] * si[k, j]
        factor = (1.0 if k == 0 else 2.0) / N
        G[k] = complex(re * factor, im * factor)
    _mean_harmonics(slope, H, mstep, co, si, p)


@kernel
def add_velocity(pb, e, H, odd, W, u, co, si, w):
    """Add the samples of an element's velocity to w (N,)."""
    first, step = (1, 2) if odd else (0, 1)
    for k in range(first, H + 1, step):
        re = im = 0.0
        for i in range(u.shape[1]):
            re += pb.directions[i, e] * u[k, i].real * k * W
            im += pb.directions[i, e] * u[k, i].imag * k * W
        for j in range(w.size):
            w[j] -= re * si[k, j] + im * co[k, j]


@kernel
def _mean_harmonics(slope, H, step, co, si, p):
    """p_m = mean of the samples times e^{-im tau} for m = 0, step, ..., 2 H."""
    N = slope.size
    for m in range(0, 2 * H + 1, step):
        re = im = 0.0
        if m < H + 5:
            for j in range(N):
                re += slope[j] * co[m, j]
                im -= slope[j] * si[m, j]
        else:
            for j in range(N):  # e^{-im tau} from the product of two tabulated rows
                a, b = H, m - H
                re += slope[j] * (co[a, j] * co[b, j] - si[a, j] * si[b, j])
                im -= slope[j] * (si[a, j] * co[b, j] + co[a, j] * si[b, j])
        p[m] = complex(re / N, im / N)


@separate_kernel
def residual_and_jacobian(pb, H, odd, W, X, co, si, R, J):
    """Residual R (n,), Jacobian J (n, n + 1) with the derivative by Omega last; returns the relative truncation.

    The truncation is the size of the two force harmonics beyond H, which nothing balances, over that of all forces.
    """
    r = pb.M11.shape[0]
    E = pb.directions.shape[1]
    n = unknowns(pb, H, odd)
    count = harmonic_count(H, odd)
    first, step = (1, 2) if odd else (0, 1)
    u = np.empty((H + 5, r), np.complex128)
    harmonics_of(pb, H, odd, X, u)
    S, dS = np.empty((r, r), np.complex128), np.empty((r, r), np.complex128)
    force, dforce = np.empty(r, np.complex128), np.empty(r, np.complex128)
    J[:n, : n + 1] = 0.0
    size = 0.0
    for m in range(count):
        k = first + m * step
        stiffness(pb, 1j * k * W, S, dS, force, dforce)
        for i in range(r):
            total, slope = 0j, 0j
            row = 2 * (m * r + i)
            for j in range(r):
                total += S[i, j] * u[k, j]
                slope += dS[i, j] * u[k, j]
                column = 2 * (m * r + j)
                J[row, column] += S[i, j].real
                J[row, column + 1] -= S[i, j].imag
                J[row + 1, column] += S[i, j].imag
                J[row + 1, column + 1] += S[i, j].real
            if k == 1:
                total -= force[i]
                slope -= dforce[i]
                size += abs(force[i]) ** 2
            slope *= 1j * k
            R[row], R[row + 1] = total.real, total.imag
            J[row, n], J[row + 1, n] = slope.real, slope.imag
    G, p = np.empty(H + 5, np.complex128), np.empty(2 * H + 1, np.complex128)
    q = np.empty(2 * H + 1, np.complex128)
    beyond = 0.0
    for e in range(E):
        element_force(pb, e, H, odd, W, u, co, si, G, p, q)
        for k in range(H + step, H + 5, step):
            beyond += abs(G[k]) ** 2
        for m in range(count):
            k = first + m * step
            size += abs(G[k]) ** 2
            for i in range(r):
                row = 2 * (m * r + i)
                R[row] += pb.directions[i, e] * G[k].real
                R[row + 1] += pb.directions[i, e] * G[k].imag
        add_slopes(pb, e, first, step, count, p, J)
        if pb.rates:
            add_rates(pb, e, first, step, count, W, q, J)
            _add_rate_by_frequency(pb, e, first, step, count, u, q, J, n)
    if not odd:
        for i in range(r):  # harmonic 0 is real
            row = 2 * i + 1
            J[row, : n + 1] = 0.0
            J[row, row] = 1.0
            R[row] = X[row]
    return math.sqrt(beyond / size) if size > 0.0 else 0.0


@kernel
def add_slopes(pb, e, first, step, count, p, J):
    """Add d G_k = sum_l p_{k-l} du_l + p_{k+l} conj(du_l) of one element to the Jacobian."""
    for mk in range(count):
        k = first + mk * step
        for ml in range(count):
            q = first + ml * step
            minus = p[k - q] if k >= q else p[q - k].conjugate()
            plus = p[k + q]
            if q == 0:  # a real unknown: only its own column counts
                minus = p[k] * (1.0 if k > 0 else 0.5)
                plus = minus
            elif k == 0:  # the real mean of the force
                minus, plus = 0.5 * minus, 0.5 * plus
            _add_block(pb, e, mk, ml, minus, plus, J)


@kernel
def add_rates(pb, e, first, step, count, W, q, J):
    """Add d G_k = sum_l q_{k-l} dw_l + q_{k+l} conj(dw_l), dw_l = il Omega du_l, of one element to the Jacobian."""
    for mk in range(count):
        k = first + mk * step
        for ml in range(count):
            m = first + ml * step
            minus, plus = _rate_entries(k, m, W, q)
            _add_block(pb, e, mk, ml, minus, plus, J)


@kernel
def _add_block(pb, e, mk, ml, minus, plus, J):
    """Add d G = minus du + plus conj(du) of one element to the block of two harmonics."""
    r = pb.M11.shape[0]
    rr, ri = minus.real + plus.real, -minus.imag + plus.imag
    ir, ii = minus.imag + plus.imag, minus.real - plus.real
    for i in range(r):
        for j in range(r):
            weight = pb.directions[i, e] * pb.directions[j, e]
            if weight == 0.0:
                continue
            row, column = 2 * (mk * r + i), 2 * (ml * r + j)
            J[row, column] += weight * rr
            J[row, column + 1] += weight * ri
            J[row + 1, column] += weight * ir
            J[row + 1, column + 1] += weight * ii


@kernel
def _rate_entries(k, m, W, q):
    """Factors of du_m and conj(du_m) in dG_k from the dependence on the velocity."""
    minus = q[k - m] if k >= m else q[m - k].conjugate()
    factor = 1j * m * W * (0.5 if k == 0 else 1.0)  # the mean of the force is real
    return factor * minus, -factor * q[k + m]


@kernel
def _add_rate_by_frequency(pb, e, first, step, count, u, q, J, n):
    """Add the derivative of G_k by Omega at fixed displacements to column n of the Jacobian."""
    r = pb.M11.shape[0]
    for mk in range(count):
        k = first + mk * step
        total = 0j
        for ml in range(count):
            m = first + ml * step
            own = 0j
            for j in range(r):
                own += pb.directions[j, e] * u[m, j]
            minus, plus = _rate_entries(k, m, 1.0, q)
            total += minus * own + plus * own.conjugate()
        for i in range(r):
            row = 2 * (mk * r + i)
            J[row, n] += pb.directions[i, e] * total.real
            J[row + 1, n] += pb.directions[i, e] * total.imag
