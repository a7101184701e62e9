"""Exact responses at one frequency, continued from all solutions of the equations of one harmonic there.

Each of these is a start for Newton's method with more harmonics. From every response found, and from every extreme of
the force of one harmonic that just misses the force given, the curve over the force is followed (`over_force`): higher
harmonics move its turns, and the pairs of responses that they make or unmake. Where the symmetry is lost on the way,
the curve of asymmetric responses is followed, too.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.kernels import fourier_tables, residual_and_jacobian, sample_count
from frahm.harmonic_balance.over_force import even_block, follow_over_force
from frahm.harmonic_balance.search import Search
from frahm.harmonic_balance.seeds import Seed
from frahm.harmonic_balance.shared_drive import Solutions
from frahm.harmonic_balance.starts import solve_seed

_SAME = 1e-6  # relative distance of two solutions that are one
_HARMONICS = 7  # with which curves over the force are followed
_FORCES = (0.2, 5.0)  # of the force: how far
_LONGEST = 0.1  # step, in units of the largest amplitude and of the force
_MOST_STEPS = 400
_ROOM = 64  # responses on one curve
_PUSHES = (0.05, 0.02, 0.1)  # off the symmetric response, in units of the largest amplitude, tried in this order
_ASYMMETRIC = 1e-3  # even part, relative, below which a response is a symmetric one

Solution = tuple[Floats, int]


@dataclass
class _Continued:
    """Solutions found so far at one frequency, symmetric and asymmetric ones (one of each mirrored pair)."""

    search: Search
    W: float
    scale: float
    symmetric: list[Solution] = field(default_factory=list)
    asymmetric: list[Solution] = field(default_factory=list)
    breaks: list[Floats] = field(default_factory=list)  # points (X / scale, lambda) where the symmetry is lost

    def follow(self, odd: bool, y: Floats, normal: Floats, side: float) -> tuple[set[int], bool]:
        """Add the solutions on a curve over the force; returns which of all these it passes, and whether it ended."""
        out, breaks = np.empty((_ROOM, y.size - 1)), np.empty((_ROOM if odd else 0, y.size))
        count, broken, ended = follow_over_force(
            self.search.problem, odd, _HARMONICS, self.W, y, normal, *_FORCES, side, self.scale, _LONGEST, _MOST_STEPS,
            out, breaks,
        )  # fmt: skip
        self.breaks += [
            one for one in breaks[:broken] if not any(np.linalg.norm(one - o) < _LONGEST for o in self.breaks)
        ]
        return {self.add(odd, self._seed(odd, X)) for X in out[:count]}, bool(ended)

    def add(self, odd: bool, seed: Seed) -> int:
        """Add what Newton's method makes of a start; returns its place in the list, -1 if it is nothing."""
        solution, found = solve_seed(self.search, seed, odd), self.symmetric if odd else self.asymmetric
        if solution is None or (not odd and np.linalg.norm(self._even(*solution)) < _ASYMMETRIC * self.scale):
            return -1
        mirrored = [solution] if odd else [solution, self._mirrored(*solution)]
        for i, other in enumerate(found):
            if any(self._same(odd, one, other) for one in mirrored):
                return i
        found.append(solution)
        return len(found) - 1

    def within(self, odd: bool, X: Floats, H: int, n: int) -> Floats:
        """The unknowns of a solution in a vector of n."""
        own, full = min(n, int(unknowns(self.search.problem, H, odd))), np.zeros(n)
        full[:own] = X[:own]
        return full

    def _seed(self, odd: bool, X: Floats) -> Seed:
        u = X.reshape(-1, self.search.problem.M11.shape[0], 2) @ np.array([1, 1j])
        return Seed(self.W, {(2 * m + 1 if odd else m): row for m, row in enumerate(u)})

    def _same(self, odd: bool, one: Solution, other: Solution) -> bool:
        n = unknowns(self.search.problem, max(one[1], other[1]), odd)
        a, b = (self.within(odd, *solution, n) for solution in (one, other))
        return bool(np.linalg.norm(a - b) < _SAME * np.linalg.norm(a))

    def _even(self, X: Floats, H: int) -> Floats:
        n, width = unknowns(self.search.problem, H, False), 2 * self.search.problem.M11.shape[0]
        return X[:n].reshape(-1, width)[::2].ravel()

    def _mirrored(self, X: Floats, H: int) -> Solution:
        other, n = X.copy(), unknowns(self.search.problem, H, False)
        other[:n].reshape(-1, 2 * self.search.problem.M11.shape[0])[::2] *= -1
        return other, H


