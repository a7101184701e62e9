"""Defining equations of saddle-node points in two parameters: the Jacobian of the orbit is singular."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.equations import Equations, row_weights


@dataclass
class FoldEquations(Equations):
    """Saddle-node points: R = 0 and g = 0, unknowns (X, q1, q2)."""

    border: tuple[Floats, Floats] = field(init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        J = self.orbit(self.start).J
        left, _, right = np.linalg.svd(row_weights(J)[:, None] * J)
        self.border = left[:, -1], right[-1]

    def residual(self, y: Floats) -> tuple[Floats, Floats]:
        """Residual (n + 1,) and Jacobian (n + 1, n + 2) in scaled unknowns."""
        n = self.n
        if min(self.axis_values(y)) <= 0:  # no system there: Newton's method is told to turn back
            return np.full(n + 1, np.nan), np.full((n + 1, n + 2), np.nan)
        orbit = self.orbit(y)
        weight = row_weights(orbit.J)
        b, c = self.border
        A = np.block([[weight[:, None] * orbit.J, b[:, None]], [c[None], np.zeros((1, 1))]])
        unit = np.zeros(n + 1)
        unit[n] = 1.0
        vg, wg = np.linalg.solve(A, unit), np.linalg.solve(A.T, unit)
        v, w = vg[:n], wg[:n] * weight
        gradient = np.append(
            -w @ orbit.curvature_matrix(v), [-w @ change.applied(orbit, v) for change in orbit.changes]
        )
        columns = np.column_stack([orbit.J, *(change.rate for change in orbit.changes)])
        scale = np.append(np.full(n, self.x_scale), self.scales)
        J = np.vstack([weight[:, None] * columns, gradient]) * scale
        R = np.append(weight * orbit.R, vg[n])
        rows = np.max(np.abs(J), axis=1)
        return R / rows, J / rows[:, None]
