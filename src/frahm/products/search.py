"""The best few kinds of absorber for many members, by the closed form.

Every member that might be the lightest of a kind, beside every member that the kind might be made for, gives a few
devices to a library; the rows of its table of utilisations that serve all members best are where the search starts.
Then, until nothing changes: every kind is made the best one for the members that take it (differential evolution), and
every member takes the kind that suits it best.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import differential_evolution
from scipy.stats import qmc

from frahm.arrays import Floats
from frahm.design.work import in_threads
from frahm.products.cover import best_rows
from frahm.products.served import ServedMember, hull
from frahm.tolerances import NO_BETTER

_LIBRARY, _LEAST, _MOST_PAIRS = 4096, 16, 256  # devices of a library; of one pair at least; pairs
_POPULATION, _DRAWN = 24, 32  # devices of an evolution, and those drawn for it: a power of two
_GENERATIONS, _CONVERGED, _SEED = 50, 1e-3, 1
_ROUNDS = 5  # of making kinds and taking them


@dataclass(frozen=True, eq=False)
class Expected:
    """What the closed form promises of a few kinds.

    Attributes
    ----------
    devices : ndarray, shape (K, 5)
        In SI units: m, k1, k3, c, k5.
    takes : ndarray of int, shape (n,)
        Kind that each member takes.
    used : ndarray, shape (n,)
        Utilisation of each member with it.
    """

    devices: Floats
    takes: np.ndarray
    used: Floats

    @property
    def worst(self) -> float:
        """Largest utilisation of a member."""
        return float(np.max(self.used))

    def group(self, kind: int) -> np.ndarray:
        """Numbers of the members that take a kind."""
        return np.flatnonzero(self.takes == kind)


class ProductSearch:
    """Search for kinds of one family of absorber that serve the same members.

    Parameters
    ----------
    members : sequence of ServedMember
    family : {"sink", "tuned", "mixed"}
    """

    def __init__(self, members: Sequence[ServedMember], family: str):
        self.members, self.family = tuple(members), family

    def best(self, count: int, starts: Sequence[Expected] = ()) -> Expected:
        """At most `count` kinds with which the worst utilisation is least.

        Parameters
        ----------
        count : int
        starts : sequence of Expected
            Products that are to be beaten, and that the search begins at besides.
        """
        devices, table = self.library
        rows = best_rows(table, count)
        first = [self._taken(devices[list(rows)], table[list(rows)]), self._by_frequency(count)]
        begins = [*first, *(self._split(one) for one in starts if len(one.devices) < count)]
        found = [*starts, *(self._settled(one) for one in begins)]
        return functools.reduce(lambda best, one: one if one.worst < NO_BETTER * best.worst else best, found)

    @functools.cached_property
    def library(self) -> tuple[Floats, Floats]:
        """Devices (D, 5), and the utilisation of every member with each, (D, n)."""
        order = sorted(range(len(self.members)), key=lambda at: self.members[at].most_mass)
        pairs = [(light, made_for) for i, light in enumerate(order) for made_for in order[i:]]
        pairs = [pairs[at] for at in np.linspace(0, len(pairs) - 1, min(len(pairs), _MOST_PAIRS)).astype(int)]
        each = 2 ** int(math.log2(max(_LEAST, _LIBRARY // len(pairs))))
        parts = []
        for number, (light, made_for) in enumerate(pairs):
            space = self.members[made_for].space(self.family, self.members[light].most_mass)
            parts.append(space.designs(qmc.Sobol(space.size, seed=number).random(each)))
        devices = np.concatenate(parts)
        return devices, self._table(devices)

    def _table(self, devices: Floats, of: Sequence[int] | np.ndarray | None = None) -> Floats:
        members = self.members if of is None else [self.members[at] for at in of]
        return np.column_stack(in_threads(lambda member: member.utilisation(devices), members))

    def _taken(self, devices: Floats, table: Floats | None = None) -> Expected:
        """Every member takes the kind that suits it best; kinds that none takes are left out."""
        table = self._table(devices) if table is None else table
        takes = np.argmin(table, axis=0)
        kinds, takes = np.unique(takes, return_inverse=True)
        return Expected(devices[kinds], takes, np.min(table, axis=0))

    def _by_frequency(self, count: int) -> Expected:
        """Neighbours in frequency share a kind, as many on each."""
        order = np.argsort([member.frequency for member in self.members])
        takes = np.empty(len(order), int)
        for kind, part in enumerate(np.array_split(order, min(count, len(order)))):
            takes[part] = kind
        return self._taken(self._made(takes, None))

    def _split(self, one: Expected) -> Expected:
        """One kind more: the members of the kind that binds part in the middle of their frequencies."""
        group = one.group(int(one.takes[np.argmax(one.used)]))
        if len(group) < 2:
            return one
        order = group[np.argsort([self.members[at].frequency for at in group])]
        takes = one.takes.copy()
        takes[order[len(order) // 2 :]] = len(one.devices)
        return self._taken(self._made(takes, one.devices))

    def _settled(self, start: Expected) -> Expected:
        """Kinds are made for those that take them, and taken anew, until that is no better."""
        best = start
        for _ in range(_ROUNDS):
            found = self._taken(np.concatenate([self._made(best.takes, best.devices), best.devices]))
            found = self._fewest(found, len(best.devices))
            if not found.worst < NO_BETTER * best.worst:
                return found if found.worst < best.worst else best
            best = found
        return best

    def _fewest(self, found: Expected, count: int) -> Expected:
        """Of the kinds made now and before, the few that serve best."""
        if len(found.devices) <= count:
            return found
        table = self._table(found.devices)
        rows = list(best_rows(table, count))
        return self._taken(found.devices[rows], table[rows])

    def _made(self, takes: np.ndarray, known: Floats | None) -> Floats:
        groups = [np.flatnonzero(takes == kind) for kind in range(int(takes.max()) + 1)]
        made = [self.best_device(group, None if known is None else known) for group in groups if len(group)]
        return np.array(made)

    def best_device(self, group: Sequence[int] | np.ndarray, known: Floats | None = None) -> Floats:
        """The device (5,) with which the worst of some members is least, as heavy as the lightest of them carries.

        Differential evolution from the best devices of the library and those known.
        """
        mass = min(self.members[at].most_mass for at in group)
        space = hull([self.members[at].space(self.family, mass) for at in group])
        devices, table = self.library
        suited = devices[np.argsort(np.max(table[:, group], axis=1), kind="stable")[: _POPULATION // 2]]
        suited = suited if known is None else np.concatenate([known, suited])
        first = np.clip(space.units(_as_heavy(suited, mass)), 0.0, 1.0)[: _POPULATION // 2]
        rest = qmc.Sobol(space.size, seed=_SEED).random(_DRAWN)[: _POPULATION - len(first)]

        def worst(units: Floats) -> Floats:
            found = np.max(self._table(space.designs(units.T), group), axis=1)
            return np.where(np.isfinite(found), np.log(np.maximum(found, np.finfo(float).tiny)), np.log(_HUGE))

        found = differential_evolution(
            worst, [(0.0, 1.0)] * space.size, init=np.vstack([first, rest]), maxiter=_GENERATIONS, vectorized=True,
            updating="deferred", polish=False, seed=_SEED, tol=0.0, atol=_CONVERGED, mutation=(0.4, 0.9),
            recombination=0.9,
        )  # fmt: skip
        return np.asarray(space.designs(found.x[None])[0])


_HUGE = 1e30  # utilisation of what is not allowed


def _as_heavy(devices: Floats, mass: float) -> Floats:
    """Devices of another mass [kg] with the same frequencies and damping ratios; no spring is a very soft one."""
    return np.maximum(devices * (mass / devices[:, :1]), np.finfo(float).tiny)
