"""What one absorber answers to a motion of the place it hangs at: one or three amplitudes, and its reaction."""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.design.kernels import beyond, extremes, load_slope, squares

# columns of an absorber at one frequency: k, q, d, m Omega^2, motions and |Z|^2 where answers turn, last |Z|^2
K, Q, _REAL, _IMAG, _INERTIA, FIRST, LAST, _UPPER, _LOWER, SQUARE = range(10)
LOW, MID, HIGH = 0, 1, 2  # answers of an absorber, by their size
_NEWTON, _ROUNDING = 8, 1e-11  # steps at most, and what is left of the squared motion


@kernel
def _turning_motions(k, q, d, wm):
    """The least and the largest s with three answers of an absorber, and |Z|^2 where they turn into one another.

    The upper turning point, then the lower one; infinite where there is one answer only.
    """
    if k == 0.0 and q == 0.0:
        return math.inf, math.inf, math.inf, math.inf
    D, R = d.real * d.real + d.imag * d.imag, d.real
    if q > 0.0:
        near = math.sqrt(math.sqrt(D) / q)  # where the part of the fifth power is as stiff as the rest
        most = beyond(k, q, D, R, 1.0, D * near)
        there, low, high = extremes(k, q, D, R, 1.0, most)
        if not there:
            return math.inf, math.inf, math.inf, math.inf
    else:
        c = R / math.sqrt(D)
        if c >= -0.5 * math.sqrt(3.0):
            return math.inf, math.inf, math.inf, math.inf
        spread, size = math.sqrt(4.0 * c * c - 3.0), math.sqrt(D) / k
        low, high = (-2.0 * c - spread) / 3.0 * size, (-2.0 * c + spread) / 3.0 * size
    last = _load_at(low, k, q, D, R)
    first = _load_at(high, k, q, D, R)
    return first / (wm * wm), last / (wm * wm), low, high


@kernel
def _load_at(N, k, q, D, R):
    n = (k + q * N) * N
    return (D + n * (2.0 * R + n)) * N


@kernel
def answer(label, s, near, law):
    """|Z|^2 of an absorber at |u|^2 = s: the smallest, the middle or the largest; where there is one, that.

    Newton's method from what is near by, as long as it stays between the turning points of this answer; the closed form
    where it does not.
    """
    k, q, R, wm = law[K], law[Q], law[_REAL], law[_INERTIA]
    D, goal = R * R + law[_IMAG] * law[_IMAG], wm * wm * s
    if k == 0.0 and q == 0.0:
        return goal / D
    N = near
    for _ in range(_NEWTON):
        slope = load_slope(N, k, q, D, R, 1.0)
        if not N > 0.0 or slope == 0.0:
            break
        excess = _load_at(N, k, q, D, R) - goal
        if abs(excess) <= _ROUNDING * goal:
            below = label == LOW and law[_UPPER] > N
            between = label == MID and law[_UPPER] < N < law[_LOWER]
            if below or between or (label == HIGH and law[_LOWER] < N):
                return N
            break
        N -= excess / slope
    d = complex(R, law[_IMAG])
    count, N1, N2, N3 = squares(k, q, d, complex(1.0, 0.0), complex(wm * math.sqrt(s), 0.0))
    if count < 3 or label == LOW:
        return N1
    return N2 if label == MID else N3


@kernel
def reaction(N, law):
    """R of an absorber that answers with |Z|^2 = N."""
    wm = law[_INERTIA]
    return wm * (1.0 + wm / complex(law[_REAL] + (law[K] + law[Q] * N) * N, law[_IMAG]))


@kernel
def prepare(W, group, spring, damping, laws):
    """Fill `laws` (N, 10) with what the absorbers are at Omega = W; returns the largest sum |R|."""
    total = 0.0
    for i in range(group.shape[0]):
        m, k1, k3, damper, k5 = group[i]
        law = laws[i]
        wm = m * W * W
        k, q, d = 0.75 * spring * k3, 0.625 * spring * k5, complex(spring * k1 - wm, W * damping * damper)
        law[K], law[Q], law[_REAL], law[_IMAG], law[_INERTIA] = k, q, d.real, d.imag, wm
        law[FIRST], law[LAST], law[_UPPER], law[_LOWER] = _turning_motions(k, q, d, wm)
        stiff = d.real if k == 0.0 and q == 0.0 else max(d.real, 0.0)
        total += wm * (1.0 + wm / max(math.hypot(stiff, d.imag), 1e-12 * wm))
    return total


@kernel
def exists(label, s, law):
    """Whether an answer is there at s: the middle one only between the turning points."""
    first, last = law[FIRST], law[LAST]
    if label == LOW:
        return not s > last
    if label == MID:
        return first < s < last
    return s > first and first < math.inf


@kernel
def total_reaction(choice, s, laws):
    """Sum of R at a motion; |Z|^2 goes into `laws`, where it is the next guess."""
    total = complex(0.0, 0.0)
    rest = choice
    for i in range(laws.shape[0]):
        law = laws[i]
        law[SQUARE] = answer(rest % 3, s, law[SQUARE], law)
        total += reaction(law[SQUARE], law)
        rest //= 3
    return total


@kernel
def begin_at(place, choice, laws, squares):
    """Guess the answers of a place from now on."""
    rest = choice
    for i in range(laws.shape[0]):
        laws[i, SQUARE] = squares[i, rest % 3, place]
        rest //= 3


@kernel
def is_linear(group):
    """Whether no absorber has a nonlinear spring."""
    return np.all(group[:, 2] == 0.0) and np.all(group[:, 4] == 0.0)
