"""Responses and extremes along the curves of `curves`: where the force they need is that given, or least."""

from __future__ import annotations

import math

from frahm.compiled import kernel, separate_kernel
from frahm.design.groups.answers import LOW, SQUARE, answer, begin_at, prepare, reaction, total_reaction

_SETTLED = 1e-4  # ln of the squared force
_ROUNDS = 12  # of the refinement of a crossing at most
_DIP = 0.9  # of the force at two places: a line between them that comes below hides an extreme
_CLOSE = 3.0  # times the squared force: what a straight line shows of an extreme that may reach it
_CHORDS, _AT_END = 3, 0.02  # of the search for a dip, and the share of a chord from where on its end is the nearest
_PLACES = 10  # between two, of which the best is where an extreme is looked for
_SECTIONS = 10  # of the search for an extreme
_OVERSHOT = 0.5  # of what three places differ by: how far an extreme may lie beyond the middle one


@kernel
def _crossing(choice, lo, hi, below, above, level, a, laws):
    """s between two of one choice where the force needed is `level` (regula falsi, Illinois), and sum R."""
    x0, x1 = math.log(lo), math.log(hi)
    f0, f1 = math.log(below / level), math.log(above / level)
    s, total = lo, complex(0.0, 0.0)
    for _ in range(_ROUNDS):
        x = x0 - f0 * (x1 - x0) / (f1 - f0) if f1 != f0 else 0.5 * (x0 + x1)
        s = math.exp(x)
        total = total_reaction(choice, s, laws)
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
def _put(choice, lo, hi, below, above, level, a, laws, found, hits, count):
    """Put the response between two places of one choice into the arrays; returns how many are there."""
    if count < found.shape[0]:
        at, total = _crossing(choice, lo, hi, below, above, level, a, laws)
        found[count, 0], found[count, 1], found[count, 2] = at, total.real, total.imag
        hits[count] = laws[:, SQUARE]
        count += 1
    return count


@kernel
def _ratio(choice, log, a, laws):
    """1 - a sum R of a choice at ln s."""
    return 1.0 - a * total_reaction(choice, math.exp(log), laws)


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
            right = middle + 0.3 * (right - middle)
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
def force_extreme(choice, left, right, sign, a, laws):
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
    if need[p] > level and need[p + 1] > level and hidden(p, _CLOSE * level, need, ratio):
        return p, p + 1, 1.0
    return p, p, 0.0


@kernel
def _alike(p, q, number, chain):
    """Whether two places are there, on one curve and of one choice."""
    return p >= 0 and q < number and chain[p, 2] == chain[q, 2] and chain[p, 1] == chain[q, 1]


@kernel
def hidden(p, below, need, ratio):
    """Whether the force is likely to be least between the place p and the next one, and less than `below`."""
    begin = ratio[p]
    share = _nearest(begin, ratio[p + 1])
    if share == 0.0 or share == 1.0:
        return False
    nearest = begin + share * (ratio[p + 1] - begin)
    s = need[p] / (begin.real * begin.real + begin.imag * begin.imag)
    return s * (nearest.real**2 + nearest.imag**2) < min(below, _DIP * min(need[p], need[p + 1]))


@separate_kernel
def responses(number, level, a, work, found, hits):
    """Responses to a squared free motion `level`: s and sum R into `found` (n, 3), |Z|^2 into `hits` (n, N)."""
    laws, _, _, s, _, chain, need, ratio, squares = work
    count = 0
    for p in range(number - 1):
        if chain[p, 2] != chain[p + 1, 2]:
            continue
        choice, same = chain[p, 1], chain[p, 1] == chain[p + 1, 1]
        if (need[p] > level) != (need[p + 1] > level):
            begin_at(chain[p, 0], choice, laws, squares)
            if same:
                here, there = s[chain[p, 0]], s[chain[p + 1, 0]]
                count = _put(choice, here, there, need[p], need[p + 1], level, a, laws, found, hits, count)
            elif count < found.shape[0]:
                total = total_reaction(choice, s[chain[p, 0]], laws)
                found[count, 0], found[count, 1], found[count, 2] = s[chain[p, 0]], total.real, total.imag
                hits[count] = laws[:, SQUARE]
                count += 1
        begin, end, sign = _turned(p, number, level, chain, need, ratio)
        if sign != 0.0:
            begin_at(chain[p, 0], choice, laws, squares)
            left, right = s[chain[begin, 0]], s[chain[end, 0]]
            at, extreme = force_extreme(choice, left, right, sign, a, laws)
            if sign * extreme < sign * level:
                count = _put(choice, left, at, need[begin], extreme, level, a, laws, found, hits, count)
                count = _put(choice, at, right, extreme, need[end], level, a, laws, found, hits, count)
    return count


@kernel
def linear_response(W, level, a, group, spring, damping, laws, found, hits):
    """As `responses`, where no absorber has a nonlinear spring: there is one."""
    prepare(W, group, spring, damping, laws)
    total = complex(0.0, 0.0)
    for i in range(laws.shape[0]):
        total += reaction(0.0, laws[i])
    z = 1.0 - a * total
    s = level / (z.real * z.real + z.imag * z.imag)
    found[0, 0], found[0, 1], found[0, 2] = s, total.real, total.imag
    for i in range(laws.shape[0]):
        hits[0, i] = answer(LOW, s, 0.0, laws[i])
    return 1
