"""A branch followed through one of its points, and whether a solution lies on it."""

from __future__ import annotations

import math

import numpy as np

from frahm.arrays import Floats
from frahm.compiled import kernel
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.follow import CLOSED, follow
from frahm.harmonic_balance.orbits import between, same_harmonics
from frahm.harmonic_balance.search import Search, Track

_MOST_POINTS = 6000
_LONGEST = 0.02
_HALVINGS = 60
_OVERHANG = 0.01  # of a chord beyond its ends, where a solution at an end of a step may lie by rounding
_AWAY = 0.5  # of a chord: farther from it no point of a smooth branch lies
_SAME = 1e-5  # relative distance of two solutions that are one
_ROUNDING = 1e-13  # of a frequency


def followed(search: Search, odd: bool, y: Floats, H: int) -> Track:
    """Follow a branch from one of its points in both directions."""
    forward, ending = _run(search, odd, y, H, 1.0)
    if ending == CLOSED:
        return track_of(search, odd, [forward], True, (ending,))
    backward, other = _run(search, odd, y, H, -1.0)
    reverse = tuple(np.ascontiguousarray(part[::-1]) for part in backward)
    reverse = (reverse[0][:-1], -reverse[1][:-1], reverse[2][:-1], reverse[3][:-1])
    return track_of(search, odd, [reverse, forward], False, (other, ending))


def _run(search: Search, odd: bool, y: Floats, H: int, direction: float) -> tuple[tuple[np.ndarray, ...], int]:
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
    return (ys[:count].copy(), ts[:count].copy(), Hs[:count].copy(), truncations[:count].copy()), ending


def track_of(
    search: Search, odd: bool, parts: list[tuple[np.ndarray, ...]], closed: bool, endings: tuple[int, ...]
) -> Track:
    """A branch made of parts in order, not yet described."""
    ys, ts, Hs, truncations = (np.concatenate(column) for column in zip(*parts, strict=True))
    columns = np.zeros((len(Hs), 5))
    columns[:, 0] = ys[np.arange(len(Hs)), unknowns(search.problem, Hs, odd)]
    return Track(odd, ys, ts, Hs, truncations, columns, np.zeros((0, 0)), closed, endings)


def lies_on(search: Search, track: Track, y: Floats, H: int) -> bool:
    """Whether a solution is a point of a branch already followed: compared in its own plane across the chord of a step.

    Only steps that reach its frequency are looked at, or in which the frequency turns.
    """
    r, out = search.problem.M11.shape[0], np.empty(len(track.Hs), np.int64)
    near = out[: steps_near(r, track.odd, track.ys, track.ts, track.Hs, y, H, search.x_scale, search.w_scale, out)]
    W = float(y[unknowns(search.problem, H, track.odd)])
    return any(lies_in_step(search, track, y, H, W, int(i)) for i in near)


def lies_in_step(search: Search, track: Track, X: Floats, H: int, W: float, i: int) -> bool:
    """Whether a solution at Omega = W is the point of the branch in its own plane across the chord of step i."""
    n = unknowns(search.problem, H, track.odd)
    y = np.append(X[:n], W)
    scales = np.append(np.full(n, search.x_scale), search.w_scale)
    ends = track.ys[i : i + 2], track.Hs[i : i + 2]
    fraction = share_of_step(search.problem.M11.shape[0], track.odd, *ends, 0, y, H, search.x_scale, search.w_scale)
    if math.isnan(fraction):
        return False
    point = midpoint(search, track, i, fraction)
    if point is None:
        return False
    found, own = np.zeros(n + 1), unknowns(search.problem, point[2], track.odd)
    found[: min(n, own)], found[n] = point[0][: min(n, own)], point[0][own]
    return bool(np.linalg.norm((found - y[: n + 1]) / scales) < _SAME * np.linalg.norm(y[:n]) / search.x_scale)


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


def point_at(search: Search, track: Track, i: int, W: float) -> tuple[Floats, int] | None:
    """Point of the branch at Omega = W between points i and i + 1 and its harmonics, by the Illinois method."""
    lo, hi, below, above = 0.0, 1.0, track.frequency[i] - W, track.frequency[i + 1] - W
    found = None
    for _ in range(_HALVINGS):
        share = 0.5 * (lo + hi) if below == above else (lo * above - hi * below) / (above - below)
        point = midpoint(search, track, i, share)
        if point is None:
            return found
        y, _, H = point
        found = y, H
        miss = float(y[unknowns(search.problem, H, track.odd)]) - W
        if abs(miss) < _ROUNDING * W:
            break
        if miss * above < 0:
            lo, below = hi, above
        else:
            below *= 0.5
        hi, above = share, miss
    return found


def midpoint(search: Search, track: Track, i: int, fraction: float = 0.5) -> tuple[Floats, Floats, int] | None:
    """Point, tangent and number of harmonics between points i and i + 1 of a branch; None if Newton's method fails."""
    pb, odd = search.problem, track.odd
    if i + 1 >= len(track.Hs):
        return None
    H = int(max(track.Hs[i], track.Hs[i + 1]))
    ends = [np.zeros(search.size(odd)) for _ in range(4)]
    for k in (0, 1):
        same_harmonics(pb, odd, track.ys[i + k], track.ts[i + k], track.Hs[i + k], H, ends[k], ends[2 + k])
    y, t = np.zeros(search.size(odd)), np.zeros(search.size(odd))
    ok = between(pb, odd, ends[0], ends[2], ends[1], ends[3], H, fraction, search.x_scale, search.w_scale, y, t)
    return (y, t, H) if ok else None
