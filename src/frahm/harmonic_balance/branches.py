"""The complete set of branches over a frequency window: seeds, continuation, matching."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np

from frahm.harmonic_balance.alike import moving_alike, seeds_alike
from frahm.harmonic_balance.asymmetric import asymmetric_branches, buckled_branches
from frahm.harmonic_balance.births import seeds_beside
from frahm.harmonic_balance.branch import Point, SolutionBranch, connected
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.following import far_from_folds, followed, lies_on
from frahm.harmonic_balance.search import LOWEST, Search, search_over
from frahm.harmonic_balance.seeds import Seed, two_harmonic_seeds
from frahm.harmonic_balance.stability import analyse_stability
from frahm.harmonic_balance.starts import solve_seed, starts_of
from frahm.tolerances import TINY

_BEYOND = 12  # windows beyond the upper edge in which branches that leave it are followed
_STRONG_FREQUENCIES = 9
_STRONG_THIRD = 0.12  # third harmonic beside the first from where on both are searched together
_CROSSING = 5e-3  # of a point: how near a branch passes that crosses another one there


def find_branches(search: Search, asymmetric: bool = True, at: float | None = None) -> list[SolutionBranch]:
    """Every branch the seeds lead to, each followed once; the one with the smallest response at `lo` comes first.

    Branches with even harmonics that leave odd ones are followed only if `asymmetric`. With `at`, starts are looked for
    at that frequency [rad/s], too.
    """
    odd, seeder = search.problem.odd, search.seeder
    branches: list[SolutionBranch] = []
    starts = starts_of(search)
    everywhere = starts.everywhere if at is None else np.append(at, starts.everywhere)
    seeds = [seed for W in everywhere for seed in seeder.at(float(W), search.x_scale)]
    others = _seeds_of_motions_alike(search, asymmetric, at)
    others += [seed for W in starts.third for seed in seeder.at(float(W), search.x_scale) if 3 in seed.harmonics]
    others += [seed for extreme in starts.extremes for seed in seeds_beside(search, extreme)]
    about_others = [seed for seed in others + seeds if odd and 0 in seed.harmonics]
    about_zero = [[seed for seed in part if not odd or 0 not in seed.harmonics] for part in (others, seeds)]
    _follow_new(search, about_zero[0], branches)
    if seeder.shared is None:
        _follow_new(search, about_zero[1], branches)
    else:
        _follow_where_more(search, about_zero[1], branches)
    if seeder.spring is not None and third_harmonic(search, branches) > _STRONG_THIRD:
        spread = np.linspace(search.lo, search.hi, _STRONG_FREQUENCIES)
        strong = [seed for W in spread for seed in two_harmonic_seeds(search.problem, float(W), seeder.spring)]
        _follow_new(search, strong, branches)
    branches = [branch for branch in branches if analyse_stability(search, branch)]
    for branch in list(branches) if asymmetric else []:
        branches += asymmetric_branches(search, branch, branches)
    if asymmetric:
        branches += buckled_branches(search, about_others, branches)
    for branch in branches:
        _connect_crossing(search, branch, branches)
    branches = sorted(branches, key=lambda branch: _response_at(branch, search.lo))
    _connect_outside(search, branches)
    return branches


def _seeds_of_motions_alike(search: Search, asymmetric: bool, at: float | None) -> list[Seed]:
    """Starts from all branches of the smaller system in which equal absorbers move alike."""
    system = moving_alike(search.system)
    if system is None:
        return []
    smaller = search_over(system, search.lo, search.hi, search.harmonics, search.problem.forcing)
    smaller = replace(smaller, budget=search.budget)
    return seeds_alike(search, smaller, find_branches(smaller, asymmetric, at))


def _follow_new(search: Search, seeds: list[Seed], branches: list[SolutionBranch]) -> None:
    """Follow the branches of all starts that do not lie on one already followed, and add them."""
    odd = search.problem.odd
    for seed in seeds:
        start = None if search.budget.reached else solve_seed(search, seed, odd)
        if start is not None and not any(lies_on(search, branch, *start) for branch in branches):
            branches.append(followed(search, odd, *start))


def _follow_where_more(search: Search, seeds: list[Seed], branches: list[SolutionBranch]) -> None:
    """As `_follow_new`, from the frequencies at which there are more starts than responses on branches followed."""
    for W, here in itertools.groupby(seeds, key=lambda seed: seed.frequency):
        group = list(here)
        if sum(_crossed(branch, W) for branch in branches) < len(group):
            _follow_new(search, group, branches)


def _crossed(branch: SolutionBranch, W: float) -> int:
    """How many times a branch comes past a frequency."""
    beyond = branch.points.frequency > W
    return int(np.count_nonzero(beyond[1:] != beyond[:-1]))


def third_harmonic(search: Search, branches: list[SolutionBranch]) -> float:
    """Largest third harmonic of a single element beside its first, on the symmetric branches in the window."""
    ratios = [0.0]
    for branch in branches:
        points = branch.points
        if points.ys.shape[1] < 5:  # two columns a harmonic and the frequency: not a third harmonic at all
            continue
        inside = (points.frequency >= search.lo) & (points.frequency <= search.hi) & (points.Hs >= 3)
        first, third = (np.hypot(points.ys[inside, k], points.ys[inside, k + 1]) for k in (0, 2))
        ratios.append(float(np.max(third / np.maximum(first, TINY), initial=0.0)))
    return max(ratios)


def _connect_crossing(search: Search, branch: SolutionBranch, branches: list[SolutionBranch]) -> None:
    """Connect a branch to those it turns back on: a turn there is no saddle-node but its birth from the other one.

    Branches cross where equal absorbers cease to move alike: the branch that is born turns into its mirror image there.
    """
    for i, event in enumerate(branch.bifurcations):
        if event.kind != "saddle-node" or event.point is None:
            continue
        others = [o for o in branches if o is not branch and o.odd == branch.odd and _passes(search, o, event.point)]
        for other in others:
            _connect(branch, other)
            branch.bifurcations[i] = replace(event, kind="branch-point")


def _connect_outside(search: Search, branches: list[SolutionBranch]) -> None:
    """Connect branches that seem apart because the window cuts off where they hang together.

    Those that leave the window are followed much further, and meet the others whose points they come to.
    """
    hanging = connected(branches)
    width = search.hi - search.lo
    far = replace(search, outer=(LOWEST * search.lo, search.hi + _BEYOND * width))
    for branch in branches:
        if branch.closed or branch.parent is not None or any(branch is other for other in hanging):
            continue
        start = branch.points[far_from_folds(search, branch)]
        whole = followed(far, branch.odd, start.y.copy(), start.H)
        for other in hanging:
            middle = int(np.argmin(np.abs(other.points.frequency - 0.5 * (search.lo + search.hi))))
            point = other.points[middle]
            if other.odd == branch.odd and lies_on(search, whole, point.y.copy(), point.H):
                _connect(branch, other)
                break


def _connect(branch: SolutionBranch, other: SolutionBranch) -> None:
    branch.crossed.append(other)
    other.crossed.append(branch)


def _passes(search: Search, branch: SolutionBranch, point: Point) -> bool:
    """Whether a branch passes through a located point, as closely as a crossing can be located."""
    n, points = unknowns(search.problem, point.H, branch.odd), branch.points
    y, W = point.y[:n], points.frequency
    offset = W - point.y[n]
    for i in np.flatnonzero((offset[:-1] * offset[1:] <= 0) & (W[:-1] != W[1:])):
        share = (point.y[n] - W[i]) / (W[i + 1] - W[i])
        a, b = (points[int(k)].with_unknowns(search.problem, branch.odd, n)[:n] for k in (i, i + 1))
        if np.linalg.norm((1 - share) * a + share * b - y) < _CROSSING * np.linalg.norm(y):
            return True
    return False


def _response_at(branch: SolutionBranch, W: float) -> float:
    """Smallest relative peak of a branch at one of its frequencies; infinite if it has no point there.

    Not the amplitude: about another equilibrium that is small, too.
    """
    here = branch.points.frequency == W
    return float(np.min(branch.points.columns[here, 4])) if np.any(here) else math.inf
