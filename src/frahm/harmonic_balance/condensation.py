"""The host condensed exactly: what the nonlinear elements feel of a linear structure with any number of modes.

With x = P u + Q y, where u holds the elements' relative coordinates and y the rest, the host's part of the equations
at the complex frequency s is the dynamic stiffness

    S(s) = D11 - D12 D22^-1 D21 ,   D = s^2 M + s C + K  in the coordinates (u, y) ,

and D22^-1 is a sum over the poles of the structure with its elements held. Linear springs and dampers of the
elements belong to C and K. At harmonic 0 a sink without linear spring has S = 0, which is no singularity here.

Reduction to the coordinates of the nonlinear elements: Krack and Gross (2019), doi 10.1007/978-3-030-14023-6.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import scipy.linalg

from frahm.absorbers.packed import pack_laws
from frahm.arrays import Complexes, Floats
from frahm.errors import ParameterError
from frahm.harmonic_balance.kernels import stiffnesses
from frahm.systems import Derivative, System

_PARALLEL = 1e-12  # sine of the angle between directions that are parallel but for rounding


class CondensedSystem(NamedTuple):
    """Arrays of the condensed problem for the compiled kernels.

    r relative coordinates, E nonlinear elements, p poles, n coordinates; rows 0 and 1 of the outputs are the pipe
    displacement and the first element's z, the others all coordinates.
    """

    M11: Floats  # (r, r)
    C11: Floats
    K11: Floats
    poles: Complexes  # (p,)
    a2: Complexes  # (p, r): D12(s) R_j = s^2 a2 + s a1 + a0
    a1: Complexes
    a0: Complexes
    b2: Complexes  # (p, r): L_j D21(s) = s^2 b2 + s b1 + b0
    b1: Complexes
    b0: Complexes
    force_u: Complexes  # (r,)
    force_y: Complexes  # (p,)
    out_u: Floats  # (2 + n, r)
    out_y: Complexes  # (2 + n, p)
    directions: Floats  # (r, E): z_e = directions[:, e] . u
    codes: np.ndarray  # (E, 3)
    table: Floats
    degree: int  # of the polynomial forces; 0 if a law is no polynomial
    rates: bool  # whether a force depends on the velocity otherwise than linearly
    forcing: Floats  # (knots, 5): Omega and four coefficients of the factor on the forcing from there on; empty: 1
    odd: bool  # whether every law is odd, so that odd harmonics form a closed set


def unknowns(problem: CondensedSystem, H: Any, odd: bool) -> Any:
    """Length of the unknown vector with harmonics up to H (a number or an array), for callers outside compiled code."""
    return 2 * problem.M11.shape[0] * ((H + 1) // 2 if odd else H + 1)


def condense(system: System, forcing: Floats | None = None) -> CondensedSystem:
    """Condense a system with at least one nonlinear element onto the elements' coordinates.

    Raises
    ------
    ParameterError
        If the structure could move freely with its elements held.
    """
    C, K = linear_part(system)
    active = [element for element in system.elements if not element.law.is_linear]
    T, directions = coordinates(system)
    r = directions.shape[0]
    M_, C_, K_ = (np.ascontiguousarray(T.T @ matrix @ T) for matrix in (system.mass, C, K))
    blocks = (M_, C_, K_)
    f = T.T @ system.forcing
    poles, R, L = _poles(*(block[r:, r:] for block in blocks))
    first = system.elements[0].direction if system.elements else np.zeros(system.size)
    outputs = np.vstack([system.output, first, np.eye(system.size)]) @ T
    a2, a1, a0 = (np.ascontiguousarray((block[:r, r:] @ R).T) for block in blocks)
    b2, b1, b0 = (np.ascontiguousarray(L @ block[r:, :r]) for block in blocks)
    nonlinear = [element.law.without_linear_part() for element in active]
    codes, table = pack_laws(nonlinear)
    M11, C11, K11 = (np.ascontiguousarray(block[:r, :r]) for block in blocks)
    return CondensedSystem(
        M11=M11, C11=C11, K11=K11, poles=poles, a2=a2, a1=a1, a0=a0, b2=b2, b1=b1, b0=b0,
        force_u=f[:r].astype(complex),
        force_y=L @ f[r:],
        out_u=np.ascontiguousarray(outputs[:, :r]),
        out_y=np.ascontiguousarray(outputs[:, r:] @ R),
        directions=np.ascontiguousarray(directions),
        codes=codes,
        table=table,
        degree=max(law.coefficients.size for law in nonlinear) if all(law.is_polynomial for law in nonlinear) else 0,
        rates=any(law.friction is not None for law in nonlinear),
        forcing=np.zeros((0, 5)) if forcing is None else np.ascontiguousarray(forcing),
        odd=all(law.is_odd for law in nonlinear),
    )  # fmt: skip


def stiffness_at(pb: CondensedSystem, k: int, W: float) -> tuple[Complexes, Complexes]:
    """S (r, r) [N/m] and condensed force (r,) [N] at harmonic k of Omega = W [rad/s]."""
    S, force = stiffnesses(pb, np.array([1j * k * W]))
    return S[0], force[0]


def stiffness_over(pb: CondensedSystem, k: int, W: Floats) -> tuple[Complexes, Complexes]:
    """S (N, r, r) [N/m] and condensed force (N, r) [N] at harmonic k of Omega = W (N,) [rad/s]."""
    S, force = stiffnesses(pb, 1j * k * W)
    return S, force


def coordinates(system: System) -> tuple[Floats, Floats]:
    """T (n, n) with x = T (u, y), and directions (r, E) with z_e = directions[:, e] . u."""
    N = np.column_stack([element.direction for element in system.elements if not element.law.is_linear])
    P, directions = _relative_coordinates(N)
    return np.column_stack([P, scipy.linalg.null_space(N.T)]), directions


class CondensedChange:
    """Derivatives of the condensed stiffness and force by a parameter of a system."""

    def __init__(self, system: System, change: Derivative, T: Floats, r: int):
        C, K = linear_part(system)
        self.r = r
        self.now = [T.T @ matrix @ T for matrix in (system.mass, C, K)]
        self.change = [T.T @ matrix @ T for matrix in (change.mass, change.damping, change.stiffness)]
        self.force, self.dforce = T.T @ system.forcing, T.T @ change.forcing

    def at(self, s: complex) -> tuple[Complexes, Complexes]:
        """DS (r, r) and dF (r,) at the complex frequency s.

        With X = D22^-1 D21 and Y = D12 D22^-1, dS = dD11 - Y dD21 - dD12 X + Y dD22 X.
        """
        s = complex(s)
        D, dD = (np.asarray(M * s * s + C * s + K, dtype=complex) for M, C, K in (self.now, self.change))
        return _condensed_derivative(D, dD, self.force, self.dforce, self.r)


def _condensed_derivative(D: Complexes, dD: Complexes, f: Floats, df: Floats, r: int) -> tuple[Complexes, Complexes]:
    X = np.linalg.solve(D[r:, r:], np.column_stack([D[r:, :r], f[r:]]))
    X, rest = X[:, :r], X[:, r]
    Y = np.linalg.solve(D[r:, r:].T, D[:r, r:].T).T
    dS = dD[:r, :r] - Y @ dD[r:, :r] - dD[:r, r:] @ X + Y @ dD[r:, r:] @ X
    dF = df[:r] - (dD[:r, r:] - Y @ dD[r:, r:]) @ rest - Y @ df[r:]
    return dS, dF


def linear_part(system: System) -> tuple[Floats, Floats]:
    """C [N s/m] and K [N/m] with the linear springs and dampers of all elements."""
    C, K = np.array(system.damping), np.array(system.stiffness)
    for element in system.elements:
        outer = np.outer(element.direction, element.direction)
        C += element.law.damping * outer
        K += element.law.coefficients[0] * outer
    return C, K


def _relative_coordinates(N: Floats) -> tuple[Floats, Floats]:
    """P with x = P u + ..., and directions with z_e = directions[:, e] . u.

    u holds z of one element of every set of parallel ones, so that these share a coordinate, where that is enough.
    """
    rank = np.linalg.matrix_rank(N)
    own, factors = _parallel(N)
    if rank == len(own):
        N = N[:, own]
        return np.asarray(np.linalg.pinv(N).T, dtype=float), factors
    V = np.linalg.svd(N)[0][:, :rank]
    return V, V.T @ N


def _parallel(N: Floats) -> tuple[list[int], Floats]:
    """Columns no two of which are parallel, and factors (columns, E) with N = N[:, columns] @ factors."""
    own: list[int] = []
    factors = np.zeros((N.shape[1], N.shape[1]))
    for e, n in enumerate(N.T):
        for row, first in enumerate(own):
            share = float(n @ N[:, first]) / float(N[:, first] @ N[:, first])
            if np.linalg.norm(n - share * N[:, first]) <= _PARALLEL * np.linalg.norm(n):
                factors[row, e] = share
                break
        else:
            factors[len(own), e] = 1.0
            own.append(e)
    return own, factors[: len(own)]


def _poles(M: Floats, C: Floats, K: Floats) -> tuple[Complexes, Complexes, Complexes]:
    """Poles lam_j and vectors R (m, 2m), L (2m, m) with (s^2 M + s C + K)^-1 = sum_j R_j L_j/(s - lam_j)."""
    m = M.shape[0]
    if m == 0:
        return np.zeros(0, complex), np.zeros((0, 0), complex), np.zeros((0, 0), complex)
    inverse = np.linalg.inv(M)
    A = np.block([[np.zeros((m, m)), np.eye(m)], [-inverse @ K, -inverse @ C]])
    scale = np.sqrt(np.linalg.norm(A[m:, :m])) or 1.0  # balance displacement against velocity
    balance = np.concatenate([np.full(m, scale), np.ones(m)])
    A = balance[:, None] * A / balance
    lam, V = np.linalg.eig(A) if np.all(np.isfinite(A)) else (np.zeros(2 * m), np.zeros((2 * m, 2 * m)))
    if not np.linalg.cond(V) <= 1e10:
        raise ParameterError(
            "system", "a structure that can drift or has a defective mode with its elements held",
            "a structure that stays supported when the coordinates of its elements are fixed",
        )  # fmt: skip
    W = np.linalg.inv(V)
    return lam, np.ascontiguousarray(V[:m] / scale), np.ascontiguousarray(W[:, m:] @ inverse)
