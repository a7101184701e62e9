"""How many first-harmonic roots there are over a window of frequencies, and where more of them are about to appear.

Branches start from these roots, so a detached curve is met only where a frequency inside its range is looked at. With
one cubic spring the number of roots is known in closed form. With any other law it is counted here on a dense grid of
amplitudes: |S + N(a)| a passes |F| once for every root. The force lambda F that a first harmonic a needs,
lambda = |S + N(a)| a/|F|, turns where two roots appear or vanish; where it is extreme over frequency, too, a detached
curve is born, see `births`.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.arrays import Complexes, Floats
from frahm.compiled import kernel
from frahm.harmonic_balance.condensation import CondensedSystem
from frahm.harmonic_balance.describing import PER_DECADE, AmplitudeTable, friction_stiffness

_LOWEST, _HIGHEST = 0.3, 1.2  # amplitudes looked at, in the smallest linear and the largest damped response
_MOST_DECADES = 14
_FRICTION_POINTS = 400
_NEXT = 0.3  # of ln a: how far the turning value moves from one frequency to the next
_LOOK = 0.7  # |ln lambda^2| of a first-harmonic extreme up to which the exact one may lie beyond 1


@kernel
def _counted(S, F, a, N, before, after, counts, turns):
    """Fill counts (W,) and turns (rows, 5) with the number of a frequency, ln a, ln lambda^2, sign and row.

    S, |F| (W,), amplitudes a (rows,), N (W or 1, rows), neighbours (rows,). The sign is +1 where lambda is smallest.
    Returns how many turns there are.
    """
    found = 0
    for w in range(S.size):
        M = N[min(w, N.shape[0] - 1)]
        counts[w] = 0
        for i in range(a.size):
            here = abs(S[w] + M[i]) * a[i]
            j, k = after[i], before[i]
            there = abs(S[w] + M[j]) * a[j] if j >= 0 else here
            if (here - F[w]) * (there - F[w]) < 0.0 or (here == F[w] and j >= 0):
                counts[w] += 1
            if j < 0 or k < 0 or found == turns.shape[0]:
                continue
            back = abs(S[w] + M[k]) * a[k]
            if (here - there) * (here - back) > 0.0 or (here == there and here != back):
                rise, bend = 0.5 * (there - back), there - 2.0 * here + back
                shift = -rise / bend
                turns[found, 0], turns[found, 1] = w, math.log(a[i]) + shift * 0.5 * math.log(a[j] / a[k])
                turns[found, 2] = 2.0 * math.log((here + 0.5 * rise * shift) / F[w])
                turns[found, 3], turns[found, 4] = math.copysign(1.0, bend), i
                found += 1
    return found


def table_counts(
    pb: CondensedSystem, table: AmplitudeTable, W: Floats, S: Complexes, F: Complexes
) -> tuple[np.ndarray, Floats]:
    """Number of roots along the curves of a table at frequencies W (w,), and the turns of lambda (t, 5).

    S and F (w,) are stiffness and force at the first harmonic. A turn is the number of the frequency, ln a,
    ln lambda^2, +1 for a minimum or -1 for a maximum, and the row of the table.
    """
    before, after = (np.full(table.amplitude.size, -1) for _ in range(2))
    i, j = table.links.T
    after[i], before[j] = j, i
    N: Complexes = table.stiffness[None, :].astype(complex)
    if pb.rates:
        # the stiffness of friction is a function of a W over a: one table serves all frequencies
        speeds = np.geomspace(table.amplitude.min() * W[0], table.amplitude.max() * W[-1], _FRICTION_POINTS)
        unit = np.empty(speeds.size)
        friction_stiffness(pb, speeds, 1.0, unit)
        at = np.log(table.amplitude[None, :] * W[:, None])
        force = np.interp(at, np.log(speeds), unit * speeds)
        N = np.asarray(N + 1j * force / table.amplitude)
    return _counts(S, F, table.amplitude, N, before, after)


def polynomial_counts(e: Floats, S: Complexes, F: Complexes) -> tuple[np.ndarray, Floats]:
    """The same for an odd polynomial with the equivalent stiffness sum_i e_i |Z|^(2 i)."""
    with np.errstate(divide="ignore"):
        low = _LOWEST * float(np.min(np.abs(F) / np.abs(S)))
        damped = np.where(S.imag > 0, np.abs(F) / S.imag, np.inf)
    high = min(_HIGHEST * float(np.max(damped)), low * 10.0**_MOST_DECADES)
    # a hardening spring leaves no larger response than the one at which it alone takes the force
    rows = max(3, math.ceil(PER_DECADE * math.log10(high / low)) + 1)
    a = np.geomspace(low, high, rows)
    N = np.polynomial.polynomial.polyval(a * a, e).astype(complex)[None, :]
    index = np.arange(rows)
    return _counts(S, F, a, N, index - 1, np.where(index + 1 < rows, index + 1, -1))


def cubic_turns(k: float, S: Complexes, F: Complexes) -> Floats:
    """The turns of lambda for one cubic spring with the equivalent stiffness k |Z|^2, in closed form.

    Where nothing damps, lambda is 0 at one of them: that is no birth.
    """
    size, c = np.abs(S), math.copysign(1.0, k) * S.real / np.abs(S)
    w = np.flatnonzero(c < -math.sqrt(0.75))
    turns = []
    for sign in (1, -1):
        N = (-2 * c[w] + sign * np.sqrt(4 * c[w] ** 2 - 3)) / 3 * size[w] / abs(k)
        squared = np.abs(S[w] + k * N) ** 2 * N / np.abs(F[w]) ** 2
        some = squared > 0
        log_a, force, sides = 0.5 * np.log(N[some]), np.log(squared[some]), np.full(np.count_nonzero(some), sign)
        turns.append(np.column_stack([w[some], log_a, force, sides, np.zeros_like(log_a)]))
    return np.concatenate(turns)


def extreme_turns(turns: Floats, last: int) -> Floats:
    """Turns (t, 5) at which lambda is extreme over frequency, too, and near 1; not those at the ends, 0 and `last`."""
    found = []
    for sign in (1.0, -1.0):
        own = turns[(turns[:, 3] == sign) & (np.abs(turns[:, 2]) < 2 * _LOOK)]
        least = _least_beside(own[:, 0], own[:, 1], sign * own[:, 2])
        inside = (own[:, 0] > 0) & (own[:, 0] < last)
        found.append(own[least & inside & (np.abs(own[:, 2]) < _LOOK)])
    return np.concatenate(found)


def _least_beside(index: Floats, log_a: Floats, level: Floats) -> np.ndarray:
    """Which turns have a level no higher than those near in amplitude at the frequencies before and after."""
    order = np.argsort(index, kind="stable")
    least = np.ones(index.size, dtype=bool)
    for side in (-1, 1):
        first, end = (np.searchsorted(index, index + side, where, sorter=order) for where in ("left", "right"))
        for k in range(int(np.max(end - first, initial=0))):
            mine = np.flatnonzero(first + k < end)
            other = order[first[mine] + k]
            near = np.abs(log_a[mine] - log_a[other]) < _NEXT
            least[mine] &= ~near | (level[mine] <= level[other])
    return least


def _counts(
    S: Complexes, F: Complexes, a: Floats, N: Complexes, before: np.ndarray, after: np.ndarray
) -> tuple[np.ndarray, Floats]:
    counts, turns = np.empty(S.size, np.int64), np.empty((20 * S.size, 5))
    found = _counted(S, np.abs(F), a, N, before, after, counts, turns)
    return counts, turns[:found]
