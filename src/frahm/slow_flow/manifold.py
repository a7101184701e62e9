"""Slow invariant manifold: where the fast motion settles, its folds, the jumps and the ceilings they set."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats
from frahm.slow_flow.model import SlowFlow


@dataclass(frozen=True)
class Folds:
    """Folds of the slow invariant manifold and the jumps between its branches.

    Amplitudes are [m]; the modulated response runs up the lower branch to the upper fold, jumps to the high branch,
    slides down to the lower fold and jumps back.

    Attributes
    ----------
    nu : tuple of float
        3/4 kappa |Z|^2 / (rho2 Omega^2) at both folds, ascending: (2 -+ sqrt(1 - 3 lambda^2))/3.
    pipe : tuple of float
        |X| at both folds, in the order of `nu`: the first is the ceiling of the modulated pipe response.
    relative : tuple of float
        |Z| at both folds.
    landing : tuple of float
        |Z| reached by the jump from each fold, 3/4 kappa |Z|^2 = (2 - 2 nu) rho2 Omega^2.
    """

    nu: tuple[float, float]
    pipe: tuple[float, float]
    relative: tuple[float, float]
    landing: tuple[float, float]

    @property
    def pipe_ceiling(self) -> float:
        """Largest |X| [m] the slow manifold admits before the motion jumps: bound of the modulated pipe response."""
        return self.pipe[0]

    @property
    def relative_ceiling(self) -> float:
        """|Z| [m] after the jump from the upper fold: bound of the modulated stroke."""
        return self.landing[0]


@dataclass(frozen=True)
class SlowManifold:
    """Relation between |X| and |Z| once the fast motion has decayed (paper Eq. 12, doi 10.3390/app12147272).

    rho2 W^2 X = (3/4 kappa |Z|^2 + i W xi2 - rho2 W^2) Z, with W = omega in the paper's form, Omega in the averaged.

    Attributes
    ----------
    slow : SlowFlow
        Parameters.
    frequency : float
        W [rad/s].
    """

    slow: SlowFlow
    frequency: float

    @property
    def lam(self) -> float:
        """lambda = xi2/(rho2 W) [-]; folds exist below 1/sqrt(3)."""
        return self.slow.xi2 / (self.slow.rho2 * self.frequency)

    def pipe_amplitude(self, relative_amplitude: ArrayLike) -> Floats:
        """|X| [m] on the manifold for |Z| [m]."""
        Z = np.asarray(relative_amplitude, dtype=float)
        nu = 0.75 * self.slow.kappa * Z**2 / self._scale
        return np.asarray(Z * np.hypot(1 - nu, self.lam))

    @property
    def folds(self) -> Folds | None:
        """Folds and jumps, or None where the manifold has none (lambda >= 1/sqrt(3), or no hardening spring)."""
        inside = 1 - 3 * self.lam**2
        if inside <= 0 or self.slow.kappa <= 0:
            return None
        root = math.sqrt(inside)
        # (2 - sqrt(..))/3 in a form without cancellation
        nu = ((1 + self.lam**2) / (2 + root), (2 + root) / 3)
        relative = tuple(self._amplitude(v) for v in nu)
        pipe = tuple(float(self.pipe_amplitude(Z)) for Z in relative)
        landing = tuple(self._amplitude(2 - 2 * v) for v in nu)
        return Folds(nu, pipe, relative, landing)  # type: ignore[arg-type]

    @property
    def reach(self) -> float:
        """Largest |Z| [m] worth showing: a little beyond the jumps."""
        if self.folds is not None:
            return 1.35 * max(self.folds.landing)
        return float(1.6 * np.sqrt(self._scale / (0.75 * self.slow.kappa)))

    @property
    def _scale(self) -> float:
        return self.slow.rho2 * self.frequency**2

    def _amplitude(self, nu: float) -> float:
        return math.sqrt(max(nu, 0.0) * self._scale / (0.75 * self.slow.kappa))


def slow_manifold(slow: SlowFlow, frequency: float | None = None) -> SlowManifold:
    """Slow invariant manifold at Omega = `frequency` [rad/s]; the paper's form knows only omega (the default)."""
    if frequency is None or slow.form == "paper":
        frequency = slow.omega
    return SlowManifold(slow, frequency)
