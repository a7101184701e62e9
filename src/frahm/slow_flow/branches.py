"""The complete response curve of the slow flow: every root, joined into branches at proven saddle-nodes."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.compiled import kernel
from frahm.errors import ConvergenceError
from frahm.polynomials import growth_rate
from frahm.slow_flow.folds import saddle_nodes
from frahm.slow_flow.kernels import characteristic, equilibria, hurwitz, linear_parts, pipe_amplitude
from frahm.slow_flow.model import SlowFlow
from frahm.slow_flow.subdivision import hopf_points

_MOST_POINTS = 256


@dataclass(frozen=True)
class LocatedPoint:
    """A saddle-node or Hopf point of the slow flow.

    Attributes
    ----------
    kind : str
        "saddle-node" or "hopf".
    frequency : float
        Omega [rad/s].
    n : float
        3/4 kappa |Z|^2 [1/s^2].
    pipe_per_relative, growth_rate : float
        |X|/|Z| [-] and largest growth rate [1/s] there.
    proven : bool
        Whether the point was proven to exist and to be the only one in its box.
    """

    kind: str
    frequency: float
    n: float
    pipe_per_relative: float
    growth_rate: float
    proven: bool


@dataclass(frozen=True)
class SlowBranches:
    """Points of all branches in order along each branch; see `slow_branches`."""

    frequency: Floats
    pipe_amplitude: Floats
    relative_amplitude: Floats
    growth_rate: Floats
    stable: np.ndarray
    branch: np.ndarray
    piece: np.ndarray
    detached: tuple[bool, ...]
    points: tuple[LocatedPoint, ...]
    point_branch: tuple[int, ...]
    unverified: tuple[str, ...]


@kernel
def _evaluate(form, omega, xi1, xi2, k1, rho2, F, kappa, W, N, X, growth):
    """All roots |Z|^2, |X| and growth rates at the frequencies W, shapes (points, 3)."""
    for i in range(W.size):
        d2, d1, d0, s1, s0, e, g2 = linear_parts(form, W[i], omega, xi1, xi2, k1, rho2)
        count, N1, N2, N3 = equilibria(d0, s0, e, F, kappa)
        N[i, 0], N[i, 1], N[i, 2] = N1, N2, N3
        for j in range(3):
            if j >= count:
                X[i, j] = math.nan
                growth[i, j] = math.nan
                continue
            n = 0.75 * kappa * N[i, j]
            c1, c2, c3, c4 = characteristic(d2, d1, d0, s1, s0, n)
            X[i, j] = pipe_amplitude(N[i, j], n, e, g2)
            growth[i, j] = growth_rate(c1, c2, c3, c4)


@kernel
def _on_curve(form, omega, xi1, xi2, k1, rho2, W, n):
    """delta_3, |X|/|Z| and growth rate at a point of the response curve given by Omega and n."""
    d2, d1, d0, s1, s0, e, g2 = linear_parts(form, W, omega, xi1, xi2, k1, rho2)
    c1, c2, c3, c4 = characteristic(d2, d1, d0, s1, s0, n)
    return c3, pipe_amplitude(1.0, n, e, g2), growth_rate(c1, c2, c3, c4)


def locate_points(slow: SlowFlow, kind: str, lo: float, hi: float) -> list[LocatedPoint]:
    """All saddle-node or Hopf points with Omega in [lo, hi], ascending in Omega [rad/s]."""
    out = np.empty((_MOST_POINTS, 3))
    search = {"saddle-node": saddle_nodes, "hopf": hopf_points}[kind]
    found = search(slow.code, *slow.host, slow.force, slow.kappa, lo, hi, out)
    if found < 0:
        raise ConvergenceError(
            f"The {kind} points could not all be separated within the work a search is given: there are too many of"
            " them, or they nearly coincide."
        )
    points = []
    for W, n, undecided in out[:found][np.argsort(out[:found, 0])]:
        third, ratio, growth = _on_curve(slow.code, *slow.host, W, n)
        real_pair = kind == "hopf" and third <= 0  # +-lambda also makes the determinant vanish: delta_3 < 0 tells
        if not real_pair and not (undecided and kind == "hopf" and _only_touches(slow, W, n)):
            points.append(LocatedPoint(kind, float(W), float(n), ratio, growth, not undecided))
    return points


def _only_touches(slow: SlowFlow, W: float, n: float) -> bool:
    """Whether the Hurwitz determinant has one sign on both sides: neutral for a moment, but nothing is lost."""
    signs = []
    for beside in (W * (1 - 1e-6), W * (1 + 1e-6)):
        d2, d1, d0, s1, s0, e, _ = linear_parts(slow.code, beside, *slow.host)
        count, *roots = equilibria(d0, s0, e, slow.force, slow.kappa)
        near = min((0.75 * slow.kappa * N for N in roots[:count]), key=lambda value: abs(value - n))
        signs.append(hurwitz(*characteristic(d2, d1, d0, s1, s0, near)) > 0)
    return signs[0] == signs[1]


def slow_branches(slow: SlowFlow, lo: float, hi: float, points: int) -> SlowBranches:
    """Every branch of the slow flow's response over Omega in [lo, hi] [rad/s].

    Saddle-nodes cut the axis into intervals on which the number of roots is constant; at a saddle-node two of the
    three roots meet. Following these joints gives the branches, closed ones included. Where three roots reach the
    window's edge, saddle-nodes outside decide which of them belong together.
    """
    folds, hopfs, unverified = [], [], []
    try:
        folds = locate_points(slow, "saddle-node", lo, hi)
        hopfs = locate_points(slow, "hopf", lo, hi)
    except ConvergenceError as failure:
        unverified.append(str(failure))
    graph = _Graph(slow, lo, hi, folds)
    grid = np.unique(np.concatenate([np.linspace(lo, hi, points), [p.frequency for p in folds + hopfs]]))
    N, X, growth = (np.empty((grid.size, 3)) for _ in range(3))
    _evaluate(slow.code, *slow.host, slow.force, slow.kappa, grid, N, X, growth)
    return _collect(slow, graph, _Roots(grid, N, X, growth), folds + hopfs, tuple(unverified))


@dataclass(frozen=True)
class _Roots:
    """All roots on the grid: frequencies (points,), |Z|^2, |X| and growth rate (points, 3)."""

    grid: Floats
    N: Floats
    X: Floats
    growth: Floats


class _Graph:
    """Intervals between saddle-nodes, their roots as nodes, and how the roots are joined."""

    def __init__(self, slow: SlowFlow, lo: float, hi: float, folds: list[LocatedPoint]):
        self.lo, self.hi = lo, hi
        self.folds = sorted(self._outer(slow, lo, hi, folds) + folds, key=lambda p: p.frequency)
        cuts = [(p.frequency, p) for p in self.folds] + [(lo, None), (hi, None)]
        self.cuts = sorted(cuts, key=lambda c: c[0])
        self.folds_at = {k: fold for k, (_, fold) in enumerate(self.cuts) if fold is not None}
        edges = [c[0] for c in self.cuts]
        ends = [min(slow.limits[0], edges[0] * 0.99), *edges, max(slow.limits[1], edges[-1] * 1.01)]
        self.intervals = list(itertools.pairwise(ends))
        self.counts = [_roots_at(slow, 0.5 * (a + b)).size for a, b in self.intervals]
        self.joints: dict[tuple[int, int, int], tuple[int, int, int]] = {}
        for k, (W, fold) in enumerate(self.cuts):
            self._join(slow, k, W, fold)
        self.components = self._walk()

    @staticmethod
    def _outer(slow: SlowFlow, lo: float, hi: float, folds: list[LocatedPoint]) -> list[LocatedPoint]:
        """Saddle-nodes outside the window, searched only where three roots reach an edge."""
        low, high = slow.limits
        outer = []
        if low < lo and _roots_at(slow, lo).size > 1:
            outer += [p for p in locate_points(slow, "saddle-node", low, lo) if p.frequency < lo]
        if high > hi and _roots_at(slow, hi).size > 1:
            outer += [p for p in locate_points(slow, "saddle-node", hi, high) if p.frequency > hi]
        return outer

    def _join(self, slow: SlowFlow, k: int, W: float, fold: LocatedPoint | None) -> None:
        """Join the roots of interval k (right ends) with those of interval k + 1 (left ends)."""
        left, right = list(range(self.counts[k])), list(range(self.counts[k + 1]))
        if fold is not None and len(left) != len(right):
            side, many = (k, left) if len(left) > len(right) else (k + 1, right)
            N = fold.n / (0.75 * slow.kappa)
            a, b = self._nearest(slow, self.intervals[side], W, N, len(many))
            end = 1 if side == k else 0
            self.joints[side, a, end] = (side, b, end)
            self.joints[side, b, end] = (side, a, end)
            many.remove(a)
            many.remove(b)
        for i, j in zip(left, right, strict=False):
            self.joints[k, i, 1] = (k + 1, j, 0)
            self.joints[k + 1, j, 0] = (k, i, 1)

    @staticmethod
    def _nearest(slow: SlowFlow, interval: tuple[float, float], W: float, N: float, count: int) -> tuple[int, int]:
        """The two neighbouring roots that meet in |Z|^2 = N at W, judged close to W inside the interval."""
        far = interval[0] if abs(interval[0] - W) > abs(interval[1] - W) else interval[1]
        roots = _roots_at(slow, W + 1e-3 * (far - W))
        if roots.size != count:
            roots = _roots_at(slow, 0.5 * (W + far))
        low = int(np.argmin([abs(roots[i] - N) + abs(roots[i + 1] - N) for i in range(count - 1)]))
        return low, low + 1

    def _walk(self) -> list[list[tuple[int, int, int]]]:
        """Components as lists of (interval, root, end entered at), the one with the lowest response at `lo` first."""
        first = next(k for k, (a, b) in enumerate(self.intervals) if a >= self.lo)
        nodes = [(k, i) for k, count in enumerate(self.counts) for i in range(count)]
        seen: set[tuple[int, int]] = set()
        components = []
        ends_first = sorted(nodes, key=lambda n: all((*n, end) in self.joints for end in (0, 1)))
        for node in ends_first:
            if node in seen:
                continue
            enter = 0 if (*node, 0) not in self.joints or (*node, 1) in self.joints else 1
            path, current = [], (*node, enter)
            while current[:2] not in seen:
                seen.add(current[:2])
                path.append(current)
                leave = (current[0], current[1], 1 - current[2])
                if leave not in self.joints:
                    break
                current = self.joints[leave]
            components.append(path)
        inside = [c for c in components if any(self._in_window(k) for k, _, _ in c)]
        return sorted(inside, key=lambda c: (not any(step[:2] == (first, 0) for step in c), c[0]))

    def _in_window(self, k: int) -> bool:
        a, b = self.intervals[k]
        return a >= self.lo and b <= self.hi

    def is_main(self, component: list[tuple[int, int, int]]) -> bool:
        """Whether a component reaches the lowest frequency searched on the lowest root there."""
        return any(step[:2] == (0, 0) for step in component)

    def is_inside(self, component: list[tuple[int, int, int]]) -> bool:
        """Whether the whole component lies in the window."""
        return all(self._in_window(k) for k, _, _ in component)

    def is_closed(self, component: list[tuple[int, int, int]]) -> bool:
        """Whether a component comes back to where it began."""
        k, i, enter = component[0]
        return (k, i, enter) in self.joints

    def pieces(self, component: list[tuple[int, int, int]], grid: Floats) -> list[list[tuple[np.ndarray, int, int]]]:
        """Runs of (grid indices, root, fold behind the run or -1) inside the window, in order along the component."""
        pieces: list[list[tuple[np.ndarray, int, int]]] = [[]]
        if not self.is_inside(component) and self.is_closed(component):  # begin outside, so that no run is cut in two
            start = next(j for j, (k, _, _) in enumerate(component) if not self._in_window(k))
            component = component[start:] + component[:start]
        for k, i, enter in component:
            if not self._in_window(k):
                if pieces[-1]:
                    pieces.append([])
                continue
            a, b = self.intervals[k]
            left = a if self._is_edge(k - 1) else np.nextafter(a, b)
            right = b if self._is_edge(k) else np.nextafter(b, a)
            index = np.arange(np.searchsorted(grid, left), np.searchsorted(grid, right, side="right"))
            if enter == 1:
                index = index[::-1]
            joint = self.joints.get((k, i, 1 - enter))
            fold = (k if enter == 0 else k - 1) if joint is not None and joint[0] == k else -1
            pieces[-1].append((index, i, fold))
        return pieces

    def _is_edge(self, cut: int) -> bool:
        return 0 <= cut < len(self.cuts) and self.cuts[cut][1] is None


def _roots_at(slow: SlowFlow, W: float) -> Floats:
    """|Z|^2 of all equilibria at one frequency, ascending."""
    _, _, d0, _, s0, e, _ = linear_parts(slow.code, W, *slow.host)
    count, *roots = equilibria(d0, s0, e, slow.force, slow.kappa)
    return np.array(roots[:count])


def _collect(
    slow: SlowFlow, graph: _Graph, roots: _Roots, points: list[LocatedPoint], unverified: tuple[str, ...]
) -> SlowBranches:
    """Concatenate the roots in the order of the branches and say on which branch each special point lies."""
    columns: list[tuple[Floats, Floats, Floats, Floats]] = []
    labels: list[tuple[int, int, int]] = []
    owner: dict[int, int] = {}
    for number, component in enumerate(graph.components):
        for k, steps in enumerate(piece for piece in graph.pieces(component, roots.grid) if piece):
            before = len(columns)
            if graph.is_closed(component) and graph.is_inside(component):
                columns.append(_fold_column(slow.kappa, graph.folds_at[steps[-1][2]]))
            for index, root, fold in steps:
                columns.append(
                    (roots.grid[index], roots.N[index, root], roots.X[index, root], roots.growth[index, root])
                )
                if fold >= 0:
                    owner[id(graph.folds_at[fold])] = number
                    columns.append(_fold_column(slow.kappa, graph.folds_at[fold]))
            labels.append((number, k, sum(c[0].size for c in columns[before:])))
    frequency, N, X, growth = (np.concatenate(parts) for parts in zip(*columns, strict=True))
    lengths = [length for _, _, length in labels]
    branch = np.repeat([number for number, _, _ in labels], lengths)
    relative = np.sqrt(N)
    known = np.isfinite(N)
    for point in points:
        if id(point) not in owner:
            amplitude = math.sqrt(point.n / (0.75 * slow.kappa))
            distance = np.abs(frequency - point.frequency) / slow.omega + np.abs(relative - amplitude) / amplitude
            owner[id(point)] = int(branch[np.nanargmin(distance)])
    return SlowBranches(
        frequency=frequency[known],
        pipe_amplitude=X[known],
        relative_amplitude=relative[known],
        growth_rate=growth[known],
        stable=growth[known] < 0,
        branch=branch[known],
        piece=np.repeat([k for _, k, _ in labels], lengths)[known],
        detached=tuple(not graph.is_main(component) for component in graph.components),
        points=tuple(points),
        point_branch=tuple(owner[id(point)] for point in points),
        unverified=unverified,
    )


def _fold_column(kappa: float, fold: LocatedPoint) -> tuple[Floats, Floats, Floats, Floats]:
    """The fold itself as one point of its branch."""
    N = fold.n / (0.75 * kappa)
    values = (fold.frequency, N, fold.pipe_per_relative * math.sqrt(N), fold.growth_rate)
    return tuple(np.array([value]) for value in values)  # type: ignore[return-value]
