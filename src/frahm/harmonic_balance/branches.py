"""The complete set of branches over a frequency window: seeds, continuation, matching, special points."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import Problem, condense
from frahm.harmonic_balance.floquet import Variation, variation_of
from frahm.harmonic_balance.follow import CLOSED, LEFT, NO_START, follow
from frahm.harmonic_balance.kernels import unknowns
from frahm.harmonic_balance.newton import solve_at
from frahm.harmonic_balance.orbits import between, describe, locate, same_harmonics
from frahm.harmonic_balance.seeds import (
    Seed,
    count_cubic,
    searched_seeds,
    single_element_seeds,
    spring_polynomial,
    stiffness_at,
)
from frahm.systems import System

GOAL = 1e-8
_AUTO_HARMONICS = 101
_MOST_POINTS = 6000
_LONGEST = 0.016
_SEED_FREQUENCIES = 17
_GRID = 401


@dataclass(frozen=True)
class LocatedEvent:
    """A special point of a branch: kind, its point, and the half-width of the interval that holds it [rad/s]."""

    kind: str
    columns: Floats
    half_width: float
    located: bool


@dataclass
class Track:
    """One branch as it was followed: points, tangents, harmonics, and what they mean.

    columns are Omega, |X1|, |Z1|, max |x|, max |z|; multipliers those of the (half) map, by descending modulus.
    """

    odd: bool
    ys: Floats
    ts: Floats
    Hs: np.ndarray
    truncations: Floats
    columns: Floats
    multipliers: np.ndarray
    closed: bool
    endings: tuple[int, ...]
    events: list[LocatedEvent] = field(default_factory=list)
    parent: int | None = None

    @property
    def frequency(self) -> Floats:
        """Omega at every point [rad/s]."""
        return self.columns[:, 0]


@dataclass(frozen=True)
class Search:
    """What a search over one window works with."""

    system: System
    problem: Problem
    variation: Variation
    lo: float
    hi: float
    outer: tuple[float, float]
    x_scale: float
    w_scale: float
    harmonics: int | None

    @property
    def highest(self) -> int:
        """Highest harmonic there is room for."""
        return _AUTO_HARMONICS if self.harmonics is None else self.harmonics

    @property
    def goal(self) -> float:
        """Truncation to reach; infinite when the number of harmonics is the user's."""
        return GOAL if self.harmonics is None else math.inf

    def size(self, odd: bool) -> int:
        """Length of a stored point."""
        return unknowns(self.problem, self.highest, odd) + 1


def begin(system: System, lo: float, hi: float, harmonics: int | None) -> Search:
    """Condense the system and set the scales of the search."""
    pb = condense(system)
    grid = np.linspace(lo, hi, 65)
    largest = 0.0
    e = spring_polynomial(pb)
    for W in grid:
        for seed in _seeds_at(pb, float(W), e, 1.0, pb.odd, first_only=True):
            largest = max(largest, float(np.max(np.abs(seed.harmonics[1]))))
    width = hi - lo
    outer = (max(lo - width, 0.02 * lo), hi + width)
    return Search(system, pb, variation_of(system), lo, hi, outer, largest or 1.0, width, harmonics)


def _seeds_at(pb: Problem, W: float, e: Floats | None, scale: float, odd: bool, first_only: bool = False) -> list[Seed]:
    if e is not None:
        seeds = single_element_seeds(pb, W, e)
        return [seed for seed in seeds if len(seed.harmonics) == 1] if first_only else seeds
    if first_only:
        S, F = stiffness_at(pb, 1, W)
        return [Seed(W, {1: np.linalg.solve(S, F)})]
    return searched_seeds(pb, W, scale, odd)


