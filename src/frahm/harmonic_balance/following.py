"""A branch followed through one of its points, and whether a solution lies on it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from frahm.arrays import Floats
from frahm.compiled import kernel
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
    points, r, W = branch.points, search.problem.M11.shape[0], float(y[unknowns(search.problem, H, branch.odd)])
    out = np.empty(len(points.Hs), np.int64)
    near = out[: steps_near(r, branch.odd, points.ys, points.ts, points.Hs, y, H, search.x_scale, search.w_scale, out)]
    return any(lies_in_step(search, branch, y, H, W, int(i)) for i in near)


def lies_in_step(search: Search, branch: SolutionBranch, X: Floats, H: int, W: float, i: int) -> bool:
    """Whether a solution at Omega = W is the point of the branch in its own plane across the chord of step i."""
    pb, odd = search.problem, branch.odd
    n = unknowns(pb, H, odd)
    y = np.append(X[:n], W)
    scales = np.append(np.full(n, search.x_scale), search.w_scale)
    ends = branch.points.ys[i : i + 2], branch.points.Hs[i : i + 2]
    fraction = share_of_step(pb.M11.shape[0], odd, *ends, 0, y, H, search.x_scale, search.w_scale)
    if math.isnan(fraction):
        return False
    point = point_in_step(search, branch, i, fraction)
    if point is None:
        return False
    apart = (point.with_unknowns(pb, odd, n) - y) / scales
    return bool(np.linalg.norm(apart) < _SAME * np.linalg.norm(y[:n]) / search.x_scale)


@kernel
def steps_near(r, odd, ys, ts, Hs, y, H, x_scale, w_scale, out):
    """Fill out with the steps of a branch on which a solution may lie; returns how many.

    Only steps that reach its frequency are looked at, or in which the frequency turns.
    """
    W, count = y[size_of(r, H, odd)], 0
    for i in range(Hs.size - 1):
        here, there = size_of(r, Hs[i], odd), size_of(r, Hs[i + 1], odd)
        reached = (ys[i, here] - W) * (ys[i + 1, there] - W) <= 0.0
        if (reached or ts[i, here] * ts[i + 1, there] < 0.0) and not math.isnan(
            share_of_step(r, odd, ys, Hs, i, y, H, x_scale, w_scale)
        ):
            out[count] = i
            count += 1
    return count


@kernel
def share_of_step(r, odd, ys, Hs, i, y, H, x_scale, w_scale):
    """Share of step i of a branch at which the plane across its chord holds a solution; NaN if that is far from it."""
    n = size_of(r, H, odd)
    n0, n1 = size_of(r, Hs[i], odd), size_of(r, Hs[i + 1], odd)
    chord = gap = along = 0.0
    for j in range(n + 1):
        a = ys[i, j] / x_scale if j < n0 else 0.0
        b = ys[i + 1, j] / x_scale if j < n1 else 0.0
        c = y[j] / x_scale
        if j == n:
            a, b, c = ys[i, n0] / w_scale, ys[i + 1, n1] / w_scale, y[n] / w_scale
        chord += (b - a) ** 2
        gap += (c - a) ** 2
        along += (b - a) * (c - a)
    if chord == 0.0:  # the branch was outside the window in between
        return math.nan
    share = along / chord
    off = gap - share * along
    return share if -_OVERHANG <= share <= 1.0 + _OVERHANG and off <= _AWAY * _AWAY * chord else math.nan


@kernel
def size_of(r, H, odd):
    """Number of unknowns of r coordinates with harmonics up to H."""
    return 2 * r * ((H + 1) // 2 if odd else H + 1)


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
