"""Defining equations of saddle-node and Neimark-Sacker points in two parameters, with exact Jacobians.

A saddle-node is R = 0 with a singular Jacobian, written as the one scalar g of a bordered system; a Neimark-Sacker
point is R = 0 with a singular Hill matrix at the exponent i nu, written as one complex scalar. The derivatives of g
need second derivatives of the forces, which are taken on the same time samples. No force has a mixed one.

Minimally extended (bordered) systems: Govaerts (2000), doi 10.1137/1.9780898719543.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, field

import numpy as np

from frahm.absorbers import Law
from frahm.absorbers.packed import law_curvatures, law_force_and_slopes
from frahm.arrays import Complexes, Floats
from frahm.compiled import kernel
from frahm.harmonic_balance.condensation import CondensedChange, CondensedSystem, condense, coordinates, unknowns
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
class Equations(ABC):
    """What both kinds of points share: residual and Jacobian of the orbit in (X, q1, q2).

    Unknowns are scaled: X by `x_scale`, the axes by `scales`. `frequency` is Omega [rad/s] where it is no axis. `start`
    is a scaled point near the curve, from which the bordering vectors are: they stay, so that g has one sign.
    """

    system: System
    axes: tuple[str, str]
    frequency: float
    H: int
    odd: bool
    x_scale: float
    scales: tuple[float, float]
    start: Floats
    problem: CondensedSystem = field(init=False)
    tables: tuple[Floats, Floats] = field(init=False)
    T: Floats = field(init=False)

    def __post_init__(self) -> None:
        self.problem = condense(self.system)
        self.T = coordinates(self.system)[0]
        self.tables = fourier_tables(self.H, self.odd, sample_count(self.problem, self.H, self.odd))

    @abstractmethod
    def residual(self, y: Floats) -> tuple[Floats, Floats]:
        """Residual and Jacobian in scaled unknowns; NaN where an axis is not positive and there is no system."""

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

    def orbit(self, y: Floats) -> Linearisation:
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
                rate = rate + self.projected(pb, of_first(derivative.law.force(z[0]), z))
            changes.append(Change(self, pb, W, rate, condensed, derivative.law))
        along = z, w, derivatives
        return Linearisation(
            self, pb, W, X, R[:n].copy(), J[:n, :n].copy(), (changes[0], changes[1]), float(truncation), along
        )

    def _along(self, pb: CondensedSystem, W: float, X: Floats) -> tuple[Floats, Floats, Floats]:
        """Samples z, w (E, N) along an orbit and the derivatives (4, E, N) of the forces there."""
        z, w = self.motion(pb, W, X)
        out = np.empty((4, *z.shape))
        _derivatives(pb, z, w, out)
        return z, w, out

    def motion(self, pb: CondensedSystem, W: float, X: Floats) -> tuple[Floats, Floats]:
        """Samples (E, N) of the elements' displacements and velocities for an unknown vector."""
        z = np.empty((pb.directions.shape[1], self.tables[0].shape[1]))
        w = np.empty_like(z)
        _motion(pb, self.H, self.odd, W, np.ascontiguousarray(X), *self.tables, z, w)
        return z, w

    def projected(self, pb: CondensedSystem, samples: Floats) -> Floats:
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
    problem: CondensedSystem
    W: float
    rate: Floats
    stiffness: CondensedChange | None
    law: Law | None

    def block(self, s: complex, k: complex) -> Complexes:
        """Derivative of S(s) (r, r) at s = lam + ik Omega by this axis."""
        if self.stiffness is None:
            return 1j * k * stiffness_and_slope(self.problem, s)[1]
        return self.stiffness.at(s)[0]

    def applied(self, orbit: Linearisation, v: Floats) -> Floats:
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
class Linearisation:
    """Residual R (n,), Jacobian J (n, n), and changes along both axes at one point.

    `along` holds samples (E, N) of z and w and the forces' derivatives dg/dz, dg/dw, d2g/dz2, d2g/dw2 (4, E, N).
    """

    equations: Equations
    problem: CondensedSystem
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


def row_weights(A: Floats | Complexes) -> Floats:
    """Factors that make the largest entry of every row 1 in size."""
    return np.asarray(1.0 / np.max(np.abs(A), axis=1), dtype=float)


def of_first(samples: Floats, like: Floats) -> Floats:
    """Samples of the first element, zero for the others."""
    out = np.zeros_like(like)
    out[0] = samples
    return out


def stiffness_and_slope(pb: CondensedSystem, s: complex) -> tuple[Complexes, Complexes, Complexes]:
    """S(s), dS/ds (r, r) and the condensed force (r,)."""
    r = pb.M11.shape[0]
    S, dS = np.empty((r, r), complex), np.empty((r, r), complex)
    force, dforce = np.empty(r, complex), np.empty(r, complex)
    stiffness(pb, complex(s), S, dS, force, dforce)
    return S, dS, force
