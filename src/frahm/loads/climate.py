"""How often the wind blows at which speed: probabilities of bands of speed, and how long it stays in one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats, frozen
from frahm.case import Case, Climate, Weibull
from frahm.errors import ParameterError, check_number

_TERMS = 200  # of the series for the persistence; the last one is below 1e-5 of the first
_TINY = 1e-12


@dataclass(frozen=True, eq=False)
class WindClimate:
    """Distribution of the wind speed, and the share of the winds that counts.

    Attributes
    ----------
    duration : float
        Time the pipe stands in this wind [s].
    weibull : Weibull or None
        Distribution P(speed > U) = exp[-(U/c)^k]; None for a table.
    edges : ndarray, shape (m + 1,)
        Ends of the classes of a table [m/s]: half-way between its speeds; the outer classes are as wide to both sides,
        but do not reach below zero. Inside a class every speed is as probable.
    shares, counted : ndarray, shape (m,)
        Probability of each class, and that of its winds from the sector that counts.
    direction_factor : float
        Share of the winds that counts, apart from the sector.
    correlation_time : float
        T_c [s], see `persistence`.
    """

    duration: float
    weibull: Weibull | None
    edges: Floats
    shares: Floats
    counted: Floats
    direction_factor: float
    correlation_time: float

    def cumulative(self, speed: ArrayLike) -> Floats:
        """P(speed <= U) of all winds [-], whatever their direction."""
        return self._cumulative(speed, self.shares)

    def probability(self, low: ArrayLike, high: ArrayLike) -> Floats:
        """Share of the time in which a wind that counts blows at a speed between `low` and `high` [m/s].

        For a Weibull distribution f (exp[-(U1/c)^k] - exp[-(U2/c)^k]), f the direction factor.
        """
        if self.weibull is not None:
            c, k = self.weibull.scale, self.weibull.shape
            first, last = (np.maximum(np.asarray(edge, dtype=float), 0.0) / c for edge in (low, high))
            return self.direction_factor * (np.exp(-(first**k)) - np.exp(-(last**k)))
        between = self._cumulative(high, self.counted) - self._cumulative(low, self.counted)
        return self.direction_factor * between

    def density(self, speed: ArrayLike) -> Floats:
        """Probability per speed [s/m] of the winds that count."""
        U = np.asarray(speed, dtype=float)
        if self.weibull is not None:
            c, k = self.weibull.scale, self.weibull.shape
            with np.errstate(divide="ignore", invalid="ignore"):
                inside = k / c * (U / c) ** (k - 1) * np.exp(-((np.maximum(U, 0) / c) ** k))
            return self.direction_factor * np.where(U > 0, inside, 0.0)
        place = np.searchsorted(self.edges, U, side="right") - 1
        inside = (place >= 0) & (place < self.counted.size)
        values = (self.counted / np.diff(self.edges))[np.clip(place, 0, self.counted.size - 1)]
        return self.direction_factor * np.where(inside, values, 0.0)

    def _cumulative(self, speed: ArrayLike, shares: Floats) -> Floats:
        U = np.asarray(speed, dtype=float)
        if self.weibull is not None:
            return -np.expm1(-((np.maximum(U, 0.0) / self.weibull.scale) ** self.weibull.shape))
        return np.interp(U, self.edges, np.concatenate([[0.0], np.cumsum(shares)]))


@dataclass(frozen=True)
class Persistence:
    """How long the wind stays in a band of speeds. Secondary: a simple model with an assumed correlation time.

    The speed, made normal by its own distribution, is taken as a diffusion with the correlation time T_c. In a band
    between the normal quantiles g1 and g2, narrow against one, it stays (g2 - g1)^2 T_c/12 on average, and longer than
    t in a share (8/pi^2) sum_(n odd) exp[-(n pi/(g2 - g1))^2 t/T_c]/n^2 of the time it is there.

    Attributes
    ----------
    probability : float
        Share of the time in the band, winds that count only [-].
    mean_stay : float
        Mean time until the speed leaves the band [s].
    build_up : float
        Time the response needs to build up, 1/(zeta omega) [s].
    share_built_up : float
        Share of the time in the band that belongs to stays with at least the time `build_up` still to come [-].
    """

    probability: float
    mean_stay: float
    build_up: float
    share_built_up: float


def wind_climate(case: Case) -> WindClimate:
    """Wind climate of a case.

    Raises
    ------
    ParameterError
        If the case has no section `climate`.
    """
    climate = case.climate
    if climate is None:
        hint = "climate: {duration: 20 year, weibull: {scale: ..., shape: ...}}."
        raise ParameterError("climate", None, "a case with the section climate", hint=hint)
    edges, shares, counted = (np.zeros(1), np.zeros(0), np.zeros(0)) if climate.weibull else _classes(climate)
    return WindClimate(
        duration=climate.duration,
        weibull=climate.weibull,
        edges=frozen(edges),
        shares=frozen(shares),
        counted=frozen(counted),
        direction_factor=climate.direction_factor,
        correlation_time=climate.correlation_time,
    )


def persistence(climate: WindClimate, low: float, high: float, build_up: float) -> Persistence:
    """How long the wind stays between `low` and `high` [m/s], against the time a response needs to build up [s]."""
    from scipy.special import ndtri  # takes long to load

    low = check_number("low", low, at_least=0, unit="m/s")
    high = check_number("high", high, above=low, unit="m/s")
    time = check_number("build_up", build_up, above=0, unit="s") if math.isfinite(build_up) else build_up
    width = float(np.diff(ndtri(np.clip(climate.cumulative([low, high]), _TINY, 1 - _TINY)))[0])
    odd = np.arange(1, 2 * _TERMS, 2)
    rate = (np.pi / width) ** 2 / climate.correlation_time if width > 0 else math.inf
    lasting = 0.0 if math.isinf(time) or math.isinf(rate) else 8 / np.pi**2 * float(
        np.sum(np.exp(-(odd**2) * rate * time) / odd**2)
    )  # fmt: skip
    return Persistence(
        probability=float(climate.probability(low, high)),
        mean_stay=width**2 * climate.correlation_time / 12,
        build_up=time,
        share_built_up=lasting,
    )


def _classes(climate: Climate) -> tuple[Floats, Floats, Floats]:
    """Edges of the classes of speed, probability of each, and of its winds from the sector that counts."""
    rows = climate.table
    total = math.fsum(row.probability for row in rows)
    speeds = np.unique([row.speed for row in rows])
    shares, counted = np.zeros(speeds.size), np.zeros(speeds.size)
    for row in rows:
        place = int(np.searchsorted(speeds, row.speed))
        shares[place] += row.probability / total
        if _in_sector(row.direction, climate.sector):
            counted[place] += row.probability / total
    middles = 0.5 * (speeds[1:] + speeds[:-1])
    first, last = max(0.0, 2 * speeds[0] - middles[0]), 2 * speeds[-1] - middles[-1]
    return np.concatenate([[first], middles, [last]]), shares, counted


def _in_sector(direction: float | None, sector: tuple[float, float] | None) -> bool:
    """Whether a direction lies in a sector, which goes clockwise from its first to its second direction [rad]."""
    if direction is None or sector is None:
        return True
    turn = 2 * math.pi
    return (direction - sector[0]) % turn <= (sector[1] - sector[0]) % turn + _TINY
