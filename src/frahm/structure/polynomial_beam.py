"""Stiffness and mass of a beam in polynomials of high degree between its nodes.

On every segment the displacement is a cubic from displacement and rotation of both ends, plus bubbles whose second
derivatives are the Legendre polynomials P_2, P_3, ...: they and the cubics are orthogonal in bending energy, so that
the stiffness matrix is diagonal but for the nodes, and the eigenvalues of the inverse problem are accurate to rounding.
All matrices are exact: products of polynomials are integrated in Legendre coefficients.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre

from frahm.arrays import Floats
from frahm.structure.beam import Beam


def segment_basis(degree: int, half: float) -> tuple[Floats, Floats]:
    """Legendre coefficients (degree + 1, degree + 1) of a segment's functions, and of their second derivatives.

    Columns: displacement and rotation of the left end, of the right end, then degree - 3 bubbles. The segment has the
    half length `half`; derivatives are by the coordinate -1 ... 1 along it.
    """
    columns, bent = np.zeros((degree + 1, degree + 1)), np.zeros((degree - 1, degree + 1))
    hermite = np.array([[0.5, -0.75, 0, 0.25], [0.25, -0.25, -0.25, 0.25],
                        [0.5, 0.75, 0, -0.25], [-0.25, -0.25, 0.25, 0.25]])  # fmt: skip
    for j, powers in enumerate(hermite):
        columns[:4, j] = legendre.poly2leg(powers)
    for k in range(2, degree - 1):
        bubble = np.zeros(degree + 1)
        bubble[k + 2] = 1 / ((2 * k + 1) * (2 * k + 3))
        bubble[k] = -1 / ((2 * k + 1) * (2 * k + 3)) - 1 / ((2 * k + 1) * (2 * k - 1))
        bubble[k - 2] = 1 / ((2 * k + 1) * (2 * k - 1))
        columns[:, k + 2] = bubble * np.sqrt((2 * k + 1) / 2)
        bent[k, k + 2] = np.sqrt((2 * k + 1) / 2)
    columns[:, [1, 3]] *= half
    bent[:2, :4] = legendre.legder(columns[:4, :4], 2)
    return columns, bent


def matrices(beam: Beam, degree: int) -> tuple[Floats, Floats, list[np.ndarray]]:
    """K and M of the unknowns that are not held, and for each segment its rows (degree + 1,), -1 where held.

    Lengths are measured in lengths l of the beam, K in E I/l^3 and M in m l.
    """
    nodes = np.array(beam.nodes) / beam.length
    rows, free = _rows(beam, degree)
    K, M = np.zeros((free, free)), np.zeros((free, free))
    weight = 2 / (2 * np.arange(degree + 1) + 1)
    for segment, (a, b) in enumerate(pairwise(nodes)):
        half = 0.5 * (b - a)
        basis, bent = segment_basis(degree, half)
        k = bent.T * weight[:-2] @ bent / half**3
        m = basis.T * weight @ basis * half
        at = rows[segment]
        keep = at >= 0
        K[np.ix_(at[keep], at[keep])] += k[np.ix_(keep, keep)]
        M[np.ix_(at[keep], at[keep])] += m[np.ix_(keep, keep)]
    _add_points(beam, rows, K, M)
    return K, M, rows


def _rows(beam: Beam, degree: int) -> tuple[list[np.ndarray], int]:
    """Rows of the unknowns of every segment in the matrices, -1 where held, and the number of rows."""
    nodes = beam.nodes
    held = {support.at: (support.translation == np.inf, support.rotation == np.inf) for support in beam.supports}
    count = 0
    at_node = []
    for node in nodes:
        pair = []
        for fixed in held.get(node, (False, False)):
            pair.append(-1 if fixed else count)
            count += not fixed
        at_node.append(pair)
    rows = []
    for left, right in pairwise(at_node):
        rows.append(np.array([*left, *right, *range(count, count + degree - 3)]))
        count += degree - 3
    return rows, count


def _add_points(beam: Beam, rows: list[np.ndarray], K: Floats, M: Floats) -> None:
    """Springs of the supports and point masses."""
    nodes = list(beam.nodes)
    length = beam.length

    def unknown(at: float, which: int) -> int:
        node = nodes.index(float(at))
        return int(rows[node][which] if node < len(rows) else rows[-1][2 + which])

    for support in beam.supports:
        for which, spring in ((0, support.translation * length**3), (1, support.rotation * length)):
            row = unknown(support.at, which)
            if row >= 0:
                K[row, row] += spring / beam.bending_stiffness
    for point in beam.point_masses:
        row = unknown(point.at, 0)
        if row >= 0:
            M[row, row] += point.mass / (beam.mass_per_length * length)
