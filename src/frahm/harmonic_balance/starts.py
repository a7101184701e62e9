"""At which frequencies branches are looked for, and how a start becomes a solution."""

from __future__ import annotations

import math

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.newton import solve_at
from frahm.harmonic_balance.root_counts import polynomial_counts, table_counts
from frahm.harmonic_balance.search import Search
from frahm.harmonic_balance.seeds import Seed, count_cubic, stiffness_at

_WORST = 0.05  # truncation with stops or friction beyond which a solution of the harmonics is none of the equations
_SEED_FREQUENCIES = 17
_GRID = 401
_SHARED_GRID = 161  # where one frequency takes several cubics: a detached curve of a smaller range can be missed
_BAND = 0.65  # ln(hi/lo) of the widest window these numbers of frequencies are for: wider ones take more of them
_SHORT_RANGE, _AROUND = 16, 9  # points of the grid in a short range of three roots; frequencies looked at around it


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
    if seeder.shared is not None:
        return _where_solutions_change(search, spread, math.ceil(_SHARED_GRID * bands)), np.empty(0), np.empty(0)
    if pb.directions.shape[0] != 1 or (e is None and table is None):
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


def _where_solutions_change(search: Search, spread: Floats, points: int) -> Floats:
    """Frequencies spread over the window, and one of every range in which the number of solutions is the same."""
    grid = np.linspace(search.lo, search.hi, points)
    counts = np.array([len(search.seeder.at(float(W), search.x_scale)) for W in grid])
    runs = np.split(grid, np.flatnonzero(np.diff(counts)) + 1)
    return np.unique(np.concatenate([spread, [run[len(run) // 2] for run in runs]]))


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
