"""What a design is judged by: a number for every disturbance, and one for all of them together."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from frahm import readable
from frahm.arrays import Floats
from frahm.attractors import WorstCase
from frahm.design.host import Conditions

_RMS = 1 / math.sqrt(2)
_MODULATED = 1.08  # modulated peaks over the larger of the periodic one and the ceiling of the slow manifold
_MODULATED_RMS = 0.8  # rms of a modulated motion over that of a harmonic one of its largest amplitude
_MODULATED_MEAN = 1.3  # what a climate mean of an unstable design is raised by before it is known better


@dataclass(frozen=True)
class _Measure:
    """What is measured of the motions under one disturbance."""

    title: str
    unit: str = "m"
    over_climate: bool = False
    of_rms: bool = False
    of_damage: bool = False


_MEASURES = {
    "peak": _Measure("worst pipe peak"),
    "rms": _Measure("worst pipe rms", of_rms=True),
    "expected": _Measure("expected pipe peak", over_climate=True),
    "damage": _Measure("fatigue damage", "1", over_climate=True, of_damage=True),
}


@dataclass(frozen=True)
class Objective:
    """What is made small.

    Attributes
    ----------
    name : {"peak", "rms", "expected", "damage"}
    quantile : float or None
        Of the values over the disturbances; the largest if None.
    """

    name: str = "peak"
    quantile: float | None = None

    @property
    def _measure(self) -> _Measure:
        return _MEASURES[self.name]

    @property
    def unit(self) -> str:
        """Of its value."""
        return self._measure.unit

    @property
    def unit_text(self) -> str:
        """Unit for a sentence, with a blank behind it."""
        return "m " if self.unit == "m" else ""

    def shown(self, value: float) -> str:
        """A value for a sentence, in the unit engineers use."""
        return readable.length(value) if self.unit == "m" else f"{value:.3g}"

    @property
    def over_climate(self) -> bool:
        """Whether it is a mean over the wind climate."""
        return self._measure.over_climate

    @property
    def of_rms(self) -> bool:
        """Whether the rms of the pipe counts in place of its peak."""
        return self._measure.of_rms

    @property
    def of_damage(self) -> bool:
        """Whether it counts fatigue damage."""
        return self._measure.of_damage

    def at_worst(self, motion: WorstCase) -> float:
        """What counts of the worst motions of one mode [m]."""
        return motion.pipe_rms if self.of_rms else motion.pipe_peak

    @property
    def title(self) -> str:
        """In words."""
        if self.quantile is None:
            return self._measure.title
        return f"{self._measure.title}, {100 * self.quantile:g} % quantile over the scatter"

    def over_scatter(self, values: Floats) -> Floats:
        """One value of those (..., D) over the disturbances: the largest, or the quantile, never interpolated."""
        if self.quantile is None:
            return np.asarray(np.max(values, axis=-1))
        return np.asarray(np.quantile(values, self.quantile, axis=-1, method="higher"))

    def of_peaks(self, peaks: Floats, unstable: np.ndarray, ceilings: Floats) -> Floats:
        """Values (N, D) expected of periodic pipe peaks (N, D) [m].

        Where a response is unstable, the modulated motion that takes its place is expected a little above the larger of
        the periodic response and the ceiling (N,) [m] of the slow manifold.
        """
        modulated = _MODULATED * np.maximum(peaks, ceilings[:, None])
        if self.of_rms:
            return _RMS * np.where(unstable[:, None], _MODULATED_RMS * modulated, peaks)
        return np.where(unstable[:, None], modulated, peaks)

    def of_means(self, means: Floats, unstable: np.ndarray) -> Floats:
        """Values (N, D) expected of climate means (N, D) of the periodic responses."""
        return np.where(unstable[:, None], _MODULATED_MEAN * means, means)


@dataclass(frozen=True, eq=False)
class ClimateMean:
    """Mean over the wind climate of what a one-harmonic amplitude does.

    Attributes
    ----------
    conditions : Conditions
        Frequencies of the winds, a row for every disturbance; the output is what the amplitude is taken of.
    weights : ndarray, shape (W,)
        Of every wind.
    of_amplitude : callable
        From amplitudes (..., W) and frequencies (W,) to what is averaged.
    """

    conditions: Conditions
    weights: Floats
    of_amplitude: Callable[[Floats, Floats], Floats]

    def means(self, amplitudes: Floats) -> Floats:
        """Means (N, D) of amplitudes (N, D, W)."""
        return np.asarray(self.of_amplitude(amplitudes, self.conditions.frequency[0]) @ self.weights)
