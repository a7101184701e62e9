"""One Dormand-Prince step of a trajectory in every lane at a time.

A lane holds one trajectory with its own step, phase and system. The state of a block is flat: component i of lane l at
LANES i + l, displacements first, then velocities; m numbers in all. `k` holds the stages one after the other, m numbers
each, `h` is the step in seconds and `turns` the step in periods of the forcing. Arrays come as addresses.

Method and step control: Hairer, Norsett and Wanner (1993), doi 10.1007/978-3-540-78862-1, sections II.4 and II.10.
"""

from __future__ import annotations

from typing import Any

from numba.core import types
from numba.extending import overload

from frahm.absorbers.packed import law_force, polynomial_force
from frahm.compiled import kernel
from frahm.lanes import LANES, cos_turns, integer, load, magnitude, maximum, spread, square_root, store
from frahm.time_integration import coefficients as c
from frahm.time_integration.packed_system import GeneralStructure

_C = (
    0.0, 0.0, c.C2, c.C3, c.C4, c.C5, c.C6, c.C7, c.C8, c.C9, c.C10, c.C11, c.C12, c.C13, c.C14, c.C15, c.C16,
)  # fmt: skip
_TINY = 1e-140  # its square must not underflow: no motion, no error


def _element_force(structure: Any, kind: int, start: int, count: int, table: Any, z: Any, w: Any) -> Any:
    """Force of an element; which laws there are is known when the code is compiled."""
    raise NotImplementedError


@overload(_element_force)
def _compiled_element_force(structure, kind, start, count, table, z, w):
    if isinstance(structure, types.BaseNamedTuple) and structure.instance_class is GeneralStructure:
        return lambda structure, kind, start, count, table, z, w: law_force(kind, start, count, table, z, w)
    return lambda structure, kind, start, count, table, z, w: polynomial_force(start, count, table, z, w)


@kernel
def derivative(structure, numbers, turns, y, k):
    """Put the time derivative of the state `y` at forcing phase `turns` [turns] into `k`."""
    half = structure.size * LANES
    drive = cos_turns(turns)
    for row in range(structure.size):
        i = row * LANES
        store(k, i, load(y, half + i))
        total = drive * load(numbers.forcing, i)
        for e in range(integer(structure.linear_start, row), integer(structure.linear_start, row + 1)):
            total = total + load(numbers.linear, e * LANES) * load(y, integer(structure.linear_column, e))
        store(k, half + i, total)
    for element in range(structure.elements):
        z, w = spread(0.0), spread(0.0)
        for e in range(integer(structure.reach_start, element), integer(structure.reach_start, element + 1)):
            direction, source = load(numbers.reach, e * LANES), integer(structure.reach_column, e)
            z = z + direction * load(y, source)
            w = w + direction * load(y, half + source)
        kind, start, count = (
            integer(structure.laws, 3 * element), integer(structure.laws, 3 * element + 1),
            integer(structure.laws, 3 * element + 2),
        )  # fmt: skip
        force = _element_force(structure, kind, start, count, numbers.law, z, w)
        for e in range(integer(structure.input_start, element), integer(structure.input_start, element + 1)):
            into = half + integer(structure.input_row, e)
            store(k, into, load(k, into) + load(numbers.input, e * LANES) * force)


