"""Equal absorbers that move alike: together they are one absorber of so many times mass, stiffness and damping.

Where an exchange of two coordinates leaves the equations as they are, motions in which both are equal stay so for ever,
and are the motions of a smaller system. All its branches are branches of the whole one, found where fewer coordinates
leave less to be searched.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from frahm.absorbers import Law
from frahm.absorbers.packed import pack_laws
from frahm.arrays import Complexes, Floats
from frahm.harmonic_balance.branch import SolutionBranch
from frahm.harmonic_balance.condensation import unknowns
from frahm.harmonic_balance.following import far_from_folds
from frahm.harmonic_balance.search import Search
from frahm.harmonic_balance.seeds import Seed
from frahm.systems import Element, System

_EQUAL = 1e-9  # relative: numbers that differ by rounding
_SAME_MOTION = 1e-6  # relative difference of two motions that are one

Harmonics = Mapping[int, Complexes]


def moving_alike(system: System) -> System | None:
    """The system of the motions in which all interchangeable coordinates are equal; None if there are none."""
    groups = interchangeable(system)
    if len(groups) == system.size:
        return None
    P = np.zeros((system.size, len(groups)))
    for column, group in enumerate(groups):
        P[group, column] = 1.0
    M, C, K = (P.T @ matrix @ P for matrix in (system.mass, system.damping, system.stiffness))
    elements = [Element(P.T @ element.direction, element.law) for element in system.elements]
    return System(M, C, K, P.T @ system.forcing, elements, P.T @ system.output, name=system.name)


def seeds_alike(search: Search, alike: Search, branches: list[SolutionBranch]) -> list[Seed]:
    """Starts in the whole system from the branches of its motions alike, one of each."""
    return [_seed(search, alike, branch) for branch in branches]


def _seed(search: Search, alike: Search, branch: SolutionBranch) -> Seed:
    at = far_from_folds(alike, branch)
    point, r = branch.points[at], alike.problem.M11.shape[0]
    X = point.y[: unknowns(alike.problem, point.H, branch.odd)].reshape(-1, r, 2)
    first, step = (1, 2) if branch.odd else (0, 1)
    return Seed(
        float(branch.points.frequency[at]),
        {first + step * m: _whole(search, alike, u[:, 0] + 1j * u[:, 1]) for m, u in enumerate(X)},
    )


def _whole(search: Search, alike: Search, u: Complexes) -> Complexes:
    """Relative coordinates of the whole system in which every element moves as it does in the motion alike."""
    z = alike.problem.directions.T @ u
    return np.asarray(np.linalg.lstsq(search.problem.directions.T.astype(complex), z, rcond=None)[0])


def are_exchanged(groups: Sequence[list[int]], one: Harmonics, other: Harmonics) -> bool:
    """Whether two motions (k: X_k of all coordinates) are one but for an exchange of coordinates within groups."""
    ks = sorted({*one, *other})
    a, b = (np.array([motion.get(k, np.zeros(len(motion[1]))) for k in ks]) for motion in (one, other))
    close = _SAME_MOTION * float(np.max(np.abs(a)))
    left = [i for i in range(a.shape[1]) if not any(i in group for group in groups)]
    if np.max(np.abs(a[:, left] - b[:, left]), initial=0.0) > close:
        return False
    for group in groups:
        waiting = list(group)
        for i in group:
            partner = next((j for j in waiting if np.max(np.abs(a[:, i] - b[:, j])) <= close), None)
            if partner is None:
                return False
            waiting.remove(partner)
    return True


def interchangeable(system: System) -> list[list[int]]:
    """Coordinates, those that can be exchanged together."""
    groups: list[list[int]] = []
    for i in range(system.size):
        for group in groups:
            if _exchangeable(system, group[0], i):
                group.append(i)
                break
        else:
            groups.append([i])
    return groups


def _exchangeable(system: System, i: int, j: int) -> bool:
    """Whether the equations stay as they are when two coordinates change places."""
    order = np.arange(system.size)
    order[[i, j]] = j, i
    matrices = (system.mass, system.damping, system.stiffness)
    if not _equal(system.forcing, system.forcing[order]):
        return False
    if not all(_equal(matrix, matrix[np.ix_(order, order)]) for matrix in matrices):
        return False
    waiting = list(system.elements)
    for element in system.elements:
        wanted = element.direction[order]
        partner = next(
            (other for other in waiting if _equal(other.direction, wanted) and _same_law(other.law, element.law)), None
        )
        if partner is None:
            return False
        waiting.remove(partner)
    return True


def _equal(a: Floats, b: Floats) -> bool:
    return bool(np.all(np.abs(a - b) <= _EQUAL * np.max(np.abs(a), initial=0.0)))


def _same_law(a: Law, b: Law) -> bool:
    (codes, table), (others, numbers) = pack_laws([a]), pack_laws([b])
    return bool(np.array_equal(codes, others)) and bool(np.allclose(table, numbers, rtol=_EQUAL, atol=0.0))
