"""Stable periodic orbits as attractors, with a ball around each in which the motion provably settles onto it.

The ball is an ellipsoid |R (y - y*)| <= r in a norm adapted to the monodromy matrix, in which the linearised map
contracts at about its spectral radius. How large r may be is verified by sampling: states on shells from small up to r
are carried over a few turns of the orbit by the exact equations, and the norm of every one of them must shrink. So the
radius rests on samples, not on a bound.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.stats import norm, qmc

from frahm.arrays import Complexes, Floats, frozen
from frahm.attractors.stroboscope import Stroboscope
from frahm.systems import System
from frahm.time_integration import integrate

_STEPS = 256  # of the variational equation per period, at least
_MOST_POINTS = 100_000  # of a motion, per period
_LARGEST_TURN = 0.25  # norm of a step's exponent
_TAYLOR = 11
_FIRST, _RATIO, _LARGEST = 0.01, 1.6, 3.0  # radii tried, in sizes of the orbit
_DIRECTIONS = 64
_PATIENCE, _MOST_TURNS = 0.25, 64  # turns over which the norm must shrink, in times of decay
_MARGIN = 0.1  # share of the linear contraction that must be left
_WELL_CONDITIONED = 1e6
_SMALLEST = 1e-6  # radius, in sizes of the orbit, that the linear theory alone may claim


@dataclass(frozen=True, eq=False)
class Ball:
    """Ellipsoid |root (y - centre)| <= radius; `verified` says whether sampled iterations found it contracting."""

    centre: Floats
    root: Floats
    radius: float
    verified: bool

    def contains(self, states: Floats) -> np.ndarray:
        """Which of the states (N, 2n) lie inside."""
        return np.asarray(np.sum(((states - self.centre) @ self.root.T) ** 2, axis=1) <= self.radius**2)


@dataclass(frozen=True, eq=False)
class Orbit:
    """Stable periodic orbit: states at whole periods (p, 2n), a ball around each, multipliers over p periods."""

    states: Floats
    balls: tuple[Ball, ...]
    multipliers: Complexes

    @property
    def multiple(self) -> int:
        """How many periods of the forcing the orbit takes."""
        return len(self.states)

    def contains(self, states: Floats) -> np.ndarray:
        """Which of the states are settling onto the orbit."""
        return np.any([ball.contains(states) for ball in self.balls], axis=0)


def monodromy_along(system: System, span: float, displacements: Floats, velocities: Floats | None = None) -> Floats:
    """Fundamental matrix (2n, 2n) over `span` [s] along a motion, states (x_0, v_0, ...).

    `displacements` and `velocities` (2 m + 1, n), which only friction asks for, are equally spaced; each of the m steps
    is a Magnus step of order 4.
    """
    n, h = system.size, 2 * span / (len(displacements) - 1)
    A = _slopes(system, displacements, np.zeros_like(displacements) if velocities is None else velocities)
    start, middle, end = A[:-1:2], A[1::2], A[2::2]
    exponent = h / 6 * (start + 4 * middle + end) - h * h / 12 * (start @ end - end @ start)
    steps = np.broadcast_to(np.eye(2 * n), exponent.shape)
    with np.errstate(all="ignore"):  # along a violently unstable motion the product may overflow
        for k in range(_TAYLOR, 0, -1):
            steps = np.eye(2 * n) + exponent @ steps / k
        Phi = functools.reduce(lambda product, step: step @ product, steps, np.eye(2 * n))
    order = np.arange(2 * n).reshape(2, n).T.ravel()
    return np.asarray(Phi[np.ix_(order, order)])


def points_needed(system: System, span: float, reach: Floats) -> int:
    """How many displacements per `span` [s] resolve the linearised motion about displacements up to `reach` (n,)."""
    grid = np.linspace(-1.0, 1.0, 21)[:, None] * np.abs(reach)
    fastest = float(np.max(np.abs(np.linalg.eigvals(_slopes(system, grid, np.zeros_like(grid))))))
    return 2 * max(_STEPS, int(np.ceil(span * fastest / _LARGEST_TURN))) + 1


def orbit_at(strobe: Stroboscope, state: Floats, multiple: int = 1) -> Orbit | None:
    """Orbit through `state`, or None if its monodromy matrix does not say that it is stable."""
    centres = [state]
    if multiple > 1:
        centres += list(strobe.run(state[None], multiple - 1, strobes=multiple - 1, tolerance=1e-12).strobes[0])
    size = orbit_size(strobe, np.array(centres))
    balls = []
    multipliers = np.zeros(0, dtype=complex)
    for centre in centres:
        turn = _turn(strobe, centre, multiple)
        if turn is None:
            return None
        Phi = turn[1]
        multipliers = np.linalg.eigvals(Phi).astype(complex)
        if not np.max(np.abs(multipliers)) < 1:
            return None
        balls.append(_ball(strobe, centre, Phi, size, multiple))
    multipliers = multipliers[np.argsort(-np.abs(multipliers))]
    return Orbit(frozen(np.array(centres)), tuple(balls), frozen(multipliers, complex))


def refined(strobe: Stroboscope, state: Floats, multiple: int) -> Floats | None:
    """Fixed point of the map over `multiple` periods near `state` by Newton's method, or None."""
    size = orbit_size(strobe, state[None])
    change = np.inf
    for _ in range(8):
        turn = _turn(strobe, state, multiple)
        if turn is None:
            return None
        try:
            step = np.linalg.solve(turn[1] - np.eye(state.size), turn[0] - state)
        except np.linalg.LinAlgError:
            return None
        last, change = change, float(np.max(np.abs(step) / size))
        state = state - step
        if change < 1e-9:
            return state
        if not change < max(0.5, 2 * last):
            return None
    return None


