"""One trajectory in a wind that changes: the lift follows it, or a wake oscillator does.

Dormand-Prince 8(5,3) as in `frahm.time_integration.stepper`, for one trajectory whose forcing is no function of the
time alone. The wind speed is linear between knots; no step crosses a knot, so that the order of the method is kept.

The state is (x_0 ... x_n-1, v_0 ... v_n-1, a, b). With a forced lift a is the phase of the shedding, the integral of
Omega dt [rad], and b rests; with a wake oscillator they are q and q'.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg

from frahm.absorbers.packed import law_force, pack_laws
from frahm.arrays import Floats
from frahm.compiled import kernel
from frahm.systems import System
from frahm.time_integration import coefficients as c

DONE, DIVERGED, STEP_LIMIT, STEP_TOO_SMALL = 0, 1, 2, 3
_STAGES = 12


def _row(stage: int) -> list[float]:
    return [getattr(c, f"A{stage}_{j}", 0.0) for j in range(1, _STAGES + 1)]


_A = np.array([_row(stage) for stage in range(1, _STAGES + 2)])  # the last row holds the weights of the solution
_C = np.array([0.0] + [getattr(c, f"C{stage}") for stage in range(2, _STAGES + 1)])
_E5 = np.array([getattr(c, f"E5_{j}", 0.0) for j in range(1, _STAGES + 1)])
_E3 = _A[_STAGES] - np.array([getattr(c, f"B3_{j}", 0.0) for j in range(1, _STAGES + 1)])
_SAFETY, _LEAST, _MOST = 0.8, 0.1, 6.0
_FIRST_STEP = 0.01  # of a natural period
_LARGEST_STEP = 0.5  # of a natural period
_SMALLEST_STEP = 1e-14  # of a natural period
_MEMORY = 0.8  # the size errors are measured by forgets by this factor a step
_LEAST_WAKE = 1e-3
_BOUND = 1e12


class Mechanics(NamedTuple):
    """A system as dense tables: -M^-1 [K C], directions of the elements, -M^-1 n, their laws, and M^-1 f."""

    linear: Any
    reach: Any
    inputs: Any
    codes: Any
    laws: Any
    forcing: Any


class Flow(NamedTuple):
    """What the wind does.

    `strouhal` and `lift` hold ln U and the value at the knots, shape (k, 2); Omega = turns U St [rad/s], and the force
    is pressure U^2 C_L cos(phase) times the forcing of the mechanics. With `wake` the force is
    pressure U^2 q - fluid_damping U v_0.
    """

    wake: bool
    turns: float
    pressure: float
    strouhal: Any
    lift: Any
    fluid_damping: float
    coupling: float  # of the pipe's acceleration [1/m]
    nonlinearity: float


def mechanics_of(system: System, forcing: Floats) -> Mechanics:
    """Tables of a system with the force on its coordinates [N] per unit of what the wind gives."""
    mass = scipy.linalg.cho_factor(system.mass)
    codes, laws = pack_laws([element.law for element in system.elements])
    reach = np.zeros((len(system.elements), system.size))
    for row, element in zip(reach, system.elements, strict=True):
        row[:] = element.direction
    inputs = -scipy.linalg.cho_solve(mass, reach.T).T if len(reach) else np.zeros_like(reach)
    linear = -scipy.linalg.cho_solve(mass, np.hstack([system.stiffness, system.damping]))
    return Mechanics(
        np.ascontiguousarray(linear), reach, np.ascontiguousarray(inputs), codes, laws,
        scipy.linalg.cho_solve(mass, np.asarray(forcing, dtype=float)),
    )  # fmt: skip


@kernel
def _at(table, log_speed):
    """Value of a table at ln U, linear between its rows and constant beyond them."""
    last = table.shape[0] - 1
    if log_speed <= table[0, 0] or last == 0:
        return table[0, 1]
    for i in range(last):
        if log_speed <= table[i + 1, 0]:
            share = (log_speed - table[i, 0]) / (table[i + 1, 0] - table[i, 0])
            return table[i, 1] + share * (table[i + 1, 1] - table[i, 1])
    return table[last, 1]


@kernel
def rate_of_change(mechanics, flow, speed, y, k):
    """Put the time derivative of the state `y` at a wind speed [m/s] into `k`."""
    n = mechanics.forcing.size
    log_speed = math.log(speed) if speed > 0.0 else -1e300
    shedding = flow.turns * speed * _at(flow.strouhal, log_speed)
    if flow.wake:
        push = flow.pressure * speed * speed * y[2 * n] - flow.fluid_damping * speed * y[n]
    else:
        push = flow.pressure * speed * speed * _at(flow.lift, log_speed) * math.cos(y[2 * n])
    for i in range(n):
        total = mechanics.forcing[i] * push
        for j in range(2 * n):
            total += mechanics.linear[i, j] * y[j]
        k[i], k[n + i] = y[n + i], total
    for e in range(mechanics.reach.shape[0]):
        z, w = 0.0, 0.0
        for j in range(n):
            z += mechanics.reach[e, j] * y[j]
            w += mechanics.reach[e, j] * y[n + j]
        kind, start, count = mechanics.codes[e, 0], mechanics.codes[e, 1], mechanics.codes[e, 2]
        force = law_force(kind, start, count, mechanics.laws, z, w)
        for i in range(n):
            k[n + i] += mechanics.inputs[e, i] * force
    if flow.wake:
        q, rate = y[2 * n], y[2 * n + 1]
        k[2 * n] = rate
        k[2 * n + 1] = (
            flow.coupling * k[n] - flow.nonlinearity * shedding * (q * q - 1.0) * rate - shedding * shedding * q
        )
    else:
        k[2 * n], k[2 * n + 1] = shedding, 0.0


@kernel
def _sizes(n, omega, y):
    """Size of the motion [m], of the velocities as displacements at omega, and of the wake."""
    motion, wake = 0.0, max(abs(y[2 * n]), abs(y[2 * n + 1]) / omega)
    for i in range(n):
        motion = max(motion, abs(y[i]), abs(y[n + i]) / omega)
    return motion, wake


@kernel
def _error(n, h, omega, k, motion, wake, is_wake):
    """Error of a step over the sizes, of a phase in radians: the book's blend of the estimates of order 5 and 3."""
    s5, s3 = 0.0, 0.0
    for i in range(2 * n + 2):
        e5, e3 = 0.0, 0.0
        for j in range(_STAGES):
            e5 += _E5[j] * k[j, i]
            e3 += _E3[j] * k[j, i]
        if i < n:
            weight = 1.0 / motion
        elif i < 2 * n:
            weight = 1.0 / (motion * omega)
        elif is_wake:
            weight = 1.0 / wake if i == 2 * n else 1.0 / (wake * omega)
        else:
            weight = 1.0
        s5 += (e5 * weight) ** 2
        s3 += (e3 * weight) ** 2
    return abs(h) * s5 / math.sqrt((s5 + 0.01 * s3) * (2 * n + 2) + 1e-280)


