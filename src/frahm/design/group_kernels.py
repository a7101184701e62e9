"""Compiled screening of several absorbers at one place: every one-harmonic response, whatever their springs.

Each absorber (mass m, spring k1 z + k3 z^3 + k5 z^5, damper c) answers the motion u of the place it hangs at alone::

    (d + n) Z = m Omega^2 u,   d = k1 - m Omega^2 + i Omega c,   n = 3/4 k3 |Z|^2 + 5/8 k5 |Z|^4,
    force on the structure g = R u,   R = m Omega^2 (1 + m Omega^2/(d + n)),

and the structure (receptance a, free motion u_F, see `host`) answers all of them together::

    u (1 - a sum R) = u_F.

So s = |u|^2 is the only unknown: for every s each absorber has one or three answers, and the force that a choice of
answers needs is L = s |1 - a sum R|^2 = |u_F|^2. Where an absorber's answers turn into one another, so do the choices:
all of them together are curves, which are walked along, once for all forces. Crossings of L with the force are the
responses; what is least along a curve is the force at which a pair of them appears.

As Im(1/a) >= 0 >= Im R, the motion is bounded: |u_F|/(1 + |a| sum |R|) <= |u| <= |u_F|/(|a| Im(1/a)).
"""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel, separate_kernel
from frahm.design.kernels import _beyond, _birth, _extremes, _slope, _squares

POINTS = 40  # of the motion over all its size, on every curve
_FEWEST = 5  # of them between two turning points
_MOST_RATIO = 1e12  # of the largest to the smallest |u|^2 looked at, where nothing damps the structure
# columns of an absorber at one frequency: k, q, d, m Omega^2, motions and |Z|^2 where answers turn, last |Z|^2
_K, _Q, _REAL, _IMAG, _INERTIA, _FIRST, _LAST, _UPPER, _LOWER, _SQUARE = range(10)
_LOW, _MID, _HIGH = 0, 1, 2  # answers of an absorber, by their size
_SELDOM = 2  # frequencies of which one is asked for its slow flow
_SETTLED = 1e-4  # ln of the squared force
_ROUNDS = 12  # of the refinement of a crossing at most
_DIP = 0.9  # of the force at two places: a line between them that comes below hides an extreme
_CLOSE = 3.0  # times the squared force: what a straight line shows of an extreme that may reach it
_FALLEN = 0.99  # an extreme that is no nearer to this share of an end is none
_CHORDS, _AT_END = 3, 0.02  # of the search for a dip, and the share of a chord from where on its end is the nearest
_PLACES = 10  # between two, of which the best is where an extreme is looked for
_SECTIONS = 10  # of the search for an extreme
_OVERSHOT = 0.5  # of what three places differ by: how far an extreme may lie beyond the middle one
_WEAKEST, _STRONGEST = 0.3, 2.0  # forces between which births are looked for [-]
_MISSED = 3  # frequencies at which an extreme may have been missed, and be one still
_NEWTON, _ROUNDING = 8, 1e-11  # steps at most, and what is left of the squared motion
_SHEETS = 12  # extremes of the force followed over the frequency
_NEAR_IN_LOG = 1.2  # of |u|^2: extremes at two frequencies that are one
_SAME = 1e-8  # relative: turning points of equal absorbers are one
_INSIDE = 1e-9  # of the distance of two turning points: how far from them an answer is asked for


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
        most = _beyond(k, q, D, R, 1.0, D * near)
        there, low, high = _extremes(k, q, D, R, 1.0, most)
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
def _answer(label, s, near, law):
    """|Z|^2 of an absorber at |u|^2 = s: the smallest, the middle or the largest; where there is one, that.

    Newton's method from what is near by, as long as it stays between the turning points of this answer; the closed form
    where it does not.
    """
    k, q, R, wm = law[_K], law[_Q], law[_REAL], law[_INERTIA]
    D, goal = R * R + law[_IMAG] * law[_IMAG], wm * wm * s
    if k == 0.0 and q == 0.0:
        return goal / D
    N = near
    for _ in range(_NEWTON):
        slope = _slope(N, k, q, D, R, 1.0)
        if not N > 0.0 or slope == 0.0:
            break
        excess = _load_at(N, k, q, D, R) - goal
        if abs(excess) <= _ROUNDING * goal:
            below = label == _LOW and law[_UPPER] > N
            between = label == _MID and law[_UPPER] < N < law[_LOWER]
            if below or between or (label == _HIGH and law[_LOWER] < N):
                return N
            break
        N -= excess / slope
    d = complex(R, law[_IMAG])
    count, N1, N2, N3 = _squares(k, q, d, complex(1.0, 0.0), complex(wm * math.sqrt(s), 0.0))
    if count < 3 or label == _LOW:
        return N1
    return N2 if label == _MID else N3


