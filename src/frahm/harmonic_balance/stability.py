"""Stability along a followed branch: cut to the window, its multipliers, points between, bifurcations."""

from __future__ import annotations

import math

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.bifurcations import bifurcations_in_step, steps_with_bifurcations, unlocated_in_step
from frahm.harmonic_balance.branch import (
    Bifurcation,
    Point,
    Points,
    SolutionBranch,
    described,
    located,
    points_of,
    with_multipliers,
)
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.following import point_in_step
from frahm.harmonic_balance.newton import solve_at
from frahm.harmonic_balance.search import Search
from frahm.tolerances import TINY

_QUICK = 0.2  # way of a multiplier near the unit circle from point to point that asks for a point between
_BEYOND_NUMBERS = 1e300  # stands for a multiplier that no number holds
_ROUNDS = 6  # of points put between points
_GRAZING = 0.1  # of its bend: a logarithm whose summit comes as near to zero may have crossed it
_STRAIGHT = 1e-9  # bend of a logarithm that is rounding
_NEAR_CIRCLE = 0.9  # modulus from which on a multiplier may soon leave the unit circle


def analyse_stability(search: Search, branch: SolutionBranch) -> bool:
    """Cut a followed branch to the window, find the multipliers of its points, and locate the bifurcations on it.

    Returns whether any of it lies in the window.
    """
    inside = (branch.points.frequency >= search.lo) & (branch.points.frequency <= search.hi)
    if np.sum(inside) < 2:
        return False
    branch.outside = _branch_points_outside(search, branch, inside) if branch.odd else []
    branch.points = described(search, branch.odd, _cut_to_window(search, branch))
    _refine(search, branch)
    _locate_bifurcations(search, branch)
    return True


def _branch_points_outside(search: Search, branch: SolutionBranch, inside: np.ndarray) -> list[Bifurcation]:
    """Losses of symmetry where a followed branch lies outside the window."""
    found: list[Bifurcation] = []
    W = branch.points.frequency
    for rows in np.split(np.arange(len(inside)), np.flatnonzero(np.diff(inside)) + 1):
        if inside[rows[0]]:
            continue
        rows = np.arange(max(rows[0] - 1, 0), min(rows[-1] + 2, len(inside)))
        rows = rows[(W[rows] >= search.outer[0]) & (W[rows] <= search.outer[1])]
        if len(rows) < 2:
            continue
        part = SolutionBranch(True, with_multipliers(search, branch.points.take(rows)), False, ())
        for i in np.flatnonzero(steps_with_bifurcations(search, part)):
            if search.budget.bifurcations <= 0:
                break
            search.budget.bifurcations -= 1
            part.bifurcations += bifurcations_in_step(search, part, int(i))
        found += [one for one, _ in located(part.bifurcations, "branch-point")]
    return found


def _cut_to_window(search: Search, branch: SolutionBranch) -> Points:
    """The points of a branch in the window, with points exactly on its edges; pieces stay in order along the branch."""
    W = branch.points.frequency
    inside = np.flatnonzero((search.lo <= W) & (search.hi >= W))
    steps, edges = _edges_crossed(W, (search.lo, search.hi))
    points = branch.points.take(inside)
    if len(steps):
        new = [_on_edge(search, branch, int(i), float(edge)) for i, edge in zip(steps, edges, strict=True)]
        added = points_of(search, branch.odd, new, branch.points.truncations[steps])
        points = points.insert(np.searchsorted(inside, steps, side="right"), added)
    W = points.frequency
    gaps = np.flatnonzero((W[:-1] == W[1:]) & ((W[1:] == search.lo) | (W[1:] == search.hi))) + 1
    if branch.closed and gaps.size:  # begin where the branch comes into the window, not in the middle of a piece
        points = points.take(np.concatenate([np.arange(gaps[0], len(W)), np.arange(1, gaps[0])]))
    return points


