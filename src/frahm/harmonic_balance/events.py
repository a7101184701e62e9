"""Special points between two points of a branch: found by counting, located, and checked by counting again.

The numbers of unstable multipliers beside a located point must agree with the numbers at the ends of the step. Where
they do not, a further event lies between, and the search goes on there: two events in one step are told apart.

Which multipliers mean which bifurcation: Kuznetsov (2004), doi 10.1007/978-1-4757-3978-7.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.orbits import between, describe, locate, same_harmonics

if TYPE_CHECKING:
    from frahm.harmonic_balance.search import Search, Track

# Moduli this close to one are neutral: a sink without linear spring that hardly moves returns nowhere by itself.
NEUTRAL = 1e-9
_NOISE = 1e-13  # of the largest modulus: multipliers below drown in its rounding
_COMPLEX = 1e-6
_DEEPEST = 5
_SHARP = 2e-11  # of the frequency: how sharply a point is located where the equations are regular

Point = tuple[Floats, Floats, int]


@dataclass(frozen=True)
class LocatedEvent:
    """A special point of a branch: kind, its point, and the half-width of the interval that holds it [rad/s]."""

    kind: str
    columns: Floats
    half_width: float
    located: bool


@dataclass(frozen=True)
class _Place:
    """A point of the branch as an end of a step: its point, columns, multipliers, dOmega/ds, how many are unstable."""

    y: Floats
    t: Floats
    H: int
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


def is_eventful(search: Search, track: Track) -> np.ndarray:
    """For every step of a branch whether stability or direction changes in it."""
    rise = track.ts[np.arange(len(track.Hs)), unknowns(search.problem, track.Hs, track.odd)]
    unstable = unstable_count(track.multipliers)
    gap = track.frequency[:-1] == track.frequency[1:]  # the branch was outside the window in between
    return np.asarray(((rise[:-1] * rise[1:] < 0) | (unstable[:-1] != unstable[1:])) & ~gap)


def events_after(search: Search, track: Track, i: int) -> list[tuple[LocatedEvent, Point | None]]:
    """Events between points i and i + 1 of a branch, in order along it."""
    a, b = (_place(search, track.odd, track.ys[k], track.ts[k], int(track.Hs[k])) for k in (i, i + 1))
    return _between(search, track.odd, a, b, 0)


def events_seen(search: Search, track: Track, i: int) -> list[tuple[LocatedEvent, Point | None]]:
    """What changes between points i and i + 1 of a branch, not located."""
    a, b = (_place(search, track.odd, track.ys[k], track.ts[k], int(track.Hs[k])) for k in (i, i + 1))
    return [(_seen(track.odd, a, b), None)]


def _seen(odd: bool, a: _Place, b: _Place) -> LocatedEvent:
    """The first event between two places, as wide as the step."""
    folded = a.rise * b.rise < 0
    rank = -1 if folded else min(a.unstable, b.unstable)
    critical = (a if a.unstable > b.unstable else b).multipliers[rank]
    half = 0.5 * abs(b.columns[0] - a.columns[0])
    return LocatedEvent(_kind(odd, folded, critical), 0.5 * (a.columns + b.columns), half, False)


def _place(search: Search, odd: bool, y: Floats, t: Floats, H: int) -> _Place:
    columns, multipliers = np.empty((1, 5)), np.empty((1, 2 * search.variation.K.shape[0]), complex)
    describe(search.problem, search.variation, odd, y[None], np.array([H]), columns, multipliers)
    rise = float(t[unknowns(search.problem, H, odd)])
    return _Place(y, t, H, columns[0], multipliers[0], rise, int(unstable_count(multipliers[0])))


def _between(search: Search, odd: bool, a: _Place, b: _Place, depth: int) -> list[tuple[LocatedEvent, Point | None]]:
    folded = a.rise * b.rise < 0
    if depth > _DEEPEST or (not folded and a.unstable == b.unstable):
        return []
    rank = -1 if folded else min(a.unstable, b.unstable)
    y, t = np.zeros(search.size(odd)), np.zeros(search.size(odd))
    ok, H, half = locate(
        search.problem, search.variation, odd, a.y, a.t, a.H, b.y, b.t, b.H, rank, search.x_scale, search.w_scale,
        y, t, np.zeros(len(a.multipliers), complex),
    )  # fmt: skip
    if not ok:
        return [(_seen(odd, a, b), None)]
    here = _place(search, odd, y, t, int(H))
    event = LocatedEvent(_kind(odd, folded, here.multipliers[rank]), here.columns, float(half), True)
    before, after = (_beside(here, end, rank) for end in (a, b))
    steps = [(a, before), (after, b)]
    crossing = half > _SHARP * here.columns[0]  # located beside the singular point where branches cross
    if folded and not crossing and before.unstable == after.unstable:  # a fold changes the number: something hides
        steps = _around(search, odd, a, here, b)
    left, right = steps[: len(steps) // 2], steps[len(steps) // 2 :]
    found = [[e for step in side for e in _between(search, odd, *step, depth + 1)] for side in (left, right)]
    return [*found[0], (event, (y, t, int(H))), *found[1]]


def _beside(here: _Place, end: _Place, rank: int) -> _Place:
    """A located point as seen from one end of the step: critical multipliers count as they agree best with that end."""
    values = here.multipliers
    critical = int(np.argmin(np.abs(values - 1))) if rank < 0 else rank
    others = np.delete(values, critical)
    pair = rank >= 0 and abs(values[rank].imag) > _COMPLEX * abs(values[rank])
    if pair:
        others = np.delete(others, np.argmin(np.abs(others - values[rank].conjugate())))
    certain = int(unstable_count(others))
    unstable = min(max(end.unstable, certain), certain + 1 + pair)
    return dataclasses.replace(here, unstable=unstable, rise=0.0 if rank < 0 else here.rise)


def _around(search: Search, odd: bool, a: _Place, here: _Place, b: _Place) -> list[tuple[_Place, _Place]]:
    """The four steps between a, a point shortly before the located one, the located one, one shortly after, and b."""
    steps = []
    for start, end, fraction in ((a, here, 0.9), (here, b, 0.1)):
        H = max(start.H, end.H)
        ends = [np.zeros(search.size(odd)) for _ in range(4)]
        for k, place in enumerate((start, end)):
            same_harmonics(search.problem, odd, place.y, place.t, place.H, H, ends[k], ends[2 + k])
        y, t = np.zeros(search.size(odd)), np.zeros(search.size(odd))
        ends = [ends[0], ends[2], ends[1], ends[3]]
        if not between(search.problem, odd, *ends, H, fraction, search.x_scale, search.w_scale, y, t):
            return []
        middle = _place(search, odd, y, t, H)
        fold = _beside(here, middle, -1)
        steps += [(start, middle), (middle, fold)] if end is here else [(fold, middle), (middle, end)]
    return steps


def _kind(odd: bool, folded: bool, multiplier: complex) -> str:
    """Kind of event from the critical multiplier of the (half) map."""
    if folded:
        return "saddle-node"
    if abs(multiplier.imag) > _COMPLEX * abs(multiplier):
        return "neimark-sacker"
    if multiplier.real > 0:
        return "branch-point"
    return "branch-point" if odd else "period-doubling"
