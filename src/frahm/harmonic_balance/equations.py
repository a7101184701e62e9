"""Defining equations of saddle-node and Neimark-Sacker points in two parameters, with exact Jacobians.

A saddle-node is R = 0 with a singular Jacobian, written as the one scalar g of a bordered system; a Neimark-Sacker
point is R = 0 with a singular Hill matrix at the exponent i nu, written as one complex scalar. The derivatives of g
need second derivatives of the forces, which are taken on the same time samples. No force has a mixed one.

Minimally extended (bordered) systems: Govaerts (2000), doi 10.1137/1.9780898719543.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from frahm.absorbers import Law
from frahm.absorbers.packed import law_curvatures, law_force_and_slopes
from frahm.arrays import Complexes, Floats
from frahm.compiled import kernel
from frahm.harmonic_balance.condensation import CondensedChange, Problem, condense, coordinates, unknowns
from frahm.harmonic_balance.kernels import (
    add_rates,
    add_slopes,
    add_velocity,
    fourier_tables,
    harmonics_of,
    residual_and_jacobian,
    sample_count,
    stiffness,
)
from frahm.systems import System, derivative_of, with_parameters

FREQUENCY = "frequency"


@kernel
def _motion(pb, H, odd, W, X, co, si, z, w):
    """Samples z and w (E, N) of the elements' displacements and velocities for an unknown vector X."""
    r = pb.M11.shape[0]
    first, step = (1, 2) if odd else (0, 1)
    u = np.empty((H + 5, r), np.complex128)
    harmonics_of(pb, H, odd, X, u)
    z[:] = 0.0
    w[:] = 0.0
    for e in range(z.shape[0]):
        add_velocity(pb, e, H, odd, W, u, co, si, w[e])
        for k in range(first, H + 1, step):
            for i in range(r):
                a = pb.directions[i, e]
                for j in range(z.shape[1]):
                    z[e, j] += a * (u[k, i].real * co[k, j] - u[k, i].imag * si[k, j])


@kernel
def _derivatives(pb, z, w, out):
    """dg/dz, dg/dw, d2g/dz2 and d2g/dw2 into out (4, E, N) at the samples z, w (E, N)."""
    for e in range(z.shape[0]):
        code = pb.codes[e]
        for j in range(z.shape[1]):
            _, out[0, e, j], out[1, e, j] = law_force_and_slopes(code[0], code[1], code[2], pb.table, z[e, j], w[e, j])
            out[2, e, j], out[3, e, j] = law_curvatures(code[0], code[1], code[2], pb.table, z[e, j], w[e, j])


@kernel
def _matrix_of_slopes(pb, H, odd, W, slopes, by_velocity, J):
    """Add to J (n, n) the matrix that slopes (E, N) along the orbit give: of displacements, or of velocities."""
    N = slopes.shape[1]
    span = math.pi if odd else 2.0 * math.pi
    first, step = (1, 2) if odd else (0, 1)
    count = (H + 1) // 2 if odd else H + 1
    for e in range(slopes.shape[0]):
        p = np.zeros(2 * H + 1, np.complex128)
        for m in range(0, 2 * H + 1, step):
            total = 0j
            for j in range(N):
                tau = span * j / N
                total += slopes[e, j] * complex(math.cos(m * tau), -math.sin(m * tau))
            p[m] = total / N
        if by_velocity:
            add_rates(pb, e, first, step, count, W, p, J)
        else:
            add_slopes(pb, e, first, step, count, p, J)