def seed_frequencies(search: Search) -> Floats:
    """Frequencies of the window at which branches are looked for: spread, and inside every range of three roots."""
    spread = np.linspace(search.lo, search.hi, _SEED_FREQUENCIES)
    e = spring_polynomial(search.problem)
    if e is None or e.size != 2 or e[0] != 0:
        return np.linspace(search.lo, search.hi, 3 * _SEED_FREQUENCIES)
    grid = np.linspace(search.lo, search.hi, _GRID)
    counts, excess = np.empty(_GRID, np.int64), np.empty(_GRID)
    count_cubic(search.problem, grid, e[1], counts, excess)
    edges = np.flatnonzero(np.diff(counts)) + 1
    middles = [grid[run[len(run) // 2]] for run in np.split(np.arange(_GRID), edges) if counts[run[0]] > 1]
    inner = excess[1:-1]
    almost = np.flatnonzero((inner > excess[:-2]) & (inner > excess[2:]) & (inner < 0)) + 1
    return np.unique(np.concatenate([spread, middles, grid[almost]]))


def find_branches(search: Search) -> list[Track]:
    """Every branch the seeds lead to, each followed once; the one with the smallest response at `lo` comes first."""
    pb = search.problem
    e = spring_polynomial(pb)
    odd = pb.odd
    tracks: list[Track] = []
    for W in seed_frequencies(search):
        seeds = _seeds_at(pb, float(W), e, search.x_scale, odd)
        seeds.sort(key=lambda seed: float(np.max(np.abs(seed.harmonics[1]))))
        for seed in seeds:
            start = solve_seed(search, seed, odd)
            if start is None or any(_lies_on(search, track, *start) for track in tracks):
                continue
            tracks.append(_followed(search, odd, *start))
    for track in tracks:
        complete(search, track)
    return tracks


def solve_seed(search: Search, seed: Seed, odd: bool) -> tuple[Floats, int] | None:
    """Newton from a seed at its frequency: the point (X, Omega) and its number of harmonics."""
    pb = search.problem
    r = pb.M11.shape[0]
    X = np.zeros(search.size(odd))
    for k, u in seed.harmonics.items():
        at = 2 * r * ((k - 1) // 2 if odd else k)
        X[at : at + 2 * r] = np.column_stack([u.real, u.imag]).ravel()
    H = search.harmonics or max(3, *seed.harmonics)
    ok, H, truncation = solve_at(pb, odd, seed.frequency, X, H, search.highest, search.goal, 25)
    if not ok or truncation > max(search.goal, 1e-6) or not np.all(np.isfinite(X)):
        return None
    X[unknowns(pb, H, odd)] = seed.frequency
    return X, H


def _lies_on(search: Search, track: Track, y: Floats, H: int) -> bool:
    """Whether a solution is a point of a branch already followed: compared at its own frequency after Newton."""
    pb, odd = search.problem, track.odd
    n = unknowns(pb, H, odd)
    W = y[n]
    crossing = np.flatnonzero((track.frequency[:-1] - W) * (track.frequency[1:] - W) <= 0)
    for i in crossing:
        a, b = track.frequency[i], track.frequency[i + 1]
        f = 0.5 if a == b else (W - a) / (b - a)
        na, nb = unknowns(pb, track.Hs[i], odd), unknowns(pb, track.Hs[i + 1], odd)
        guess = np.zeros(search.size(odd))
        guess[:na] += (1 - f) * track.ys[i, :na]
        guess[:nb] += f * track.ys[i + 1, :nb]
        leap = np.linalg.norm(track.ys[i + 1, : min(na, nb)] - track.ys[i, : min(na, nb)])
        if np.linalg.norm(guess[:n] - y[:n]) > 3 * leap + 0.05 * np.linalg.norm(y[:n]):
            continue
        ok, _, _ = solve_at(pb, odd, W, guess, max(H, track.Hs[i]), search.highest, math.inf, 15)
        if ok and np.linalg.norm(guess[:n] - y[:n]) < 1e-5 * np.linalg.norm(y[:n]) + 1e-12 * search.x_scale:
            return True
    return False


def _followed(search: Search, odd: bool, y: Floats, H: int) -> Track:
    """Follow a branch from one of its points in both directions."""
    forward, ending = _run(search, odd, y, H, 1.0)
    if ending == CLOSED:
        return _track(search, odd, [forward], True, (ending,))
    backward, other = _run(search, odd, y, H, -1.0)
    reverse = tuple(np.ascontiguousarray(part[::-1]) for part in backward)
    reverse = (reverse[0][:-1], -reverse[1][:-1], reverse[2][:-1], reverse[3][:-1])
    return _track(search, odd, [reverse, forward], False, (other, ending))


def _run(search: Search, odd: bool, y: Floats, H: int, direction: float) -> tuple[tuple[np.ndarray, ...], int]:
    size = search.size(odd)
    ys, ts = np.empty((_MOST_POINTS, size)), np.empty((_MOST_POINTS, size))
    Hs, truncations = np.empty(_MOST_POINTS, np.int64), np.empty(_MOST_POINTS)
    count, ending = follow(
        search.problem, odd, y, H, search.highest, search.goal, direction, *search.outer,
        search.x_scale, search.w_scale, _LONGEST, ys, ts, Hs, truncations,
    )  # fmt: skip
    return (ys[:count].copy(), ts[:count].copy(), Hs[:count].copy(), truncations[:count].copy()), ending


def _track(
    search: Search, odd: bool, parts: list[tuple[np.ndarray, ...]], closed: bool, endings: tuple[int, ...]
) -> Track:
    ys, ts, Hs, truncations = (np.concatenate(column) for column in zip(*parts, strict=True))
    columns = np.zeros((len(Hs), 5))
    columns[:, 0] = ys[np.arange(len(Hs)), [unknowns(search.problem, H, odd) for H in Hs]]
    return Track(odd, ys, ts, Hs, truncations, columns, np.zeros((0, 0)), closed, endings)


def complete(search: Search, track: Track) -> None:
    """Give a followed branch its amplitudes and multipliers, refine it between hidden events, locate them all."""
    _trim(search, track)
    _describe(search, track)
    _uncover(search, track)
    _locate_events(search, track)


def _describe(search: Search, track: Track) -> None:
    m = 2 * search.system.size
    track.columns, track.multipliers = np.empty((len(track.Hs), 5)), np.empty((len(track.Hs), m), complex)
    describe(search.problem, search.variation, track.odd, track.ys, track.Hs, track.columns, track.multipliers)


def _trim(search: Search, track: Track) -> None:
    """Cut a branch to the window, with points exactly on its edges; pieces stay in order along the branch."""
    W = track.frequency
    rows: list[tuple[Floats, Floats, int, float]] = []
    for i in range(len(W)):
        if search.lo <= W[i] <= search.hi:
            rows.append((track.ys[i], track.ts[i], track.Hs[i], track.truncations[i]))
        if i + 1 < len(W):
            crossed = [edge for edge in (search.lo, search.hi) if (W[i] - edge) * (W[i + 1] - edge) < 0]
            for edge in sorted(crossed, key=lambda value: abs(value - W[i])):
                rows.append((*_on_edge(search, track, i, edge), track.truncations[i]))
    track.ys, track.ts = np.array([row[0] for row in rows]), np.array([row[1] for row in rows])
    track.Hs, track.truncations = np.array([row[2] for row in rows]), np.array([row[3] for row in rows])


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
    """Insert points where a multiplier may leave the unit circle and come back between two points."""
    for _ in range(6):
        logs = np.log(np.maximum(np.abs(track.multipliers), 1e-300))
        left, mid, right = logs[:-2], logs[1:-1], logs[2:]
        bend = left - 2 * mid + right
        with np.errstate(divide="ignore", invalid="ignore"):
            summit = mid - (right - left) ** 2 / (8 * bend)
        hidden = ((mid - left) * (mid - right) > 0) & (np.sign(summit) != np.sign(mid)) & (np.abs(bend) > 1e-12)
        rows = np.flatnonzero(hidden.any(axis=1)) + 1
        wanted = np.unique(np.concatenate([rows - 1, rows])) if rows.size else rows
        if not _insert(search, track, wanted):
            return


def _insert(search: Search, track: Track, after: np.ndarray) -> bool:
    """Insert the midpoint behind every listed point; returns whether any was inserted."""
    new = []
    for i in after:
        point = _midpoint(search, track, int(i))
        if point is not None:
            new.append((int(i), point))
    if not new:
        return False
    at = [i + 1 for i, _ in new]
    track.ys = np.insert(track.ys, at, [p[0] for _, p in new], axis=0)
    track.ts = np.insert(track.ts, at, [p[1] for _, p in new], axis=0)
    track.Hs = np.insert(track.Hs, at, [p[2] for _, p in new])
    track.truncations = np.insert(track.truncations, at, [track.truncations[i] for i, _ in new])
    _describe(search, track)
    return True


def _midpoint(search: Search, track: Track, i: int, fraction: float = 0.5) -> tuple[Floats, Floats, int] | None:
    pb, odd = search.problem, track.odd
    if i + 1 >= len(track.Hs):
        return None
    H = int(max(track.Hs[i], track.Hs[i + 1]))
    ends = [np.zeros(search.size(odd)) for _ in range(4)]
    for k in (0, 1):
        same_harmonics(pb, odd, track.ys[i + k], track.ts[i + k], track.Hs[i + k], H, ends[k], ends[2 + k])
    y, t = np.zeros(search.size(odd)), np.zeros(search.size(odd))
    ok = between(
        pb, odd, ends[0], ends[2], ends[1], ends[3], H, fraction, search.x_scale, search.w_scale, y, t
    )
    return (y, t, H) if ok else None


def _locate_events(search: Search, track: Track) -> None:
    """Locate every change of stability or direction along the branch and put its point on the branch."""
    pb, odd = search.problem, track.odd
    ends = [unknowns(pb, H, odd) for H in track.Hs]
    rise = track.ts[np.arange(len(ends)), ends]
    unstable = np.sum(np.abs(track.multipliers) > 1, axis=1)
    inserted: list[tuple[int, Floats, Floats, int]] = []
    for i, j in itertools.pairwise(range(len(ends))):
        gap = track.frequency[i] in (search.lo, search.hi) and track.frequency[j] in (search.lo, search.hi)
        if gap and _is_gap(track, i):
            continue
        folded = rise[i] * rise[j] < 0
        ranks = list(range(min(unstable[i], unstable[j]), max(unstable[i], unstable[j])))
        if folded:
            inserted += _one_event(search, track, i, -1)
        if ranks and not (folded and len(ranks) == 1):
            pairs = ranks[::2] if len(ranks) % 2 == 0 else ranks
            for rank in pairs:
                inserted += _one_event(search, track, i, rank)
    if inserted:
        at = [i + 1 for i, *_ in inserted]
        track.ys = np.insert(track.ys, at, [p[1] for p in inserted], axis=0)
        track.ts = np.insert(track.ts, at, [p[2] for p in inserted], axis=0)
        track.Hs = np.insert(track.Hs, at, [p[3] for p in inserted])
        track.truncations = np.insert(track.truncations, at, [track.truncations[i] for i, *_ in inserted])
        _describe(search, track)


def _is_gap(track: Track, i: int) -> bool:
    """Whether two neighbouring points on the window's edges belong to different pieces of the branch."""
    return track.frequency[i] == track.frequency[i + 1]


def _one_event(search: Search, track: Track, i: int, rank: int) -> list[tuple[int, Floats, Floats, int]]:
    """Locate one event between points i and i + 1, note it, and return its point for insertion."""
    pb, odd = search.problem, track.odd
    size = search.size(odd)
    y, t = np.zeros(size), np.zeros(size)
    multipliers = np.zeros(2 * search.system.size, complex)
    ok, H, half = locate(
        pb, search.variation, odd, track.ys[i], track.ts[i], track.Hs[i], track.ys[i + 1], track.ts[i + 1],
        track.Hs[i + 1], rank, search.x_scale, search.w_scale, y, t, multipliers,
    )  # fmt: skip
    if not ok:
        kind = "saddle-node" if rank < 0 else _kind(track.odd, track.multipliers[i, rank])
        middle = 0.5 * (track.columns[i] + track.columns[i + 1])
        half = 0.5 * abs(track.frequency[i + 1] - track.frequency[i])
        track.events.append(LocatedEvent(kind, middle, half, False))
        return []
    columns, again = np.empty((1, 5)), np.empty((1, multipliers.size), complex)
    describe(pb, search.variation, odd, y[None], np.array([H]), columns, again)
    kind = "saddle-node" if rank < 0 else _kind(odd, multipliers[rank])
    track.events.append(LocatedEvent(kind, columns[0], float(half), True))
    return [(i, y, t, int(H))]


def _kind(odd: bool, multiplier: complex) -> str:
    """Kind of event from the critical multiplier of the (half) map."""
    if abs(multiplier.imag) > 1e-6 * abs(multiplier):
        return "neimark-sacker"
    if multiplier.real > 0:
        return "branch-point"
    return "branch-point" if odd else "period-doubling"


def is_detached(track: Track, main: Track) -> bool:
    """Whether a branch has no connection, as far as it was followed, with the main one."""
    return track is not main


ENDINGS = {LEFT: "left the searched range", CLOSED: "closed", NO_START: "could not be started"}
