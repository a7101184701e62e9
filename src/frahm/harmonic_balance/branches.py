"""The complete set of branches over a frequency window: seeds, continuation, matching, special points."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.linalg

from frahm.absorbers.packed import law_force_and_slopes
from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import Problem, condense, unknowns
from frahm.harmonic_balance.events import LocatedEvent, Point, events_after, events_seen, is_eventful
from frahm.harmonic_balance.floquet import Variation, variation_of
from frahm.harmonic_balance.follow import CLOSED, follow
from frahm.harmonic_balance.found import Budget
from frahm.harmonic_balance.kernels import fourier_tables, residual_and_jacobian, sample_count
from frahm.harmonic_balance.newton import correct, solve_at
from frahm.harmonic_balance.orbits import between, describe, same_harmonics
from frahm.harmonic_balance.quasi_static import searched_window
from frahm.harmonic_balance.root_counts import polynomial_counts, table_counts
from frahm.harmonic_balance.seeds import (
    Seed,
    Seeder,
    almost_seeds,
    count_cubic,
    seeder_for,
    stiffness_at,
    two_harmonic_seeds,
)
from frahm.systems import System

GOAL = 1e-8
_ROUGH_GOAL = 1e-6  # with stops or friction, whose force harmonics fall off slowly
_WORST = 0.05  # truncation with stops or friction beyond which a solution of the harmonics is none of the equations
_AUTO_HARMONICS = 101
_MOST_POINTS = 6000
_LONGEST = 0.02
_SEED_FREQUENCIES = 17
_QUICK = 0.2  # way of a multiplier near the unit circle from point to point that asks for a point between
_BEYOND = 12  # windows beyond the upper edge in which branches that leave it are followed
_GRID = 401
_BAND = 0.65  # ln(hi/lo) of the widest window these numbers of frequencies are for: wider ones take more of them
_SHORT_RANGE, _AROUND = 16, 9  # points of the grid in a short range of three roots; frequencies looked at around it
_STRONG_FREQUENCIES = 9
_STRONG_THIRD = 0.12  # third harmonic beside the first from where on both are searched together
_BEYOND_NUMBERS = 1e300  # stands for a multiplier that no number holds
_CROSSING = 5e-3  # of a point: how near a branch passes that crosses another one there


@dataclass
class Track:
    """One branch as it was followed: points, tangents, harmonics, and what they mean.

    columns are Omega, |X1|, |Z1|, max |x|, max |z|; multipliers those of the (half) map, by descending modulus; births
    are losses of symmetry outside the window, from where an asymmetric branch may come into it.
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
    event_points: list[tuple[Floats, Floats, int] | None] = field(default_factory=list)
    births: list[tuple[LocatedEvent, Point]] = field(default_factory=list)
    parent: Track | None = None
    meets: list[Track] = field(default_factory=list)

    @property
    def pieces(self) -> np.ndarray:
        """Number of the piece inside the window every point belongs to."""
        same = self.frequency[:-1] == self.frequency[1:]
        return np.concatenate([[0], np.cumsum(same)]).astype(int)

    @property
    def frequency(self) -> Floats:
        """Omega at every point [rad/s]."""
        return self.columns[:, 0]


@dataclass(frozen=True)
class Search:
    """What a search over one window works with."""

    system: System
    problem: Problem
    seeder: Seeder
    variation: Variation
    lo: float
    hi: float
    outer: tuple[float, float]
    x_scale: float
    w_scale: float
    harmonics: int | None
    unsearched: tuple[str, ...] = ()
    budget: Budget = field(default_factory=Budget)

    @property
    def highest(self) -> int:
        """Highest harmonic there is room for."""
        return _AUTO_HARMONICS if self.harmonics is None else self.harmonics

    @property
    def goal(self) -> float:
        """Truncation to reach; infinite when the number of harmonics is the user's."""
        if self.harmonics is not None:
            return math.inf
        return GOAL if self.smooth else _ROUGH_GOAL

    @property
    def smooth(self) -> bool:
        """Whether no element has stops or friction."""
        return all(element.law.is_smooth for element in self.system.elements)

    def size(self, odd: bool) -> int:
        """Length of a stored point."""
        return unknowns(self.problem, self.highest, odd) + 1


