"""How many first-harmonic roots there are over a window of frequencies, and where more of them nearly appear.

Branches start from these roots, so a detached curve is met only where a frequency inside its range is looked at. With
one cubic spring the number of roots is known in closed form. With any other law it is counted here on
a dense grid of amplitudes: |S + N(a)| a passes |F| once for every root, and comes near where two are about to appear.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.arrays import Complexes, Floats
from frahm.compiled import kernel
from frahm.harmonic_balance.condensation import Problem
from frahm.harmonic_balance.describing import PER_DECADE, Table, friction_stiffness

_LOWEST, _HIGHEST = 0.3, 1.2  # amplitudes looked at, in the smallest linear and the largest damped response
_MOST_DECADES = 14
_FRICTION_POINTS = 400


@kernel
def _counted(S, F, a, N, before, after, counts, excess):
    """Fill counts and excess (W,) from S and |F| (W,), amplitudes a (rows,), N (W or 1, rows), neighbours (rows,)."""
    for w in range(S.size):
        M = N[min(w, N.shape[0] - 1)]
        counts[w], excess[w] = 0, -math.inf
        for i in range(a.size):
            here = abs(S[w] + M[i]) * a[i] - F[w]
            j, k = after[i], before[i]
            there = abs(S[w] + M[j]) * a[j] - F[w] if j >= 0 else here
            back = abs(S[w] + M[k]) * a[k] - F[w] if k >= 0 else here
            if here * there < 0.0 or (here == 0.0 and j >= 0):
                counts[w] += 1
            inner = j >= 0 and k >= 0 and here * there > 0.0 and here * back > 0.0
            if inner and abs(here) <= abs(there) and abs(here) <= abs(back):
                excess[w] = max(excess[w], -abs(here) / F[w])


def table_counts(pb: Problem, table: Table, W: Floats, S: Complexes, F: Complexes) -> tuple[np.ndarray, Floats]:
    """Number of roots along the curves of a table at frequencies W (w,), and how nearly more appear (at most 0).

    S and F (w,) are stiffness and force at the first harmonic.
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


def _counts(
    S: Complexes, F: Complexes, a: Floats, N: Complexes, before: np.ndarray, after: np.ndarray
) -> tuple[np.ndarray, Floats]:
    counts, excess = np.empty(S.size, np.int64), np.empty(S.size)
    _counted(S, np.abs(F), a, N, before, after, counts, excess)
    return counts, excess
