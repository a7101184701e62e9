"""A followed branch made complete: cut to the window, described, refined between hidden events, all of them located."""

from __future__ import annotations

import math

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.events import LocatedEvent, Point, events_after, events_seen, is_eventful
from frahm.harmonic_balance.following import midpoint
from frahm.harmonic_balance.newton import solve_at
from frahm.harmonic_balance.orbits import describe, multipliers_along, same_harmonics
from frahm.harmonic_balance.search import Search, Track

_QUICK = 0.2  # way of a multiplier near the unit circle from point to point that asks for a point between
_BEYOND_NUMBERS = 1e300  # stands for a multiplier that no number holds
_LEAST_NUMBER = 1e-300  # stands for a multiplier of zero, whose logarithm none holds
_ROUNDS = 6  # of points put between points
_GRAZING = 0.1  # of its bend: a logarithm whose summit comes as near to zero may have crossed it
_STRAIGHT = 1e-9  # bend of a logarithm that is rounding
_NEAR_CIRCLE = 0.9  # modulus from which on a multiplier may soon leave the unit circle


def complete(search: Search, track: Track) -> bool:
    """Give a followed branch its amplitudes and multipliers, refine it between hidden events, locate them all.

    Returns whether any of it lies in the window.
    """
    inside = (track.frequency >= search.lo) & (track.frequency <= search.hi)
    if np.sum(inside) < 2:
        return False
    track.births = _births_outside(search, track, inside) if track.odd else []
    trim(search, track)
    track.columns, track.multipliers = described(search, track.odd, track.ys, track.Hs)
    _uncover(search, track)
    _locate_events(search, track)
    return True


def _births_outside(search: Search, track: Track, inside: np.ndarray) -> list[tuple[LocatedEvent, Point]]:
    """Losses of symmetry where a followed branch lies outside the window."""
    found: list[tuple[LocatedEvent, Point]] = []
    for rows in np.split(np.arange(len(inside)), np.flatnonzero(np.diff(inside)) + 1):
        if inside[rows[0]]:
            continue
        rows = np.arange(max(rows[0] - 1, 0), min(rows[-1] + 2, len(inside)))
        rows = rows[(track.frequency[rows] >= search.outer[0]) & (track.frequency[rows] <= search.outer[1])]
        if len(rows) < 2:
            continue
        multipliers = np.empty((len(rows), 2 * search.variation.K.shape[0]), complex)
        multipliers_along(search.problem, search.variation, True, track.ys[rows], track.Hs[rows], multipliers)
        part = Track(True, track.ys[rows], track.ts[rows], track.Hs[rows], track.truncations[rows],
                     track.columns[rows], multipliers, False, ())  # fmt: skip
        for i in np.flatnonzero(is_eventful(search, part)):
            if search.budget.events <= 0:
                break
            search.budget.events -= 1
            events = events_after(search, part, int(i))
            found += [(event, point) for event, point in events if event.kind == "branch-point" and point is not None]
    return found


def described(search: Search, odd: bool, ys: Floats, Hs: np.ndarray) -> tuple[Floats, np.ndarray]:
    """Columns and multipliers of points."""
    columns, multipliers = np.empty((len(Hs), 5)), np.empty((len(Hs), 2 * search.variation.K.shape[0]), complex)
    describe(search.problem, search.variation, odd, ys, Hs, columns, multipliers)
    return columns, multipliers


def trim(search: Search, track: Track) -> None:
    """Cut a branch to the window, with points exactly on its edges; pieces stay in order along the branch."""
    W = track.frequency
    inside = np.flatnonzero((search.lo <= W) & (search.hi >= W))
    steps, edges = _edges_crossed(W, (search.lo, search.hi))
    at = np.searchsorted(inside, steps, side="right")
    points = [_on_edge(search, track, int(i), float(edge)) for i, edge in zip(steps, edges, strict=True)]
    whole = (track.ys, track.ts, track.Hs, track.truncations)
    track.ys, track.ts, track.Hs, track.truncations = (part[inside] for part in whole)
    if points:
        track.ys = np.insert(track.ys, at, np.array([point[0] for point in points]), axis=0)
        track.ts = np.insert(track.ts, at, np.array([point[1] for point in points]), axis=0)
        track.Hs = np.insert(track.Hs, at, [point[2] for point in points])
        track.truncations = np.insert(track.truncations, at, whole[3][steps])
    W = track.ys[np.arange(len(track.Hs)), unknowns(search.problem, track.Hs, track.odd)]
    track.columns = np.column_stack([W, np.zeros((len(W), 4))])
    gaps = np.flatnonzero((W[:-1] == W[1:]) & ((W[1:] == search.lo) | (W[1:] == search.hi))) + 1
    if track.closed and gaps.size:  # begin where the branch comes into the window, not in the middle of a piece
        order = np.concatenate([np.arange(gaps[0], len(W)), np.arange(1, gaps[0])])
        track.ys, track.ts, track.Hs = track.ys[order], track.ts[order], track.Hs[order]
        track.truncations, track.columns = track.truncations[order], track.columns[order]