def begin(system: System, lo: float, hi: float, harmonics: int | None, forcing: Floats | None = None) -> Search:
    """Condense the system and set the scales of the search; `forcing` is a factor over Omega, see `forcing_factor`."""
    lo, hi, unsearched = searched_window(system, lo, hi)
    pb = condense(system, forcing)
    grid = np.linspace(lo, hi, _SEED_FREQUENCIES)
    largest = 0.0
    seeder = seeder_for(pb, grid)
    for W in grid:
        for seed in seeder.at(float(W), 1.0, first_only=True):
            largest = max(largest, *(float(np.max(np.abs(u))) for u in seed.harmonics.values()))
    width = hi - lo
    outer = (max(lo - width, 0.02 * lo), hi + width)
    scale = largest or 1.0
    variation = variation_of(system, *_strongest(pb, scale, hi)) if system.size > 3 else variation_of(system)
    return Search(system, pb, seeder, variation, lo, hi, outer, scale, width, harmonics, unsearched)


def _strongest(pb: Problem, scale: float, hi: float) -> tuple[float, float]:
    """Largest slope of the elements [N/m] at the largest amplitude expected, and the frequency [rad/s]."""
    z = scale * np.linspace(-1.0, 1.0, 201)
    slopes = [law_force_and_slopes(*row, pb.table, value, 0.0)[1] for row in pb.codes for value in z]
    return float(np.max(np.abs(slopes))), hi


