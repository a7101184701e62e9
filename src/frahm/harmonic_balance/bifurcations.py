"""Bifurcations between two points of a branch: found by counting, located, and checked by counting again.

The numbers of unstable multipliers beside a located point must agree with the numbers at the ends of the step. Where
they do not, a further one lies between, and the search goes on there: two in one step are told apart.

Which multipliers mean which bifurcation: Kuznetsov (2004), doi 10.1007/978-1-4757-3978-7.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.branch import Bifurcation, Point, SolutionBranch, described, point_between, points_of
from frahm.harmonic_balance.orbits import locate
from frahm.harmonic_balance.search import Search

# Moduli this close to one are neutral: a sink without linear spring that hardly moves returns nowhere by itself.
NEUTRAL = 1e-9
_NOISE = 1e-13  # of the largest modulus: multipliers below drown in its rounding
COMPLEX = 1e-6  # imaginary part, of the modulus, from which on a multiplier is one of a pair
_DEEPEST = 5
_SHARP = 2e-11  # of the frequency: how sharply a point is located where the equations are regular


@dataclass(frozen=True, eq=False)
class _End:
    """A point of the branch as an end of a step: its columns, multipliers, dOmega/ds, how many are unstable."""

    point: Point
    columns: Floats
    multipliers: np.ndarray
    rise: float
    unstable: int


def unstable_count(multipliers: np.ndarray) -> np.ndarray:
    """Number of multipliers seen outside the unit circle, along the last axis.

    Beside a very large one, or one beyond all numbers, the others drown in rounding: they are not counted.
    """
    moduli = np.abs(multipliers)
    largest = np.max(moduli, axis=-1, keepdims=True)
    seen = moduli > 1 + NEUTRAL + _NOISE * np.where(np.isfinite(largest), largest, 0.0)
    return np.where(np.isfinite(largest[..., 0]), np.sum(seen, axis=-1), 1)


def steps_with_bifurcations(search: Search, branch: SolutionBranch) -> np.ndarray:
    """For every step of a branch whether stability or direction changes in it."""
    rise, W = branch.points.rise(search.problem, branch.odd), branch.points.frequency
    unstable = unstable_count(branch.points.multipliers)
    gap = W[:-1] == W[1:]  # the branch was outside the window in between
    return np.asarray(((rise[:-1] * rise[1:] < 0) | (unstable[:-1] != unstable[1:])) & ~gap)


def bifurcations_in_step(search: Search, branch: SolutionBranch, i: int) -> list[Bifurcation]:
    """Bifurcations between points i and i + 1 of a branch, in order along it."""
    return _between(search, branch.odd, *_ends(search, branch, i), 0)


def unlocated_in_step(search: Search, branch: SolutionBranch, i: int) -> list[Bifurcation]:
    """What changes between points i and i + 1 of a branch, not located."""
    return [_unlocated(branch.odd, *_ends(search, branch, i))]


def _unlocated(odd: bool, a: _End, b: _End) -> Bifurcation:
    """The first bifurcation between two points, as wide as the step."""
    folded = a.rise * b.rise < 0
    rank = -1 if folded else min(a.unstable, b.unstable)
    critical = (a if a.unstable > b.unstable else b).multipliers[rank]
    half = 0.5 * abs(b.columns[0] - a.columns[0])
    return Bifurcation(_kind(odd, folded, critical), 0.5 * (a.columns + b.columns), half, None)


def _ends(search: Search, branch: SolutionBranch, i: int) -> tuple[_End, _End]:
    a, b = (_end(search, branch.odd, branch.points[k]) for k in (i, i + 1))
    return a, b


def _end(search: Search, odd: bool, point: Point) -> _End:
    points = described(search, odd, points_of(search, odd, [point], np.full(1, np.nan)))
    multipliers, rise = points.multipliers[0], float(points.rise(search.problem, odd)[0])
    return _End(point, points.columns[0], multipliers, rise, int(unstable_count(multipliers)))


def _between(search: Search, odd: bool, a: _End, b: _End, depth: int) -> list[Bifurcation]:
    folded = a.rise * b.rise < 0
    if depth > _DEEPEST or (not folded and a.unstable == b.unstable):
        return []
    rank = -1 if folded else min(a.unstable, b.unstable)
    y, t = np.zeros(search.size(odd)), np.zeros(search.size(odd))
    ok, H, half = locate(
        search.problem, search.variation, odd, a.point.y, a.point.t, a.point.H, b.point.y, b.point.t, b.point.H, rank,
        search.x_scale, search.w_scale, y, t, np.zeros(len(a.multipliers), complex),
    )  # fmt: skip
    if not ok:
        return [_unlocated(odd, a, b)]
    here = _end(search, odd, Point(y, t, int(H)))
    located = Bifurcation(_kind(odd, folded, here.multipliers[rank]), here.columns, float(half), here.point)
    before, after = (_beside(here, end, rank) for end in (a, b))
    steps = [(a, before), (after, b)]
    crossing = half > _SHARP * here.columns[0]  # located beside the singular point where branches cross
    if folded and not crossing and before.unstable == after.unstable:  # a fold changes the number: something hides
        steps = _around(search, odd, a, here, b)
    left, right = steps[: len(steps) // 2], steps[len(steps) // 2 :]
    found = [[one for step in side for one in _between(search, odd, *step, depth + 1)] for side in (left, right)]
    return [*found[0], located, *found[1]]


def _beside(here: _End, end: _End, rank: int) -> _End:
    """A located point as seen from one end of the step: critical multipliers count as they agree best with that end."""
    values = here.multipliers
    critical = int(np.argmin(np.abs(values - 1))) if rank < 0 else rank
    others = np.delete(values, critical)
    pair = rank >= 0 and abs(values[rank].imag) > COMPLEX * abs(values[rank])
    if pair:
        others = np.delete(others, np.argmin(np.abs(others - values[rank].conjugate())))
    certain = int(unstable_count(others))
    unstable = min(max(end.unstable, certain), certain + 1 + pair)
    return dataclasses.replace(here, unstable=unstable, rise=0.0 if rank < 0 else here.rise)


def _around(search: Search, odd: bool, a: _End, here: _End, b: _End) -> list[tuple[_End, _End]]:
    """The four steps between a, a point shortly before the located one, the located one, one shortly after, and b."""
    steps = []
    for start, end, fraction in ((a, here, 0.9), (here, b, 0.1)):
        point = point_between(search, odd, start.point, end.point, fraction)
        if point is None:
            return []
        middle = _end(search, odd, point)
        fold = _beside(here, middle, -1)
        steps += [(start, middle), (middle, fold)] if end is here else [(fold, middle), (middle, end)]
    return steps


def _kind(odd: bool, folded: bool, multiplier: complex) -> str:
    """Kind of bifurcation from the critical multiplier of the (half) map."""
    if folded:
        return "saddle-node"
    if abs(multiplier.imag) > COMPLEX * abs(multiplier):
        return "neimark-sacker"
    if multiplier.real > 0:
        return "branch-point"
    return "branch-point" if odd else "period-doubling"
