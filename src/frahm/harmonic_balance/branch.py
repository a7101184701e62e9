"""A branch of solutions: its points, and the bifurcations on it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import CondensedSystem, unknowns
from frahm.harmonic_balance.orbits import between, describe, multipliers_along, same_harmonics
from frahm.harmonic_balance.search import Search


@dataclass(frozen=True, eq=False)
class Point:
    """One point of a branch: y = (X, Omega), its scaled unit tangent t, and the number of harmonics H.

    y and t have the length of a stored point; what lies beyond their unknowns is zero.
    """

    y: Floats
    t: Floats
    H: int

    def with_harmonics(self, pb: CondensedSystem, odd: bool, H: int) -> Point:
        """The point and its tangent with another number of harmonics."""
        y, t = np.zeros_like(self.y), np.zeros_like(self.t)
        same_harmonics(pb, odd, self.y, self.t, self.H, H, y, t)
        return Point(y, t, H)

    def with_unknowns(self, pb: CondensedSystem, odd: bool, n: int) -> Floats:
        """X with n unknowns, cut off or filled with zeros, and Omega (n + 1,)."""
        own = unknowns(pb, self.H, odd)
        y = np.zeros(n + 1)
        y[: min(n, own)], y[n] = self.y[: min(n, own)], self.y[own]
        return y


@dataclass(frozen=True, eq=False)
class Points:
    """Points in order along a branch, one a row, and what they mean.

    columns are Omega, |X1|, |Z1|, max |x|, max |z|, and multipliers those of the (half) map, by descending modulus; of
    points that were followed and not yet described all but Omega is zero, and there are no multipliers.
    """

    ys: Floats
    ts: Floats
    Hs: np.ndarray
    truncations: Floats
    columns: Floats
    multipliers: np.ndarray

    def __len__(self) -> int:
        return len(self.Hs)

    def __getitem__(self, i: int) -> Point:
        return Point(self.ys[i], self.ts[i], int(self.Hs[i]))

    @property
    def frequency(self) -> Floats:
        """Omega at every point [rad/s]."""
        return self.columns[:, 0]

    @property
    def pieces(self) -> np.ndarray:
        """Number of the piece inside the window every point belongs to."""
        same = self.frequency[:-1] == self.frequency[1:]
        return np.concatenate([[0], np.cumsum(same)]).astype(int)

    def rise(self, pb: CondensedSystem, odd: bool) -> Floats:
        """dOmega/ds at every point, in scaled unknowns; it changes its sign at a fold."""
        return np.asarray(self.ts[np.arange(len(self)), unknowns(pb, self.Hs, odd)])

    def take(self, rows: np.ndarray) -> Points:
        """The points of these rows, in this order."""
        return Points(*(part[rows] for part in self._parts))

    def insert(self, at: Sequence[int] | np.ndarray, new: Points) -> Points:
        """Every new point put before the row of its number."""
        return Points(*(np.insert(a, at, b, axis=0) for a, b in zip(self._parts, new._parts, strict=True)))

    @property
    def _parts(self) -> tuple[np.ndarray, ...]:
        return self.ys, self.ts, self.Hs, self.truncations, self.columns, self.multipliers


def undescribed(search: Search, odd: bool, ys: Floats, ts: Floats, Hs: np.ndarray, truncations: Floats) -> Points:
    """Points as they are followed; ys and ts are (points, size)."""
    columns = np.zeros((len(Hs), 5))
    columns[:, 0] = ys[np.arange(len(Hs)), unknowns(search.problem, Hs, odd)]
    return Points(ys, ts, Hs, truncations, columns, np.zeros((len(Hs), 0)))


def points_of(search: Search, odd: bool, points: Sequence[Point], truncations: Floats) -> Points:
    """Single points in a row, not described."""
    ys, ts = np.array([point.y for point in points]), np.array([point.t for point in points])
    return undescribed(search, odd, ys, ts, np.array([point.H for point in points]), truncations)


def described(search: Search, odd: bool, points: Points) -> Points:
    """Points with their columns and multipliers."""
    columns = np.empty((len(points), 5))
    multipliers = np.empty((len(points), 2 * search.variation.K.shape[0]), complex)
    describe(search.problem, search.variation, odd, points.ys, points.Hs, columns, multipliers)
    return replace(points, columns=columns, multipliers=multipliers)


def with_multipliers(search: Search, points: Points) -> Points:
    """Points of motions of odd harmonics with the multipliers of the half map alone."""
    multipliers = np.empty((len(points), 2 * search.variation.K.shape[0]), complex)
    multipliers_along(search.problem, search.variation, True, points.ys, points.Hs, multipliers)
    return replace(points, multipliers=multipliers)


def point_between(search: Search, odd: bool, a: Point, b: Point, fraction: float = 0.5) -> Point | None:
    """Point of a branch between two others, in the plane across their chord; None if Newton's method fails."""
    pb, H = search.problem, max(a.H, b.H)
    a, b = a.with_harmonics(pb, odd, H), b.with_harmonics(pb, odd, H)
    y, t = np.zeros(search.size(odd)), np.zeros(search.size(odd))
    ok = between(pb, odd, a.y, a.t, b.y, b.t, H, fraction, search.x_scale, search.w_scale, y, t)
    return Point(y, t, H) if ok else None


@dataclass(frozen=True, eq=False)
class Bifurcation:
    """A bifurcation on a branch: kind, columns, half-width of the interval that holds it [rad/s], and its point.

    It was seen, but not located, where it has no point.
    """

    kind: str
    columns: Floats
    half_width: float
    point: Point | None

    @property
    def located(self) -> bool:
        """Whether its point is known."""
        return self.point is not None


@dataclass
class SolutionBranch:
    """One branch as it was followed, with the bifurcations on it and the branches it is connected to.

    outside are branch points beyond the window, from where an asymmetric branch may come into it; parent is the branch
    it bifurcates from, and crossed are those it has a point in common with.
    """

    odd: bool
    points: Points
    closed: bool
    endings: tuple[int, ...]
    bifurcations: list[Bifurcation] = field(default_factory=list)
    outside: list[Bifurcation] = field(default_factory=list)
    parent: SolutionBranch | None = None
    crossed: list[SolutionBranch] = field(default_factory=list)


def located(bifurcations: Iterable[Bifurcation], kind: str) -> list[tuple[Bifurcation, Point]]:
    """Bifurcations of a kind whose points are known, and these."""
    return [(one, one.point) for one in bifurcations if one.kind == kind and one.point is not None]


def connected(branches: list[SolutionBranch]) -> list[SolutionBranch]:
    """Branches that hang together with the first one, directly or through others."""
    found: list[SolutionBranch] = []
    waiting = branches[:1]
    while waiting:
        branch = waiting.pop()
        if any(branch is other for other in found):
            continue
        found.append(branch)
        waiting += [other for other in branches if other.parent is branch or other is branch.parent]
        waiting += branch.crossed
    return found
