"""At which frequencies branches are looked for, and how a start becomes a solution."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import CondensedSystem, stiffness_at, stiffness_over, unknowns
from frahm.harmonic_balance.newton import solve_at
from frahm.harmonic_balance.root_counts import cubic_turns, extreme_turns, polynomial_counts, table_counts
from frahm.harmonic_balance.search import Search
from frahm.harmonic_balance.seeds import Extreme, Seed, third_harmonics
from frahm.harmonic_balance.shared_drive import Solutions
from frahm.polynomials import cubic_roots

_WORST = 0.05  # truncation with stops or friction beyond which a solution of the harmonics is none of the equations
_SEED_FREQUENCIES = 17
_GRID = 401
_SHARED_GRID = 161  # where one frequency takes several cubics: a detached curve of a smaller range can be missed
_BAND = 0.65  # ln(hi/lo) of the widest window these numbers of frequencies are for: wider ones take more of them
_NEXT = 0.2  # of a motion: how far a turn of the force moves from one frequency to the next
_BESIDE = 8  # points of the grid beyond each edge: a detached curve born there can reach into the window
_SHORT_RANGE, _AROUND = 16, 9  # points of the grid in a short range of three roots; frequencies looked at around it


@dataclass(frozen=True)
class Starts:
    """Where to start: frequencies for all first-harmonic roots, for free third harmonics; extremes of the force."""

    everywhere: Floats
    third: Floats
    extremes: list[Extreme]


def starts_of(search: Search) -> Starts:
    """Where branches are looked for in a window.

    With one cubic element the roots are continuous where their number is constant, so that one frequency in every
    such range, and both edges, stand for all.
    """
    bands = max(1.0, math.log(search.hi / search.lo) / _BAND)
    points, seeds = math.ceil(_GRID * bands), math.ceil(_SEED_FREQUENCIES * bands)
    spread, dense = (np.linspace(search.lo, search.hi, number) for number in (seeds, 3 * seeds))
    e, table = search.seeder.spring, search.seeder.table
    if search.seeder.shared is not None:
        return _starts_of_several(search, spread, math.ceil(_SHARED_GRID * bands))
    if e is None and table is None:
        return Starts(dense, np.empty(0), [])
    grid = np.linspace(search.lo, search.hi, points)
    grid = np.concatenate([grid[0] - (grid[1] - grid[0]) * np.arange(_BESIDE, 0, -1), grid,
                           grid[-1] + (grid[1] - grid[0]) * np.arange(1, _BESIDE + 1)])  # fmt: skip
    grid = grid[grid > 0.5 * search.lo]
    counts, found = _counted(search, grid)
    middles, short = _ranges(grid, counts, (search.lo, search.hi))
    if e is not None and e.size == 2 and e[0] == 0 and not search.seeder.buckled:
        return Starts(np.unique(np.concatenate([spread[[0, -1]], middles])), spread, found)
    return Starts(np.unique(np.concatenate([dense, middles, short])), np.empty(0), found)


def _counted(search: Search, grid: Floats) -> tuple[np.ndarray, list[Extreme]]:
    """Number of first-harmonic roots on a grid of frequencies, and the extremes of the force they need."""
    pb, e, table = search.problem, search.seeder.spring, search.seeder.table
    stiffness, force = stiffness_over(pb, 1, grid)
    S, F = stiffness[:, 0, 0], force[:, 0]
    counts, found = np.zeros(grid.size, np.int64), []
    if e is not None and e.size == 2 and e[0] == 0:
        counts = counts + [cubic_roots(s, f, e[1])[0] for s, f in zip(S, F, strict=True)]
        found += _with_third_harmonics(pb, e, _extremes(grid, cubic_turns(float(e[1]), S, F), None))
    elif e is not None:
        number, turns = polynomial_counts(e, S, F)
        counts = counts + number
        found += _with_third_harmonics(pb, e, _extremes(grid, turns, None))
    if table is not None:
        number, turns = table_counts(pb, table, grid, S, F)
        counts = counts + number
        found += _extremes(grid, turns, table.mean, pb.odd)
    return counts, found


def _extremes(grid: Floats, turns: Floats, means: Floats | None, odd: bool = True) -> list[Extreme]:
    found = []
    for w, log_a, _, sign, row in extreme_turns(turns, grid.size - 1):
        mean = 0.0 if means is None else float(means[int(row)])
        harmonics = {1: np.array([complex(math.exp(log_a))])}
        if mean != 0 or not odd:
            harmonics[0] = np.array([complex(mean)])
        found.append(Extreme(float(grid[int(w)]), harmonics, int(sign), 0 not in harmonics))
    return found


def _with_third_harmonics(pb: CondensedSystem, e: Floats, found: list[Extreme]) -> list[Extreme]:
    """Extremes, with every free third harmonic beside each."""
    free = []
    for extreme in found:
        S, _ = stiffness_at(pb, 3, extreme.frequency)
        for third in third_harmonics(complex(S[0, 0]), complex(extreme.harmonics[1][0]), e):
            free.append(replace(extreme, harmonics={**extreme.harmonics, 3: np.array([third])}))
    return [*found, *free]


def _ranges(grid: Floats, counts: np.ndarray, window: tuple[float, float]) -> tuple[Floats, Floats]:
    """The middle of every range of one number of roots in a window, and frequencies around short ranges of several.

    Those may lie beside the range of the exact equations.
    """
    runs = np.split(np.arange(grid.size), np.flatnonzero(np.diff(counts)) + 1)
    step = grid[1] - grid[0]
    short = [run for run in runs if counts[run[0]] >= 3 and len(run) <= _SHORT_RANGE]
    around = [np.linspace(grid[run[0]] - 2 * step, grid[run[-1]] + 2 * step, _AROUND) for run in short]
    middles = np.array([grid[run[len(run) // 2]] for run in runs])
    inside = [part[(part >= window[0]) & (part <= window[1])] for part in (middles, np.concatenate([[], *around]))]
    return inside[0], inside[1]


def _starts_of_several(search: Search, spread: Floats, points: int) -> Starts:
    """Frequencies spread over the window, and one of every range in which the number of solutions is the same."""
    grid = np.linspace(search.lo, search.hi, points)
    found = [search.seeder.solutions(float(W)) for W in grid]
    counts = np.array([len(at.harmonics) for at in found])
    middles, short = _ranges(grid, counts, (search.lo, search.hi))
    extremes = [extreme for w in range(1, points - 1) for extreme in _extremes_at(grid, found, w)]
    return Starts(np.unique(np.concatenate([spread, middles, short])), np.empty(0), extremes)


def _extremes_at(grid: Floats, found: list[Solutions], w: int) -> list[Extreme]:
    """Turns of the force at one frequency that are beyond those beside it."""
    motions, sizes, signs = found[w].turns
    beaten = np.zeros(sizes.size, bool)
    for others, other_sizes, other_signs in (found[w - 1].turns, found[w + 1].turns):
        apart = np.linalg.norm(np.abs(motions)[:, None] - np.abs(others)[None], axis=2)
        near = (apart < _NEXT * np.linalg.norm(motions, axis=1)[:, None]) & (signs[:, None] == other_signs[None])
        beaten |= np.any(near & ((signs * sizes)[:, None] > signs[:, None] * other_sizes[None]), axis=1)
    extremes = []
    for u, sign in zip(motions[~beaten], signs[~beaten], strict=True):
        largest = u[np.argmax(np.abs(u))]
        extremes.append(Extreme(float(grid[w]), {1: u * abs(largest) / largest}, int(sign), True))
    return extremes


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
