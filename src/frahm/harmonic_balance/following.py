"""A branch followed through one of its points, and whether a solution lies on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.branch import Point, Points, SolutionBranch, point_between, undescribed
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.follow import CLOSED, follow
from frahm.harmonic_balance.search import Search

_MOST_POINTS = 6000
_LONGEST = 0.02
_HALVINGS = 60
_OVERHANG = 0.01  # of a chord beyond its ends, where a solution at an end of a step may lie by rounding
_AWAY = 0.5  # of a chord: farther from it no point of a smooth branch lies
_SAME = 1e-5  # relative distance of two solutions that are one
_ROUNDING = 1e-13  # of a frequency


def followed(search: Search, odd: bool, y: Floats, H: int) -> SolutionBranch:
    """Follow a branch from one of its points in both directions."""
    forward, ending = _one_way(search, odd, y, H, 1.0)
    if ending == CLOSED:
        return SolutionBranch(odd, forward, True, (ending,))
    backward, other = _one_way(search, odd, y, H, -1.0)
    reverse = backward.take(np.arange(len(backward))[:0:-1])
    points = forward.insert(np.zeros(len(reverse), int), replace(reverse, ts=-reverse.ts))
    return SolutionBranch(odd, points, False, (other, ending))


def _one_way(search: Search, odd: bool, y: Floats, H: int, direction: float) -> tuple[Points, int]:
    size = search.size(odd)
    most = search.budget.points_of(unknowns(search.problem, H, odd), _MOST_POINTS)
    ys, ts = np.empty((most, size)), np.empty((most, size))
    Hs, truncations = np.empty(most, np.int64), np.empty(most)
    count, ending = follow(
        search.problem, odd, y, H, search.highest, search.goal, direction, *search.outer,
        search.x_scale, search.w_scale, _LONGEST, ys, ts, Hs, truncations,
    )  # fmt: skip
    if count:
        search.budget.take_points(count, int(np.mean(unknowns(search.problem, Hs[:count], odd))))
    return undescribed(search, odd, ys[:count].copy(), ts[:count].copy(), Hs[:count], truncations[:count]), ending


def far_from_folds(search: Search, branch: SolutionBranch) -> int:
    """The point of a branch in the window where Omega changes most along it: a good one to solve anew at its Omega."""
    rise, W = np.abs(branch.points.rise(search.problem, branch.odd)), branch.points.frequency
    return int(np.argmax(np.where((search.lo <= W) & (search.hi >= W), rise, -1.0)))


def lies_on(search: Search, branch: SolutionBranch, y: Floats, H: int) -> bool:
    """Whether a solution is a point of a branch already followed: compared in its own plane across the chord of a step.

    Only steps that reach its frequency are looked at, or in which the frequency turns.
    """
    n = unknowns(search.problem, H, branch.odd)
    beyond = branch.points.frequency - y[n]
    rise = branch.points.rise(search.problem, branch.odd)
    steps = np.flatnonzero((beyond[:-1] * beyond[1:] <= 0) | (rise[:-1] * rise[1:] < 0))
    return any(lies_in_step(search, branch, y, H, y[n], int(i)) for i in steps)


def lies_in_step(search: Search, branch: SolutionBranch, X: Floats, H: int, W: float, i: int) -> bool:
    """Whether a solution at Omega = W is the point of the branch in its own plane across the chord of step i."""
    pb, odd = search.problem, branch.odd
    n = unknowns(pb, H, odd)
    y = np.append(X[:n], W)
    scales = np.append(np.full(n, search.x_scale), search.w_scale)
    a, b = (branch.points[k].with_unknowns(pb, odd, n) / scales for k in (i, i + 1))
    here, chord = y / scales - a, b - a
    length = float(np.linalg.norm(chord))
    if length == 0.0:  # the branch was outside the window in between
        return False
    fraction = float(here @ chord) / length**2
    if not -_OVERHANG <= fraction <= 1 + _OVERHANG or np.linalg.norm(here - fraction * chord) > _AWAY * length:
        return False
    point = point_in_step(search, branch, i, fraction)
    if point is None:
        return False
    apart = (point.with_unknowns(pb, odd, n) - y) / scales
    return bool(np.linalg.norm(apart) < _SAME * np.linalg.norm(y[:n]) / search.x_scale)


def point_in_step(search: Search, branch: SolutionBranch, i: int, fraction: float = 0.5) -> Point | None:
    """Point of a branch between its points i and i + 1; None if Newton's method fails."""
    return point_between(search, branch.odd, branch.points[i], branch.points[i + 1], fraction)


def point_at(search: Search, branch: SolutionBranch, i: int, W: float) -> Point | None:
    """Point of the branch at Omega = W between points i and i + 1, by the Illinois method."""
    lo, hi, (below, above) = 0.0, 1.0, branch.points.frequency[i : i + 2] - W
    found = None
    for _ in range(_HALVINGS):
        share = 0.5 * (lo + hi) if below == above else (lo * above - hi * below) / (above - below)
        point = point_in_step(search, branch, i, share)
        if point is None:
            return found
        found = point
        miss = float(point.y[unknowns(search.problem, point.H, branch.odd)]) - W
        if abs(miss) < _ROUNDING * W:
            break
        if miss * above < 0:
            lo, below = hi, above
        else:
            below *= 0.5
        hi, above = share, miss
    return found