@kernel
def _stage_state(stage, m, h, start, k, y):
    # fmt: off
    if stage == 2:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (c.A2_1 * load(k, i)))
    elif stage == 3:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (c.A3_1 * load(k, i) + c.A3_2 * load(k, m + i)))
    elif stage == 4:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (c.A4_1 * load(k, i) + c.A4_3 * load(k, 2 * m + i)))
    elif stage == 5:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A5_1 * load(k, i) + c.A5_3 * load(k, 2 * m + i) + c.A5_4 * load(k, 3 * m + i)
            ))
    elif stage == 6:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A6_1 * load(k, i) + c.A6_4 * load(k, 3 * m + i) + c.A6_5 * load(k, 4 * m + i)
            ))
    elif stage == 7:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A7_1 * load(k, i) + c.A7_4 * load(k, 3 * m + i) + c.A7_5 * load(k, 4 * m + i)
                + c.A7_6 * load(k, 5 * m + i)
            ))
    elif stage == 8:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A8_1 * load(k, i) + c.A8_4 * load(k, 3 * m + i) + c.A8_5 * load(k, 4 * m + i)
                + c.A8_6 * load(k, 5 * m + i) + c.A8_7 * load(k, 6 * m + i)
            ))
    elif stage == 9:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A9_1 * load(k, i) + c.A9_4 * load(k, 3 * m + i) + c.A9_5 * load(k, 4 * m + i)
                + c.A9_6 * load(k, 5 * m + i) + c.A9_7 * load(k, 6 * m + i) + c.A9_8 * load(k, 7 * m + i)
            ))
    elif stage == 10:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A10_1 * load(k, i) + c.A10_4 * load(k, 3 * m + i) + c.A10_5 * load(k, 4 * m + i)
                + c.A10_6 * load(k, 5 * m + i) + c.A10_7 * load(k, 6 * m + i) + c.A10_8 * load(k, 7 * m + i)
                + c.A10_9 * load(k, 8 * m + i)
            ))
    elif stage == 11:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A11_1 * load(k, i) + c.A11_4 * load(k, 3 * m + i) + c.A11_5 * load(k, 4 * m + i)
                + c.A11_6 * load(k, 5 * m + i) + c.A11_7 * load(k, 6 * m + i) + c.A11_8 * load(k, 7 * m + i)
                + c.A11_9 * load(k, 8 * m + i) + c.A11_10 * load(k, 9 * m + i)
            ))
    elif stage == 12:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A12_1 * load(k, i) + c.A12_4 * load(k, 3 * m + i) + c.A12_5 * load(k, 4 * m + i)
                + c.A12_6 * load(k, 5 * m + i) + c.A12_7 * load(k, 6 * m + i) + c.A12_8 * load(k, 7 * m + i)
                + c.A12_9 * load(k, 8 * m + i) + c.A12_10 * load(k, 9 * m + i) + c.A12_11 * load(k, 10 * m + i)
            ))
    elif stage == 13:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A13_1 * load(k, i) + c.A13_6 * load(k, 5 * m + i) + c.A13_7 * load(k, 6 * m + i)
                + c.A13_8 * load(k, 7 * m + i) + c.A13_9 * load(k, 8 * m + i) + c.A13_10 * load(k, 9 * m + i)
                + c.A13_11 * load(k, 10 * m + i) + c.A13_12 * load(k, 11 * m + i)
            ))
    elif stage == 14:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A14_1 * load(k, i) + c.A14_7 * load(k, 6 * m + i) + c.A14_8 * load(k, 7 * m + i)
                + c.A14_9 * load(k, 8 * m + i) + c.A14_10 * load(k, 9 * m + i) + c.A14_11 * load(k, 10 * m + i)
                + c.A14_12 * load(k, 11 * m + i) + c.A14_13 * load(k, 12 * m + i)
            ))
    elif stage == 15:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A15_1 * load(k, i) + c.A15_6 * load(k, 5 * m + i) + c.A15_7 * load(k, 6 * m + i)
                + c.A15_8 * load(k, 7 * m + i) + c.A15_11 * load(k, 10 * m + i) + c.A15_12 * load(k, 11 * m + i)
                + c.A15_13 * load(k, 12 * m + i) + c.A15_14 * load(k, 13 * m + i)
            ))
    elif stage == 16:
        for i in range(0, m, LANES):
            store(y, i, load(start, i) + h * (
                c.A16_1 * load(k, i) + c.A16_6 * load(k, 5 * m + i) + c.A16_7 * load(k, 6 * m + i)
                + c.A16_8 * load(k, 7 * m + i) + c.A16_9 * load(k, 8 * m + i) + c.A16_13 * load(k, 12 * m + i)
                + c.A16_14 * load(k, 13 * m + i) + c.A16_15 * load(k, 14 * m + i)
            ))
    # fmt: on


@kernel
def run_stages(structure, numbers, first, last, phase, turns, h, start, k, y):
    """Stages `first` to `last` of a step from `start` at `phase` [turns]; `y` ends as the state of the last of them."""
    m = 2 * structure.size * LANES
    for stage in range(first, last + 1):
        _stage_state(stage, m, h, start, k, y)
        derivative(structure, numbers, phase + _C[stage] * turns, y, k + 8 * m * (stage - 1))


@kernel
def sizes(m, y):
    """Largest displacement and largest velocity of a state, per lane."""
    half = m // 2
    x, v = magnitude(load(y, 0)), magnitude(load(y, half))
    for i in range(LANES, half, LANES):
        x, v = maximum(x, magnitude(load(y, i))), maximum(v, magnitude(load(y, half + i)))
    return x, v


