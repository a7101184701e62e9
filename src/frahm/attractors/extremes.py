"""The largest displacement that a motion which never repeats reaches in a stated time, from shorter stretches of it.

What peaks over equal stretches exceed a high threshold by follows the generalised Pareto distribution
P(excess <= y) = 1 - (1 - k y / alpha)^(1/k), whose parameters come from two probability-weighted moments: Hosking and
Wallis, Technometrics 29 (1987) 339-349. Only the highest peaks enter: chaos that bursts has two kinds of stretches, and
the quiet ones say nothing of how large the bursts are.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.stats import chi2

from frahm.arrays import Floats

DURATION = 10_000  # periods of the forcing: three and a half hours of the pipe of the paper
HIGHEST = 3 / 16  # share of the peaks that enters
_RUN = 5  # neighbouring stretches that are drawn together: what lasts longer than one of them stays together
_DRAWS, _SHARE = 1000, 5 / 8  # of the bootstrap: draws, and runs in each of them over all runs
_TAIL = 0.025
_FLAT = 1e-6  # shape k below which the distribution is exponential


class Level(NamedTuple):
    """Level exceeded once, on average, in a stated time, and its 95 % interval."""

    value: float
    interval: tuple[float, float]


def expected_peak(peaks: Floats, stretches: float) -> Level:
    """Level that the peak of one in `stretches` stretches exceeds.

    Parameters
    ----------
    peaks : ndarray, shape (m, S)
        Peaks of m motions over S consecutive stretches each, S being 5 at least.
    stretches : float
        How many stretches the stated time has, more than 16/3.

    Returns
    -------
    Level
        The interval is that of a bootstrap over runs of five stretches that draws five eighths of them: drawing all
        gives intervals that are too short for so few excesses.
    """
    runs = peaks[:, : peaks.shape[1] // _RUN * _RUN].reshape(-1, _RUN)
    drawn = np.random.default_rng(0).integers(len(runs), size=(_DRAWS, int(np.ceil(_SHARE * len(runs)))))
    levels = return_level(runs[drawn].reshape(_DRAWS, -1), stretches)
    low, high = np.quantile(levels, [_TAIL, 1 - _TAIL])
    value = float(return_level(peaks.reshape(1, -1), stretches)[0])
    return Level(value, (min(float(low), value), max(float(high), value)))


def return_level(peaks: Floats, stretches: float) -> Floats:
    """Level exceeded by one in `stretches` of the peaks (N, m), by the fit to each of the N samples, shape (N,)."""
    m = peaks.shape[1]
    count = max(int(HIGHEST * m), 2)
    ordered = np.sort(peaks, axis=1)
    threshold = ordered[:, -count - 1]
    excess = ordered[:, -count:] - threshold[:, None]
    a0 = np.mean(excess, axis=1)
    a1 = np.mean(excess * (count - 1 - np.arange(count)) / (count - 1), axis=1)
    flat = a0 <= 1e-12 * np.abs(threshold)
    ratio = np.where(flat, 3.0, a0 / np.where(flat, 1.0, a0 - 2 * a1))
    k = np.where(np.abs(ratio - 2) < _FLAT, _FLAT, ratio - 2)
    alpha = 2 * a1 * ratio
    return np.asarray(threshold + alpha / k * (1 - (stretches * count / m) ** -k))


def poisson_interval(count: int, exposure: float) -> tuple[float, float]:
    """95 % interval of the rate of events of which `count` were seen in `exposure` (Garwood)."""
    if not exposure > 0:
        return 0.0, float("inf")
    low = float(chi2.ppf(_TAIL, 2 * count)) / 2 if count else 0.0
    return low / exposure, float(chi2.ppf(1 - _TAIL, 2 * count + 2)) / 2 / exposure
