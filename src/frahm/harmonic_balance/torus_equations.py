"""Defining equations of Neimark-Sacker points in two parameters, with exact Jacobians.

The Hill matrix is singular at the exponent i nu, written as one complex scalar.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from frahm.arrays import Complexes, Floats
from frahm.harmonic_balance.equations import (
    Change,
    Equations,
    Linearisation,
    of_first,
    row_weights,
    stiffness_and_slope,
)


@dataclass
class TorusEquations(Equations):
    """Neimark-Sacker points: R = 0 and complex g = 0, unknowns (X, q1, q2, nu), nu scaled by `frequency`.

    The disturbance e^{i nu t} sum_k v_k e^{ik Omega t} uses the harmonics -H ... H of the orbit's parity.
    """

    border: tuple[Complexes, Complexes] = field(init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        A, _ = self._hill(self.orbit(self.start), float(self.start[self.n + 2] * self.frequency))
        left, _, right = np.linalg.svd(row_weights(A)[:, None] * A)
        self.border = left[:, -1], right[-1].conj()

    @property
    def waves(self) -> np.ndarray:
        """Harmonics k of the disturbance."""
        return np.arange(-self.H, self.H + 1, 2 if self.odd else 1)

    def residual(self, y: Floats) -> tuple[Floats, Floats]:
        """Residual (n + 2,) and Jacobian (n + 2, n + 3) in scaled unknowns."""
        n = self.n
        if min(self.axis_values(y)) <= 0:
            return np.full(n + 2, np.nan), np.full((n + 2, n + 3), np.nan)
        orbit = self.orbit(y)
        nu = float(y[n + 2] * self.frequency)
        A, parts = self._hill(orbit, nu)
        weight: Any = row_weights(A)
        b, c = self.border
        M = np.block([[weight[:, None] * A, b[:, None]], [c.conj()[None], np.zeros((1, 1))]])
        unit = np.zeros(len(A) + 1)
        unit[-1] = 1.0
        vg, wg = np.linalg.solve(M, unit), np.linalg.solve(M.T, unit)
        v, w = vg[:-1], wg[:-1] * weight
        gradient = np.append(
            self._by_orbit(orbit, nu, v, w),
            [-w @ self._by_axis(orbit, change, nu) @ v for change in orbit.changes],
        )
        by_exponent = self._diagonal([1j * dS for _, dS in parts])
        if orbit.problem.rates:
            by_exponent = by_exponent + 1j * self._slopes(orbit, orbit.derivatives[1])
        gradient = np.append(gradient, -w @ by_exponent @ v)
        columns = np.column_stack([orbit.J, *(change.rate for change in orbit.changes), np.zeros(n)])
        scale = np.concatenate([np.full(n, self.x_scale), self.scales, [self.frequency]])
        J = np.vstack([columns, gradient.real, gradient.imag]) * scale
        R = np.concatenate([orbit.R, [vg[-1].real, vg[-1].imag]])
        rows = np.max(np.abs(J), axis=1)
        return R / rows, J / rows[:, None]

    def _hill(self, orbit: Linearisation, nu: float) -> tuple[Complexes, list[tuple[Complexes, Complexes]]]:
        """Hill's matrix at the exponent i nu, and (S, dS/ds) at every wave."""
        pb = orbit.problem
        parts = [stiffness_and_slope(pb, 1j * (nu + k * orbit.W))[:2] for k in self.waves]
        A = self._diagonal([S for S, _ in parts]) + self._slopes(orbit, orbit.derivatives[0])
        if pb.rates:
            A = A + self._slopes(orbit, orbit.derivatives[1]) * self._per_wave(1j * (nu + self.waves * orbit.W), orbit)
        return A, parts

    def _per_wave(self, factors: Any, orbit: Linearisation) -> Any:
        """Row of a factor for every entry of a disturbance."""
        return np.repeat(factors, orbit.problem.M11.shape[0])

    def _slopes(self, orbit: Linearisation, slopes: Floats) -> Complexes:
        """Matrix of P_{k-l} for slopes (E, N) along the orbit."""
        D, E = orbit.problem.directions, self._waves_in_time()
        blocks = [np.einsum("aj,j,bj->ab", E.conj(), slope, E) / slope.size for slope in slopes]
        return np.asarray(sum(np.kron(block, np.outer(D[:, e], D[:, e])) for e, block in enumerate(blocks)))

    def _waves_in_time(self) -> Complexes:
        N = self.tables[0].shape[1]
        tau = (math.pi if self.odd else 2 * math.pi) * np.arange(N) / N
        return np.asarray(np.exp(1j * self.waves[:, None] * tau))

    def _by_orbit(self, orbit: Linearisation, nu: float, v: Complexes, w: Complexes) -> Complexes:
        """-w A_X v over the orbit's unknowns (n,)."""
        D, E = orbit.problem.directions, self._waves_in_time()
        r = D.shape[0]
        N = E.shape[1]
        co, si = self.tables
        out = np.zeros((len(self.harmonics), r, 2), complex)
        for e, (curvature, bend) in enumerate(zip(*orbit.derivatives[2:], strict=True)):
            own = v.reshape(-1, r) @ D[:, e]
            felt, pushed = own @ E, (w.reshape(-1, r) @ D[:, e]) @ E.conj()
            density = curvature * felt * pushed / N
            for m, k in enumerate(self.harmonics):
                out[m, :, 0] -= D[:, e] * (density @ co[k])
                out[m, :, 1] += D[:, e] * (density @ si[k])
            if orbit.problem.rates:
                density = bend * ((1j * (nu + self.waves * orbit.W) * own) @ E) * pushed / N
                for m, k in enumerate(self.harmonics):
                    out[m, :, 0] += k * orbit.W * D[:, e] * (density @ si[k])
                    out[m, :, 1] += k * orbit.W * D[:, e] * (density @ co[k])
        if not self.odd:
            out[0, :, 1] = 0.0
        return out.ravel()

    def _by_axis(self, orbit: Linearisation, change: Change, nu: float) -> Complexes:
        """Derivative of Hill's matrix by one axis."""
        out = self._diagonal([change.block(1j * (nu + k * orbit.W), k) for k in self.waves])
        if change.law is not None:
            out = out + self._slopes(orbit, of_first(change.law.stiffness(orbit.z[0]), orbit.z))
        if change.stiffness is None and orbit.problem.rates:
            _, rate, _, bend = orbit.derivatives
            waves = self.waves
            out = out + self._slopes(orbit, rate) * self._per_wave(1j * waves, orbit)
            bent = self._slopes(orbit, bend * orbit.w / orbit.W)
            out = out + bent * self._per_wave(1j * (nu + waves * orbit.W), orbit)
        return out

    def _diagonal(self, blocks: list[Complexes]) -> Complexes:
        r = blocks[0].shape[0]
        out = np.zeros((len(blocks) * r, len(blocks) * r), complex)
        for a, block in enumerate(blocks):
            out[a * r : (a + 1) * r, a * r : (a + 1) * r] = block
        return out