def _edges_crossed(W: Floats, edges: tuple[float, float]) -> tuple[np.ndarray, Floats]:
    """Steps of a branch that cross an edge of the window, and the edge, in order along the branch."""
    steps = np.concatenate([np.flatnonzero((W[:-1] - edge) * (W[1:] - edge) < 0) for edge in edges])
    crossed = np.repeat(edges, [np.count_nonzero((W[:-1] - edge) * (W[1:] - edge) < 0) for edge in edges])
    order = np.lexsort([np.abs(crossed - W[steps]), steps])
    return steps[order], crossed[order]


def _on_edge(search: Search, branch: SolutionBranch, i: int, edge: float) -> Point:
    """Point of the branch at Omega = edge between points i and i + 1."""
    pb, odd = search.problem, branch.odd
    H = int(max(branch.points.Hs[i : i + 2]))
    a, b = (branch.points[k].with_harmonics(pb, odd, H) for k in (i, i + 1))
    n = unknowns(pb, H, odd)
    f = (edge - a.y[n]) / (b.y[n] - a.y[n])
    y = (1 - f) * a.y + f * b.y
    ok, _, _ = solve_at(pb, odd, edge, y, H, search.highest, math.inf, 12)
    y[n] = edge
    return Point(y if ok else a.y, (1 - f) * a.t + f * b.t, H)


def _refine(search: Search, branch: SolutionBranch) -> None:
    """Insert points where a multiplier may leave the unit circle and come back between two points, or moves far."""
    for _ in range(_ROUNDS):
        m, W = branch.points.multipliers, branch.points.frequency
        m = np.where(np.isfinite(m), m, _BEYOND_NUMBERS)
        logs = np.log(np.maximum(np.abs(m), TINY))
        left, mid, right = logs[:-2], logs[1:-1], logs[2:]
        bend = left - 2 * mid + right
        with np.errstate(divide="ignore", invalid="ignore"):
            summit = mid - (right - left) ** 2 / (8 * bend)
        crossed = (np.sign(summit) != np.sign(mid)) | (np.abs(summit) < _GRAZING * np.abs(bend))
        hidden = ((mid - left) * (mid - right) > 0) & crossed & (np.abs(bend) > _STRAIGHT)
        rows = np.flatnonzero(hidden.any(axis=1)) + 1
        leap = np.min(np.abs(m[:-1, :, None] - m[1:, None, :]), axis=2)
        size = np.abs(m[:-1])  # far outside the unit circle a way counts beside the size: steep growth asks for nothing
        quick = np.flatnonzero(((leap > _QUICK * np.maximum(size, 1.0)) & (size > _NEAR_CIRCLE)).any(axis=1))
        wanted = np.unique(np.concatenate([rows - 1, rows, quick]))
        wanted = wanted[W[wanted] != W[wanted + 1]]  # not across a gap between pieces
        search.budget.take_points(len(wanted), int(unknowns(search.problem, np.max(branch.points.Hs), branch.odd)))
        if search.budget.reached or not _insert_midpoints(search, branch, wanted):
            return


def _insert_midpoints(search: Search, branch: SolutionBranch, steps: np.ndarray) -> bool:
    """Insert a point in the middle of every listed step; returns whether any was inserted."""
    middles = [(int(i), point_in_step(search, branch, int(i))) for i in steps]
    new = [(i, point) for i, point in middles if point is not None]
    _insert(search, branch, new)
    return bool(new)


def _insert(search: Search, branch: SolutionBranch, new: list[tuple[int, Point]]) -> None:
    """Insert points in the steps of these numbers."""
    if new:
        steps = np.array([i for i, _ in new])
        added = points_of(search, branch.odd, [point for _, point in new], branch.points.truncations[steps])
        branch.points = branch.points.insert(steps + 1, described(search, branch.odd, added))


def _locate_bifurcations(search: Search, branch: SolutionBranch) -> None:
    """Locate every change of stability or direction along the branch and put its point on the branch."""
    new: list[tuple[int, Point]] = []
    for i in np.flatnonzero(steps_with_bifurcations(search, branch)):
        within = bifurcations_in_step if search.budget.bifurcations > 0 else unlocated_in_step
        found = within(search, branch, int(i))
        search.budget.bifurcations -= len(found)
        branch.bifurcations += found
        new += [(int(i), one.point) for one in found if one.point is not None]
    _insert(search, branch, new)
