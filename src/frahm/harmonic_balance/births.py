"""Detached curves beside their birth: where the force that a response needs is extreme.

A response with the first harmonic a at Omega needs the force lambda(a, Omega) F, and the branches are the curves
lambda = 1. A detached curve is born where lambda has a minimum, or a maximum, over both: near its birth it is a small
ring around that place, between the frequencies of any grid. So the extremes near 1 of the first-harmonic lambda are
located on the exact equations, and a start lies where lambda passes 1 beside them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.compiled import kernel
from frahm.continuation.dense import factorise, solve_factorised
from frahm.harmonic_balance.kernels import fourier_tables, residual_and_jacobian, sample_count, stiffness, unknowns
from frahm.harmonic_balance.search import Search
from frahm.harmonic_balance.seeds import Extreme, Seed
from frahm.harmonic_balance.starts import starts_of
from frahm.tolerances import TINY

MARGIN = 1e-6  # of the force: nearer to a birth it is not decided on which side of it a system lies
_STEPS = np.array([3e-3, 3e-4])  # of ln a and of Omega, over which slopes are first compared
_LONGEST = np.array([0.2, 0.02])  # of a step
_ITERATIONS = 30
_FINEST = 1 / 64  # of a step along places where lambda turns over a: at shorter ones it has ceased to turn
_SHARES = np.geomspace(0.7, 1.35, 28)  # of a, over which lambda is looked at
_CLOSE = 0.1  # |ln lambda^2| up to which an extreme that was not located is told
_FIRST_HARMONICS = 5
_MET = 1e-3  # share of the way to lambda = 1 at which a ring counts as met
_STATIONARY = 1e-3  # change of ln lambda^2 by the next step, in units of the margin, at which lambda is stationary
_CAUTIOUS = 0.2  # share of `_CLOSE` by which lambda may change in one step, so that an extreme is not passed over
LOOKED_AHEAD = 1.35  # factor on the force; first-harmonic extremes are known a little farther
_ENOUGH = 1e-8  # truncation: lambda is then known far better than the margin


@dataclass(frozen=True)
class _Place:
    """A response whose coordinate c has a given first harmonic a: ln lambda^2, its slopes by ln a and ln Omega."""

    W: float
    X: Floats
    H: int
    force: complex  # lambda e^{i phase} where a has the phase 0
    truncation: float
    size: float
    slopes: Floats


def seeds_beside(search: Search, extreme: Extreme) -> list[Seed]:
    """A start on every ring around an exact extreme of lambda beside a first-harmonic one.

    What could not be told is put into `search.undecided`.
    """
    seeds = []
    for turn in _turns(search, extreme):
        place = _with_harmonics(search, extreme, turn)
        located = None if place is None else _extreme(search, extreme, place)
        if place is not None and located is None:
            place, none = _downhill(search, extreme, place)
            if none:
                continue
            located = _extreme(search, extreme, place)
        if located is not None:
            place, bend = located
            seeds += _on_ring(search, extreme, place, bend) if bend else []
        elif abs(turn.size) < _CLOSE:
            search.undecided.append(turn.W)
    return seeds


def births_ahead(search: Search) -> list[tuple[float, float]]:
    """Factors on the force beyond 1 at which detached curves are born, ascending, and where [rad/s].

    Those up to `LOOKED_AHEAD` whose first-harmonic extreme leads to an exact one; nothing is said of others.
    """
    found = []
    for extreme in starts_of(search).extremes:
        for turn in _turns(search, extreme) if extreme.sign > 0 else ():
            place = _with_harmonics(search, extreme, turn)
            located = None if place is None else _extreme(search, extreme, place)
            if located is None:
                continue
            place, bend = located
            if bend and place.size > 0 and search.lo < place.W < search.hi:
                found.append((math.exp(0.5 * place.size), place.W))
    return sorted(found)


def _turns(search: Search, start: Extreme) -> list[_Place]:
    """Where lambda turns over a at the frequency of a start: the third harmonic can move that far from where it was."""
    found: list[_Place] = []
    X = _unknowns(search, start)
    before, force = None, 0j
    H = min(search.highest, _FIRST_HARMONICS)
    for share, more in zip(_SHARES, _SHARES / np.append(1.0, _SHARES[:-1]), strict=True):
        X = X * more
        place = _place(search, start, start.frequency, X.copy(), H, force)
        if place is None:
            before, X = None, share * _unknowns(search, start)
            continue
        X, force = place.X, place.force
        if before is not None and start.sign * before.slopes[0] < 0 <= start.sign * place.slopes[0]:
            found.append(min(before, place, key=lambda end: abs(float(end.slopes[0]))))
        before = place
    return found


def _on_ring(search: Search, extreme: Extreme, place: _Place, bend: float) -> list[Seed]:
    """A start where lambda passes 1 beside its extreme; none if it does not."""
    if abs(place.size) < 2 * MARGIN:
        search.undecided.append(place.W)
        return []
    if extreme.sign * place.size > 0:
        return []
    way = math.sqrt(-2 * place.size / bend)
    for _ in range(_ITERATIONS):
        beside = _with(search, extreme, place, np.array([way, 0.0]))
        if beside is None:
            break
        if abs(beside.size) < _MET * abs(place.size):
            return [_seed(search, extreme, beside)]
        way -= beside.size / beside.slopes[0]
    if abs(place.size) < _CLOSE:  # larger rings are met from first-harmonic roots
        search.undecided.append(place.W)
    return []


def _extreme(search: Search, start: Extreme, place: _Place) -> tuple[_Place, float] | None:
    """Where lambda is stationary near a place, and the second derivative by ln a, by Broyden's method.

    The derivative is given as 0 where two curves meet instead of one being born. None if the method fails.
    """
    sides = [_with(search, start, place, step) for step in np.diag(_STEPS)]
    if any(side is None for side in sides):
        return None
    B = np.column_stack([(side.slopes - place.slopes) / _STEPS[i] for i, side in enumerate(sides) if side is not None])
    for _ in range(_ITERATIONS):
        step = -np.linalg.lstsq(B, place.slopes, rcond=None)[0]
        step /= max(1.0, float(np.max(np.abs(step) / _LONGEST)))
        if abs(float(step @ place.slopes)) < _STATIONARY * MARGIN:
            bends = np.linalg.eigvalsh((B + B.T) / 2) * start.sign
            return place, float(B[0, 0]) if np.min(bends) > 0 else 0.0
        there = _with(search, start, place, step)
        if there is None:
            return None
        B += np.outer(there.slopes - place.slopes - B @ step, step) / float(step @ step)
        place = there
    return None


def _downhill(search: Search, start: Extreme, place: _Place) -> tuple[_Place, bool]:
    """From a place where lambda turns over a, along such places, towards its extreme over both until it is passed.

    Returns the last place, and whether there is no birth of a small ring: lambda goes past 1 by more than `_CLOSE`, or
    it ceases to turn over a, a minimum and a maximum having met, before it is extreme.
    """
    way = -start.sign * math.copysign(1.0, place.slopes[1])
    share = 1.0
    for _ in range(2 * _ITERATIONS):
        length = share * min(_CAUTIOUS * _CLOSE / max(abs(float(place.slopes[1])), TINY), float(_LONGEST[1]))
        there = _with(search, start, place, np.array([0.0, way * length]))
        there, gone = (None, False) if there is None else _turn_near(search, start, there)
        if there is None:
            if share < _FINEST:
                return place, gone
            share /= 2
            continue
        if start.sign * (there.size - place.size) >= 0:
            return place, False
        place = there
        if start.sign * place.size < -_CLOSE:
            return place, True
    return place, False


def _turn_near(search: Search, start: Extreme, place: _Place) -> tuple[_Place | None, bool]:
    """Where lambda turns over a near a place, at its frequency, by Newton's method; and whether it does not turn."""
    for _ in range(_ITERATIONS):
        side = _with(search, start, place, np.array([_STEPS[1], 0.0]))
        if side is None:
            return None, False
        bend = float(side.slopes[0] - place.slopes[0]) / float(_STEPS[1])
        if start.sign * bend <= 0:
            return None, True
        step = float(np.clip(-place.slopes[0] / bend, -0.5 * _LONGEST[0], 0.5 * _LONGEST[0]))
        if abs(step) < _STEPS[1]:
            return place, False
        there = _with(search, start, place, np.array([step, 0.0]))
        if there is None:
            return None, False
        place = there
    return None, False


