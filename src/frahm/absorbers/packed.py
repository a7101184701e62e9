"""Force laws as compiled code sees them: one table of numbers, one place where a kind of law becomes a force.

The compiled functions take `z` and `w` either as numbers or as `frahm.lanes` vectors; the table then holds one
number or eight per entry. A further kind of law needs a code here, its row in `pack_laws` and a branch in the two
compiled functions.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from frahm.absorbers.laws import Polynomial
from frahm.arrays import Floats
from frahm.compiled import kernel
from frahm.lanes import parameter

POLYNOMIAL = 0


def pack_laws(laws: Sequence[Polynomial]) -> tuple[NDArray[np.int64], Floats]:
    """Codes and numbers of force laws.

    Parameters
    ----------
    laws : sequence of force laws, length e

    Returns
    -------
    codes : ndarray of int, shape (e, 3)
        Kind of the law, its first entry in the table, and how many coefficients it has.
    table : ndarray, shape (t,)
        Per polynomial: damping d [N s/m], then c_p ... c_1 [N/m^p ... N/m], highest power first as Horner's rule reads.
    """
    codes, table = np.zeros((len(laws), 3), dtype=np.int64), [0.0]
    for row, law in zip(codes, laws, strict=True):
        row[:] = POLYNOMIAL, len(table), law.coefficients.size
        table += [law.damping, *law.coefficients[::-1]]
    return codes, np.array(table)


@kernel
def law_force(kind, start, count, table, z, w):
    """Force g [N] of the law with the codes (kind, start, count) at displacement z [m] and velocity w [m/s]."""
    spring = parameter(table, start + 1, z)
    for k in range(start + 2, start + 1 + count):
        spring = spring * z + parameter(table, k, z)
    return spring * z + parameter(table, start, z) * w


@kernel
def law_force_and_slopes(kind, start, count, table, z, w):
    """Force g [N], dg/dz [N/m] and dg/dw [N s/m] of the law with the codes (kind, start, count)."""
    spring = parameter(table, start + 1, z)
    slope = spring
    for k in range(start + 2, start + 1 + count):
        spring = spring * z + parameter(table, k, z)
        slope = slope * z + spring
    damping = parameter(table, start, z)
    return spring * z + damping * w, slope, damping


@kernel
def law_curvature(kind, start, count, table, z):
    """Second derivative d2g/dz2 [N/m^2] of the law with the codes (kind, start, count) at displacement z [m]."""
    value = 0.0
    for k in range(count - 1):  # the table holds c_count first
        power = count - k
        value = value * z + power * (power - 1) * table[start + 1 + k]
    return value
