"""Largest responses, strokes and growth rates of many designs of several absorbers."""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.design.groups.answers import K, Q, is_linear
from frahm.design.groups.crossings import linear_response, responses
from frahm.design.groups.curves import curves, room_for

_SELDOM = 2  # frequencies of which one is asked for its slow flow


@kernel
def _growth(W, group, spring, damping, mode, squares, u, laws, matrix):
    """Largest growth rate [1/s] of the slow flow beside a response; minus infinity for a saddle.

    With w = u + z and the governing mode M of the structure: 2 i Omega M u' = -(K - M Omega^2 + i Omega C) u + sum g,
    2 i Omega m w' = m Omega^2 w - g, and dg = (k1 + i Omega c + 2 n') dz + n'' conj(dz).
    """
    omega, xi1, mass = mode
    n = group.shape[0]
    size = n + 1
    matrix[:] = 0.0
    turn = 1.0 / (2j * W)
    matrix[0, 0] = -turn * complex(omega * omega - W * W, W * xi1)
    for i in range(n):
        m, k1, _, damper, _ = group[i]
        N = squares[i]
        d = complex(spring * k1, W * damping * damper)
        wm = m * W * W
        k, q = laws[i, K], laws[i, Q]
        steady = (k + q * N) * N
        steep = (k + 2.0 * q * N) * N
        z = wm * u / (d - wm + steady)
        phase = z * z / max(N, 1e-300)
        same, other = d + steady + steep, steep * phase
        at = i + 1
        matrix[0, at] += turn * same / mass
        matrix[0, 0] -= turn * same / mass
        matrix[0, size + at] += turn * other / mass
        matrix[0, size] -= turn * other / mass
        matrix[at, at] = turn * (W * W - same / m)
        matrix[at, 0] = turn * same / m
        matrix[at, size + at] = -turn * other / m
        matrix[at, size] = turn * other / m
    for i in range(size):
        for j in range(size):
            matrix[size + i, size + j] = np.conj(matrix[i, j])
            matrix[size + i, j] = np.conj(matrix[i, size + j])
    growth, above = -math.inf, 0
    for value in np.linalg.eigvals(matrix):
        growth = max(growth, value.real)
        above += 1 if value.real > 0.0 else 0
    return -math.inf if above % 2 == 1 else growth


@kernel
def group_responses(frequency, a, u, b, x, absorber, mode, forces, designs, ratios, found, peaks):
    """As `kernels.screened`, for designs (D, N, 5) of N absorbers at one place.

    `frequency`, `a` and so on (R, W) are those of the first force; `forces` (F,) are factors on it, and `peaks`
    (D, F * R) has the rows of the first force, then of the next. `ratios` (N,) are motions of the absorbers over those
    they are screened with. The slow flow is asked at every `_SELDOM`th frequency.
    """
    R, W = frequency.shape
    N = designs.shape[1]
    work, matrix = room_for(N), np.empty((2 * N + 2, 2 * N + 2), np.complex128)
    hits, squares = np.empty((3**N * 4, 3)), np.empty((3**N * 4, N))
    low, top = np.min(forces) ** 2, np.max(forces) ** 2
    for at in range(designs.shape[0]):
        group = designs[at]
        linear = is_linear(group)
        stroke, growth = 0.0, -math.inf
        peaks[at] = 0.0
        for r in range(R):
            spring, damping = absorber[r]
            for j in range(W):
                free = u[r, j].real ** 2 + u[r, j].imag ** 2
                if free == 0.0:
                    continue
                W_j, a_j, number = frequency[r, j], a[r, j], 0
                if not linear:
                    number = curves(W_j, a_j, low * free, top * free, group, spring, damping, work)
                for f in range(forces.size):
                    level = forces[f] ** 2 * free
                    if linear:
                        count = linear_response(W_j, level, a_j, group, spring, damping, work[0], hits, squares)
                    else:
                        count = responses(number, level, a_j, work, hits, squares)
                    for hit in range(count):
                        total = complex(hits[hit, 1], hits[hit, 2])
                        motion = forces[f] * u[r, j] / (1.0 - a[r, j] * total)
                        size = abs(forces[f] * x[r, j] + b[r, j] * total * motion)
                        peaks[at, f * R + r] = max(peaks[at, f * R + r], size)
                        for i in range(N):
                            stroke = max(stroke, ratios[i] * math.sqrt(squares[hit, i]))
                        if j % _SELDOM == 0:
                            rate = _growth(
                                frequency[r, j], group, spring, damping, mode[r], squares[hit], motion, work[0], matrix
                            )
                            growth = max(growth, rate)
        found[at, 0], found[at, 1] = stroke, growth


@kernel
def group_amplitudes(frequency, a, u, b, x, absorber, designs, found):
    """As `kernels.amplitude_tables`, for designs (D, N, 5) of N absorbers at one place."""
    R, W = frequency.shape
    N = designs.shape[1]
    work = room_for(N)
    hits, squares = np.empty((3**N * 4, 3)), np.empty((3**N * 4, N))
    found[:] = 0.0
    for at in range(designs.shape[0]):
        linear = is_linear(designs[at])
        for r in range(R):
            spring, damping = absorber[r]
            for j in range(W):
                free = u[r, j].real ** 2 + u[r, j].imag ** 2
                if free == 0.0:
                    found[at, r, j] = abs(x[r, j])
                    continue
                if linear:
                    count = linear_response(
                        frequency[r, j], free, a[r, j], designs[at], spring, damping, work[0], hits, squares
                    )
                else:
                    number = curves(frequency[r, j], a[r, j], free, free, designs[at], spring, damping, work)
                    count = responses(number, free, a[r, j], work, hits, squares)
                for hit in range(count):
                    total = complex(hits[hit, 1], hits[hit, 2])
                    size = abs(x[r, j] + b[r, j] * total * u[r, j] / (1.0 - a[r, j] * total))
                    found[at, r, j] = max(found[at, r, j], size)
