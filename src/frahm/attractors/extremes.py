"""The largest displacement that a motion which never repeats reaches in a stated time, from stretches of a longer one.

What one in so many equal stretches exceeds is a quantile of their peaks, and is read off them: of n independent ones a
binomial number lies above it, whatever their distribution is. Neighbouring stretches are not independent where chaos
bursts; how much their number counts for is seen from how unevenly high peaks fall to blocks of them.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import binom, chi2

from frahm.arrays import Floats

DURATION = 10_000  # periods of the forcing: three and a half hours of the pipe of the paper
_HIGH = 0.05  # share of the peaks whose spread over the blocks is looked at
_TAIL = 0.025
_FLAT = 1e-9  # of the largest peak: what differs by less is one


class Level(NamedTuple):
    """Level exceeded once, on average, in a stated time, and its 95 % interval: open above if too little is seen."""

    value: float
    interval: tuple[float, float]


class RarePeaks:
    """Levels of the pipe and of the first element, found when they are first asked for: that takes long motions.

    Parameters
    ----------
    find : callable
        Finds both.
    """

    def __init__(self, find: Callable[[], tuple[Level, Level]]):
        self._find = find

    @classmethod
    def known(cls, pipe: float, relative: float) -> RarePeaks:
        """Of a motion whose peaks are always the same, or of one that nothing is known of."""
        return cls.of((Level(pipe, (pipe, pipe)), Level(relative, (relative, relative))))

    @classmethod
    def of(cls, levels: tuple[Level, Level]) -> RarePeaks:
        """Those that have been found."""
        return cls(lambda: levels)

    def __reduce__(self) -> tuple[Any, ...]:
        return RarePeaks.of, (self.levels,)  # compiled code in another process could not go on from addresses of this

    @functools.cached_property
    def levels(self) -> tuple[Level, Level]:
        """Of the pipe, and of the first element."""
        return self._find()


def expected_peak(peaks: Floats, stretches: float) -> Level:
    """Level that the peak of one in `stretches` stretches exceeds.

    Parameters
    ----------
    peaks : ndarray, shape (B, S)
        Peaks over blocks of S consecutive stretches each.
    stretches : float
        How many stretches the stated time has.

    Returns
    -------
    Level
        The interval lies between two of the peaks: as many exceed its ends as a binomial number with the stretches'
        effective number leaves possible. Its upper end is infinite where the stretches are too few to exclude that
        none has reached the level.
    """
    ordered = np.sort(peaks.ravel())[::-1]
    value = float(np.interp(ordered.size / stretches, np.arange(ordered.size) + 0.5, ordered))
    if ordered[0] - ordered[-1] <= _FLAT * ordered[0]:
        return Level(value, (value, value))
    fewest, most = _above(peaks, stretches)
    low = float(ordered[min(most, ordered.size - 1)])
    high = float(ordered[fewest - 1]) if fewest else float("inf")
    return Level(value, (min(low, value), max(high, value)))


def enough(peaks: Floats, stretches: float) -> bool:
    """Whether peaks (B, S) bound the level from above; see `expected_peak`."""
    return bool(np.ptp(peaks) <= _FLAT * np.max(peaks) or _above(peaks, stretches)[0] > 0)


def _above(peaks: Floats, stretches: float) -> tuple[int, int]:
    """Fewest and most of the peaks that may lie above the level."""
    unevenness = _unevenness(peaks)
    count = int(peaks.size / unevenness)
    fewest, most = binom.ppf([_TAIL, 1 - _TAIL], count, 1 / stretches)
    return int(np.ceil(fewest * unevenness)), int(np.ceil((most + 1) * unevenness)) - 1


def _unevenness(peaks: Floats) -> float:
    """Variance of the number of high peaks in a block over that of independent ones, 1 at least."""
    share = max(_HIGH, 1 / peaks.size)
    high = np.count_nonzero(peaks > np.quantile(peaks, 1 - share), axis=1)
    mean = float(np.mean(high))
    if not mean > 0:
        return 1.0
    return max(1.0, float(np.var(high, ddof=1)) / (mean * (1 - share)))


def poisson_interval(count: int, exposure: float) -> tuple[float, float]:
    """95 % interval of the rate of events of which `count` were seen in `exposure` (Garwood)."""
    if not exposure > 0:
        return 0.0, float("inf")
    low = float(chi2.ppf(_TAIL, 2 * count)) / 2 if count else 0.0
    return low / exposure, float(chi2.ppf(1 - _TAIL, 2 * count + 2)) / 2 / exposure