@dataclass
class Equations:
    """What both kinds of points share: residual and Jacobian of the orbit in (X, q1, q2).

    Unknowns are scaled: X by `x_scale`, the axes by `scales`. `frequency` is Omega [rad/s] where it is no axis.
    """

    system: System
    axes: tuple[str, str]
    frequency: float
    H: int
    odd: bool
    x_scale: float
    scales: tuple[float, float]
    problem: Problem = field(init=False)
    tables: tuple[Floats, Floats] = field(init=False)
    T: Floats = field(init=False)

    def __post_init__(self) -> None:
        self.problem = condense(self.system)
        self.T = coordinates(self.system)[0]
        self.tables = fourier_tables(self.H, self.odd, sample_count(self.problem, self.H, self.odd))

    @property
    def n(self) -> int:
        """Number of unknowns of the orbit."""
        return int(unknowns(self.problem, self.H, self.odd))

    @property
    def harmonics(self) -> range:
        """Harmonics of the orbit."""
        return range(1, self.H + 1, 2) if self.odd else range(self.H + 1)

    def axis_values(self, y: Floats) -> tuple[float, float]:
        """Values of both axes at a scaled point."""
        return float(y[self.n] * self.scales[0]), float(y[self.n + 1] * self.scales[1])

    def frequency_at(self, y: Floats) -> float:
        """Omega [rad/s] at a scaled point."""
        values = dict(zip(self.axes, self.axis_values(y), strict=True))
        return values.get(FREQUENCY, self.frequency)

    def system_at(self, y: Floats) -> System:
        """The system with the parameters of a scaled point."""
        values = dict(zip(self.axes, self.axis_values(y), strict=True))
        values.pop(FREQUENCY, None)
        return with_parameters(self.system, **values)

    def orbit(self, y: Floats) -> Orbit:
        """Residual, Jacobian and derivatives by both axes at a scaled point."""
        system, W, X = self.system_at(y), self.frequency_at(y), np.ascontiguousarray(y[: self.n] * self.x_scale)
        pb = condense(system)
        n = self.n
        R, J = np.empty(n + 1), np.empty((n + 1, n + 1))
        truncation = residual_and_jacobian(pb, self.H, self.odd, W, X, *self.tables, R, J)
        z, w, derivatives = self._along(pb, W, X)
        changes = []
        for axis in self.axes:
            if axis == FREQUENCY:
                changes.append(Change(self, pb, W, J[:n, n].copy(), None, None))
                continue
            derivative = derivative_of(system, self.system, axis)
            condensed = CondensedChange(system, derivative, self.T, pb.M11.shape[0])
            rate = self._by_parameter(X, {k: condensed.at(1j * k * W) for k in self.harmonics})
            if derivative.law is not None:
                rate = rate + self.projected(pb, _of_first(derivative.law.force(z[0]), z))
            changes.append(Change(self, pb, W, rate, condensed, derivative.law))
        along = z, w, derivatives
        return Orbit(self, pb, W, X, R[:n].copy(), J[:n, :n].copy(), (changes[0], changes[1]), float(truncation), along)

    def _along(self, pb: Problem, W: float, X: Floats) -> tuple[Floats, Floats, Floats]:
        """Samples z, w (E, N) along an orbit and the derivatives (4, E, N) of the forces there."""
        z, w = self.motion(pb, W, X)
        out = np.empty((4, *z.shape))
        _derivatives(pb, z, w, out)
        return z, w, out

    def motion(self, pb: Problem, W: float, X: Floats) -> tuple[Floats, Floats]:
        """Samples (E, N) of the elements' displacements and velocities for an unknown vector."""
        z = np.empty((pb.directions.shape[1], self.tables[0].shape[1]))
        w = np.empty_like(z)
        _motion(pb, self.H, self.odd, W, np.ascontiguousarray(X), *self.tables, z, w)
        return z, w

    def projected(self, pb: Problem, samples: Floats) -> Floats:
        """What forces with the samples (E, N) on the elements contribute to the residual (n,)."""
        co, si = self.tables
        rows = list(self.harmonics)
        factor = np.where(np.array(rows) == 0, 1.0, 2.0)[:, None, None] / samples.shape[1]
        parts = np.stack([samples @ co[rows].T, -samples @ si[rows].T])  # (2, E, harmonics)
        return np.asarray(factor * np.einsum("re,peh->hrp", pb.directions, parts)).ravel()

    def _by_parameter(self, X: Floats, blocks: dict[int, tuple[Complexes, Complexes]]) -> Floats:
        r = self.problem.M11.shape[0]
        out = np.zeros(self.n)
        for m, k in enumerate(self.harmonics):
            u = X[2 * r * m : 2 * r * (m + 1)].reshape(r, 2) @ np.array([1, 1j])
            dS, dF = blocks[k]
            value = dS @ u - (dF if k == 1 else 0)
            out[2 * r * m : 2 * r * (m + 1)] = np.column_stack([value.real, value.imag]).ravel()
        return out

    def real_blocks(self, blocks: dict[int, Complexes]) -> Floats:
        """Block-diagonal real matrix of complex blocks (r, r), one for each harmonic."""
        r = self.problem.M11.shape[0]
        out = np.zeros((self.n, self.n))
        for m, k in enumerate(self.harmonics):
            B = blocks[k]
            real = np.zeros((2 * r, 2 * r))
            real[::2, ::2], real[::2, 1::2], real[1::2, ::2], real[1::2, 1::2] = B.real, -B.imag, B.imag, B.real
            if k == 0:
                real[1::2] = 0.0
            out[2 * r * m : 2 * r * (m + 1), 2 * r * m : 2 * r * (m + 1)] = real
        return out


