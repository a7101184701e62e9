"""All first-harmonic responses of several cubic elements that one motion of the structure drives.

Where the condensed stiffness couples the coordinates through one motion only, S = diag(p) + F b^T, as it does for any
two absorbers on any structure and for any number of them on one mode, the balance S U + k |U|^2 U = F is

    p_i U_i + k_i |U_i|^2 U_i = F_i Y ,   Y = 1 - sum_i b_i U_i .

With Y = y e^{i theta} every U_i e^{-i theta} follows from y through a cubic with one or three roots, so that all
solutions are the roots y > 0 of |y + sum_i b_i U_i(y) e^{-i theta}| = 1 over the combinations of these. Between the
turning values of the cubics each combination is an analytic function of y, whose roots are searched on a grid that is
dense at the turning values: the cubics are solved once a place, for all combinations, and with the slopes two roots
between neighbouring places are seen, too. The degree of the equations is 1 where every k_i is not zero, so that the
signs of det J of all solutions add up to 1: where they do not, the grid is refined.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.arrays import Complexes, Floats
from frahm.harmonic_balance.condensation import CondensedSystem, stiffness_at, stiffness_over
from frahm.harmonic_balance.drive_roots import roots_of_drive

_POINTS = (64, 256, 1024, 4096)  # of an interval of y: the first, then what is tried where the degree says no
_COUPLED = 1e-9  # of the largest coupling: what is rounding
_MOST = 6  # coordinates: combinations grow as 3 to that number


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
    if b is None:
        return Solutions(none, (none, np.empty(0), np.empty(0)), False)
    for points in _POINTS:
        harmonics, turns, sizes, degree, fits = roots_of_drive(S, F, b, k, points)
        found = Solutions(harmonics, (turns, sizes[:, 0], sizes[:, 1]), bool(fits and degree == 1))
        if found.complete:
            break
    return found