def _unknowns(search: Search, start: Extreme) -> Floats:
    """The unknown vector of a start."""
    r = search.problem.M11.shape[0]
    X = np.zeros(search.size(start.odd))
    for k, u in start.harmonics.items():
        at = 2 * r * ((k - 1) // 2 if start.odd else k)
        if at < X.size - 1:
            X[at : at + 2 * r] = np.column_stack([u.real, u.imag]).ravel()
    return X


def _first(search: Search, start: Extreme) -> int:
    """Where the unknown vector has the first harmonic that is kept."""
    return 2 * search.problem.M11.shape[0] * (0 if start.odd else 1) + 2 * start.largest


def _with_harmonics(search: Search, start: Extreme, place: _Place) -> _Place | None:
    """A place with harmonics enough."""
    while True:
        if search.harmonics or place.truncation < _ENOUGH or search.highest < place.H + 4:
            return place
        more = _place(search, start, place.W, place.X.copy(), place.H + 4, place.force)
        if more is None:
            return None
        place = more


def _place(search: Search, start: Extreme, W: float, X: Floats, H: int, force: complex) -> _Place | None:
    """The response with the first harmonic that X has, from X and a force that are near; None if Newton's method fails.

    X receives the response.
    """
    ok, truncation, force, *rest = needed_force(search.problem, H, start.odd, W, start.largest, X, force)
    return _Place(W, X, H, force, truncation, rest[0], np.array(rest[1:])) if ok else None


def _with(search: Search, start: Extreme, place: _Place, step: Floats) -> _Place | None:
    """The response with ln a and ln Omega changed by a step."""
    X = place.X.copy()
    X[_first(search, start)] *= math.exp(step[0])
    return _place(search, start, place.W * math.exp(step[1]), X, place.H, place.force)


def _seed(search: Search, start: Extreme, place: _Place) -> Seed:
    """The response turned so that its force has the phase 0."""
    r = search.problem.M11.shape[0]
    n = unknowns(search.problem, place.H, start.odd)
    u = place.X[:n].reshape(-1, r, 2) @ np.array([1, 1j])
    turn = place.force.conjugate() / abs(place.force)
    ks = range(1, place.H + 1, 2) if start.odd else range(place.H + 1)
    return Seed(place.W, {k: np.asarray(u[m] * turn**k) for m, k in enumerate(ks)})


@kernel
def needed_force(pb, H, odd, W, c, X, force):
    """The force lambda e^{i phase} F that makes X a response whose coordinate c keeps its first harmonic, a real one.

    X receives the other unknowns. Returns (converged, truncation, lambda e^{i phase}, ln lambda^2, and its derivatives
    by ln a and ln Omega).
    """
    r = pb.M11.shape[0]
    n = unknowns(pb, H, odd)
    at = 0 if odd else 2 * r
    re, im = at + 2 * c, at + 2 * c + 1
    a = X[re]
    co, si = fourier_tables(H, odd, sample_count(pb, H, odd))
    F, dF = np.empty(r, np.complex128), np.empty(r, np.complex128)
    S, dS = np.empty((r, r), np.complex128), np.empty((r, r), np.complex128)
    stiffness(pb, 1j * W, S, dS, F, dF)
    R, J, A = np.empty(n + 1), np.empty((n + 1, n + 1)), np.empty((n, n))
    pivots = np.empty(n, np.int64)
    missing = 1.0 - force  # part of F that is not there
    truncation = math.inf
    done = False
    for _ in range(20):
        truncation = residual_and_jacobian(pb, H, odd, W, X, co, si, R, J)
        for i in range(r):
            part = missing * F[i]
            R[at + 2 * i] += part.real
            R[at + 2 * i + 1] += part.imag
        _put_force(A, J, n, r, at, re, a, F)
        if not factorise(A, pivots, n):
            return False, truncation, force, 0.0, 0.0, 0.0
        solve_factorised(A, pivots, n, R)
        size = 0.0
        for j in range(n):
            size = max(size, abs(R[j]))
            if j != re and j != im:
                X[j] -= a * R[j]
        missing -= complex(R[re], R[im])
        if not size < 1e3:
            return False, truncation, force, 0.0, 0.0, 0.0
        if size < 1e-12 or (done and size < 1e-9):
            done = True
            break
        done = size < 1e-9
    force = 1.0 - missing
    by = np.empty(2)
    for which in range(2):
        for j in range(n):
            R[j] = J[j, re] * a if which == 0 else J[j, n] * W
        if which == 1:
            for i in range(r):
                part = missing * 1j * dF[i] * W
                R[at + 2 * i] += part.real
                R[at + 2 * i + 1] += part.imag
        solve_factorised(A, pivots, n, R)
        slope = complex(R[re], R[im])  # of the force: what is missing falls by it
        by[which] = 2.0 * (force.conjugate() * slope).real / abs(force) ** 2
    return done, truncation, force, 2.0 * math.log(abs(force)), by[0], by[1]


@kernel
def _put_force(A, J, n, r, at, re, a, F):
    """Jacobian by the unknowns per a, the missing part of the force in place of the first harmonic that is kept."""
    for i in range(n):
        for j in range(n):
            A[i, j] = a * J[i, j]
        A[i, re] = A[i, re + 1] = 0.0
    for i in range(r):
        row = at + 2 * i
        A[row, re], A[row, re + 1] = F[i].real, -F[i].imag
        A[row + 1, re], A[row + 1, re + 1] = F[i].imag, F[i].real