@dataclass
class Change:
    """How the orbit's equations change along one axis; `stiffness` is None for the frequency.

    `law` is the derivative of the first nonlinear element's law, if it changes.
    """

    equations: Equations
    problem: Problem
    W: float
    rate: Floats
    stiffness: CondensedChange | None
    law: Law | None

    def block(self, s: complex, k: complex) -> Complexes:
        """Derivative of S(s) (r, r) at s = lam + ik Omega by this axis."""
        if self.stiffness is None:
            return 1j * k * _stiffness(self.problem, s)[1]
        return self.stiffness.at(s)[0]

    def applied(self, orbit: Orbit, v: Floats) -> Floats:
        """Derivative of J v by this axis at fixed X and v."""
        eq, pb = self.equations, self.problem
        out = eq.real_blocks({k: self.block(1j * k * self.W, k) for k in eq.harmonics}) @ v
        if self.law is None and not (self.stiffness is None and pb.rates):
            return np.asarray(out)
        z, w = eq.motion(pb, self.W, v)
        samples = np.zeros_like(z)
        if self.law is not None:
            samples[0] = self.law.stiffness(orbit.z[0]) * z[0]
        if self.stiffness is None:  # velocities are proportional to the frequency
            _, rate, _, bend = orbit.derivatives
            samples += (rate + bend * orbit.w) * w / self.W
        return np.asarray(out + eq.projected(pb, samples))


@dataclass
class Orbit:
    """Residual R (n,), Jacobian J (n, n), and changes along both axes at one point.

    `along` holds samples (E, N) of z and w and the forces' derivatives dg/dz, dg/dw, d2g/dz2, d2g/dw2 (4, E, N).
    """

    equations: Equations
    problem: Problem
    W: float
    X: Floats
    R: Floats
    J: Floats
    changes: tuple[Change, Change]
    truncation: float
    along: tuple[Floats, Floats, Floats]

    @property
    def z(self) -> Floats:
        """Displacements (E, N) of the elements."""
        return self.along[0]

    @property
    def w(self) -> Floats:
        """Velocities (E, N) of the elements."""
        return self.along[1]

    @property
    def derivatives(self) -> Floats:
        """dg/dz, dg/dw, d2g/dz2 and d2g/dw2 (4, E, N)."""
        return self.along[2]

    def curvature_matrix(self, v: Floats) -> Floats:
        """Matrix (n, n) of the second derivative R_XX[v, .]."""
        eq, pb = self.equations, self.problem
        out = np.zeros((eq.n, eq.n))
        z, w = eq.motion(pb, self.W, v)
        _matrix_of_slopes(pb, eq.H, eq.odd, self.W, self.derivatives[2] * z, False, out)
        if pb.rates:
            _matrix_of_slopes(pb, eq.H, eq.odd, self.W, self.derivatives[3] * w, True, out)
        if not eq.odd:
            out[1 : 2 * pb.M11.shape[0] : 2] = 0.0
        return out


def _of_first(samples: Floats, like: Floats) -> Floats:
    """Samples of the first element, zero for the others."""
    out = np.zeros_like(like)
    out[0] = samples
    return out


def _stiffness(pb: Problem, s: complex) -> tuple[Complexes, Complexes, Complexes]:
    """S(s), dS/ds (r, r) and the condensed force (r,)."""
    r = pb.M11.shape[0]
    S, dS = np.empty((r, r), complex), np.empty((r, r), complex)
    force, dforce = np.empty(r, complex), np.empty(r, complex)
    stiffness(pb, complex(s), S, dS, force, dforce)
    return S, dS, force