@kernel
def error_estimate(m, h, k, x_scale, v_scale):
    """Error of a step in units of the scales: the book's blend of the estimates of order 5 and 3, which is O(h^8)."""
    x5, x3, v5, v3 = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    half = m // 2
    for i in range(0, m, LANES):
        # fmt: off
        e5 = (
            c.E5_1 * load(k, i) + c.E5_6 * load(k, 5 * m + i) + c.E5_7 * load(k, 6 * m + i)
            + c.E5_8 * load(k, 7 * m + i) + c.E5_9 * load(k, 8 * m + i) + c.E5_10 * load(k, 9 * m + i)
            + c.E5_11 * load(k, 10 * m + i) + c.E5_12 * load(k, 11 * m + i)
        )
        e3 = (
            (c.A13_1 - c.B3_1) * load(k, i) + c.A13_6 * load(k, 5 * m + i) + c.A13_7 * load(k, 6 * m + i)
            + c.A13_8 * load(k, 7 * m + i) + (c.A13_9 - c.B3_9) * load(k, 8 * m + i)
            + c.A13_10 * load(k, 9 * m + i) + c.A13_11 * load(k, 10 * m + i)
            + (c.A13_12 - c.B3_12) * load(k, 11 * m + i)
        )
        # fmt: on
        if i < half:
            x5, x3 = x5 + e5 * e5, x3 + e3 * e3
        else:
            v5, v3 = v5 + e5 * e5, v3 + e3 * e3
    x_weight, v_weight = 1.0 / (x_scale + _TINY), 1.0 / (v_scale + _TINY)
    x_weight, v_weight = x_weight * x_weight, v_weight * v_weight
    s5, s3 = x5 * x_weight + v5 * v_weight, x3 * x_weight + v3 * v_weight
    count = 1.0 * (m // LANES)
    return h * s5 / square_root((s5 + 0.01 * s3) * count + _TINY)


@kernel
def dense_coefficients(m, h, start, end, k, dense):
    """Polynomial of order 7 over the step (needs all 16 stages): eight coefficients of m numbers each, see `blend`."""
    for i in range(0, m, LANES):
        first, change = load(start, i), load(end, i) - load(start, i)
        initial, final = h * load(k, i), h * load(k, 12 * m + i)
        # Stores last: before a store that might overlap them, every stage would be read again.
        # fmt: off
        d4 = h * (
            c.D4_1 * load(k, i) + c.D4_6 * load(k, 5 * m + i) + c.D4_7 * load(k, 6 * m + i)
            + c.D4_8 * load(k, 7 * m + i) + c.D4_9 * load(k, 8 * m + i) + c.D4_10 * load(k, 9 * m + i)
            + c.D4_11 * load(k, 10 * m + i) + c.D4_12 * load(k, 11 * m + i) + c.D4_13 * load(k, 12 * m + i)
            + c.D4_14 * load(k, 13 * m + i) + c.D4_15 * load(k, 14 * m + i) + c.D4_16 * load(k, 15 * m + i)
        )
        d5 = h * (
            c.D5_1 * load(k, i) + c.D5_6 * load(k, 5 * m + i) + c.D5_7 * load(k, 6 * m + i)
            + c.D5_8 * load(k, 7 * m + i) + c.D5_9 * load(k, 8 * m + i) + c.D5_10 * load(k, 9 * m + i)
            + c.D5_11 * load(k, 10 * m + i) + c.D5_12 * load(k, 11 * m + i) + c.D5_13 * load(k, 12 * m + i)
            + c.D5_14 * load(k, 13 * m + i) + c.D5_15 * load(k, 14 * m + i) + c.D5_16 * load(k, 15 * m + i)
        )
        d6 = h * (
            c.D6_1 * load(k, i) + c.D6_6 * load(k, 5 * m + i) + c.D6_7 * load(k, 6 * m + i)
            + c.D6_8 * load(k, 7 * m + i) + c.D6_9 * load(k, 8 * m + i) + c.D6_10 * load(k, 9 * m + i)
            + c.D6_11 * load(k, 10 * m + i) + c.D6_12 * load(k, 11 * m + i) + c.D6_13 * load(k, 12 * m + i)
            + c.D6_14 * load(k, 13 * m + i) + c.D6_15 * load(k, 14 * m + i) + c.D6_16 * load(k, 15 * m + i)
        )
        d7 = h * (
            c.D7_1 * load(k, i) + c.D7_6 * load(k, 5 * m + i) + c.D7_7 * load(k, 6 * m + i)
            + c.D7_8 * load(k, 7 * m + i) + c.D7_9 * load(k, 8 * m + i) + c.D7_10 * load(k, 9 * m + i)
            + c.D7_11 * load(k, 10 * m + i) + c.D7_12 * load(k, 11 * m + i) + c.D7_13 * load(k, 12 * m + i)
            + c.D7_14 * load(k, 13 * m + i) + c.D7_15 * load(k, 14 * m + i) + c.D7_16 * load(k, 15 * m + i)
        )
        # fmt: on
        store(dense, i, first)
        store(dense, m + i, change)
        store(dense, 2 * m + i, initial - change)
        store(dense, 3 * m + i, change - final - (initial - change))
        store(dense, 4 * m + i, d4)
        store(dense, 5 * m + i, d5)
        store(dense, 6 * m + i, d6)
        store(dense, 7 * m + i, d7)


@kernel
def blend(s, d0, d1, d2, d3, d4, d5, d6, d7):
    """Dense output at the fraction s of a step."""
    r = 1.0 - s
    return d0 + s * (d1 + r * (d2 + s * (d3 + r * (d4 + s * (d5 + r * (d6 + s * d7))))))