@kernel
def _reaction(N, law):
    """R of an absorber that answers with |Z|^2 = N."""
    wm = law[_INERTIA]
    return wm * (1.0 + wm / complex(law[_REAL] + (law[_K] + law[_Q] * N) * N, law[_IMAG]))


@kernel
def _prepare(W, group, spring, damping, laws):
    """Fill `laws` (N, 9) with what the absorbers are at Omega = W; returns the largest sum |R|."""
    total = 0.0
    for i in range(group.shape[0]):
        m, k1, k3, damper, k5 = group[i]
        law = laws[i]
        wm = m * W * W
        k, q, d = 0.75 * spring * k3, 0.625 * spring * k5, complex(spring * k1 - wm, W * damping * damper)
        law[_K], law[_Q], law[_REAL], law[_IMAG], law[_INERTIA] = k, q, d.real, d.imag, wm
        law[_FIRST], law[_LAST], law[_UPPER], law[_LOWER] = _turning_motions(k, q, d, wm)
        stiff = d.real if k == 0.0 and q == 0.0 else max(d.real, 0.0)
        total += wm * (1.0 + wm / max(math.hypot(stiff, d.imag), 1e-12 * wm))
    return total


@kernel
def _at_edge(turn, edge):
    return abs(turn - edge) <= _SAME * edge


@kernel
def _edges(a, weakest, strongest, reaction, laws, edges):
    """Ascending ends of the motion and turning points between them, into `edges`; returns how many.

    For squared free motions between the weakest and the strongest.
    """
    size = abs(a)
    least = weakest / (1.0 + size * reaction) ** 2
    damped = size * (1.0 / a).imag
    most = strongest / max(damped * damped, 1e-300)
    most = min(max(most, 4.0 * least), _MOST_RATIO * least)
    edges[0] = 0.999 * least
    count = 1
    for i in range(laws.shape[0]):
        for turn in (laws[i, _FIRST], laws[i, _LAST]):
            known = not edges[0] < turn < math.inf
            for at in range(1, count):
                known = known or _at_edge(turn, edges[at])
            if not known:
                at = count
                while edges[at - 1] > turn:
                    edges[at] = edges[at - 1]
                    at -= 1
                edges[at] = turn
                count += 1
    edges[count] = max(1.001 * most, 1.001 * edges[count - 1])
    return count + 1


@kernel
def _grid(edges, count, starts, s):
    """Ascending motions between the edges, dense at every edge, into `s`; their places into `starts`."""
    total = math.log(edges[count - 1] / edges[0])
    at = 0
    for t in range(count - 1):
        lo, hi = edges[t], edges[t + 1]
        ratio = math.log(hi / lo)
        points = min(max(_FEWEST, int(POINTS * ratio / total)), POINTS)
        starts[t] = at
        for j in range(points):
            share = 0.5 * (1.0 - math.cos(math.pi * j / (points - 1)))
            s[at + j] = lo * math.exp(ratio * min(max(share, _INSIDE), 1.0 - _INSIDE))
        at += points
    starts[count - 1] = at
    return at


@kernel
def _exists(label, s, law):
    """Whether an answer is there at s: the middle one only between the turning points."""
    first, last = law[_FIRST], law[_LAST]
    if label == _LOW:
        return not s > last
    if label == _MID:
        return first < s < last
    return s > first and first < math.inf