@dataclass
class FoldEquations(Equations):
    """Saddle-node points: R = 0 and g = 0, unknowns (X, q1, q2)."""

    border: tuple[Floats, Floats] | None = None

    def residual(self, y: Floats) -> tuple[Floats, Floats]:
        """Residual (n + 1,) and Jacobian (n + 1, n + 2) in scaled unknowns."""
        n = self.n
        if min(self.axis_values(y)) <= 0:  # no system there: Newton's method is told to turn back
            return np.full(n + 1, np.nan), np.full((n + 1, n + 2), np.nan)
        orbit = self.orbit(y)
        weight = 1.0 / np.max(np.abs(orbit.J), axis=1)
        if self.border is None:
            left, _, right = np.linalg.svd(weight[:, None] * orbit.J)
            self.border = left[:, -1], right[-1]
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


@dataclass
class TorusEquations(Equations):
    """Neimark-Sacker points: R = 0 and complex g = 0, unknowns (X, q1, q2, nu), nu scaled by `frequency`.

    The disturbance e^{i nu t} sum_k v_k e^{ik Omega t} uses the harmonics -H ... H of the orbit's parity.
    """

    border: tuple[Complexes, Complexes] | None = None

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
        weight = 1.0 / np.max(np.abs(A), axis=1)
        if self.border is None:
            left, _, right = np.linalg.svd(weight[:, None] * A)
            self.border = left[:, -1], right[-1].conj()
        b, c = self.border
        M = np.block([[weight[:, None] * A, b[:, None]], [c.conj()[None], np.zeros((1, 1))]])
        unit = np.zeros(len(A) + 1)
        unit[-1] = 1.0
        vg, wg = np.linalg.solve(M, unit), np.linalg.solve(M.T, unit)
        v, w = vg[:-1], wg[:-1] * weight
        gradient = np.append(
            self._by_orbit(orbit, nu, v, w),
            [-w @ self._by_axis(orbit, change, nu, parts) @ v for change in orbit.changes],
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

    def _hill(self, orbit: Orbit, nu: float) -> tuple[Complexes, list[tuple[Complexes, Complexes]]]:
        """Hill's matrix at the exponent i nu, and (S, dS/ds) at every wave."""
        pb = orbit.problem
        parts = [_stiffness(pb, 1j * (nu + k * orbit.W))[:2] for k in self.waves]
        A = self._diagonal([S for S, _ in parts]) + self._slopes(orbit, orbit.derivatives[0])
        if pb.rates:
            A = A + self._slopes(orbit, orbit.derivatives[1]) * self._per_wave(1j * (nu + self.waves * orbit.W), orbit)
        return A, parts

    def _per_wave(self, factors: Any, orbit: Orbit) -> Any:
        """Row of a factor for every entry of a disturbance."""
        return np.repeat(factors, orbit.problem.M11.shape[0])

    def _slopes(self, orbit: Orbit, slopes: Floats) -> Complexes:
        """Matrix of P_{k-l} for slopes (E, N) along the orbit."""
        D, E = orbit.problem.directions, self._waves_in_time()
        blocks = [np.einsum("aj,j,bj->ab", E.conj(), slope, E) / slope.size for slope in slopes]
        return np.asarray(sum(np.kron(block, np.outer(D[:, e], D[:, e])) for e, block in enumerate(blocks)))

    def _waves_in_time(self) -> Complexes:
        N = self.tables[0].shape[1]
        tau = (math.pi if self.odd else 2 * math.pi) * np.arange(N) / N
        return np.asarray(np.exp(1j * self.waves[:, None] * tau))

    def _by_orbit(self, orbit: Orbit, nu: float, v: Complexes, w: Complexes) -> Complexes:
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

    def _by_axis(self, orbit: Orbit, change: Change, nu: float, parts: list[tuple[Complexes, Complexes]]) -> Complexes:
        """Derivative of Hill's matrix by one axis."""
        out = self._diagonal([change.block(1j * (nu + k * orbit.W), k) for k in self.waves])
        if change.law is not None:
            out = out + self._slopes(orbit, _of_first(change.law.stiffness(orbit.z[0]), orbit.z))
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
