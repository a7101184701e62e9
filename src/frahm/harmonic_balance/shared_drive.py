"""All first-harmonic responses of several cubic elements that one motion of the structure drives.

Where the condensed stiffness couples the coordinates through one motion only, S = diag(p) + F b^T, as it does for any
two absorbers on any structure and for any number of them on one mode, the balance S U + k |U|^2 U = F is

    p_i U_i + k_i |U_i|^2 U_i = F_i Y ,   Y = 1 - sum_i b_i U_i .

With Y = y e^{i theta} every U_i e^{-i theta} follows from y through a cubic with one or three roots, so that all
solutions are the roots y > 0 of |y + sum_i b_i U_i(y) e^{-i theta}| = 1 over the combinations of these. Between the
turning values of the cubics each combination is an analytic function of y, whose roots are searched on a grid that is
dense at the turning values. The degree of the equations is 1 where every k_i is not zero, so that the signs of det J of
all solutions add up to 1: where they do not, the grid is refined.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from frahm.arrays import Complexes, Floats
from frahm.compiled import kernel
from frahm.harmonic_balance.condensation import CondensedSystem, stiffness_at, stiffness_over
from frahm.polynomials import cubic_roots

_POINTS = (192, 768, 3072)  # of an interval of y: the first, then what is tried where the degree says no
_COUPLED = 1e-9  # of the largest coupling: what is rounding
_MOST = 6  # coordinates: combinations grow as 3 to that number
_SAME = 1e-9
_SOLVED = 1e-6  # of the drive: what a change of sign that is a root leaves
_NEAR = 0.3  # |lambda - 1| up to which its turns are told


class _Arc(NamedTuple):
    """One combination of roots between two turning values of y."""

    p: Complexes  # (r,)
    F: Complexes  # (r,)
    b: Complexes  # (r,)
    k: Floats  # (r,)
    which: np.ndarray  # (r,): which root every coordinate takes
    counts: np.ndarray  # (r,): of how many
    lo: float
    hi: float


@dataclass(frozen=True)
class Solutions:
    """First harmonics at one frequency.

    Attributes
    ----------
    harmonics : ndarray, shape (s, r)
        U of all solutions.
    turns : tuple of ndarray
        U (t, r) where the force lambda F that a combination needs is extreme over y, near lambda = 1; there
        ln lambda^2 (t,), and +1 (t,) for a minimum or -1 for a maximum.
    complete : bool
        Whether the signs of det J of the solutions add up to the degree of the equations.
    """

    harmonics: Complexes
    turns: tuple[Complexes, Floats, Floats]
    complete: bool


def shared_stiffnesses(pb: CondensedSystem, window: Floats) -> Floats | None:
    """k_i (r,) where `solutions_at` finds all first-harmonic solutions at frequencies of a window; None elsewhere."""
    k = cubic_stiffnesses(pb)
    if k is None or any(shared_drive(S, F) is None for S, F in zip(*stiffness_over(pb, 1, window), strict=True)):
        return None
    return k


def cubic_stiffnesses(pb: CondensedSystem) -> Floats | None:
    """k_i (r,) of cubic elements each of which moves with one coordinate; None for any other elements."""
    if pb.degree == 0 or not pb.odd or np.any(np.count_nonzero(pb.directions, axis=0) != 1):
        return None
    k = np.zeros(pb.directions.shape[0])
    for (_, start, count), d in zip(pb.codes, pb.directions.T, strict=True):
        c = pb.table[start + 1 : start + 1 + count][::-1]
        if np.any(np.delete(c, [2])) or count < 3:
            return None
        at = int(np.flatnonzero(d)[0])
        k[at] += 0.75 * c[2] * d[at] ** 4
    return k if k.size <= _MOST and np.all(k != 0) else None


def shared_drive(S: Complexes, F: Complexes) -> Complexes | None:
    """b (r,) with S = diag(p) + F b^T off the diagonal; None if one motion does not couple all coordinates."""
    r = F.size
    if np.any(np.abs(F) <= _COUPLED * np.max(np.abs(F))):  # not driven, but for rounding
        return None
    per_force = S / F[:, None]
    b = np.array([np.mean(np.delete(per_force[:, j], j)) for j in range(r)])
    misfit = np.abs(S - F[:, None] * b)
    np.fill_diagonal(misfit, 0.0)
    return b if np.all(misfit <= _COUPLED * np.max(np.abs(S))) else None


def solutions_at(pb: CondensedSystem, W: float, k: Floats) -> Solutions:
    """All first-harmonic solutions at Omega = W [rad/s] of coordinates with the cubic stiffnesses k (r,)."""
    S, F = stiffness_at(pb, 1, W)
    b = shared_drive(S, F)
    none = np.empty((0, F.size), complex)
    found = Solutions(none, (none, np.empty(0), np.empty(0)), False)
    if b is None:
        return found
    for points in _POINTS:
        harmonics, turns = _roots(np.diag(S) - F * b, F, b, k, points)
        found = Solutions(harmonics, turns, _degree(S, k, harmonics) == 1)
        if found.complete:
            break
    return found


def _degree(S: Complexes, k: Floats, U: Complexes) -> int:
    """Sum of the signs of det J over solutions (s, r)."""
    r = k.size
    total = 0
    for u in U:
        J = np.empty((2 * r, 2 * r), complex)  # for U and its conjugate
        J[:r, :r] = S + np.diag(2 * k * np.abs(u) ** 2)
        J[:r, r:] = np.diag(k * u**2)
        J[r:, :r], J[r:, r:] = J[:r, r:].conj(), J[:r, :r].conj()
        total += int(np.sign(np.linalg.det(J / np.max(np.abs(J))).real))
    return total


def _roots(
    p: Complexes, F: Complexes, b: Complexes, k: Floats, points: int
) -> tuple[Complexes, tuple[Complexes, Floats, Floats]]:
    """Solutions (s, r), and the turns of the force, see `Solutions`."""
    found: list[Complexes] = []
    turning: list[Complexes] = []
    sizes: list[tuple[float, float]] = []
    for arc in _arcs(p, F, b, k):
        out, turns = np.empty((points, 2)), np.empty((points, 3))
        number, turned = _search(arc, points, out, turns)
        found += [_motion(arc, s) for s, miss in out[:number] if miss < _SOLVED]
        turning += [_motion(arc, s) for s in turns[:turned, 0]]
        sizes += [(2 * math.log1p(excess), sign) for _, excess, sign in turns[:turned]]
    force, sign = np.array(sizes).reshape(-1, 2).T
    return _distinct(found, k.size), (np.array(turning, complex).reshape(-1, k.size), force, sign)


def _arcs(p: Complexes, F: Complexes, b: Complexes, k: Floats) -> Iterator[_Arc]:
    """Every combination of roots between every two turning values of y."""
    edges = [0.0, *sorted(y for i in range(k.size) for y in _turning_drives(p[i], F[i], k[i]))]
    edges.append(_largest_drive(p, F, b, k, edges[-1]))
    for lo, hi in itertools.pairwise(edges):
        if hi - lo <= _SAME * hi:  # of equal elements: what lies between is rounding
            continue
        middle = 0.5 * (lo + hi)
        counts = np.array([cubic_roots(p[i], F[i] * middle, k[i])[0] for i in range(k.size)])
        for roots in itertools.product(*(range(count) for count in counts)):
            yield _Arc(p, F, b, k, np.array(roots), counts, lo, hi)


def _distinct(found: list[Complexes], r: int) -> Complexes:
    kept: list[Complexes] = []
    for u in found:
        if not any(np.max(np.abs(u - other)) < _SAME * np.max(np.abs(u)) for other in kept):
            kept.append(u)
    return np.array(kept, complex).reshape(-1, r)


def _turning_drives(p: complex, F: complex, k: float) -> list[float]:
    """Values of y at which a pair of roots of p U + k |U|^2 U = F y appears or vanishes."""
    c = math.copysign(1.0, k) * p.real / abs(p)
    if c > -math.sqrt(0.75):
        return []
    spread = math.sqrt(4 * c * c - 3)
    sizes = [(-2 * c + side * spread) / 3 * abs(p) / abs(k) for side in (-1, 1)]
    return [abs(p + k * N) * math.sqrt(N) / abs(F) for N in sizes]


def _largest_drive(p: Complexes, F: Complexes, b: Complexes, k: Floats, beyond: float) -> float:
    """A value of y above which no combination is a solution: all U together stay below y - 1."""
    y = max(2.0, 2.0 * beyond)
    while True:
        largest = [cubic_roots(p[i], F[i] * y, k[i]) for i in range(k.size)]
        U = np.array([math.sqrt(roots[roots[0]]) for roots in largest])
        growing = all(abs(p[i] + k[i] * U[i] ** 2) >= abs(p[i]) for i in range(k.size))
        if growing and y - float(np.abs(b) @ U) > 1.0:
            return y
        y *= 2.0


@kernel
def _unturned(arc, s, U):
    """Fill U (r,) with U_i e^{-i theta} of the chosen roots and return y, at the share s of the interval.

    The shares are dense in y at both ends, as the square roots there want it.
    """
    y = arc.lo + 0.5 * (arc.hi - arc.lo) * (1.0 - math.cos(math.pi * s))
    for i in range(arc.k.size):
        at, share = y, 1e-15
        count, small, middle, large = cubic_roots(arc.p[i], arc.F[i] * at, arc.k[i])
        while count != arc.counts[i] and share < 1.0:  # at a turning value rounding takes a pair away, or makes one
            at, share = y + share * (0.5 * (arc.lo + arc.hi) - y), 10.0 * share
            count, small, middle, large = cubic_roots(arc.p[i], arc.F[i] * at, arc.k[i])
        N = small if arc.which[i] == 0 else (middle if arc.which[i] == 1 else large)
        U[i] = arc.F[i] * at / (arc.p[i] + arc.k[i] * N)
    return y


@kernel
def _excess(arc, s, U):
    total = complex(_unturned(arc, s, U), 0.0)
    for i in range(U.size):
        total += arc.b[i] * U[i]
    return abs(total) - 1.0


@kernel
def _search(arc, points, out, turns):
    """Roots s in [0, 1] of one combination, with what they miss by, into out; s, lambda - 1 and sign into turns."""
    U = np.empty(arc.k.size, np.complex128)
    number = turned = 0
    value = np.empty(points)
    step = 1.0 / (points - 1.0)
    for j in range(points):
        value[j] = _excess(arc, j * step, U)
    for j in range(points - 1):
        if value[j] * value[j + 1] <= 0.0 and value[j] != 0.0:
            number = _put_crossing(arc, j * step, (j + 1) * step, U, out, number)
    for j in range(1, points - 1):
        if (value[j] - value[j - 1]) * (value[j] - value[j + 1]) <= 0.0 or abs(value[j]) > _NEAR:
            continue
        left, right = (j - 1) * step, (j + 1) * step
        sign = 1.0 if value[j] < value[j - 1] else -1.0
        s = _summit(arc, left, right, sign, U)
        there = _excess(arc, s, U)
        if there * value[j] <= 0.0 and value[j] * value[j - 1] > 0.0 and value[j] * value[j + 1] > 0.0:
            number = _put_crossing(arc, left, s, U, out, number)
            number = _put_crossing(arc, s, right, U, out, number)
        if turned < turns.shape[0]:
            turns[turned, 0], turns[turned, 1], turns[turned, 2] = s, there, sign
            turned += 1
    return number, turned


@kernel
def _put_crossing(arc, left, right, U, out, number):
    """Put the root between two places, by bisection, into out; returns how many are there."""
    below = _excess(arc, left, U)
    for _ in range(60):
        s = 0.5 * (left + right)
        if _excess(arc, s, U) * below > 0.0:
            left = s
        else:
            right = s
    if number < out.shape[0]:
        out[number, 0] = 0.5 * (left + right)
        out[number, 1] = abs(_excess(arc, out[number, 0], U))
        number += 1
    return number


@kernel
def _summit(arc, left, right, sign, U):
    """Place between two others where sign times the excess is smallest, by golden sections."""
    share = 0.5 * (math.sqrt(5.0) - 1.0)
    for _ in range(40):
        a, c = right - share * (right - left), left + share * (right - left)
        if sign * _excess(arc, a, U) < sign * _excess(arc, c, U):
            right = c
        else:
            left = a
    return 0.5 * (left + right)


def _motion(arc: _Arc, s: float) -> Complexes:
    """U (r,) of a combination at a place, turned to the phase of the force."""
    U = np.empty(arc.k.size, complex)
    total = _unturned(arc, s, U) + complex(arc.b @ U)
    return np.asarray(U * abs(total) / total)
