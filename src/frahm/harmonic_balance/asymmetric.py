"""Branches that lack the symmetry of the equations: from where it is lost, and about other means."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from frahm.arrays import Floats
from frahm.continuation.dense import factorise, solve_factorised
from frahm.harmonic_balance.branch import Bifurcation, Point, SolutionBranch, described, located, points_of
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.following import followed, lies_on
from frahm.harmonic_balance.kernels import fourier_tables, residual_and_jacobian, sample_count
from frahm.harmonic_balance.newton import correct
from frahm.harmonic_balance.search import Search
from frahm.harmonic_balance.seeds import Seed
from frahm.harmonic_balance.stability import analyse_stability
from frahm.harmonic_balance.starts import solve_seed

_REACH = 2.0  # steps of a branch within which its end lies of the point where it is born
_SAME = 1e-7
_SYMMETRIC = 1e-3  # even part, in units of the scale, below which an orbit of any parity is a symmetric one
_PUSHES = (0.02, 0.005, 0.05)  # off the symmetric orbit, in units of the scale, tried in this order
_KEPT = 0.3  # share of a push that must be left as even part: else Newton's method fell back on the symmetric branch
_RESIDUAL, _MOST_STEPS = 1e-9, 15  # of Newton's method
_TILT = 1e-14  # of a singular matrix, relative, so that it can be factorised
_ALL_BUT_SYMMETRIC = 0.05  # even part at an end over that of its neighbour


def asymmetric_branches(search: Search, parent: SolutionBranch, known: list[SolutionBranch]) -> list[SolutionBranch]:
    """Branches with even harmonics that leave an odd branch where it loses its symmetry.

    One of each mirrored pair is followed, between the points at which it meets odd branches.
    """
    if not parent.odd:
        return []
    branches: list[SolutionBranch] = []
    for event, point in located([*parent.bifurcations, *parent.outside], "branch-point"):
        asymmetric = [branch for branch in known + branches if not branch.odd]
        ends = [branch.points.columns[i] for branch in asymmetric for i in (0, -1)]
        if any(np.allclose(c[[0, 4]], event.columns[[0, 4]], rtol=_SAME) for c in ends):
            continue
        start = None if search.budget.reached else _asymmetric_start(search, point)
        if start is None:
            continue
        branch = _half_of_pair(search, followed(search, False, *start))
        branch.parent = parent
        if analyse_stability(search, branch) and not any(_is_same(search, branch, other) for other in asymmetric):
            _extend_to_branch_points(search, branch, [other for other in known if other.odd])
            branches.append(branch)
    return branches


def _extend_to_branch_points(search: Search, branch: SolutionBranch, odd: list[SolutionBranch]) -> None:
    """Put the points at which the symmetry is lost on the ends of a branch that leaves there."""
    births = [birth for other in odd for birth in located(other.bifurcations, "branch-point")]
    places = [_scaled(search, _with_even(search, point)) for _, point in births]
    for end, beside in ((0, 1), (-1, -2)):
        a, b = (_scaled(search, branch.points[i]) for i in (end, beside))
        away = [float(np.linalg.norm(place - a)) for place in places]
        if away and min(away) < _REACH * float(np.linalg.norm(b - a)):
            _put_at_end(search, branch, end, *births[int(np.argmin(away))])


def _put_at_end(search: Search, branch: SolutionBranch, end: int, event: Bifurcation, birth: Point) -> None:
    """Add a symmetric point to an end of an asymmetric branch, which leaves it along its even part."""
    tangent, n = np.zeros(search.size(False)), unknowns(search.problem, birth.H, False)
    even = branch.points.ys[end, :n].copy().reshape(-1, 2 * search.problem.M11.shape[0])
    even[1::2] = 0.0
    tangent[:n] = even.ravel() / np.linalg.norm(even) * (1.0 if end == 0 else -1.0)
    point = replace(_with_even(search, birth), t=tangent)
    new = described(search, False, points_of(search, False, [point], branch.points.truncations[[end]]))
    new = replace(new, columns=event.columns[None])  # the same numbers as on the branch that it leaves
    branch.points = branch.points.insert([0 if end == 0 else len(branch.points)], new)


def _with_even(search: Search, point: Point) -> Point:
    """A point with odd harmonics only, as one with all harmonics."""
    r, H = search.problem.M11.shape[0], point.H
    odd_n, n = unknowns(search.problem, H, True), unknowns(search.problem, H, False)
    y, t = np.zeros(search.size(False)), np.zeros(search.size(False))
    for full, part in ((y, point.y), (t, point.t)):
        full[:n].reshape(-1, 2 * r)[1::2] = part[:odd_n].reshape(-1, 2 * r)
        full[n] = part[odd_n]
    return Point(y, t, H)


def _scaled(search: Search, point: Point) -> Floats:
    """A point with all harmonics and Omega in the scales of the search, as long as any."""
    y = point.with_unknowns(search.problem, False, search.size(False) - 1)
    y[:-1] /= search.x_scale
    y[-1] /= search.w_scale
    return y


def buckled_branches(search: Search, seeds: list[Seed], known: list[SolutionBranch]) -> list[SolutionBranch]:
    """Branches of an odd system about another mean than 0 that no loss of symmetry in the window has led to.

    One of each mirrored pair is followed.
    """
    branches: list[SolutionBranch] = []
    for seed in seeds:
        start = None if search.budget.reached else solve_seed(search, seed, False)
        if start is None or np.linalg.norm(_even_part(search, *start)) < _SYMMETRIC * search.x_scale:
            continue
        others = [branch for branch in known + branches if not branch.odd]
        if any(lies_on_up_to_symmetry(search, branch, *start) for branch in others):
            continue
        branch = _half_of_pair(search, followed(search, False, *start))
        if analyse_stability(search, branch):
            branches.append(branch)
    return branches


def _is_same(search: Search, branch: SolutionBranch, other: SolutionBranch) -> bool:
    """Whether two asymmetric branches are one, or mirror images of one another, judged where the first is least odd."""
    points = branch.points
    i = int(np.argmax([np.linalg.norm(_even_part(search, y, H)) for y, H in zip(points.ys, points.Hs, strict=True)]))
    return lies_on_up_to_symmetry(search, other, points.ys[i], int(points.Hs[i]))


def lies_on_up_to_symmetry(search: Search, other: SolutionBranch, y: Floats, H: int) -> bool:
    """Whether a solution or its mirror image lies on an asymmetric branch."""
    pb, r = search.problem, search.problem.M11.shape[0]
    mirrored = y.copy()
    mirrored[: unknowns(pb, H, False)].reshape(-1, 2 * r)[::2] *= -1
    return lies_on(search, other, y, H) or lies_on(search, other, mirrored, H)


def _asymmetric_start(search: Search, point: Point) -> tuple[Floats, int] | None:
    """A point beside a loss of symmetry, off along the even null vector of the full Jacobian."""
    pb, H, full = search.problem, point.H, _with_even(search, point).y
    n = unknowns(pb, H, False)
    R, J, A = np.empty(n + 1), np.empty((n + 1, n + 1)), np.empty((n + 1, n + 1))
    tables = fourier_tables(H, False, sample_count(pb, H, False))
    residual_and_jacobian(pb, H, False, full[n], full, *tables, R, J)
    normal = np.zeros(n + 1)
    normal[:n] = _null_vector(J[:n, :n])
    for push in _PUSHES:
        trial = full.copy()
        trial[:n] += push * search.x_scale * normal[:n]
        offset = float(normal[:n] @ trial[:n]) / search.x_scale
        ok, _, _ = correct(
            pb, H, False, trial, normal, offset, search.x_scale, search.w_scale, *tables, J, A,
            np.empty(n + 1, np.int64), _RESIDUAL, _MOST_STEPS,
        )  # fmt: skip
        if ok and np.linalg.norm(_even_part(search, trial, H)) > _KEPT * push * search.x_scale:
            return trial, H
    return None


def _null_vector(J: Floats) -> Floats:
    """Unit vector that a nearly singular matrix maps to nearly nothing, by inverse iteration."""
    factors, pivots = J + _TILT * np.linalg.norm(J) * np.eye(len(J)), np.empty(len(J), np.int64)
    factorise(factors, pivots, len(J))
    null = np.random.default_rng(1).standard_normal(len(J))
    for _ in range(3):
        null /= np.linalg.norm(null)
        solve_factorised(factors, pivots, len(J), null)
    return np.asarray(null / np.linalg.norm(null))


def _even_part(search: Search, y: Floats, H: int) -> Floats:
    """Mean and even harmonics of a point with all harmonics, flat."""
    r = search.problem.M11.shape[0]
    n = unknowns(search.problem, H, False)
    return y[:n].reshape(-1, 2 * r)[::2].ravel()


def _half_of_pair(search: Search, branch: SolutionBranch) -> SolutionBranch:
    """Cut an asymmetric branch where it passes through a symmetric orbit into its mirror image."""
    parts = [_even_part(search, y, H) for y, H in zip(branch.points.ys, branch.points.Hs, strict=True)]
    flips = [
        i for i in range(len(parts) - 1)
        if float(np.dot(*(p[: min(parts[i].size, parts[i + 1].size)] for p in parts[i : i + 2]))) < 0
    ]  # fmt: skip
    sizes = np.array([np.linalg.norm(p) for p in parts])
    if not flips:
        keep = np.arange(len(parts))
    else:
        start = int(np.argmax(sizes))
        low = max([i + 1 for i in flips if i < start], default=0)
        keep = np.arange(low, min([i + 1 for i in flips if i >= start], default=len(parts)))
    if flips or not branch.closed:  # an end that is all but symmetric lies on the point where the branch was born
        keep = keep[int(sizes[keep[0]] < _ALL_BUT_SYMMETRIC * sizes[keep[1]]) :] if len(keep) > 2 else keep
        keep = keep[: -1 if sizes[keep[-1]] < _ALL_BUT_SYMMETRIC * sizes[keep[-2]] else None] if len(keep) > 2 else keep
    if len(keep) == len(parts):
        return branch
    return SolutionBranch(False, branch.points.take(keep), False, branch.endings)