@kernel
def _walk(a, edges, starts, count, s, tables, laws, chain, need, ratio):
    """Walk along all curves; returns the number of their places.

    Places in the grid and choices go into `chain`, L into `need` and 1 - a sum R into `ratio`.
    A row of `chain` is the place in `s`, the choice as a number to the base 3, and the number of the curve, negative
    for a closed one.
    """
    absorbers = laws.shape[0]
    choices = 3**absorbers
    seen = np.zeros((count - 1, choices), np.bool_)
    labels = np.empty(absorbers, np.int64)
    number = 0
    curve = 0
    for begin in range((count - 1) * choices):
        interval, choice = begin // choices, begin % choices
        if seen[interval, choice]:
            continue
        middle = s[(starts[interval] + starts[interval + 1]) // 2]
        there = True
        rest = choice
        for i in range(absorbers):
            labels[i] = rest % 3
            rest //= 3
            there = there and _exists(labels[i], middle, laws[i])
        if not there:
            continue
        up, begun, closed = True, number, True
        while not seen[interval, choice]:
            seen[interval, choice] = True
            points = starts[interval + 1] - starts[interval]
            if number + points > chain.shape[0]:
                return number
            for step in range(points):
                j = starts[interval] + (step if up else points - 1 - step)
                total = complex(0.0, 0.0)
                for i in range(absorbers):
                    total += tables[i, labels[i], j]
                z = 1.0 - a * total
                ratio[number] = z
                need[number] = s[j] * (z.real * z.real + z.imag * z.imag)
                chain[number, 0], chain[number, 1] = j, choice
                number += 1
            edge = edges[interval + 1] if up else edges[interval]
            turned = False
            for i in range(absorbers):
                if up and _at_edge(laws[i, _LAST], edge) and labels[i] != _HIGH:
                    labels[i], turned = _MID - labels[i], True
                elif not up and _at_edge(laws[i, _FIRST], edge) and labels[i] != _LOW:
                    labels[i], turned = _HIGH + _MID - labels[i], True
            if turned:
                up = not up
                choice = 0
                for i in range(absorbers - 1, -1, -1):
                    choice = 3 * choice + labels[i]
            else:
                interval += 1 if up else -1
                if interval < 0 or interval > count - 2:
                    closed = False
                    break
        curve += 1
        for at in range(begun, number):
            chain[at, 2] = -curve if closed else curve
    return number


@kernel
def _fill_tables(s, number, laws, tables, squares):
    """R and |Z|^2 of every answer (N, 3, places) that is there."""
    for i in range(laws.shape[0]):
        law = laws[i]
        for label in range(3):
            near = math.nan
            for j in range(number):
                if _exists(label, s[j], law):
                    near = _answer(label, s[j], near, law)
                    squares[i, label, j] = near
                    tables[i, label, j] = _reaction(near, law)


@kernel
def _total(choice, s, laws):
    """Sum of R at a motion; |Z|^2 goes into `laws`, where it is the next guess."""
    total = complex(0.0, 0.0)
    rest = choice
    for i in range(laws.shape[0]):
        law = laws[i]
        law[_SQUARE] = _answer(rest % 3, s, law[_SQUARE], law)
        total += _reaction(law[_SQUARE], law)
        rest //= 3
    return total


@kernel
def _begin_at(place, choice, laws, squares):
    """Guess the answers of a place from now on."""
    rest = choice
    for i in range(laws.shape[0]):
        laws[i, _SQUARE] = squares[i, rest % 3, place]
        rest //= 3


@kernel
def _crossing(choice, lo, hi, below, above, level, a, laws):
    """s between two of one choice where the force needed is `level` (regula falsi, Illinois), and sum R."""
    x0, x1 = math.log(lo), math.log(hi)
    f0, f1 = math.log(below / level), math.log(above / level)
    s, total = lo, complex(0.0, 0.0)
    for _ in range(_ROUNDS):
        x = x0 - f0 * (x1 - x0) / (f1 - f0) if f1 != f0 else 0.5 * (x0 + x1)
        s = math.exp(x)
        total = _total(choice, s, laws)
        z = 1.0 - a * total
        f = math.log(max(s * (z.real * z.real + z.imag * z.imag) / level, 1e-300))
        if abs(f) < _SETTLED:
            break
        if (f > 0.0) == (f1 > 0.0):
            x1, f1, f0 = x, f, 0.5 * f0
        else:
            x0, f0, f1 = x, f, 0.5 * f1
    return s, total


@kernel
def _room(absorbers):
    """Places on all curves together at most."""
    return 3**absorbers * (2 * absorbers + 1) * POINTS


@separate_kernel
def _curves(W, a, weakest, strongest, group, spring, damping, work):
    """All choices of answers at Omega = W as curves in `work`; returns the number of their places."""
    laws, edges, starts, s, tables, chain, need, ratio, squares = work
    reaction = _prepare(W, group, spring, damping, laws)
    count = _edges(a, weakest, strongest, reaction, laws, edges)
    number = _grid(edges, count, starts, s)
    _fill_tables(s, number, laws, tables, squares)
    return _walk(a, edges, starts, count, s, tables, laws, chain, need, ratio)


@kernel
def _work(absorbers):
    """Room for `_curves`."""
    n, points = absorbers, (2 * absorbers + 1) * POINTS
    return (
        np.empty((n, 10)), np.empty(2 * n + 2), np.empty(2 * n + 2, np.int64), np.empty(points),
        np.empty((n, 3, points), np.complex128), np.empty((_room(n), 3), np.int64), np.empty(_room(n)),
        np.empty(_room(n), np.complex128), np.empty((n, 3, points)),
    )  # fmt: skip


@kernel
def _put(choice, lo, hi, below, above, level, a, laws, found, hits, count):
    """Put the response between two places of one choice into the arrays; returns how many are there."""
    if count < found.shape[0]:
        at, total = _crossing(choice, lo, hi, below, above, level, a, laws)
        found[count, 0], found[count, 1], found[count, 2] = at, total.real, total.imag
        hits[count] = laws[:, _SQUARE]
        count += 1
    return count


@kernel
def _ratio(choice, log, a, laws):
    """1 - a sum R of a choice at ln s."""
    return 1.0 - a * _total(choice, math.exp(log), laws)


@kernel
def _force(log, z):
    return math.exp(log) * (z.real * z.real + z.imag * z.imag)


@kernel
def _nearest(begin, end):
    """Share of the way from one complex number to another where the straight line comes nearest to 0."""
    step = end - begin
    length = step.real * step.real + step.imag * step.imag
    share = -(begin.real * step.real + begin.imag * step.imag) / length if length > 0.0 else 0.5
    return min(max(share, 0.0), 1.0)


@kernel
def _narrowed(choice, left, right, a, laws):
    """Two ln s around where 1 - a sum R comes nearest to 0 between two, however narrow the dip of the force is."""
    begin, end = _ratio(choice, left, a, laws), _ratio(choice, right, a, laws)
    for _ in range(_CHORDS):
        share = _nearest(begin, end)
        if share < _AT_END or share > 1.0 - _AT_END:
            break
        middle = left + share * (right - left)
        there = _ratio(choice, middle, a, laws)
        before, after = _nearest(begin, there), _nearest(there, end)
        nearer = abs(begin + before * (there - begin)) < abs(there + after * (end - there))
        if nearer:
            right, end = middle + 0.3 * (right - middle), end
            end = _ratio(choice, right, a, laws)
        else:
            left = left + 0.7 * (middle - left)
            begin = _ratio(choice, left, a, laws)
    return left, right


@kernel
def _best_bracket(choice, left, right, a, laws):
    """Two ln s around the place of least force among a few: evenly spaced ones, and the middle of `_narrowed`."""
    lo, hi = _narrowed(choice, left, right, a, laws)
    z = _ratio(choice, 0.5 * (lo + hi), a, laws)
    least, step = _force(0.5 * (lo + hi), z), (right - left) / _PLACES
    for j in range(1, _PLACES):
        at = left + step * j
        force = _force(at, _ratio(choice, at, a, laws))
        if force < least:
            least, lo, hi = force, at - step, at + step
    return lo, hi


@separate_kernel
def _extreme(choice, left, right, sign, a, laws):
    """s between two of one choice where `sign` times the force needed is least, and that force.

    By golden sections around the best of a few places, of which some lie where the dip of the force is expected.
    """
    x0, x1 = math.log(left), math.log(right)
    if sign > 0.0:
        x0, x1 = _best_bracket(choice, x0, x1, a, laws)
    share = 0.5 * (math.sqrt(5.0) - 1.0)
    y0, y1 = x1 - share * (x1 - x0), x0 + share * (x1 - x0)
    f0, f1 = _force(y0, _ratio(choice, y0, a, laws)), _force(y1, _ratio(choice, y1, a, laws))
    for _ in range(_SECTIONS):
        if sign * f0 < sign * f1:
            x1, y1, f1 = y1, y0, f0
            y0 = x1 - share * (x1 - x0)
            f0 = _force(y0, _ratio(choice, y0, a, laws))
        else:
            x0, y0, f0 = y0, y1, f1
            y1 = x0 + share * (x1 - x0)
            f1 = _force(y1, _ratio(choice, y1, a, laws))
    return (math.exp(y0), f0) if sign * f0 < sign * f1 else (math.exp(y1), f1)


@kernel
def _turned(p, number, level, chain, need, ratio):
    """Places around an extreme of the force between which it may pass `level` twice unseen, and its sign: +1 a minimum.

    The sign is 0 where there is none. Either the place p is lower, or higher, than its neighbours, or the straight line
    that 1 - a sum R follows from p to the next place comes nearer to 0 than both its ends.
    """
    if not _alike(p, p + 1, number, chain):
        return p, p, 0.0
    if _alike(p - 1, p, number, chain):
        sign = 1.0 if need[p] > level else -1.0
        turned = sign * need[p] < sign * need[p - 1] and sign * need[p] <= sign * need[p + 1]
        beyond = (need[p - 1] > level) == (need[p] > level) and (need[p + 1] > level) == (need[p] > level)
        if turned and beyond:
            steep = max(abs(math.log(need[p - 1] / need[p])), abs(math.log(need[p + 1] / need[p])))
            if abs(math.log(need[p] / level)) < _OVERSHOT * steep:
                return p - 1, p + 1, sign
    if need[p] > level and need[p + 1] > level and _hidden(p, _CLOSE * level, need, ratio):
        return p, p + 1, 1.0
    return p, p, 0.0


@kernel
def _alike(p, q, number, chain):
    """Whether two places are there, on one curve and of one choice."""
    return p >= 0 and q < number and chain[p, 2] == chain[q, 2] and chain[p, 1] == chain[q, 1]


@kernel
def _hidden(p, below, need, ratio):
    """Whether the force is likely to be least between the place p and the next one, and less than `below`."""
    begin = ratio[p]
    share = _nearest(begin, ratio[p + 1])
    if share == 0.0 or share == 1.0:
        return False
    nearest = begin + share * (ratio[p + 1] - begin)
    s = need[p] / (begin.real * begin.real + begin.imag * begin.imag)
    return s * (nearest.real**2 + nearest.imag**2) < min(below, _DIP * min(need[p], need[p + 1]))


@separate_kernel
def _responses(number, level, a, work, found, hits):
    """Responses to a squared free motion `level`: s and sum R into `found` (n, 3), |Z|^2 into `hits` (n, N)."""
    laws, _, _, s, _, chain, need, ratio, squares = work
    count = 0
    for p in range(number - 1):
        if chain[p, 2] != chain[p + 1, 2]:
            continue
        choice, same = chain[p, 1], chain[p, 1] == chain[p + 1, 1]
        if (need[p] > level) != (need[p + 1] > level):
            _begin_at(chain[p, 0], choice, laws, squares)
            if same:
                here, there = s[chain[p, 0]], s[chain[p + 1, 0]]
                count = _put(choice, here, there, need[p], need[p + 1], level, a, laws, found, hits, count)
            elif count < found.shape[0]:
                total = _total(choice, s[chain[p, 0]], laws)
                found[count, 0], found[count, 1], found[count, 2] = s[chain[p, 0]], total.real, total.imag
                hits[count] = laws[:, _SQUARE]
                count += 1
        begin, end, sign = _turned(p, number, level, chain, need, ratio)
        if sign != 0.0:
            _begin_at(chain[p, 0], choice, laws, squares)
            left, right = s[chain[begin, 0]], s[chain[end, 0]]
            at, extreme = _extreme(choice, left, right, sign, a, laws)
            if sign * extreme < sign * level:
                count = _put(choice, left, at, need[begin], extreme, level, a, laws, found, hits, count)
                count = _put(choice, at, right, extreme, need[end], level, a, laws, found, hits, count)
    return count


@kernel
def _is_linear(group):
    return np.all(group[:, 2] == 0.0) and np.all(group[:, 4] == 0.0)


@kernel
def _linear_response(W, level, a, group, spring, damping, laws, found, hits):
    """As `_responses`, where no absorber has a nonlinear spring: there is one."""
    _prepare(W, group, spring, damping, laws)
    total = complex(0.0, 0.0)
    for i in range(laws.shape[0]):
        total += _reaction(0.0, laws[i])
    z = 1.0 - a * total
    s = level / (z.real * z.real + z.imag * z.imag)
    found[0, 0], found[0, 1], found[0, 2] = s, total.real, total.imag
    for i in range(laws.shape[0]):
        hits[0, i] = _answer(_LOW, s, 0.0, laws[i])
    return 1


@kernel
def _growth(W, group, spring, damping, mode, squares, u, laws, matrix):
    """Largest growth rate [1/s] of the slow flow beside a response; minus infinity for a saddle.

    With w = u + z and the governing mode M of the structure: 2 i Omega M u' = -(K - M Omega^2 + i Omega C) u + sum g,
    2 i Omega m w' = m Omega^2 w - g, and dg = (k1 + i Omega c + 2 n') dz + n'' conj(dz).
    """
    omega, xi1, mass = mode
    n = group.shape[0]
    size = n + 1
    matrix[:] = 0.0
    turn = 1.0 / (2j * W)
    matrix[0, 0] = -turn * complex(omega * omega - W * W, W * xi1)
    for i in range(n):
        m, k1, _, damper, _ = group[i]
        N = squares[i]
        d = complex(spring * k1, W * damping * damper)
        wm = m * W * W
        k, q = laws[i, _K], laws[i, _Q]
        steady = (k + q * N) * N
        steep = (k + 2.0 * q * N) * N
        z = wm * u / (d - wm + steady)
        phase = z * z / max(N, 1e-300)
        same, other = d + steady + steep, steep * phase
        at = i + 1
        matrix[0, at] += turn * same / mass
        matrix[0, 0] -= turn * same / mass
        matrix[0, size + at] += turn * other / mass
        matrix[0, size] -= turn * other / mass
        matrix[at, at] = turn * (W * W - same / m)
        matrix[at, 0] = turn * same / m
        matrix[at, size + at] = -turn * other / m
        matrix[at, size] = turn * other / m
    for i in range(size):
        for j in range(size):
            matrix[size + i, size + j] = np.conj(matrix[i, j])
            matrix[size + i, j] = np.conj(matrix[i, size + j])
    growth, above = -math.inf, 0
    for value in np.linalg.eigvals(matrix):
        growth = max(growth, value.real)
        above += 1 if value.real > 0.0 else 0
    return -math.inf if above % 2 == 1 else growth


@kernel
def group_responses(frequency, a, u, b, x, absorber, mode, forces, designs, ratios, found, peaks):
    """As `kernels.screened`, for designs (D, N, 5) of N absorbers at one place.

    `frequency`, `a` and so on (R, W) are those of the first force; `forces` (F,) are factors on it, and `peaks`
    (D, F * R) has the rows of the first force, then of the next. `ratios` (N,) are motions of the absorbers over those
    they are screened with. The slow flow is asked at every `_SELDOM`th frequency.
    """
    R, W = frequency.shape
    N = designs.shape[1]
    work, matrix = _work(N), np.empty((2 * N + 2, 2 * N + 2), np.complex128)
    hits, squares = np.empty((3**N * 4, 3)), np.empty((3**N * 4, N))
    low, top = np.min(forces) ** 2, np.max(forces) ** 2
    for at in range(designs.shape[0]):
        group = designs[at]
        linear = _is_linear(group)
        stroke, growth = 0.0, -math.inf
        peaks[at] = 0.0
        for r in range(R):
            spring, damping = absorber[r]
            for j in range(W):
                free = u[r, j].real ** 2 + u[r, j].imag ** 2
                if free == 0.0:
                    continue
                W_j, a_j, number = frequency[r, j], a[r, j], 0
                if not linear:
                    number = _curves(W_j, a_j, low * free, top * free, group, spring, damping, work)
                for f in range(forces.size):
                    level = forces[f] ** 2 * free
                    if linear:
                        count = _linear_response(W_j, level, a_j, group, spring, damping, work[0], hits, squares)
                    else:
                        count = _responses(number, level, a_j, work, hits, squares)
                    for hit in range(count):
                        total = complex(hits[hit, 1], hits[hit, 2])
                        motion = forces[f] * u[r, j] / (1.0 - a[r, j] * total)
                        size = abs(forces[f] * x[r, j] + b[r, j] * total * motion)
                        peaks[at, f * R + r] = max(peaks[at, f * R + r], size)
                        for i in range(N):
                            stroke = max(stroke, ratios[i] * math.sqrt(squares[hit, i]))
                        if j % _SELDOM == 0:
                            rate = _growth(
                                frequency[r, j], group, spring, damping, mode[r], squares[hit], motion, work[0], matrix
                            )
                            growth = max(growth, rate)
        found[at, 0], found[at, 1] = stroke, growth


@kernel
def group_amplitudes(frequency, a, u, b, x, absorber, designs, found):
    """As `kernels.amplitude_tables`, for designs (D, N, 5) of N absorbers at one place."""
    R, W = frequency.shape
    N = designs.shape[1]
    work = _work(N)
    hits, squares = np.empty((3**N * 4, 3)), np.empty((3**N * 4, N))
    found[:] = 0.0
    for at in range(designs.shape[0]):
        linear = _is_linear(designs[at])
        for r in range(R):
            spring, damping = absorber[r]
            for j in range(W):
                free = u[r, j].real ** 2 + u[r, j].imag ** 2
                if free == 0.0:
                    found[at, r, j] = abs(x[r, j])
                    continue
                if linear:
                    count = _linear_response(
                        frequency[r, j], free, a[r, j], designs[at], spring, damping, work[0], hits, squares
                    )
                else:
                    number = _curves(frequency[r, j], a[r, j], free, free, designs[at], spring, damping, work)
                    count = _responses(number, free, a[r, j], work, hits, squares)
                for hit in range(count):
                    total = complex(hits[hit, 1], hits[hit, 2])
                    size = abs(x[r, j] + b[r, j] * total * u[r, j] / (1.0 - a[r, j] * total))
                    found[at, r, j] = max(found[at, r, j], size)


@kernel
def _lower(p, number, chain, need):
    """Whether the force is less at the place p than beside it."""
    return p + 1 < number and chain[p + 1, 2] == chain[p, 2] and need[p] < need[p - 1] and need[p] <= need[p + 1]


@kernel
def _least(number, a, work, places, needs):
    """Where along the curves the force needed is least: ln s and its square into the arrays; returns how many."""
    laws, _, _, s, _, chain, need, ratio, squares = work
    count, begun = 0, 0
    for p in range(number):
        if p > 0 and chain[p, 2] != chain[p - 1, 2]:
            begun = p
        ends = p == number - 1 or chain[p + 1, 2] != chain[p, 2]
        if p == begun and (chain[p, 2] > 0 or ends):
            continue
        if p == begun:
            before = p
            while before + 1 < number and chain[before + 1, 2] == chain[p, 2]:
                before += 1
            before -= 1
        else:
            before = p - 1
        if ends or count == places.size:
            continue
        choice, at, least = chain[p, 1], s[chain[p, 0]], need[p]
        if need[p] < need[before] and need[p] <= need[p + 1]:
            left = before if chain[before, 1] == choice else p
            right = p + 1 if chain[p + 1, 1] == choice else p
            _begin_at(chain[p, 0], choice, laws, squares)
            if left != right:  # where answers turn into one another, on the one side or the other
                at, least = _extreme(choice, s[chain[left, 0]], s[chain[right, 0]], 1.0, a, laws)
        elif chain[p + 1, 1] == choice and _hidden(p, math.inf, need, ratio) and not _lower(p + 1, number, chain, need):
            _begin_at(chain[p, 0], choice, laws, squares)
            at, least = _extreme(choice, at, s[chain[p + 1, 0]], 1.0, a, laws)
            if least > _FALLEN * min(need[p], need[p + 1]):  # it falls to an end
                continue
        else:
            continue
        places[count], needs[count] = math.log(at), least
        count += 1
    return count


@kernel
def _sheet_of(place, where, seen, j):
    """Sheet of extremes that one at the frequency j belongs to: the nearest of late, or an idle one; -1 if none."""
    nearest, distance = -1, _NEAR_IN_LOG
    for sheet in range(where.size):
        if 0 < j - seen[sheet] <= _MISSED and abs(where[sheet] - place) < distance:
            nearest, distance = sheet, abs(where[sheet] - place)
    for sheet in range(where.size):
        if nearest < 0 and j - seen[sheet] > _MISSED + 2:
            nearest = sheet
    return nearest


@kernel
def group_births(frequency, a, u, absorber, designs, found):
    """As `kernels.births`, for designs (D, N, 5) of N absorbers at one place."""
    R, W = frequency.shape
    N = designs.shape[1]
    work = _work(N)
    sheets, highest = np.empty((_SHEETS, W)), np.empty(W)
    where, places, needs = np.empty(_SHEETS), np.empty(_SHEETS), np.empty(_SHEETS)
    seen = np.empty(_SHEETS, np.int64)
    for at in range(designs.shape[0]):
        found[at] = math.inf
        if _is_linear(designs[at]):
            continue
        for r in range(R):
            spring, damping = absorber[r]
            sheets[:] = math.inf
            seen[:] = -W
            for j in range(W):
                free = u[r, j].real ** 2 + u[r, j].imag ** 2
                if free == 0.0:
                    continue
                number = _curves(
                    frequency[r, j],
                    a[r, j],
                    _WEAKEST**2 * free,
                    _STRONGEST**2 * free,
                    designs[at],
                    spring,
                    damping,
                    work,
                )
                count = _least(number, a[r, j], work, places, needs)
                for one in range(count):
                    sheet = _sheet_of(places[one], where, seen, j)
                    if sheet < 0:
                        continue
                    here = math.sqrt(needs[one] / free)
                    for gap in range(max(seen[sheet] + 1, 0) if j - seen[sheet] <= _MISSED else j, j):
                        share = (gap - seen[sheet]) / (j - seen[sheet])
                        sheets[sheet, gap] = (1.0 - share) * sheets[sheet, seen[sheet]] + share * here
                    sheets[sheet, j], where[sheet], seen[sheet] = here, places[one], j
            for sheet in range(_SHEETS):
                found[at] = min(found[at], _birth(sheets[sheet], highest))
        if not found[at] < _STRONGEST:
            found[at] = math.inf