def orbit_size(strobe: Stroboscope, states: Floats) -> Floats:
    """Size (2n,) of displacements [m] and velocities [m/s] of motions through the states."""
    x = max(float(np.max(np.abs(states[:, 0::2]))), float(np.max(np.abs(states[:, 1::2]))) / strobe.frequency)
    push = float(np.max(np.abs(np.linalg.solve(strobe.system.mass, strobe.system.forcing)))) / strobe.frequency**2
    x = max(x, 1e-3 * push) or 1.0
    return np.tile([x, x * strobe.frequency], strobe.system.size)


def unstable_directions(strobe: Stroboscope, state: Floats) -> Floats:
    """Real directions (k, 2n), of the orbit's size, along which motions leave the period-one orbit through `state`."""
    turn = _turn(strobe, state, 1)
    if turn is None:
        return np.zeros((0, state.size))
    values, vectors = np.linalg.eig(turn[1])
    size = orbit_size(strobe, state[None])
    found = []
    for value, vector in zip(values, vectors.T, strict=True):
        if abs(value) > 1 and value.imag >= 0:
            parts = [vector.real] if value.imag == 0 else [vector.real, vector.imag]
            found += [part / np.max(np.abs(part) / size) for part in parts]
    return np.array(found).reshape(-1, state.size)


def _turn(strobe: Stroboscope, state: Floats, multiple: int) -> tuple[Floats, Floats] | None:
    """Image of a state under the map over `multiple` periods and the map's derivative there; None if out of reach."""
    system, size = strobe.system, orbit_size(strobe, state[None])
    per_period = points_needed(system, strobe.period, 1.5 * size[0::2]) - 1
    if not per_period < _MOST_POINTS:
        return None
    history = integrate(
        system, frequency=strobe.frequency, periods=multiple, initial_state=state,
        samples_per_period=per_period, tolerance=1e-12,
    )  # fmt: skip
    if not history.outcome.ok:
        return None
    image = np.column_stack([history.x[-1], history.v[-1]]).ravel()
    Phi = monodromy_along(system, multiple * strobe.period, history.x, history.v)
    return (image, Phi) if np.all(np.isfinite(Phi)) else None


def _slopes(system: System, x: Floats, v: Floats) -> Floats:
    """Jacobians (N, 2n, 2n) of the equations of motion at displacements x and velocities v (N, n), states (x, v)."""
    n = system.size
    K = np.broadcast_to(system.stiffness, (len(x), n, n)).copy()
    C = np.broadcast_to(system.damping, (len(x), n, n)).copy()
    for element in system.elements:
        law = element.law
        outer = np.outer(element.direction, element.direction)
        K += law.stiffness(x @ element.direction)[:, None, None] * outer
        C += law.damping_at(v @ element.direction)[:, None, None] * outer
    A = np.zeros((len(x), 2 * n, 2 * n))
    A[:, :n, n:] = np.eye(n)
    A[:, n:, :n] = -np.linalg.solve(system.mass, K)
    A[:, n:, n:] = -np.linalg.solve(system.mass, C)
    return A


def _ball(strobe: Stroboscope, centre: Floats, Phi: Floats, size: Floats, multiple: int) -> Ball:
    """Ball as large as the sampled shells allow, found by doubling or halving its radius."""
    rho = float(np.max(np.abs(np.linalg.eigvals(Phi))))
    turns = int(np.clip(np.ceil(_PATIENCE / (1 - rho)), 1, _MOST_TURNS))
    limit = 1 - _MARGIN * (1 - rho**turns)
    root = _adapted_root(Phi * size / size[:, None], rho)
    to_states = np.linalg.inv(root) * size[:, None]
    root = root / size
    directions = _directions(len(size)) @ to_states.T

    def shrinks(radius: float) -> bool:
        ended = strobe.run(centre + radius * directions, turns * multiple)
        left = np.linalg.norm((ended.states - centre) @ root.T, axis=1)
        return bool(np.all(ended.codes == 0) and np.all(left <= limit * radius))

    radius = _FIRST
    if shrinks(radius):
        while radius < _LARGEST and shrinks(_RATIO * radius):
            radius *= _RATIO
        verified = True
    else:
        radius /= _RATIO
        while radius > _SMALLEST and not shrinks(radius):
            radius /= _RATIO
        verified = radius > _SMALLEST and shrinks(radius / _RATIO)
    return Ball(frozen(centre), frozen(root), max(radius / _RATIO, _SMALLEST), verified)


def _adapted_root(Phi: Floats, rho: float) -> Floats:
    """Upper triangular R, |R| = 1, such that |R Phi y| <= about rho |R y|.

    R^T R = sum of l l^* over the left eigenvectors l; where these are all but dependent, the solution P of the
    discrete Lyapunov equation Phi^T P Phi / rho - P = -1.
    """
    _, vectors = np.linalg.eig(Phi)
    if np.linalg.cond(vectors) < _WELL_CONDITIONED:
        left = np.linalg.inv(vectors)
        P = (left.conj().T @ left).real
    else:
        P = scipy.linalg.solve_discrete_lyapunov(Phi.T / np.sqrt(max(rho, 1e-3)), np.eye(len(Phi)))
    root = np.linalg.cholesky((P + P.T) / 2).T
    return np.asarray(root / np.linalg.norm(root, 2))


@functools.cache
def _directions(dimension: int) -> Floats:
    """Unit vectors (count, dimension) spread evenly over the sphere."""
    points = qmc.Sobol(dimension, scramble=True, seed=0).random(_DIRECTIONS)
    vectors = norm.ppf(np.clip(points, 1e-12, 1 - 1e-12))
    return frozen(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))
