"""Compiled arcs of the slow flow with their derivatives by start and frequency, for cycles of the slow flow.

The state is (Re X, Im X, Re Z, Im Z). An arc is integrated by DOP853 with the step chosen for the state; its 24 numbers
are six columns of four: the state, its derivatives by the four initial values, and by Omega.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.slow_flow.kernels import PAPER, coefficients
from frahm.slow_flow.motion import put_jacobian, slow_velocity
from frahm.time_integration import coefficients as dop853

STAGES = 12
MOST_STEPS = 400_000
_STEPS_OF_ARC = 4_000  # an arc of a cycle needs about a hundred; a bad guess of a cycle may be as stiff as it likes


def _weights(letter: str, row: int) -> list[float]:
    return [getattr(dop853, f"{letter}{row}_{j}", 0.0) for j in range(1, STAGES + 1)]


_A = np.array([_weights("A", row) for row in range(1, STAGES + 2)])  # row 13 holds the weights of the solution
_E5 = np.array(_weights("E", 5))
_E3 = _A[STAGES] - np.array(_weights("B", 3))


@kernel
def frequency_slope(form, omega, xi1, xi2, k1, rho2, F, kappa, W, X, Z):
    """Derivatives of X' and Z' by Omega [m]."""
    dX, dZ = slow_velocity(form, omega, xi1, xi2, k1, rho2, F, kappa, W, X, Z)
    return _slope_at(form, omega, xi1, xi2, k1, rho2, W, X, Z, dX, dZ)


@kernel
def velocities(form, omega, xi1, xi2, k1, rho2, F, kappa, W, states, found):
    """Time derivatives of states (M, 4) into `found` [m/s]."""
    for m in range(states.shape[0]):
        X, Z = complex(states[m, 0], states[m, 1]), complex(states[m, 2], states[m, 3])
        dX, dZ = slow_velocity(form, omega, xi1, xi2, k1, rho2, F, kappa, W, X, Z)
        found[m, 0], found[m, 1], found[m, 2], found[m, 3] = dX.real, dX.imag, dZ.real, dZ.imag


@kernel
def _slope_at(form, omega, xi1, xi2, k1, rho2, W, X, Z, dX, dZ):
    """`frequency_slope` where X' and Z' are known."""
    p, _, q, r, _, _, _ = coefficients(form, W, omega, xi1, xi2, k1, rho2)
    if form == PAPER:
        ap, ep = complex(-2.0 * omega, 0.0), 2.0 * rho2 * omega
        g1p, g2p, pp, qp = 0j, complex(0.0, xi2), 0j, 0j
    else:
        ap, ep = complex(-2.0 * W, xi1), 2.0 * rho2 * W
        g1p = complex(0.0, xi2)
        g2p, pp, qp = g1p, 2j, 2j * rho2
    slope = (g1p * Z - ap * X - pp * dX) / p
    return slope, (ep * (X + Z) - g2p * Z - qp * dX - q * slope - qp * dZ) / r


@kernel
def _derivative(form, omega, xi1, xi2, k1, rho2, F, kappa, W, y, columns, out, J):
    """Time derivative of the columns (4 columns numbers, row by row) into `out`; J is room for the Jacobian."""
    X, Z = complex(y[0], y[columns]), complex(y[2 * columns], y[3 * columns])
    dX, dZ = slow_velocity(form, omega, xi1, xi2, k1, rho2, F, kappa, W, X, Z)
    out[0], out[columns], out[2 * columns], out[3 * columns] = dX.real, dX.imag, dZ.real, dZ.imag
    if columns == 1:
        return
    put_jacobian(form, omega, xi1, xi2, k1, rho2, kappa, W, Z, J)
    for i in range(4):
        for c in range(1, columns):
            out[i * columns + c] = 0.0
        for j in range(4):
            for c in range(1, columns):
                out[i * columns + c] += J[i, j] * y[j * columns + c]
    sX, sZ = _slope_at(form, omega, xi1, xi2, k1, rho2, W, X, Z, dX, dZ)
    last = columns - 1
    out[last] += sX.real
    out[columns + last] += sX.imag
    out[2 * columns + last] += sZ.real
    out[3 * columns + last] += sZ.imag


@kernel
def _step(form, omega, xi1, xi2, k1, rho2, F, kappa, W, y, columns, h, k, new, J):
    """One step of length h into `new`; the stages into `k` (12, 4 columns)."""
    count = 4 * columns
    for stage in range(STAGES + 1):
        for i in range(count):
            new[i] = y[i]
        for j in range(stage if stage < STAGES else STAGES):
            a = h * _A[stage, j]
            if a != 0.0:
                for i in range(count):
                    new[i] += a * k[j, i]
        if stage < STAGES:
            _derivative(form, omega, xi1, xi2, k1, rho2, F, kappa, W, new, columns, k[stage], J)


@kernel
def _error(h, columns, k, size_x, size_z, tolerance):
    """Error of the state in a step in units of what is tolerated."""
    s5, s3 = 0.0, 0.0
    for i in range(4):
        e5, e3 = 0.0, 0.0
        for j in range(STAGES):
            e5 += _E5[j] * k[j, i * columns]
            e3 += _E3[j] * k[j, i * columns]
        scale = tolerance * (size_x if i < 2 else size_z)
        s5 += (e5 / scale) ** 2
        s3 += (e3 / scale) ** 2
    return abs(h) * s5 / math.sqrt(4.0 * (s5 + 0.01 * s3) + 1e-300)


@kernel
def arc(
    form, omega, xi1, xi2, k1, rho2, F, kappa, W, y, columns, duration, size_x, size_z, tolerance, most, times, states
):
    """Integrate y (4 columns numbers, in place) over `duration` [s]; the number of steps, -1 if `most` do not do.

    Step ends go into `times` (rows,) and `states` (rows, 4) as far as these reach.
    """
    k, new, J = np.empty((STAGES, 4 * columns)), np.empty(4 * columns), np.empty((4, 4))
    t, h, steps = 0.0, min(duration, 0.3 / W), 0
    kept = 0
    if times.size > 0:
        times[0] = 0.0
        for i in range(4):
            states[0, i] = y[i * columns]
        kept = 1
    while t < duration:
        h = min(h, duration - t)
        _step(form, omega, xi1, xi2, k1, rho2, F, kappa, W, y, columns, h, k, new, J)
        error = _error(h, columns, k, size_x, size_z, tolerance)
        if not math.isfinite(error) or h < 1e-12 * duration or steps > most:
            return -1
        if error <= 1.0:
            last = h >= duration - t
            t = duration if last else t + h
            for i in range(4 * columns):
                y[i] = new[i]
            steps += 1
            if kept < times.size:
                times[kept] = t
                for i in range(4):
                    states[kept, i] = y[i * columns]
                kept += 1
        h *= min(5.0, max(0.2, 0.9 * (error + 1e-300) ** -0.125))
    return steps


@kernel
def shoot(form, omega, xi1, xi2, k1, rho2, F, kappa, W, nodes, durations, size_x, size_z, tolerance, ends, maps):
    """Arcs from every node (m, 4): ends (m, 4), derivatives by start and Omega (m, 4, 5); whether all arrive."""
    y = np.empty(24)
    none, nowhere = np.empty(0), np.empty((0, 4))
    for m in range(nodes.shape[0]):
        for i in range(4):
            for c in range(6):
                y[6 * i + c] = 1.0 if c == i + 1 else 0.0
            y[6 * i] = nodes[m, i]
        steps = arc(
            form, omega, xi1, xi2, k1, rho2, F, kappa, W, y, 6, durations[m], size_x, size_z, tolerance,
            _STEPS_OF_ARC, none, nowhere,
        )  # fmt: skip
        if steps < 0:
            return False
        for i in range(4):
            ends[m, i] = y[6 * i]
            for c in range(5):
                maps[m, i, c] = y[6 * i + 1 + c]
    return True


@kernel
def _radial(form, omega, xi1, xi2, k1, rho2, F, kappa, W, y, which):
    """Square of |X| (0) or |Z| (1) and half its time derivative."""
    X, Z = complex(y[0], y[1]), complex(y[2], y[3])
    dX, dZ = slow_velocity(form, omega, xi1, xi2, k1, rho2, F, kappa, W, X, Z)
    u, du = (X, dX) if which == 0 else (Z, dZ)
    return u.real * u.real + u.imag * u.imag, u.real * du.real + u.imag * du.imag


@kernel
def envelope(form, omega, xi1, xi2, k1, rho2, F, kappa, W, times, states, out):
    """Smallest and largest |X|, smallest and largest |Z| on the way through step ends, located within the steps."""
    k, new, J = np.empty((STAGES, 4)), np.empty(4), np.empty((4, 4))
    for which in range(2):
        least, most = math.inf, 0.0
        for n in range(times.size - 1):
            size, a = _radial(form, omega, xi1, xi2, k1, rho2, F, kappa, W, states[n], which)
            _, b = _radial(form, omega, xi1, xi2, k1, rho2, F, kappa, W, states[n + 1], which)
            least, most = min(least, size), max(most, size)
            if a * b >= 0.0:
                continue
            lo, hi = 0.0, times[n + 1] - times[n]
            for _ in range(12):
                middle = (lo * b - hi * a) / (b - a)
                _step(form, omega, xi1, xi2, k1, rho2, F, kappa, W, states[n], 1, middle, k, new, J)
                size, f = _radial(form, omega, xi1, xi2, k1, rho2, F, kappa, W, new, which)
                if f * b < 0.0:
                    lo, a = hi, b
                else:
                    a *= 0.5
                hi, b = middle, f
                if f == 0.0 or abs(hi - lo) < 1e-9 * (times[n + 1] - times[n]):
                    break
            least, most = min(least, size), max(most, size)
        out[2 * which], out[2 * which + 1] = math.sqrt(least), math.sqrt(most)