def seed_frequencies(search: Search) -> tuple[Floats, Floats, Floats]:
    """Frequencies for starts: all first-harmonic roots; free third harmonics; near misses of further roots.

    With one cubic element the roots are continuous where their number is constant, so that one frequency in every
    such range, and both edges, stand for all.
    """
    bands = max(1.0, math.log(search.hi / search.lo) / _BAND)
    points, seeds = math.ceil(_GRID * bands), math.ceil(_SEED_FREQUENCIES * bands)
    spread = np.linspace(search.lo, search.hi, seeds)
    pb, seeder = search.problem, search.seeder
    e, table = seeder.spring, seeder.table
    cubic = e is not None and e.size == 2 and e[0] == 0 and not seeder.buckled
    dense = np.linspace(search.lo, search.hi, 3 * seeds)
    if pb.directions.shape != (1, 1) or (e is None and table is None):
        return dense, np.empty(0), np.empty(0)
    grid = np.linspace(search.lo, search.hi, points)
    counts, excess = np.empty(points, np.int64), np.empty(points)
    if cubic and e is not None:
        count_cubic(pb, grid, e[1], counts, excess)
    else:
        parts = [stiffness_at(pb, 1, float(W)) for W in grid]
        S, F = (np.array([part[which].flat[0] for part in parts]) for which in (0, 1))
        counts, excess = np.zeros(points, np.int64), np.full(points, -math.inf)
        found = [] if e is None else [polynomial_counts(e, S, F)]
        found += [] if table is None else [table_counts(pb, table, grid, S, F)]
        for number, near_miss in found:
            counts, excess = counts + number, np.maximum(excess, near_miss)
    edges = np.flatnonzero(np.diff(counts)) + 1
    runs = np.split(np.arange(points), edges)
    middles = [grid[run[len(run) // 2]] for run in runs]
    inner = excess[1:-1]
    almost = np.flatnonzero((inner > excess[:-2]) & (inner > excess[2:]) & (inner < 0)) + 1
    # a short range of three roots may lie beside that of the exact equations: both are looked at around it, too
    short = [run for run in runs if counts[run[0]] >= 3 and len(run) <= _SHORT_RANGE]
    step = grid[1] - grid[0]
    around = [np.linspace(grid[run[0]] - 2 * step, grid[run[-1]] + 2 * step, _AROUND) for run in short]
    near = np.concatenate([grid[almost], *around])
    near = near[(near > search.lo) & (near < search.hi)]
    if cubic:
        return np.unique(np.concatenate([spread[[0, -1]], middles])), spread, near
    return np.unique(np.concatenate([dense, middles])), np.empty(0), near


def find_branches(search: Search, asymmetric: bool = True) -> list[Track]:
    """Every branch the seeds lead to, each followed once; the one with the smallest response at `lo` comes first.

    Branches with even harmonics that leave odd ones are followed only if `asymmetric`.
    """
    odd, seeder = search.problem.odd, search.seeder
    tracks: list[Track] = []
    complete_at, beside, almost = seed_frequencies(search)
    seeds = [seed for W in complete_at for seed in seeder.at(float(W), search.x_scale)]
    seeds += [seed for W in beside for seed in seeder.at(float(W), search.x_scale) if 3 in seed.harmonics]
    if seeder.spring is not None:
        seeds += [seed for W in almost for seed in almost_seeds(search.problem, float(W), seeder.spring)]
    if seeder.table is not None:
        seeds += [seed for W in almost for seed in seeder.at(float(W), search.x_scale)]
    about_others = [seed for seed in seeds if odd and 0 in seed.harmonics]
    _follow_new(search, [seed for seed in seeds if not odd or 0 not in seed.harmonics], tracks)
    if seeder.spring is not None and _third_harmonic(search, tracks) > _STRONG_THIRD:
        spread = np.linspace(search.lo, search.hi, _STRONG_FREQUENCIES)
        strong = [seed for W in spread for seed in two_harmonic_seeds(search.problem, float(W), seeder.spring)]
        _follow_new(search, strong, tracks)
    tracks = [track for track in tracks if complete(search, track)]
    for track in list(tracks) if asymmetric else []:
        tracks += asymmetric_branches(search, track, tracks)
    if asymmetric:
        tracks += _buckled_branches(search, about_others, tracks)
    for track in tracks:
        _join(search, track, tracks)
    tracks = sorted(tracks, key=lambda track: _response_at(track, search.lo))
    _join_beyond(search, tracks)
    return tracks


def _buckled_branches(search: Search, seeds: list[Seed], known: list[Track]) -> list[Track]:
    """Branches of an odd system about another mean than 0 that no loss of symmetry in the window has led to.

    One of each mirrored pair is followed.
    """
    tracks: list[Track] = []
    for seed in seeds:
        start = None if search.budget.reached else solve_seed(search, seed, False)
        if start is None or np.linalg.norm(_even_part(search, *start)) < 1e-3 * search.x_scale:
            continue
        others = [track for track in known + tracks if not track.odd]
        if any(_meets(search, track, *start) for track in others):
            continue
        track = _half_of_pair(search, _followed(search, False, *start))
        if complete(search, track):
            tracks.append(track)
    return tracks


def _follow_new(search: Search, seeds: list[Seed], tracks: list[Track]) -> None:
    """Follow the branches of all starts that do not lie on one already followed, and add them."""
    odd = search.problem.odd
    for seed in seeds:
        start = None if search.budget.reached else solve_seed(search, seed, odd)
        if start is not None and not any(_lies_on(search, track, *start) for track in tracks):
            tracks.append(_followed(search, odd, *start))


def _third_harmonic(search: Search, tracks: list[Track]) -> float:
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
        inside = np.flatnonzero((track.frequency >= search.lo) & (track.frequency <= search.hi))
        start = int(inside[len(inside) // 2])
        whole = _followed(far, track.odd, track.ys[start].copy(), int(track.Hs[start]))
        for other in hanging:
            at = int(np.argmin(np.abs(other.frequency - 0.5 * (search.lo + search.hi))))
            if other.odd == track.odd and _lies_on(search, whole, other.ys[at].copy(), int(other.Hs[at])):
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


def connected(tracks: list[Track]) -> list[Track]:
    """Branches that hang together with the first one, directly or through others."""
    found: list[Track] = []
    waiting = tracks[:1]
    while waiting:
        track = waiting.pop()
        if any(track is other for other in found):
            continue
        found.append(track)
        waiting += [other for other in tracks if other.parent is track or other is track.parent]
        waiting += track.meets
    return found


def _response_at(track: Track, W: float) -> float:
    """Smallest relative peak of a branch at one of its frequencies; infinite if it has no point there.

    Not the amplitude: about another equilibrium that is small, too.
    """
    here = track.frequency == W
    return float(np.min(track.columns[here, 4])) if np.any(here) else math.inf


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
    most = 1e-6 if search.smooth else _WORST
    if not ok or truncation > max(search.goal, most) or not np.all(np.isfinite(X)):
        return None
    X[unknowns(pb, H, odd)] = seed.frequency
    return X, H


def _lies_on(search: Search, track: Track, y: Floats, H: int) -> bool:
    """Whether a solution is a point of a branch already followed: compared in its own plane across the chord of a step.

    Only steps that reach its frequency are looked at, or in which the frequency turns.
    """
    n = unknowns(search.problem, H, track.odd)
    beyond = track.frequency - y[n]
    rise = track.ts[np.arange(len(track.Hs)), unknowns(search.problem, track.Hs, track.odd)]
    steps = np.flatnonzero((beyond[:-1] * beyond[1:] <= 0) | (rise[:-1] * rise[1:] < 0))
    return any(_lies_in_step(search, track, y, n, int(i)) for i in steps)


def _lies_in_step(search: Search, track: Track, y: Floats, n: int, i: int) -> bool:
    """Whether a solution is the point of the branch in its own plane across the chord of step i."""
    scales = np.append(np.full(n, search.x_scale), search.w_scale)
    a, b = (_with_unknowns(search, track, k, n) / scales for k in (i, i + 1))
    here, chord = y[: n + 1] / scales - a, b - a
    length = float(np.linalg.norm(chord))
    if length == 0.0:  # the branch was outside the window in between
        return False
    fraction = float(here @ chord) / length**2
    if not -0.01 <= fraction <= 1.01 or np.linalg.norm(here - fraction * chord) > 0.5 * length:
        return False
    point = _midpoint(search, track, i, fraction)
    if point is None:
        return False
    found, own = np.zeros(n + 1), unknowns(search.problem, point[2], track.odd)
    found[: min(n, own)], found[n] = point[0][: min(n, own)], point[0][own]
    return bool(np.linalg.norm((found - y[: n + 1]) / scales) < 1e-5 * np.linalg.norm(y[:n]) / search.x_scale)


def _with_unknowns(search: Search, track: Track, i: int, n: int) -> Floats:
    """A point of a branch with `n` unknowns before Omega."""
    own = unknowns(search.problem, track.Hs[i], track.odd)
    point = np.zeros(n + 1)
    point[: min(n, own)], point[n] = track.ys[i, : min(n, own)], track.ys[i, own]
    return point


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


def _track(
    search: Search, odd: bool, parts: list[tuple[np.ndarray, ...]], closed: bool, endings: tuple[int, ...]
) -> Track:
    ys, ts, Hs, truncations = (np.concatenate(column) for column in zip(*parts, strict=True))
    columns = np.zeros((len(Hs), 5))
    columns[:, 0] = ys[np.arange(len(Hs)), unknowns(search.problem, Hs, odd)]
    return Track(odd, ys, ts, Hs, truncations, columns, np.zeros((0, 0)), closed, endings)


def complete(search: Search, track: Track) -> bool:
    """Give a followed branch its amplitudes and multipliers, refine it between hidden events, locate them all.

    Returns whether any of it lies in the window.
    """
    inside = (track.frequency >= search.lo) & (track.frequency <= search.hi)
    if np.sum(inside) < 2:
        return False
    track.births = _births_outside(search, track, inside) if track.odd else []
    _trim(search, track)
    track.columns, track.multipliers = _described(search, track.odd, track.ys, track.Hs)
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
        part = Track(True, track.ys[rows], track.ts[rows], track.Hs[rows], track.truncations[rows],
                     *_described(search, True, track.ys[rows], track.Hs[rows]), False, ())  # fmt: skip
        for i in np.flatnonzero(is_eventful(search, part)):
            if search.budget.events <= 0:
                break
            search.budget.events -= 1
            events = events_after(search, part, int(i))
            found += [(event, point) for event, point in events if event.kind == "branch-point" and point is not None]
    return found


def _described(search: Search, odd: bool, ys: Floats, Hs: np.ndarray) -> tuple[Floats, np.ndarray]:
    """Columns and multipliers of points."""
    columns, multipliers = np.empty((len(Hs), 5)), np.empty((len(Hs), 2 * search.variation.K.shape[0]), complex)
    describe(search.problem, search.variation, odd, ys, Hs, columns, multipliers)
    return columns, multipliers


def asymmetric_branches(search: Search, parent: Track, known: list[Track]) -> list[Track]:
    """Branches with even harmonics that leave an odd branch where it loses its symmetry.

    One of each mirrored pair is followed, between the points at which it meets odd branches.
    """
    if not parent.odd:
        return []
    tracks: list[Track] = []
    own = zip(parent.events, parent.event_points, strict=True)
    births = [(event, point) for event, point in own if event.kind == "branch-point" and point is not None]
    for event, point in births + parent.births:
        ends = [c for t in known + tracks if not t.odd for c in (t.columns[0], t.columns[-1])]
        if any(np.allclose(c[[0, 4]], event.columns[[0, 4]], rtol=2e-3) for c in ends):
            continue
        start = None if search.budget.reached else _asymmetric_start(search, *point)
        if start is None:
            continue
        track = _half_of_pair(search, _followed(search, False, *start))
        track.parent = parent
        if complete(search, track) and not any(_is_same(search, track, t) for t in known + tracks if not t.odd):
            tracks.append(track)
    return tracks


def _is_same(search: Search, track: Track, other: Track) -> bool:
    """Whether two asymmetric branches are one, or mirror images of one another, judged where the first is least odd."""
    i = int(np.argmax([np.linalg.norm(_even_part(search, y, H)) for y, H in zip(track.ys, track.Hs, strict=True)]))
    return _meets(search, other, track.ys[i], int(track.Hs[i]))


def _meets(search: Search, other: Track, y: Floats, H: int) -> bool:
    """Whether a solution or its mirror image lies on an asymmetric branch."""
    pb, r = search.problem, search.problem.M11.shape[0]
    mirrored = y.copy()
    mirrored[: unknowns(pb, H, False)].reshape(-1, 2 * r)[::2] *= -1
    return _lies_on(search, other, y, H) or _lies_on(search, other, mirrored, H)


def _asymmetric_start(search: Search, y: Floats, _: Floats, H: int) -> tuple[Floats, int] | None:
    """A point beside a loss of symmetry, off along the even null vector of the full Jacobian."""
    pb = search.problem
    r = pb.M11.shape[0]
    full = np.zeros(search.size(False))
    odd_n, n = unknowns(pb, H, True), unknowns(pb, H, False)
    for m in range(odd_n // (2 * r)):
        full[2 * r * (2 * m + 1) : 2 * r * (2 * m + 2)] = y[2 * r * m : 2 * r * (m + 1)]
    full[n] = y[odd_n]
    R, J, A = np.empty(n + 1), np.empty((n + 1, n + 1)), np.empty((n + 1, n + 1))
    tables = fourier_tables(H, False, sample_count(pb, H, False))
    residual_and_jacobian(pb, H, False, full[n], full, *tables, R, J)
    normal = np.zeros(n + 1)
    normal[:n] = _null_vector(J[:n, :n])
    for push in (0.02, 0.005, 0.05):
        trial = full.copy()
        trial[:n] += push * search.x_scale * normal[:n]
        offset = float(normal[:n] @ trial[:n]) / search.x_scale
        ok, _, _ = correct(
            pb, H, False, trial, normal, offset, search.x_scale, search.w_scale, *tables, J, A,
            np.empty(n + 1, np.int64), 1e-9, 15,
        )  # fmt: skip
        if ok and np.linalg.norm(_even_part(search, trial, H)) > 0.3 * push * search.x_scale:
            return trial, H
    return None


def _null_vector(J: Floats) -> Floats:
    """Unit vector that a nearly singular matrix maps to nearly nothing, by inverse iteration."""
    factors = scipy.linalg.lu_factor(J + 1e-14 * np.linalg.norm(J) * np.eye(len(J)), check_finite=False)
    null = np.random.default_rng(1).standard_normal(len(J))
    for _ in range(3):
        null = scipy.linalg.lu_solve(factors, null / np.linalg.norm(null), check_finite=False)
    return np.asarray(null / np.linalg.norm(null))


def _even_part(search: Search, y: Floats, H: int) -> Floats:
    """Mean and even harmonics of a point with all harmonics, flat."""
    r = search.problem.M11.shape[0]
    n = unknowns(search.problem, H, False)
    return y[:n].reshape(-1, 2 * r)[::2].ravel()


def _half_of_pair(search: Search, track: Track) -> Track:
    """Cut an asymmetric branch where it passes through a symmetric orbit into its mirror image."""
    parts = [_even_part(search, y, H) for y, H in zip(track.ys, track.Hs, strict=True)]
    flips = [
        i for i in range(len(parts) - 1)
        if float(np.dot(*(p[: min(parts[i].size, parts[i + 1].size)] for p in parts[i : i + 2]))) < 0
    ]  # fmt: skip
    sizes = np.array([np.linalg.norm(p) for p in parts])
    if not flips:
        keep = np.arange(len(parts))
    elif track.closed:
        order = np.concatenate([np.arange(flips[0] + 1, len(parts) - 1), np.arange(flips[0] + 1)])
        keep = order[: ((flips[1] if len(flips) > 1 else flips[0]) - flips[0]) or len(order)]
    else:
        start = int(np.argmax(sizes))
        low = max([i + 1 for i in flips if i < start], default=0)
        keep = np.arange(low, min([i + 1 for i in flips if i >= start], default=len(parts)))
    if flips or not track.closed:  # an end that is all but symmetric lies on the point where the branch was born
        keep = keep[int(sizes[keep[0]] < 0.05 * sizes[keep[1]]) :] if len(keep) > 2 else keep
        keep = keep[: -1 if sizes[keep[-1]] < 0.05 * sizes[keep[-2]] else None] if len(keep) > 2 else keep
    if len(keep) == len(parts):
        return track
    part = [track.ys[keep], track.ts[keep], track.Hs[keep], track.truncations[keep]]
    return _track(search, False, [tuple(part)], False, track.endings)


def _trim(search: Search, track: Track) -> None:
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
    for _ in range(6):
        m = np.where(np.isfinite(track.multipliers), track.multipliers, _BEYOND_NUMBERS)
        logs = np.log(np.maximum(np.abs(m), 1e-300))
        left, mid, right = logs[:-2], logs[1:-1], logs[2:]
        bend = left - 2 * mid + right
        with np.errstate(divide="ignore", invalid="ignore"):
            summit = mid - (right - left) ** 2 / (8 * bend)
        crossed = (np.sign(summit) != np.sign(mid)) | (np.abs(summit) < 0.1 * np.abs(bend))
        hidden = ((mid - left) * (mid - right) > 0) & crossed & (np.abs(bend) > 1e-9)
        rows = np.flatnonzero(hidden.any(axis=1)) + 1
        leap = np.min(np.abs(m[:-1, :, None] - m[1:, None, :]), axis=2)
        size = np.abs(m[:-1])  # far outside the unit circle a way counts beside the size: steep growth asks for nothing
        quick = np.flatnonzero(((leap > _QUICK * np.maximum(size, 1.0)) & (size > 0.9)).any(axis=1))
        wanted = np.unique(np.concatenate([rows - 1, rows, quick]))
        wanted = wanted[track.frequency[wanted] != track.frequency[wanted + 1]]  # not across a gap between pieces
        search.budget.take_points(len(wanted), int(unknowns(search.problem, np.max(track.Hs), track.odd)))
        if search.budget.reached or not _insert(search, track, wanted):
            return


def _insert(search: Search, track: Track, after: np.ndarray) -> bool:
    """Insert the midpoint behind every listed point; returns whether any was inserted."""
    new = []
    for i in after:
        point = _midpoint(search, track, int(i))
        if point is not None:
            new.append((int(i), point))
    _put_in(search, track, new)
    return bool(new)


def _put_in(search: Search, track: Track, new: list[tuple[int, tuple[Floats, Floats, int]]]) -> None:
    """Put points behind the given indices of a branch."""
    if not new:
        return
    at = [i + 1 for i, _ in new]
    ys, ts = np.array([point[0] for _, point in new]), np.array([point[1] for _, point in new])
    Hs = np.array([point[2] for _, point in new])
    columns, multipliers = _described(search, track.odd, ys, Hs)
    track.ys, track.ts = np.insert(track.ys, at, ys, axis=0), np.insert(track.ts, at, ts, axis=0)
    track.Hs = np.insert(track.Hs, at, Hs)
    track.truncations = np.insert(track.truncations, at, [track.truncations[i] for i, _ in new])
    track.columns = np.insert(track.columns, at, columns, axis=0)
    track.multipliers = np.insert(track.multipliers, at, multipliers, axis=0)


def _midpoint(search: Search, track: Track, i: int, fraction: float = 0.5) -> tuple[Floats, Floats, int] | None:
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
    _put_in(search, track, inserted)
