"""Tier 1: many designs at once by the closed form of one harmonic, in threads.

Absorbers that hang elsewhere than the one where the governing mode moves most are screened as if the pipe moved in that
mode alone: one where it moves rho times as much is the same as one beside that, with rho^2 times the mass, damping and
linear stiffness, rho^4 times the cubic stiffness and rho^6 times that of the fifth power. On a pipe of one mode this is
exact. As rho is 1 at most, one at a node counts for nothing, as it should.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from frahm.arrays import Floats
from frahm.design.groups import group_amplitudes, group_births, group_responses
from frahm.design.host import Conditions, Host
from frahm.design.kernels import amplitude_tables, births, largest_responses, screened
from frahm.design.objective import ClimateMean

_BATCH, _GROUPS = 2000, 6  # designs a thread takes at once, of one absorber and of several
_AT_NODE = 1e-6  # least ratio of motions: an absorber that hangs where one is less feels nothing, and has a mass still
_POWERS = np.array([2, 2, 4, 2, 6])  # of the ratio of motions that m, k1, k3, c, k5 grow with


@dataclass(frozen=True, eq=False)
class Screening:
    """A host under conditions, ready to be asked about designs (D, 5 N).

    A design is m [kg], k1 [N/m], k3 [N/m^3], c [N s/m], k5 [N/m^5] of the first absorber, then of the next.

    Attributes
    ----------
    host : Host
    conditions : Conditions
        Where the response counts.
    wide : Conditions
        Where detached curves are looked for; finer, because their range can be narrow.
    climate : ClimateMean, optional
        Mean over the wind climate, if one is asked for.
    others : tuple of Screening
        The other modes that winds excite, each under the same disturbances and forces.
    workers : int, optional
        Threads; one per core by default.
    """

    host: Host
    conditions: Conditions
    wide: Conditions
    climate: ClimateMean | None = None
    others: tuple[Screening, ...] = ()
    workers: int | None = None

    @property
    def forces(self) -> Floats:
        """Factors on the force [-] in the rows of every mode, (R,): those of the first mode, then of the next."""
        return np.concatenate([mode.conditions.forces for mode in (self, *self.others)])

    def reloaded(self, margin: float) -> Screening:
        """The same with another factor on the force where it is not 1."""
        others = tuple(mode.reloaded(margin) for mode in self.others)
        return replace(self, conditions=self.conditions.reloaded(margin), others=others)

    def largest_pipe_amplitudes(self, designs: Floats, limit: float = math.inf) -> Floats:
        """Largest first-harmonic amplitude of the pipe [m], shape (D,), over all roots and conditions.

        A design that exceeds `limit` [m] at one frequency error is not followed to the next.
        """
        found = np.empty(len(designs))
        c = self.conditions

        def run(part: slice) -> None:
            largest_responses(*c.arrays, designs[part], limit, found[part])

        self._in_threads(run, len(designs))
        return found

    def births(self, designs: Floats) -> Floats:
        """Least factor on the force [-] at which a detached curve is born, shape (D,); infinite where none is."""
        found, wide = np.empty(len(designs)), self.wide

        groups = self._groups(designs)

        def run(part: slice) -> None:
            if groups is None:
                births(wide.frequency, wide.a, wide.u, wide.absorber, designs[part], found[part])
            else:
                group_births(wide.frequency, wide.a, wide.u, wide.absorber, groups[part], found[part])

        self._in_threads(run, len(designs), groups is not None)
        return np.min([found, *(mode.births(designs) for mode in self.others)], axis=0)

    def births_by_condition(self, design: Floats) -> Floats:
        """Least factor on the force [-] at a birth of one design (5,), for every mode and every disturbance."""
        wide = self.wide
        found = np.empty((len(wide.disturbances), 1))
        groups = self._groups(design[None])
        for row, into in enumerate(found):
            part = slice(row, row + 1)
            asked = wide.frequency[part], wide.a[part], wide.u[part], wide.absorber[part]
            if groups is None:
                births(*asked, design[None], into)
            else:
                group_births(*asked, groups, into)
        return np.concatenate([found[:, 0], *(mode.births_by_condition(design) for mode in self.others)])

    def responses(self, designs: Floats) -> tuple[Floats, Floats]:
        """Largest pipe amplitude [m] in every row of every mode, (D, R); largest |Z| [m] and growth [1/s], (D, 2)."""
        found = np.empty((len(designs), 2))
        peaks = np.empty((len(designs), len(self.conditions.forces)))
        c, host = self.conditions, self.host
        mode = np.empty((len(c.forces), 3))
        mode[:, 0] = host.frequency * c.pipe_frequencies
        mode[:, 1] = host.modal_damping * c.pipe_frequencies * c.pipe_dampings
        mode[:, 2] = host.modal_mass

        groups, given, ratios = self._groups(designs), c.first_force, self._ratios

        def run(part: slice) -> None:
            if groups is None:
                screened(*c.arrays, mode, designs[part], found[part], peaks[part])
            else:
                rows = mode[: len(given.forces)]
                group_responses(*given.arrays, rows, c.steps, groups[part], ratios, found[part], peaks[part])

        self._in_threads(run, len(designs), groups is not None)
        parts = [(peaks, found), *(mode.responses(designs) for mode in self.others)]
        return np.hstack([part for part, _ in parts]), np.max([largest for _, largest in parts], axis=0)

    def climate_means(self, designs: Floats) -> Floats:
        """Means over the wind climate, (D, disturbances): the sums over the modes that have one."""
        mean = self.climate
        if mean is None:
            return np.empty((len(designs), 0))
        others = [mode.climate_means(designs) for mode in self.others if mode.climate is not None]
        found = np.empty((len(designs), len(mean.conditions.disturbances)))
        groups = self._groups(designs)

        def run(part: slice) -> None:
            tables = np.empty((part.stop - part.start, *mean.conditions.frequency.shape))
            if groups is None:
                amplitude_tables(*mean.conditions.arrays, designs[part], tables)
            else:
                group_amplitudes(*mean.conditions.arrays, groups[part], tables)
            found[part] = mean.means(tables)

        self._in_threads(run, len(designs), groups is not None)
        return np.asarray(np.sum([found, *others], axis=0))

    def _groups(self, designs: Floats) -> Floats | None:
        """Designs (D, N, 5) as if all absorbers hung at one place; None for one absorber."""
        groups = np.reshape(designs, (len(designs), -1, 5))
        if groups.shape[1] == 1:
            return None
        return np.asarray(groups * self._ratios[:, None] ** _POWERS)

    @property
    def _ratios(self) -> Floats:
        """Motion of the governing mode where each absorber hangs over that where it moves most [-], (N,)."""
        return np.maximum(np.abs(self.host.ratios), _AT_NODE)

    def _in_threads(self, run: Callable[[slice], None], count: int, of_groups: bool = False) -> None:
        batch = _GROUPS if of_groups else _BATCH
        parts = [slice(at, min(at + batch, count)) for at in range(0, count, batch)]
        if len(parts) == 1:
            run(parts[0])
            return
        with ThreadPoolExecutor(self.workers or os.cpu_count() or 1) as pool:
            for _ in pool.map(run, parts):
                pass


def fold_ceilings(screening: Screening, designs: Floats) -> Floats:
    """Largest |x| [m] the slow manifold admits at resonance before the motion jumps, shape (D,); NaN without a fold.

    m Omega^2 X = (k1 - m Omega^2 + n + i Omega c) Z has folds where 3 n^2 + 4 p n + p^2 + q^2 = 0 with
    p = k1 - m Omega^2 and q = Omega c, n = 3/4 k3 |Z|^2: the smaller root is the upper fold of the pipe. The largest
    over all absorbers, disturbances and modes is taken. A part of the fifth power is left out.
    """
    largest = np.zeros(len(designs))
    for mode in (screening, *screening.others):
        for at, ratio in enumerate(np.abs(mode.host.ratios)):
            if ratio and math.isfinite(mode.host.output_ratio):
                part = designs[:, 5 * at : 5 * at + 5]
                largest = np.maximum(largest, _ceilings(mode.host, mode.conditions, part) / ratio)
    return np.where(largest > 0, largest, np.nan)


def _ceilings(host: Host, conditions: Conditions, designs: Floats) -> Floats:
    """Of one absorber where one mode moves most [m], (D,); 0 without a fold."""
    m, k1, k3, damper, _ = designs.T[:, None, :]
    springs, dampers = conditions.absorber.T[:, :, None]
    W = host.frequency * conditions.pipe_frequencies[:, None]
    p, q = springs * k1 - m * W * W, W * dampers * damper
    inside = p * p - 3 * q * q
    folded = (k3 > 0) & (p < 0) & (inside > 0)
    n = (-2 * p - np.sqrt(np.where(folded, inside, 0.0))) / 3
    Z = np.sqrt(np.where(folded, n / np.where(k3 > 0, 0.75 * springs * k3, 1.0), 0.0))
    ceilings = host.output_ratio * Z * np.hypot(p + n, q) / (m * W * W)
    return np.asarray(np.max(np.where(folded, ceilings, 0.0), axis=0))