def continued(search: Search, W: float) -> tuple[list[Solution], list[Solution]] | None:
    """Exact symmetric solutions at Omega = W [rad/s], and asymmetric ones, one of each mirrored pair.

    None where not all solutions of one harmonic are known.
    """
    if search.seeder.shared is None or search.seeder.buckled or search.harmonics is not None:
        return None
    known = search.seeder.solutions(W)
    if not known.complete:
        return None
    found = _Continued(search, W, float(np.max(np.abs(known.harmonics))))
    for u in known.harmonics:
        found.add(True, Seed(W, {1: u}))
    _follow_beside_misses(found, known)
    _follow_from_solutions(found)
    _follow_asymmetric(found)
    return found.symmetric, found.asymmetric


def _follow_from_solutions(found: _Continued) -> None:
    """Follow the curve of every solution on both sides, those that are added on the way, too."""
    n = unknowns(found.search.problem, _HARMONICS, True)
    passed: set[int] = set()
    for i, (X, H) in enumerate(found.symmetric):
        y = np.append(found.within(True, X, H, n) / found.scale, 1.0)
        for side in (-1.0, 1.0) if i not in passed else ():
            passed |= found.follow(True, y, np.eye(n + 1)[n], side)[0]


def _follow_beside_misses(found: _Continued, known: Solutions) -> None:
    """Follow the curves over the force that, with one harmonic, turn just before they come to the force given."""
    pb, n, width = found.search.problem, unknowns(found.search.problem, _HARMONICS, True), known.harmonics.shape[1]
    tables = fourier_tables(_HARMONICS, True, sample_count(pb, _HARMONICS, True))
    R, J = np.empty(n + 1), np.empty((n + 1, n + 1))
    for u, size, sign in zip(*known.turns, strict=True):
        if sign * size < 0:
            continue
        X = np.zeros(n)
        X[: 2 * width] = np.column_stack([u.real, u.imag]).ravel()
        residual_and_jacobian(pb, _HARMONICS, True, found.W, X, *tables, R, J)
        y = np.append(X / found.scale, np.exp(0.5 * size))
        for side in (-1.0, 1.0):
            found.follow(True, y, np.append(_null(J[:n, :n]), 0.0), side)


def _follow_asymmetric(found: _Continued) -> None:
    """Follow the curves of asymmetric responses over the force from where symmetric ones lose their symmetry."""
    pb = found.search.problem
    m, width = unknowns(pb, _HARMONICS, False), 2 * pb.M11.shape[0]
    tables = fourier_tables(_HARMONICS, False, sample_count(pb, _HARMONICS, False))
    full, R, J, even = np.zeros(m + 1), np.empty(m + 1), np.empty((m + 1, m + 1)), np.empty((m // 2, m // 2))
    for point in found.breaks:
        even_block(pb, _HARMONICS, found.W, point[:-1] * found.scale, tables, full, R, J, even)
        normal = np.zeros((m // width, width))
        normal[::2] = _null(even).reshape(-1, width)
        normal = np.append(normal.ravel(), 0.0)
        for push in _PUSHES:
            y = np.append(full[:-1] / found.scale, point[-1]) + push * normal
            sides = [found.follow(False, y, normal, side) for side in (1.0, -1.0)]
            if any(ended for _, ended in sides):
                break


def _null(A: Floats) -> Floats:
    """Unit vector that a nearly singular matrix maps to nearly nothing."""
    return np.asarray(np.linalg.svd(A)[2][-1])
