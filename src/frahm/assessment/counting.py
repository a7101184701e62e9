"""How the damage of a case over its wind climate is counted: winds, bins, initial states."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from frahm.assessment.detail import fatigue_section
from frahm.case import Case
from frahm.errors import check_count
from frahm.loads import operating_range, speed_window, wind_climate, wind_excitation

CALM, STORM = 1e-3, 200.0  # speeds between which wind is looked for [m/s]
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Counting:
    """What `fatigue_damage` is asked for, checked; what is left out is that of the case.

    Attributes
    ----------
    band : (float, float)
        Wind speeds that are counted [m/s].
    bins : int
        Wind bins.
    samples, seed : int
        Of the initial states at every wind.
    workers : int or None
        Threads; one per core if None.
    progress : callable or None
        Called with the number of winds done and the number of bins.
    """

    band: tuple[float, float]
    bins: int
    samples: int
    seed: int
    workers: int | None = None
    progress: Progress | None = None

    @classmethod
    def of(
        cls, case: Case, bins: int | None = None, *, wind: tuple[float, float] | None = None,
        samples: int | None = None, seed: int | None = None, workers: int | None = None,
        progress: Progress | None = None,
    ) -> Counting:  # fmt: skip
        """The counting of a case.

        Raises
        ------
        ParameterError
            If the case has no climate or no detail, or for bad input.
        """
        fatigue, _ = fatigue_section(case), wind_climate(case)
        bins = check_count("bins", fatigue.bins if bins is None else bins, at_least=4, at_most=2000)
        samples = check_count("samples", fatigue.samples if samples is None else samples, at_most=100_000)
        seed = check_count("seed", case.analysis.seed if seed is None else seed, at_least=0)
        workers = None if workers is None else check_count("workers", workers, at_most=1024)
        return cls(counted_band(case, wind), bins, samples, seed, workers, progress)

    def seen(self, done: int) -> None:
        """Tell that a number of winds is done."""
        if self.progress is not None:
            self.progress(min(done, self.bins), self.bins)


def counted_band(case: Case, given: tuple[float, float] | None = None) -> tuple[float, float]:
    """Wind speeds that are counted [m/s]: those given, those of the case, or those of its range of operation."""
    if given is None and case.fatigue is not None:
        given = case.fatigue.wind_speeds
    if given is not None:
        return speed_window(case, given)
    within = operating_range(case)
    if within.winds is not None:
        return within.winds
    excitation = wind_excitation(case)
    low, high = max(excitation.speed_range[0], CALM), min(excitation.speed_range[1], STORM)
    found = excitation.speed(np.array(within.frequency), low, high)
    ends = np.where(np.isnan(found), [low, high], found)
    return speed_window(case, (float(ends[0]), float(ends[1])))
