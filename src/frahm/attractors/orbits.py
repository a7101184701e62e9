"""Stable periodic orbits as attractors, with balls around states of each in which a motion settles onto it.

The ball is an ellipsoid |R (y - y*)| <= r in a norm adapted to the monodromy matrix, in which the linearised map
contracts at about its spectral radius. How large r may be is verified by sampling: states on shells from small up to r
are carried over a few turns of the orbit by the exact equations, and the norm of every one of them must shrink. So the
radius rests on samples, not on a bound. Of an orbit that takes many periods only a few states have one: a motion on it
passes through each of them in turn.

Linearisation by Magnus steps: Blanes et al. (2009), doi 10.1016/j.physrep.2008.11.001.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.stats import norm, qmc

from frahm.arrays import Complexes, Floats, eigenvalues, frozen
from frahm.attractors.stroboscope import Stroboscope
from frahm.systems import System
from frahm.time_integration import integrate

_STEPS = 256  # of the variational equation per period, at least
_MOST_POINTS = 100_000  # of a motion, per period
_LARGEST_TURN = 0.25  # norm of a step's exponent
_TAYLOR = 11
_FIRST, _RATIO, _LARGEST = 0.01, 1.6, 3.0  # radii tried, in sizes of the orbit
_DIRECTIONS = 64
_BALLS = 4  # of an orbit, at most: more than one, because some are too small to be met
_PATIENCE, _MOST_TURNS = 0.25, 64  # turns over which the norm must shrink, in times of decay
_MARGIN = 0.1  # share of the linear contraction that must be left
_WELL_CONDITIONED, _BLIND = 1e6, 1e12  # condition numbers: of eigenvectors that can be trusted, of a norm that cannot
_SMALLEST = 1e-6  # radius, in sizes of the orbit, that the linear theory alone may claim
_DIFFERENCE = 1e-5  # of the size of a motion: steps of central differences, of relative error about 1e-7 here
_FIRST_STEPS = 0.5  # in sizes of the motion: of Newton's method; later ones must shrink
_LAST_STEP, _NEWTON_STEPS = 1e-9, 8  # in sizes of the motion: at which Newton's method has ended, and after how many
_TIGHT = 1e-12  # tolerance of motions that derivatives are taken of
_LEAST_SIZE = 1e-3  # of the displacement of the masses by the force alone: a motion is not taken for smaller
_INNER = 1e-12  # off the ends of [0, 1], where the normal distribution has no quantile
_SETTLED = 1e-4  # in sizes of the orbit: how far off the tolerance may leave a motion that has settled
_ONE = 1e-6  # in sizes of the orbit: states of refined orbits nearer than this are one state


@dataclass(frozen=True, eq=False)
class Ball:
    """Ellipsoid |root (y - centre)| <= radius; `verified` says whether sampled iterations found it contracting."""

    centre: Floats
    root: Floats
    radius: float
    verified: bool

    def distance(self, states: Floats) -> Floats:
        """Distance of states (N, 2n) from the centre, in the norm of the ball over its radius."""
        return np.asarray(np.linalg.norm((states - self.centre) @ self.root.T, axis=1) / self.radius)

    def contains(self, states: Floats) -> np.ndarray:
        """Which of the states (N, 2n) lie inside."""
        return self.distance(states) <= 1


@dataclass(frozen=True, eq=False)
class Orbit:
    """Stable periodic orbit: states at whole periods (p, 2n), balls around some of them, multipliers over p periods."""

    states: Floats
    balls: tuple[Ball, ...]
    multipliers: Complexes

    @property
    def multiple(self) -> int:
        """How many periods of the forcing the orbit takes."""
        return len(self.states)

    def passes(self, state: Floats, size: Floats) -> bool:
        """Whether the refined orbit through `state` is this one; `size` (2n,) as of `orbit_size`."""
        return bool(np.min(np.max(np.abs((self.states - state) / size), axis=1)) < _ONE)

    def holds(self, states: Floats, size: Floats) -> bool:
        """Whether all the states (N, 2n) are on it, as far as a motion that has settled can be: none comes nearer."""
        apart = np.max(np.abs(states[:, None] - self.states) / size, axis=2)
        return bool(np.max(np.min(apart, axis=1)) < _SETTLED)

    def distance(self, strobes: Floats) -> Floats:
        """How near a motion with these strobes (K, 2n) came to the balls, turn by turn (K // p,), over their radii."""
        turns = len(strobes) // self.multiple
        last = strobes[len(strobes) - turns * self.multiple :]
        return np.asarray(np.min([ball.distance(last).reshape(turns, -1) for ball in self.balls], axis=(0, 2)))

    def contains(self, states: Floats) -> np.ndarray:
        """Which of the states (N, 2n) lie in a ball, so that the motion settles onto the orbit."""
        return np.any([ball.contains(states) for ball in self.balls], axis=0)

    def attracts(self, strobes: Floats) -> np.ndarray:
        """Which motions with strobes (N, K, 2n) came through a ball in their last p periods; K must be p at least."""
        last = strobes[:, -self.multiple :]
        return np.any(self.contains(last.reshape(-1, last.shape[2])).reshape(last.shape[:2]), axis=1)


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
        Phi = _product(steps)
    order = np.arange(2 * n).reshape(2, n).T.ravel()
    return np.asarray(Phi[np.ix_(order, order)])


def _product(steps: Floats) -> Floats:
    """Product (k, k) of maps (m, k, k), the first applied first, by pairs."""
    while len(steps) > 1:
        odd = steps[len(steps) & ~1 :]
        steps = np.concatenate([steps[1::2] @ steps[: len(steps) & ~1 : 2], odd])
    return np.asarray(steps[0])


def points_needed(system: System, span: float, reach: Floats) -> int:
    """How many displacements per `span` [s] resolve the linearised motion about displacements up to `reach` (n,).

    More than are ever taken where the motion is too fast to resolve.
    """
    grid = np.linspace(-1.0, 1.0, 21)[:, None] * np.abs(reach)
    with np.errstate(over="ignore", invalid="ignore"):
        fastest = float(np.max(np.abs(eigenvalues(_slopes(system, grid, np.zeros_like(grid))))))
    if not span * fastest / _LARGEST_TURN < _MOST_POINTS:  # nor where a slope is no number
        return 2 * _MOST_POINTS + 1
    return 2 * max(_STEPS, int(np.ceil(span * fastest / _LARGEST_TURN))) + 1


def orbit_at(strobe: Stroboscope, state: Floats, multiple: int = 1) -> Orbit | None:
    """Orbit through `state`, or None if its monodromy matrix does not say that it is stable."""
    turn = _turn(strobe, state, multiple)
    if turn is None:
        return None
    multiple = _shortest(strobe, np.array([state, *turn.states[:-1]]))
    centres = np.array([state, *turn.states[: multiple - 1]])
    maps = [turn.product(start, multiple) for start in range(multiple)]
    if not all(spectral_radius(Phi) < 1 for Phi in maps):
        return None
    size = orbit_size(strobe, centres)
    balls: list[Ball] = []
    for at in range(0, multiple, math.ceil(multiple / _BALLS)):
        balls.append(_ball(strobe, centres[at], maps[at], size, multiple, balls[-1] if balls else None))
    multipliers = eigenvalues(maps[0])
    multipliers = multipliers[np.argsort(-np.abs(multipliers))]
    return Orbit(frozen(centres), tuple(balls), frozen(multipliers, complex))


def spectral_radius(Phi: Floats) -> float:
    """Largest modulus of the eigenvalues; infinite where the matrix is, or they cannot be found."""
    largest = float(np.max(np.abs(eigenvalues(Phi))))
    return np.inf if np.isnan(largest) else largest


def _shortest(strobe: Stroboscope, states: Floats) -> int:
    """Least number of periods, a divisor of their number, after which the states (p, 2n) of an orbit repeat."""
    size = orbit_size(strobe, states)
    for multiple in range(1, len(states)):
        if len(states) % multiple == 0 and np.max(np.abs(np.roll(states, -multiple, axis=0) - states) / size) < _ONE:
            return multiple
    return len(states)


def refined(strobe: Stroboscope, state: Floats, multiple: int) -> tuple[Floats, Floats] | None:
    """Fixed point (2n,) near `state` of the map over `multiple` periods, and its derivative (2n, 2n), or None.

    Newton's method; the derivative is that of central differences, which cost no more than eight motions.
    """
    size = orbit_size(strobe, state[None])
    steps = _DIFFERENCE * np.diag(size)
    change = np.inf
    for turn in range(_NEWTON_STEPS):
        around = np.concatenate([state[None], state + steps, state - steps])
        turned = strobe.run(around, multiple, tolerance=_TIGHT)
        if np.any(turned.codes):
            return None
        ahead, behind = np.split(turned.states[1:], 2)
        Phi = (ahead - behind).T / (2 * np.diag(steps))
        try:
            step = np.linalg.solve(Phi - np.eye(state.size), turned.states[0] - state)
        except np.linalg.LinAlgError:
            return None
        last, change = change, float(np.max(np.abs(step) / size))
        state = state - step
        if change < _LAST_STEP:
            return state, Phi
        if not change < (_FIRST_STEPS if turn < 2 else last):
            return None
    return None


def orbit_size(strobe: Stroboscope, states: Floats) -> Floats:
    """Size (2n,) of displacements [m] and velocities [m/s] of motions through the states."""
    x = max(float(np.max(np.abs(states[:, 0::2]))), float(np.max(np.abs(states[:, 1::2]))) / strobe.frequency)
    push = float(np.max(np.abs(np.linalg.solve(strobe.system.mass, strobe.system.forcing)))) / strobe.frequency**2
    x = max(x, _LEAST_SIZE * push) or 1.0
    return np.tile([x, x * strobe.frequency], strobe.system.size)


def unstable_directions(strobe: Stroboscope, state: Floats) -> Floats:
    """Real directions (k, 2n), of the orbit's size, along which motions leave the period-one orbit through `state`."""
    turn = _turn(strobe, state, 1)
    if turn is None:
        return np.zeros((0, state.size))
    values, vectors = np.linalg.eig(turn.maps[0])
    size = orbit_size(strobe, state[None])
    found = []
    for value, vector in zip(values, vectors.T, strict=True):
        if abs(value) > 1 and value.imag >= 0:
            parts = [vector.real] if value.imag == 0 else [vector.real, vector.imag]
            found += [part / np.max(np.abs(part) / size) for part in parts]
    return np.array(found).reshape(-1, state.size)


@dataclass(frozen=True, eq=False)
class _Turn:
    """A motion over p periods: states (p, 2n) at the end of each, and the derivative (p, 2n, 2n) of each one's map."""

    states: Floats
    maps: Floats

    def product(self, start: int, count: int) -> Floats:
        """Derivative of the map over `count` periods of an orbit, from its period `start` on."""
        with np.errstate(all="ignore"):  # as in `monodromy_along`
            return _product(np.roll(self.maps[:count], -start, axis=0))


def _turn(strobe: Stroboscope, state: Floats, multiple: int) -> _Turn | None:
    """Motion from a state over `multiple` periods and its linearisation; None if out of reach."""
    system, size = strobe.system, orbit_size(strobe, state[None])
    per_period = points_needed(system, strobe.period, 1.5 * size[0::2]) - 1
    if not per_period < _MOST_POINTS:
        return None
    history = integrate(
        system, frequency=strobe.frequency, periods=multiple, initial_state=state,
        samples_per_period=per_period, tolerance=_TIGHT,
    )  # fmt: skip
    if not history.outcome.ok:
        return None
    ends = slice(per_period, None, per_period)
    states = np.stack([history.x[ends], history.v[ends]], axis=-1).reshape(multiple, -1)
    pieces = [slice(k * per_period, (k + 1) * per_period + 1) for k in range(multiple)]
    maps = np.array([monodromy_along(system, strobe.period, history.x[at], history.v[at]) for at in pieces])
    return _Turn(states, maps) if np.all(np.isfinite(maps)) else None


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


def _ball(
    strobe: Stroboscope, centre: Floats, Phi: Floats, size: Floats, multiple: int, before: Ball | None = None
) -> Ball:
    """Ball as large as the sampled shells allow, found by growing or shrinking it from the one `before`, if any."""
    rho = spectral_radius(Phi)
    turns = int(np.clip(np.ceil(_PATIENCE / (1 - rho)), 1, _MOST_TURNS))
    limit = 1 - _MARGIN * (1 - rho**turns)
    # what linear theory alone may claim: the adapted norm may be next to blind in some direction
    least = Ball(frozen(centre), frozen(np.diag(1 / size)), _SMALLEST, verified=False)
    try:
        root = _adapted_root(Phi * size / size[:, None], rho)
        clear = np.linalg.cond(root) < _BLIND
    except np.linalg.LinAlgError:  # multipliers so far apart that the norm they ask for is none
        return least
    if not clear:
        return least
    to_states = np.linalg.inv(root) * size[:, None]
    root = root / size
    directions = _directions(len(size)) @ to_states.T
    few = int(np.clip(4 * _DIRECTIONS // multiple, _DIRECTIONS // 4, _DIRECTIONS))
    turned = np.linalg.matrix_power(Phi, turns)
    spare = limit - np.linalg.norm(root @ turned @ to_states, 2)

    def shell(radius: float, count: int = few) -> tuple[bool, bool]:
        """Whether all states of a shell come nearer, and so nearly as linear theory says that smaller ones do too."""
        states = radius * directions[:count]
        ended = strobe.run(centre + states, turns * multiple)
        moved = ended.states - centre
        shrinks = np.all(ended.codes == 0) and np.all(np.linalg.norm(moved @ root.T, axis=1) <= limit * radius)
        off = np.max(np.linalg.norm((moved - states @ turned.T) @ root.T, axis=1))
        return bool(shrinks), bool(shrinks and off <= spare * radius)

    first = _FIRST if before is None or not before.verified else min(_RATIO * before.radius, _FIRST)
    shrinks, sure = shell(first)
    largest = first if shrinks else 0.0
    while 0 < largest < _LARGEST and shell(_RATIO * largest)[0]:
        largest *= _RATIO
    # another attractor inside draws states of a large shell inwards too: the smaller ones tell
    radius = first
    while not sure and radius > _SMALLEST:
        radius /= _RATIO
        shrinks, sure = shell(radius)
        largest = max(largest, radius) if shrinks else 0.0
    while few < _DIRECTIONS and largest > _RATIO * _SMALLEST and not shell(largest, _DIRECTIONS)[0]:
        largest /= _RATIO
    if largest <= _RATIO * _SMALLEST:
        return least
    return Ball(frozen(centre), frozen(root), largest / _RATIO, verified=True)


def _adapted_root(Phi: Floats, rho: float) -> Floats:
    """Upper triangular R, |R| = 1, such that |R Phi y| <= c |R y|, c being rho or, at worst, (1 + rho) / 2.

    |R y| = |M y| where the rows of M are the left eigenvectors. Where these are all but dependent, Phi = Q T Q^* with T
    upper triangular (Schur), and M = D^-1 Q^* with a diagonal D that shrinks what T has above its diagonal. R comes
    from M without forming M^T M, whose rounding errors could make it indefinite.
    """
    _, vectors = np.linalg.eig(Phi)
    if np.linalg.cond(vectors) < _WELL_CONDITIONED:
        M = np.linalg.inv(vectors)
    else:
        T, Q = scipy.linalg.schur(Phi.astype(complex), output="complex")
        M = Q.conj().T / _shrinking(T, (1 - rho) / 2)[:, None]
    root = np.linalg.qr(np.concatenate([M.real, M.imag])).R
    return np.asarray(root / np.linalg.norm(root, 2))


def _shrinking(T: Complexes, left: float) -> Floats:
    """Diagonal D such that D^-1 T D has nothing above its diagonal whose norm exceeds `left`."""
    size = len(T)
    D = np.ones(size)
    for j in range(1, size):
        above = np.abs(T[:j, j])
        with np.errstate(divide="ignore"):
            D[j] = min(D[j - 1], float(np.min(left / size * D[:j] / above)))
    return D


@functools.cache
def _directions(dimension: int) -> Floats:
    """Unit vectors (count, dimension) spread evenly over the sphere."""
    points = qmc.Sobol(dimension, scramble=True, seed=0).random(_DIRECTIONS)
    vectors = norm.ppf(np.clip(points, _INNER, 1 - _INNER))
    return frozen(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))