def _edges_crossed(W: Floats, edges: tuple[float, float]) -> tuple[np.ndarray, Floats]:
    """Steps of a branch that cross an edge of the window, and the edge, in order along the branch."""
    steps = np.concatenate([np.flatnonzero((W[:-1] - edge) * (W[1:] - edge) < 0) for edge in edges])
    crossed = np.repeat(edges, [np.count_nonzero((W[:-1] - edge) * (W[1:] - edge) < 0) for edge in edges])
    order = np.lexsort([np.abs(crossed - W[steps]), steps])
    return steps[order], crossed[order]


def _on_edge(search: Search, track: Track, i: int, edge: float) -> tuple[Floats, Floats, int]:
    """Point of the branch at Omega = edge between points i and i + 1."""
    pb, odd = search.problem, track.odd
    H = max(track.Hs[i], track.Hs[i + 1])
    ends = [np.zeros(search.size(odd)) for _ in range(4)]
    for k in (0, 1):
        same_harmonics(pb, odd, track.ys[i + k], track.ts[i + k], track.Hs[i + k], H, ends[k], ends[2 + k])
    n = unknowns(pb, H, odd)
    f = (edge - ends[0][n]) / (ends[1][n] - ends[0][n])
    y = (1 - f) * ends[0] + f * ends[1]
    ok, _, _ = solve_at(pb, odd, edge, y, H, search.highest, math.inf, 12)
    y[n] = edge
    tangent = (1 - f) * ends[2] + f * ends[3]
    return (y if ok else ends[0]), tangent, int(H)


def _uncover(search: Search, track: Track) -> None:
    """Insert points where a multiplier may leave the unit circle and come back between two points, or moves far."""
    for _ in range(_ROUNDS):
        m = np.where(np.isfinite(track.multipliers), track.multipliers, _BEYOND_NUMBERS)
        logs = np.log(np.maximum(np.abs(m), _LEAST_NUMBER))
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
        wanted = wanted[track.frequency[wanted] != track.frequency[wanted + 1]]  # not across a gap between pieces
        search.budget.take_points(len(wanted), int(unknowns(search.problem, np.max(track.Hs), track.odd)))
        if search.budget.reached or not _insert(search, track, wanted):
            return


def _insert(search: Search, track: Track, after: np.ndarray) -> bool:
    """Insert the midpoint behind every listed point; returns whether any was inserted."""
    new = []
    for i in after:
        point = midpoint(search, track, int(i))
        if point is not None:
            new.append((int(i), point))
    put_in(search, track, new)
    return bool(new)


def put_in(search: Search, track: Track, new: list[tuple[int, tuple[Floats, Floats, int]]]) -> None:
    """Put points behind the given indices of a branch."""
    if not new:
        return
    at = [i + 1 for i, _ in new]
    ys, ts = np.array([point[0] for _, point in new]), np.array([point[1] for _, point in new])
    Hs = np.array([point[2] for _, point in new])
    columns, multipliers = described(search, track.odd, ys, Hs)
    track.ys, track.ts = np.insert(track.ys, at, ys, axis=0), np.insert(track.ts, at, ts, axis=0)
    track.Hs = np.insert(track.Hs, at, Hs)
    track.truncations = np.insert(track.truncations, at, [track.truncations[i] for i, _ in new])
    track.columns = np.insert(track.columns, at, columns, axis=0)
    track.multipliers = np.insert(track.multipliers, at, multipliers, axis=0)


def _locate_events(search: Search, track: Track) -> None:
    """Locate every change of stability or direction along the branch and put its point on the branch."""
    inserted: list[tuple[int, Point]] = []
    for i in np.flatnonzero(is_eventful(search, track)):
        look = events_after if search.budget.events > 0 else events_seen
        for event, point in look(search, track, int(i)):
            search.budget.events -= 1
            track.events.append(event)
            track.event_points.append(point)
            if point is not None:
                inserted.append((int(i), point))
    put_in(search, track, inserted)