@kernel
def drive(mechanics, flow, knots, speeds, spacing, omega, least, tolerance, max_steps, state, samples):
    """Integrate from knots[0] on and sample every `spacing` seconds.

    `omega` [rad/s] and `least` [m] are the scales of the problem; `state` is replaced by the last one and row 0 of
    `samples` is the state it was. Returns the outcome, the number of samples taken and the accepted and rejected steps.
    """
    n, m = mechanics.forcing.size, state.size
    k, y, new = np.empty((_STAGES + 1, m)), state.copy(), np.empty(m)
    period = 2.0 * math.pi / omega
    begin, t, step = knots[0], knots[0], _FIRST_STEP * period
    samples[0] = y
    taken, segment, growth_limit, accepted, attempted = 1, 0, _MOST, 0, 0
    motion_memory, wake_memory = _sizes(n, omega, y)
    bound = _BOUND * max(least, motion_memory)
    while segment < knots.size - 2 and knots[segment + 1] <= t:
        segment += 1
    rate_of_change(mechanics, flow, speeds[0], y, k[0])
    while taken < samples.shape[0]:
        attempted += 1
        if attempted > max_steps:
            state[:] = y
            return STEP_LIMIT, taken, accepted, attempted - accepted
        sample_due = begin + taken * spacing
        knot_due = knots[segment + 1] if segment < knots.size - 2 else np.inf
        target = min(sample_due, knot_due)
        h = target - t if target - t <= 1.05 * step else step
        slope = (speeds[segment + 1] - speeds[segment]) / (knots[segment + 1] - knots[segment])
        first = speeds[segment] + slope * (t - knots[segment])
        for stage in range(1, _STAGES + 1):
            for i in range(m):
                total = 0.0
                for j in range(stage):
                    total += _A[stage, j] * k[j, i]
                new[i] = y[i] + h * total
            at = _C[stage] * h if stage < _STAGES else h
            rate_of_change(mechanics, flow, max(0.0, first + slope * at), new, k[stage])
        motion, wake = _sizes(n, omega, new)
        motion, wake = max(motion, motion_memory), max(wake, wake_memory)
        error = _error(n, h, omega, k, max(motion, least), max(wake, _LEAST_WAKE), flow.wake) / tolerance
        growth = _SAFETY / max(error, 1e-12) ** 0.125
        growth = min(growth_limit, max(_LEAST, growth)) if error <= 1e30 else _LEAST
        if not error <= 1.0:
            step, growth_limit = h * growth, 1.0
            if step < _SMALLEST_STEP * period:
                state[:] = y
                return (STEP_TOO_SMALL if math.isfinite(error) else DIVERGED), taken, accepted, attempted - accepted
            continue
        accepted += 1
        growth_limit = _MOST
        step = min(_LARGEST_STEP * period, h * growth if h >= step else max(step, h * growth))
        landed = h == target - t
        t = target if landed else t + h
        for i in range(m):
            y[i], k[0, i] = new[i], k[_STAGES, i]
        motion_memory, wake_memory = _MEMORY * motion, _MEMORY * wake
        if not motion <= bound:
            state[:] = y
            return DIVERGED, taken, accepted, attempted - accepted
        if landed and target == sample_due:
            samples[taken] = y
            taken += 1
        if landed and target == knot_due:
            segment += 1
    state[:] = y
    return DONE, taken, accepted, attempted - accepted


def table_of(knots: Sequence[float] | Floats, values: Sequence[float] | Floats) -> Floats:
    """Rows (ln U, value) for `Flow`."""
    return np.ascontiguousarray(np.column_stack([np.asarray(knots, dtype=float), np.asarray(values, dtype=float)]))
