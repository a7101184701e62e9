"""What a design meets that it was not designed for: another pipe, another absorber, another force."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from frahm.case import Scatter
from frahm.systems import Element, System

_STEP = 0.05  # of the pipe's frequency: at which a design is searched and verified, refined beside the worst
_NOMINAL = 1.0


@dataclass(frozen=True, order=True)
class Disturbance:
    """Factors on pipe, absorber and force, 1 as designed for.

    Attributes
    ----------
    pipe_frequency : float
        r: natural frequency of the pipe over the nominal one [-]; its damping ratio stays.
    pipe_damping : float
        On the damping ratio of the pipe [-].
    kappa : float
        On the spring of the absorber, linear and nonlinear part alike [-].
    xi2 : float
        On its damper [-].
    force : float
        On the force [-].
    lock_in : bool
        Whether the force grows with the square of `pipe_frequency`: the wind locks in at a speed in proportion to it.
    others : int
        Number of the absorbers, from the last, that are not designed: their springs and dampers stay as they are.
    """

    pipe_frequency: float = _NOMINAL
    pipe_damping: float = _NOMINAL
    kappa: float = _NOMINAL
    xi2: float = _NOMINAL
    force: float = _NOMINAL
    lock_in: bool = True
    others: int = 0

    @property
    def load(self) -> float:
        """Factor on the force, lock-in included [-]."""
        return self.force * (self.pipe_frequency**2 if self.lock_in else 1.0)

    @property
    def text(self) -> str:
        """What is off, for a sentence; empty if nothing is."""
        words = {"pipe_frequency": "the pipe's frequency", "pipe_damping": "its damping", "kappa": "the spring",
                 "xi2": "the damper", "force": "the force"}  # fmt: skip
        off = [f"{words[name]} {100 * (getattr(self, name) - 1):+.3g} %" for name in words if getattr(self, name) != 1]
        return ", ".join(off)

    def at_force(self, factor: float) -> Disturbance:
        """The same with a further factor on the force."""
        return replace(self, force=self.force * factor)

    def of(self, system: System) -> System:
        """The system under it."""
        if self == Disturbance(lock_in=self.lock_in, others=self.others):
            return system
        r = self.pipe_frequency
        reference = r * system.reference_frequency
        elements = list(system.elements)
        if self.kappa != 1 or self.xi2 != 1:
            for at, element in enumerate(elements[: max(len(elements) - self.others, 0)]):
                elements[at] = Element(element.direction, element.law.scaled(self.kappa, self.xi2))
        return System(
            system.mass, r * self.pipe_damping * system.damping, r**2 * system.stiffness, self.load * system.forcing,
            elements, system.output, reference, system.name,
        )  # fmt: skip


def disturbances(
    scatter: Scatter, quantile: float | None, samples: int, seed: int, *, lock_in: bool = True, others: int = 0
) -> list[Disturbance]:
    """The conditions a design is judged under; the nominal one first where the worst counts.

    If the pipe's frequency alone scatters and the worst counts: a grid over it. Otherwise a scrambled Sobol sample of
    the box of all that scatters, uniform; where the worst counts also its corners and its centre.
    """
    names = scatter.names
    nominal = Disturbance(lock_in=lock_in, others=others)
    if not names:
        return [nominal]
    if names == ("pipe_frequency",) and quantile is None:
        s = scatter.pipe_frequency
        count = 1 + 2 * math.ceil(s / _STEP - 1e-9)
        ratios = np.linspace(1 - s, 1 + s, count)
        ratios[count // 2] = _NOMINAL  # rounding may miss it, and the pipe as given is one of them
        return [replace(nominal, pipe_frequency=float(r)) for r in ratios]
    from scipy.stats import qmc

    widths = np.array([getattr(scatter, name) for name in names])
    sobol = qmc.Sobol(len(names), seed=seed)
    units = sobol.random_base2(math.ceil(math.log2(samples)))[:samples]
    factors = 1 + (2 * units - 1) * widths
    if quantile is None:
        corners = 1 + np.array(list(itertools.product((-1.0, 1.0), repeat=len(names)))) * widths
        factors = np.concatenate([np.ones((1, len(names))), corners, factors])
    rows: list[dict[str, Any]] = [dict(zip(names, map(float, row), strict=True)) for row in factors]
    return [replace(nominal, **row) for row in rows]
