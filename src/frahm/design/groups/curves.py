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
from frahm.design.groups.answers import FIRST, HIGH, LAST, LOW, MID, answer, exists, prepare, reaction

POINTS = 40  # of the motion over all its size, on every curve
_FEWEST = 5  # of them between two turning points
_MOST_RATIO = 1e12  # of the largest to the smallest |u|^2 looked at, where nothing damps the structure
_SAME = 1e-8  # relative: turning points of equal absorbers are one
_INSIDE = 1e-9  # of the distance of two turning points: how far from them an answer is asked for


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
        for turn in (laws[i, FIRST], laws[i, LAST]):
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
            there = there and exists(labels[i], middle, laws[i])
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
                if up and _at_edge(laws[i, LAST], edge) and labels[i] != HIGH:
                    labels[i], turned = MID - labels[i], True
                elif not up and _at_edge(laws[i, FIRST], edge) and labels[i] != LOW:
                    labels[i], turned = HIGH + MID - labels[i], True
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
                if exists(label, s[j], law):
                    near = answer(label, s[j], near, law)
                    squares[i, label, j] = near
                    tables[i, label, j] = reaction(near, law)


@kernel
def _room(absorbers):
    """Places on all curves together at most."""
    return 3**absorbers * (2 * absorbers + 1) * POINTS


@separate_kernel
def curves(W, a, weakest, strongest, group, spring, damping, work):
    """All choices of answers at Omega = W as curves in `work`; returns the number of their places."""
    laws, edges, starts, s, tables, chain, need, ratio, squares = work
    reaction = prepare(W, group, spring, damping, laws)
    count = _edges(a, weakest, strongest, reaction, laws, edges)
    number = _grid(edges, count, starts, s)
    _fill_tables(s, number, laws, tables, squares)
    return _walk(a, edges, starts, count, s, tables, laws, chain, need, ratio)


@kernel
def room_for(absorbers):
    """Room for `curves`."""
    n, points = absorbers, (2 * absorbers + 1) * POINTS
    return (
        np.empty((n, 10)), np.empty(2 * n + 2), np.empty(2 * n + 2, np.int64), np.empty(points),
        np.empty((n, 3, points), np.complex128), np.empty((_room(n), 3), np.int64), np.empty(_room(n)),
        np.empty(_room(n), np.complex128), np.empty((n, 3, points)),
    )  # fmt: skip
