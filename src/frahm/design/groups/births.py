"""Least force at which several absorbers have a detached curve, of many designs."""

from __future__ import annotations

import math

import numpy as np

from frahm.compiled import kernel
from frahm.design.groups.answers import begin_at, is_linear
from frahm.design.groups.crossings import force_extreme, hidden
from frahm.design.groups.curves import curves, room_for
from frahm.design.kernels import birth

_FALLEN = 0.99  # an extreme that is no nearer to this share of an end is none
_WEAKEST, _STRONGEST = 0.3, 2.0  # forces between which births are looked for [-]
_MISSED = 3  # frequencies at which an extreme may have been missed, and be one still
_SHEETS = 12  # extremes of the force followed over the frequency
_NEAR_IN_LOG = 1.2  # of |u|^2: extremes at two frequencies that are one


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
            begin_at(chain[p, 0], choice, laws, squares)
            if left != right:  # where answers turn into one another, on the one side or the other
                at, least = force_extreme(choice, s[chain[left, 0]], s[chain[right, 0]], 1.0, a, laws)
        elif chain[p + 1, 1] == choice and hidden(p, math.inf, need, ratio) and not _lower(p + 1, number, chain, need):
            begin_at(chain[p, 0], choice, laws, squares)
            at, least = force_extreme(choice, at, s[chain[p + 1, 0]], 1.0, a, laws)
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
    work = room_for(N)
    sheets, highest = np.empty((_SHEETS, W)), np.empty(W)
    where, places, needs = np.empty(_SHEETS), np.empty(_SHEETS), np.empty(_SHEETS)
    seen = np.empty(_SHEETS, np.int64)
    for at in range(designs.shape[0]):
        found[at] = math.inf
        if is_linear(designs[at]):
            continue
        for r in range(R):
            spring, damping = absorber[r]
            sheets[:] = math.inf
            seen[:] = -W
            for j in range(W):
                free = u[r, j].real ** 2 + u[r, j].imag ** 2
                if free == 0.0:
                    continue
                number = curves(
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
                found[at] = min(found[at], birth(sheets[sheet], highest))
        if not found[at] < _STRONGEST:
            found[at] = math.inf
