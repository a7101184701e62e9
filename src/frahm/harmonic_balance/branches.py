"""The complete set of branches over a frequency window: seeds, continuation, matching."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np

from frahm.harmonic_balance.alike import moving_alike, seeds_alike
from frahm.harmonic_balance.asymmetric import asymmetric_branches, buckled_branches
from frahm.harmonic_balance.births import seeds_beside
from frahm.harmonic_balance.completing import complete
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.events import Point
from frahm.harmonic_balance.following import followed, lies_on
from frahm.harmonic_balance.search import Search, Track, away_from_turns, begin, connected
from frahm.harmonic_balance.seeds import Seed, two_harmonic_seeds
from frahm.harmonic_balance.starts import solve_seed, starts_of

_BEYOND = 12  # windows beyond the upper edge in which branches that leave it are followed
_STRONG_FREQUENCIES = 9
_STRONG_THIRD = 0.12  # third harmonic beside the first from where on both are searched together
_CROSSING = 5e-3  # of a point: how near a branch passes that crosses another one there


def find_branches(search: Search, asymmetric: bool = True, at: float | None = None) -> list[Track]:
    """Every branch the seeds lead to, each followed once; the one with the smallest response at `lo` comes first.

    Branches with even harmonics that leave odd ones are followed only if `asymmetric`. With `at`, starts are looked for
    at that frequency [rad/s], too.
    """
    odd, seeder = search.problem.odd, search.seeder
    tracks: list[Track] = []
    starts = starts_of(search)
    everywhere = starts.everywhere if at is None else np.append(at, starts.everywhere)
    seeds = [seed for W in everywhere for seed in seeder.at(float(W), search.x_scale)]
    others = _seeds_of_motions_alike(search, asymmetric, at)
    others += [seed for W in starts.third for seed in seeder.at(float(W), search.x_scale) if 3 in seed.harmonics]
    others += [seed for extreme in starts.extremes for seed in seeds_beside(search, extreme)]
    about_others = [seed for seed in others + seeds if odd and 0 in seed.harmonics]
    about_zero = [[seed for seed in part if not odd or 0 not in seed.harmonics] for part in (others, seeds)]
    _follow_new(search, about_zero[0], tracks)
    if seeder.shared is None:
        _follow_new(search, about_zero[1], tracks)
    else:
        _follow_where_more(search, about_zero[1], tracks)
    if seeder.spring is not None and third_harmonic(search, tracks) > _STRONG_THIRD:
        spread = np.linspace(search.lo, search.hi, _STRONG_FREQUENCIES)
        strong = [seed for W in spread for seed in two_harmonic_seeds(search.problem, float(W), seeder.spring)]
        _follow_new(search, strong, tracks)
    tracks = [track for track in tracks if complete(search, track)]
    for track in list(tracks) if asymmetric else []:
        tracks += asymmetric_branches(search, track, tracks)
    if asymmetric:
        tracks += buckled_branches(search, about_others, tracks)
    for track in tracks:
        _join(search, track, tracks)
    tracks = sorted(tracks, key=lambda track: _response_at(track, search.lo))
    _join_beyond(search, tracks)
    return tracks


def _seeds_of_motions_alike(search: Search, asymmetric: bool, at: float | None) -> list[Seed]:
    """Starts from all branches of the smaller system in which equal absorbers move alike."""
    system = moving_alike(search.system)
    if system is None:
        return []
    smaller = begin(system, search.lo, search.hi, search.harmonics, search.problem.forcing)
    smaller = replace(smaller, budget=search.budget)
    return seeds_alike(search, smaller, find_branches(smaller, asymmetric, at))


def _follow_new(search: Search, seeds: list[Seed], tracks: list[Track]) -> None:
    """Follow the branches of all starts that do not lie on one already followed, and add them."""
    odd = search.problem.odd
    for seed in seeds:
        start = None if search.budget.reached else solve_seed(search, seed, odd)
        if start is not None and not any(lies_on(search, track, *start) for track in tracks):
            tracks.append(followed(search, odd, *start))


def _follow_where_more(search: Search, seeds: list[Seed], tracks: list[Track]) -> None:
    """As `_follow_new`, from the frequencies at which there are more starts than responses on branches followed."""
    for W, here in itertools.groupby(seeds, key=lambda seed: seed.frequency):
        group = list(here)
        if sum(_crossed(track, W) for track in tracks) < len(group):
            _follow_new(search, group, tracks)


def _crossed(track: Track, W: float) -> int:
    """How many times a branch comes past a frequency."""
    beyond = track.frequency > W
    return int(np.count_nonzero(beyond[1:] != beyond[:-1]))


def third_harmonic(search: Search, tracks: list[Track]) -> float:
    """Largest third harmonic of a single element beside its first, on the symmetric branches in the window."""
    ratios = [0.0]
    for track in tracks:
        if track.ys.shape[1] < 5:  # two columns a harmonic and the frequency: not a third harmonic at all
            continue
        inside = (track.frequency >= search.lo) & (track.frequency <= search.hi) & (track.Hs >= 3)
        first, third = (
            np.hypot(track.ys[inside, 0], track.ys[inside, 1]),
            np.hypot(track.ys[inside, 2], track.ys[inside, 3]),
        )
        ratios.append(float(np.max(third / np.maximum(first, 1e-300), initial=0.0)))
    return max(ratios)


def _join(search: Search, track: Track, tracks: list[Track]) -> None:
    """Tell the branches a branch turns back on: a turn there is no saddle-node but its birth from the other one.

    Branches cross where equal absorbers cease to move alike: the branch that is born turns into its mirror image there.
    """
    for i, (event, point) in enumerate(zip(track.events, track.event_points, strict=True)):
        if event.kind != "saddle-node" or point is None:
            continue
        others = [o for o in tracks if o is not track and o.odd == track.odd and _passes(search, o, point)]
        for other in others:
            track.meets.append(other)
            other.meets.append(track)
            track.events[i] = replace(event, kind="branch-point")


def _join_beyond(search: Search, tracks: list[Track]) -> None:
    """Tell the branches that seem apart because the window cuts off where they hang together.

    Those that leave the window are followed much further, and meet the others whose points they come to.
    """
    hanging = connected(tracks)
    width = search.hi - search.lo
    far = replace(search, outer=(0.02 * search.lo, search.hi + _BEYOND * width))
    for track in tracks:
        if track.closed or track.parent is not None or any(track is other for other in hanging):
            continue
        start = away_from_turns(search, track)
        whole = followed(far, track.odd, track.ys[start].copy(), int(track.Hs[start]))
        for other in hanging:
            at = int(np.argmin(np.abs(other.frequency - 0.5 * (search.lo + search.hi))))
            if other.odd == track.odd and lies_on(search, whole, other.ys[at].copy(), int(other.Hs[at])):
                track.meets.append(other)
                other.meets.append(track)
                break


def _passes(search: Search, track: Track, point: Point) -> bool:
    """Whether a branch passes through a located point, as closely as a crossing can be located."""
    y, _, H = point
    n = unknowns(search.problem, H, track.odd)
    W, offset = y[n], track.frequency - y[n]
    for i in np.flatnonzero((offset[:-1] * offset[1:] <= 0) & (track.frequency[:-1] != track.frequency[1:])):
        share = (W - track.frequency[i]) / (track.frequency[i + 1] - track.frequency[i])
        ends = []
        for k in (i, i + 1):
            own = np.zeros(n)
            kept = min(n, unknowns(search.problem, int(track.Hs[k]), track.odd))
            own[:kept] = track.ys[k, :kept]
            ends.append(own)
        if np.linalg.norm((1 - share) * ends[0] + share * ends[1] - y[:n]) < _CROSSING * np.linalg.norm(y[:n]):
            return True
    return False


def _response_at(track: Track, W: float) -> float:
    """Smallest relative peak of a branch at one of its frequencies; infinite if it has no point there.

    Not the amplitude: about another equilibrium that is small, too.
    """
    here = track.frequency == W
    return float(np.min(track.columns[here, 4])) if np.any(here) else math.inf
