"""Force laws as compiled code sees them: one table of numbers, one place where a law becomes a force.

Every law is a polynomial and a linear damper; further parts add to them, and the law's kind says which: 0 is the bare
polynomial, otherwise a sum of `SPRINGS`, `STOPS`, `FRICTION` and `WEIGHT`. The compiled functions take `z` and `w`
either as numbers or as `frahm.lanes` vectors; the table then holds, for every entry, one number or one of each lane. A
further part needs a number here, its entries in `pack_laws` and a branch in the three functions of parts.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from frahm.absorbers.law import Law
from frahm.absorbers.transverse_springs import TransverseSprings
from frahm.arrays import Floats
from frahm.compiled import kernel
from frahm.lanes import hyperbolic_tangent, larger, parameter, root

POLYNOMIAL, SPRINGS, STOPS, FRICTION, WEIGHT = 0, 1, 2, 4, 8


def pack_laws(laws: Sequence[Law]) -> tuple[NDArray[np.int64], Floats]:
    """Codes and numbers of force laws.

    Parameters
    ----------
    laws : sequence of force laws, length e

    Returns
    -------
    codes : ndarray of int, shape (e, 3)
        Kind of the law, its first entry in the table, and how many coefficients its polynomial has.
    table : ndarray, shape (t,)
        Per law: damping d [N s/m], then c_p ... c_1 [N/m^p ... N/m], highest power first as Horner's rule reads. If
        there are further parts: weight [N]; stiffness k [N/m], length L [m] and pretension T0 [N] of transverse
        springs; stiffness [N/m], gap [m] and depth [m] of stops; force [N] and inverse speed [s/m] of friction.
    """
    codes, table = np.zeros((len(laws), 3), dtype=np.int64), [0.0]
    for row, law in zip(codes, laws, strict=True):
        kind = POLYNOMIAL
        springs, stops, friction = (0.0, 1.0, 0.0), (0.0, 1.0, 1.0), (0.0, 1.0)
        if isinstance(law, TransverseSprings):
            kind += SPRINGS
            springs = law.spring_stiffness, law.length, law.pretension
        if law.stops is not None:
            kind += STOPS
            stops = law.stops.stiffness, law.stops.gap, law.stops.depth
        if law.friction is not None:
            kind += FRICTION
            friction = law.friction.force, 1.0 / law.friction.speed
        if law.weight != 0:
            kind += WEIGHT
        row[:] = kind, len(table), law.coefficients.size
        table += [law.damping, *law.coefficients[::-1]]
        if kind != POLYNOMIAL:
            table += [law.weight, *springs, *stops, *friction]
    return codes, np.array(table)


@kernel
def polynomial_force(start, count, table, z, w):
    """What `law_force` gives for a bare polynomial, for loops that have nothing else."""
    spring = parameter(table, start + 1, z)
    for k in range(start + 2, start + 1 + count):
        spring = spring * z + parameter(table, k, z)
    return spring * z + parameter(table, start, z) * w


@kernel
def law_force(kind, start, count, table, z, w):
    """Force g [N] of the law with the codes (kind, start, count) at displacement z [m] and velocity w [m/s]."""
    force = polynomial_force(start, count, table, z, w)
    if kind != POLYNOMIAL:
        force = force + _parts_force(kind, start + 1 + count, table, z, w)
    return force


@kernel
def polynomial_and_slopes(start, count, table, z, w):
    """What `law_force_and_slopes` gives for a bare polynomial, for loops that have nothing else."""
    spring = parameter(table, start + 1, z)
    slope = spring
    for k in range(start + 2, start + 1 + count):
        spring = spring * z + parameter(table, k, z)
        slope = slope * z + spring
    damping = parameter(table, start, z)
    return spring * z + damping * w, slope, damping


@kernel
def law_force_and_slopes(kind, start, count, table, z, w):
    """Force g [N], dg/dz [N/m] and dg/dw [N s/m] of the law with the codes (kind, start, count)."""
    force, slope, damping = polynomial_and_slopes(start, count, table, z, w)
    if kind != POLYNOMIAL:
        at = start + 1 + count
        by_z, by_w = _parts_slopes(kind, at, table, z, w)
        return force + _parts_force(kind, at, table, z, w), slope + by_z, damping + by_w
    return force, slope, damping


@kernel
def law_curvatures(kind, start, count, table, z, w):
    """Second derivatives d2g/dz2 [N/m^2] and d2g/dw2 [N s^2/m^2] of the law; the mixed one is zero for every law."""
    value = 0.0
    for k in range(count - 1):  # the table holds c_count first
        power = count - k
        value = value * z + power * (power - 1) * table[start + 1 + k]
    if kind == POLYNOMIAL:
        return value, 0.0
    at = start + 1 + count
    by_w = 0.0
    if kind & SPRINGS:
        k, length, pretension = table[at + 1], table[at + 2], table[at + 3]
        q = root(length * length + z * z)
        value += 6.0 * length * length * (k * length - pretension) * z / (q * q * q * q * q)
    if kind & STOPS:
        value += _stop_curvature(at, table, z) - _stop_curvature(at, table, -z)
    if kind & FRICTION:
        t = hyperbolic_tangent(w * table[at + 8])
        by_w = -2.0 * table[at + 7] * table[at + 8] * table[at + 8] * t * (1.0 - t * t)
    return value, by_w


@kernel
def _parts_force(kind, at, table, z, w):
    """Force of all parts beside the polynomial, whose numbers begin at `at`."""
    force = -1.0 * parameter(table, at, z)
    if kind & SPRINGS:
        k, length, pretension = (parameter(table, at + 1, z), parameter(table, at + 2, z), parameter(table, at + 3, z))
        square = z * z
        q = root(length * length + square)
        force = force + 2.0 * z / q * (k * square / (q + length) + pretension)
    if kind & STOPS:
        force = force + _stop_force(at, table, z) - _stop_force(at, table, -1.0 * z)
    if kind & FRICTION:
        force = force + parameter(table, at + 7, z) * hyperbolic_tangent(w * parameter(table, at + 8, z))
    return force


@kernel
def _parts_slopes(kind, at, table, z, w):
    """Derivatives of the parts' force by z and by w."""
    by_z, by_w = 0.0 * z, 0.0 * z
    if kind & SPRINGS:
        k, length, pretension = (parameter(table, at + 1, z), parameter(table, at + 2, z), parameter(table, at + 3, z))
        square, own = z * z, length * length
        q = root(own + square)
        cube = q * q * q
        stretch = k * square / (q + length) * (q * q + q * length + own) / cube
        by_z = by_z + 2.0 * (stretch + pretension * own / cube)
    if kind & STOPS:
        by_z = by_z + _stop_slope(at, table, z) + _stop_slope(at, table, -1.0 * z)
    if kind & FRICTION:
        rate = parameter(table, at + 8, z)
        t = hyperbolic_tangent(w * rate)
        by_w = by_w + parameter(table, at + 7, z) * rate * (1.0 - t * t)
    return by_z, by_w


@kernel
def _buffer(at, table, z):
    """How far the stop on the positive side is pressed, as a share of its depth between 0 and 1."""
    share = (z - parameter(table, at + 5, z)) / parameter(table, at + 6, z)
    return larger(1.0 - larger(1.0 - share, 0.0), 0.0)


@kernel
def _stop_force(at, table, z):
    depth = parameter(table, at + 6, z)
    r = _buffer(at, table, z)
    beyond = larger(z - parameter(table, at + 5, z) - depth, 0.0)
    return parameter(table, at + 4, z) * (depth * (r * r * r * (1.0 - 0.5 * r)) + beyond)


@kernel
def _stop_slope(at, table, z):
    r = _buffer(at, table, z)
    return parameter(table, at + 4, z) * (r * r * (3.0 - 2.0 * r))


@kernel
def _stop_curvature(at, table, z):
    r = _buffer(at, table, z)
    return table[at + 4] / table[at + 6] * (6.0 * r * (1.0 - r))
