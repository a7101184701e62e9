"""Newton's method on the harmonic balance, at fixed frequency or on a hyperplane across the response curve."""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel, separate_kernel
from frahm.continuation.dense import factorise, solve_factorised
from frahm.harmonic_balance.kernels import (
    fourier_tables,
    residual_and_jacobian,
    sample_count,
    unknowns,
)


@separate_kernel
def correct(pb, H, odd, y, normal, offset, x_scale, w_scale, co, si, J, A, pivots, tolerance, iterations):
    """Correct y = (X, Omega) onto the curve inside the hyperplane normal . (X/x_scale, Omega/w_scale) = offset.

    Returns (converged, truncation, size of the first step). A then holds the factors of the bordered Jacobian at the
    last but one iterate, in scaled unknowns, ready for the tangent.
    """
    n = unknowns(pb, H, odd)
    R = np.empty(n + 1)
    first = 0.0
    truncation = math.inf
    previous = math.inf
    for iteration in range(iterations):
        truncation = residual_and_jacobian(pb, H, odd, y[n], y, co, si, R, J)
        plane = -offset
        for j in range(n):
            plane += normal[j] * y[j] / x_scale
        plane += normal[n] * y[n] / w_scale
        for i in range(n):
            biggest = 0.0
            for j in range(n):
                A[i, j] = J[i, j] * x_scale
                biggest = max(biggest, abs(A[i, j]))
            A[i, n] = J[i, n] * w_scale
            biggest = max(biggest, abs(A[i, n]))
            scale = 1.0 / biggest if biggest > 0.0 else 1.0
            for j in range(n + 1):
                A[i, j] *= scale
            R[i] *= scale
        for j in range(n + 1):
            A[n, j] = normal[j]
        R[n] = plane
        if not factorise(A, pivots, n + 1):
            return False, truncation, first
        solve_factorised(A, pivots, n + 1, R)
        size = 0.0
        for j in range(n):
            size += R[j] * R[j]
            y[j] -= R[j] * x_scale
        size = math.sqrt(size + R[n] * R[n])
        y[n] -= R[n] * w_scale
        if not size < 1e3:
            return False, truncation, first
        if iteration == 0:
            first = size
        if size < tolerance:
            return True, truncation, first
        if iteration > 1 and size > 2.0 * previous:
            return False, truncation, first
        previous = size
    return False, truncation, first


@kernel
def tangent(A, pivots, n, old, t):
    """Unit tangent t (n + 1) from the factors of the bordered Jacobian, oriented along `old`."""
    for j in range(n):
        t[j] = 0.0
    t[n] = 1.0
    solve_factorised(A, pivots, n + 1, t)
    size, along = 0.0, 0.0
    for j in range(n + 1):
        size += t[j] * t[j]
        along += t[j] * old[j]
    size = math.copysign(math.sqrt(size), along)
    for j in range(n + 1):
        t[j] /= size
    return along / size


@kernel
def resize(pb, H, H_new, odd, y):
    """Move Omega behind the unknowns of another number of harmonics, new ones zero."""
    n, m = unknowns(pb, H, odd), unknowns(pb, H_new, odd)
    W = y[n]
    for j in range(min(n, m), max(n, m) + 1):
        y[j] = 0.0
    y[m] = W


@kernel
def solve_at(pb, odd, W, X, H, H_most, goal, iterations):
    """Newton at fixed Omega with harmonics added until the truncation is below `goal`.

    X holds the start and receives the solution (room for H_most). Returns (converged, H, truncation).
    """
    step = 2 if odd else 1
    size = unknowns(pb, H_most, odd) + 1
    J, A, pivots = np.empty((size, size)), np.empty((size, size)), np.empty(size, np.int64)
    normal, y = np.zeros(size), np.zeros(size)
    n = unknowns(pb, H, odd)
    y[:n] = X[:n]
    y[n] = W
    while True:
        n = unknowns(pb, H, odd)
        scale = 0.0
        for j in range(n):
            scale = max(scale, abs(y[j]))
        scale = scale if scale > 0.0 else 1.0
        normal[:n] = 0.0
        normal[n] = 1.0
        co, si = fourier_tables(H, odd, sample_count(pb, H, odd))
        done, truncation, _ = correct(pb, H, odd, y, normal, 1.0, scale, W, co, si, J, A, pivots, 1e-9, iterations)
        if not done or truncation < goal or H + 2 * step > H_most:
            X[:] = 0.0
            X[:n] = y[:n]
            return done, H, truncation
        resize(pb, H, H + 2 * step, odd, y)
        H += 2 * step
