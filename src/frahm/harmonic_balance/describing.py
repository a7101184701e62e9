"""First-harmonic responses of one element, or of parallel ones, with any law, on a dense grid of amplitudes.

With u = m + a cos(tau) the mean of the force depends on m and a only, and so does its first harmonic, but for friction,
whose first harmonic depends on a Omega. So the means m that balance are found once, on a grid of amplitudes a; at a
frequency the first-harmonic balance |S + N| a = |F| is then one equation along each curve m(a), and every change of
sign and every near miss on the grid is a start for Newton's method. Roots closer than the grid can be missed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from frahm.absorbers.packed import law_force
from frahm.arrays import Complexes, Floats
from frahm.compiled import kernel
from frahm.harmonic_balance.condensation import CondensedSystem

PER_DECADE = 100  # amplitudes
_MEANS = 121
_SAMPLES = 32  # over half a period
_LOWEST = 1e-6  # smallest amplitude, in linear responses
_MOST_DECADES = 14
_NEAR = 0.15  # imbalance per force that still counts as a near miss


@dataclass(frozen=True)
class AmplitudeTable:
    """Amplitudes a and means m (rows,) of u that balance the mean force, and the springs' equivalent stiffness N.

    `links` (pairs, 2) joins rows that follow each other on a curve m(a).
    """

    amplitude: Floats
    mean: Floats
    stiffness: Floats
    links: np.ndarray

    def roots(self, pb: CondensedSystem, W: float, S: complex, F: complex) -> list[tuple[complex, complex]]:
        """Mean and first harmonic of u at every first-harmonic solution seen, and at near misses."""
        a = self.amplitude
        N = self.stiffness.astype(complex)
        if pb.rates:
            levels, which = np.unique(a, return_inverse=True)
            rates = np.empty(levels.size)
            friction_stiffness(pb, levels, W, rates)
            N += 1j * rates[which]
        total = S + N
        gap = np.abs(total) * a - abs(F)
        i, j = self.links.T
        crossed = gap[i] * gap[j] <= 0
        i, j = i[crossed], j[crossed]
        share = np.where(gap[i] == gap[j], 0.5, gap[i] / np.where(gap[i] == gap[j], 1.0, gap[i] - gap[j]))
        found = [self._solution(F, *((1 - share) * value[i] + share * value[j] for value in (a, self.mean, total)))]
        near = self._near(gap, abs(F))
        found.append(self._solution(F, a[near], self.mean[near], total[near]))
        return [pair for solutions in found for pair in solutions]

    def _near(self, gap: Floats, force: float) -> np.ndarray:
        """Rows where the imbalance is small, of one sign and smaller than beside them."""
        i, j = self.links.T
        size = np.abs(gap)
        beside, crossed = np.full(gap.size, np.inf), np.zeros(gap.size, bool)
        np.minimum.at(beside, i, size[j])
        np.minimum.at(beside, j, size[i])
        sign = gap[i] * gap[j] <= 0
        np.logical_or.at(crossed, i, sign)
        np.logical_or.at(crossed, j, sign)
        return np.flatnonzero((size < _NEAR * force) & (size <= beside) & ~crossed)

    @staticmethod
    def _solution(F: complex, a: Floats, m: Floats, total: Complexes) -> list[tuple[complex, complex]]:
        turn = F / np.where(total == 0, 1.0, total)
        u = turn / np.where(turn == 0, 1.0, np.abs(turn)) * a
        return list(zip(m.astype(complex).tolist(), u.tolist(), strict=True))


def amplitude_table(
    pb: CondensedSystem, rest: float, linear: Floats, damped: Floats, symmetric: bool
) -> AmplitudeTable | None:
    """Table of one coordinate u for a window of frequencies.

    Parameters
    ----------
    pb : CondensedSystem
    rest : float
        Host's stiffness S at harmonic 0 [N/m].
    linear, damped : ndarray
        |F/S| and |F/Im S| over the window [m]: no response is larger than the latter.
    symmetric : bool
        Whether rows with m = 0 are wanted where the law is odd.

    Returns
    -------
    AmplitudeTable or None
        None if there is no row.
    """
    edge = outer_balances(pb, rest)
    low = _LOWEST * float(np.min(linear))
    high = 1.5 * float(np.max(damped)) if np.all(np.isfinite(damped)) else math.inf
    high = min(high, low * 10.0**_MOST_DECADES)
    if not 0 < low < high:  # below what numbers hold
        return None
    amplitudes = np.geomspace(low, high, max(2, math.ceil(PER_DECADE * math.log10(high / low)) + 1))
    rows = np.empty((amplitudes.size * 12, 3))
    owner = np.empty(amplitudes.size * 12, np.int64)
    count = int(fill_rows(pb, rest, amplitudes, edge, symmetric, rows, owner))
    if count == 0:
        return None
    a, m, N = (np.ascontiguousarray(column) for column in rows[:count].T)
    return AmplitudeTable(a, m, N, _links(owner[:count], a, m))


def _links(owner: np.ndarray, a: Floats, m: Floats) -> np.ndarray:
    """Pairs of rows at neighbouring amplitudes whose means follow each other."""
    starts = np.searchsorted(owner, np.arange(owner[-1] + 2))
    pairs = []
    for k in range(int(owner[0]), int(owner[-1])):
        here, there = np.arange(starts[k], starts[k + 1]), np.arange(starts[k + 1], starts[k + 2])
        if not len(here) or not len(there):
            continue
        for i in here:
            j = there[np.argmin(np.abs(m[there] - m[i]))]
            if abs(m[j] - m[i]) <= 0.2 * (abs(m[i]) + a[i]):
                pairs.append((i, j))
    return np.array(pairs, dtype=int).reshape(-1, 2)


@kernel
def _force(pb, u, v):
    """Force [N] of all elements on the coordinate u at its displacement u [m] and velocity v [m/s]."""
    total = 0.0
    for e in range(pb.codes.shape[0]):
        d = pb.directions[0, e]
        total += d * law_force(pb.codes[e, 0], pb.codes[e, 1], pb.codes[e, 2], pb.table, d * u, d * v)
    return total


@kernel
def _first_harmonics(pb, m, a):
    """Mean of the static force [N] for u = m + a cos tau, and its first harmonic per amplitude [N/m]."""
    mean = first = 0.0
    for j in range(_SAMPLES):
        c = math.cos(math.pi * (j + 0.5) / _SAMPLES)
        g = _force(pb, m + a * c, 0.0)
        mean += g
        first += g * c
    return mean / _SAMPLES, 2.0 * first / (_SAMPLES * a)


@kernel
def friction_stiffness(pb, a, W, out):
    """Imaginary equivalent stiffness [N/m] of what depends on the velocity, for u = a cos(W t)."""
    still = _force(pb, 0.0, 0.0)
    for i in range(a.size):
        total = 0.0
        for j in range(_SAMPLES):
            s = math.sin(math.pi * (j + 0.5) / _SAMPLES)
            total += (_force(pb, 0.0, a[i] * W * s) - still) * s
        out[i] = 2.0 * total / (_SAMPLES * a[i])


@kernel
def outer_balances(pb, rest):
    """Largest |m| at which rest m + g(m) changes its sign, at a well or a top; 0 if there is none.

    Searched between 1 nm and 10 km.
    """
    outermost = 0.0
    for side in (-1.0, 1.0):
        last = 0.0
        for i in range(13 * 64 + 1):
            m = side * 10.0 ** (-9.0 + i / 64.0)
            value = rest * m + _force(pb, m, 0.0)
            if value * last < 0.0:
                outermost = max(outermost, abs(m))
            if value != 0.0:
                last = value
    return outermost


@kernel
def fill_rows(pb, rest, amplitudes, edge, symmetric, rows, owner):
    """Rows (a, m, N) whose mean force rest m + mean g vanishes, ascending in a; returns their number.

    For odd laws m = 0 if wanted and the positive means only.
    """
    count = 0
    for k in range(amplitudes.size):
        a = amplitudes[k]
        if pb.odd and symmetric and count < owner.size:
            rows[count, 0], rows[count, 1], rows[count, 2] = a, 0.0, _first_harmonics(pb, 0.0, a)[1]
            owner[count] = k
            count += 1
        if pb.odd and a > 2.0 * edge:
            continue
        reach = 1.5 * edge + 2.0 * a
        low = 1e-3 * edge if pb.odd else -reach
        before, at = 0.0, low
        for i in range(_MEANS):
            m = low + (reach - low) * i / (_MEANS - 1)
            value = rest * m + _first_harmonics(pb, m, a)[0]
            if i > 0 and value * before <= 0.0 and value != before and count < owner.size:
                root = _balanced(pb, rest, a, at, before, m, value)
                rows[count, 0], rows[count, 1], rows[count, 2] = a, root, _first_harmonics(pb, root, a)[1]
                owner[count] = k
                count += 1
            before, at = value, m
    return count


@kernel
def _balanced(pb, rest, a, m0, f0, m1, f1):
    """Root of the mean force between m0 and m1 by the Illinois method, to what a start needs."""
    m = m1
    for _ in range(12):
        if f1 == f0:
            break
        m = m1 - f1 * (m1 - m0) / (f1 - f0)
        f = rest * m + _first_harmonics(pb, m, a)[0]
        if f == 0.0:
            break
        if f * f1 < 0.0:
            m0, f0 = m1, f1
        else:
            f0 *= 0.5
        m1, f1 = m, f
    return m
