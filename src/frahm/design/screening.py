"""Tier 1: many designs at once by the closed form of one harmonic, in threads."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.design.host import Conditions, Host
from frahm.design.kernels import births, largest_responses, screened

_BATCH = 2000


@dataclass(frozen=True, eq=False)
class Screening:
    """A host under conditions, ready to be asked about designs (D, 4): m [kg], k1 [N/m], k3 [N/m^3], c [N s/m].

    Attributes
    ----------
    host : Host
    conditions : Conditions
        Where the response counts.
    wide : Conditions
        Where detached curves are looked for; finer, because their range can be narrow.
    workers : int, optional
        Threads; one per core by default.
    """

    host: Host
    conditions: Conditions
    wide: Conditions
    workers: int | None = None

    def largest_pipe_amplitudes(self, designs: Floats, limit: float = math.inf) -> Floats:
        """Largest first-harmonic amplitude of the pipe [m], shape (D,), over all roots and conditions.

        A design that exceeds `limit` [m] at one frequency error is not followed to the next.
        """
        found = np.empty(len(designs))
        c = self.conditions

        def run(part: slice) -> None:
            largest_responses(c.frequency, c.a, c.u, c.b, c.x, designs[part], limit, found[part])

        self._in_threads(run, len(designs))
        return found

    def births(self, designs: Floats) -> Floats:
        """Least factor on the force [-] at which a detached curve is born, shape (D,); infinite where none is."""
        found = np.empty(len(designs))

        def run(part: slice) -> None:
            births(self.wide.frequency, self.wide.a, self.wide.u, designs[part], found[part])

        self._in_threads(run, len(designs))
        return found

    def births_by_error(self, design: Floats) -> Floats:
        """Least factor on the force [-] at which one design (4,) has a detached curve, for every frequency error."""
        found = np.empty((len(self.wide.errors), 1))
        for row, into in enumerate(found):
            part = slice(row, row + 1)
            births(self.wide.frequency[part], self.wide.a[part], self.wide.u[part], design[None], into)
        return found[:, 0]

    def responses(self, designs: Floats) -> tuple[Floats, Floats]:
        """Largest pipe amplitude [m] at every frequency error, (D, R); largest |Z| [m] and growth [1/s], (D, 2)."""
        found = np.empty((len(designs), 2))
        peaks = np.empty((len(designs), len(self.conditions.errors)))
        c, host = self.conditions, self.host
        mode = np.empty((len(c.errors), 3))
        mode[:, 0], mode[:, 1], mode[:, 2] = host.frequency * c.errors, host.modal_damping * c.errors, host.modal_mass

        def run(part: slice) -> None:
            screened(c.frequency, c.a, c.u, c.b, c.x, mode, designs[part], found[part], peaks[part])

        self._in_threads(run, len(designs))
        return peaks, found

    def _in_threads(self, run: Callable[[slice], None], count: int) -> None:
        parts = [slice(at, min(at + _BATCH, count)) for at in range(0, count, _BATCH)]
        if len(parts) == 1:
            run(parts[0])
            return
        with ThreadPoolExecutor(self.workers or os.cpu_count() or 1) as pool:
            for _ in pool.map(run, parts):
                pass


def fold_ceilings(screening: Screening, designs: Floats) -> Floats:
    """Largest |x| [m] the slow manifold admits at resonance before the motion jumps, shape (D,); NaN without a fold.

    m Omega^2 X = (k1 - m Omega^2 + n + i Omega c) Z has folds where 3 n^2 + 4 p n + p^2 + q^2 = 0 with
    p = k1 - m Omega^2 and q = Omega c: the smaller root is the upper fold of the pipe. The largest over all frequency
    errors is taken.
    """
    m, k1, k3, damper = designs.T[:, None, :]
    W = screening.host.frequency * screening.conditions.errors[:, None]
    p, q = k1 - m * W * W, W * damper
    inside = p * p - 3 * q * q
    folded = (k3 > 0) & (p < 0) & (inside > 0)
    n = (-2 * p - np.sqrt(np.where(folded, inside, 0.0))) / 3
    Z = np.sqrt(np.where(folded, n / np.where(k3 > 0, 0.75 * k3, 1.0), 0.0))
    ceilings = screening.host.output_ratio * Z * np.hypot(p + n, q) / (m * W * W)
    largest = np.max(np.where(folded, ceilings, 0.0), axis=0)
    return np.where(np.any(folded, axis=0), largest, np.nan)
