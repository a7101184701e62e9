"""The range of operation: every excitation a member can meet, as one object that all verbs take.

Either winds, each with its own shedding frequency and lift, or a window of the excitation frequency at one fixed lift
(the setting of doi 10.3390/app12147272).
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.loads.over_wind import WindExcitation

SAME = 1e-9  # relative difference below which two winds are one
HALF = 0.5  # what a range is widened by when its worst is put to the test
_KNOTS = 200  # of the lift over the frequency where a table bends it; a cubic between them is exact to about 1e-10
_CALM, _STORM = 1e-3, 1e3  # times the winds of a range: where a site has no bound nothing is stretched beyond
_NEAR_ZERO = 0.5  # a window widened below zero frequency ends at this share of its lower end instead


@dataclass(frozen=True, eq=False)
class OperatingRange:
    """Excitations over which something is asked; immutable.

    Attributes
    ----------
    frequency : (float, float)
        Lowest and highest excitation frequency Omega [rad/s].
    reference : float
        Frequency the detuning counts from [rad/s]; NaN where a system has none.
    wind : (float, float) or None
        Wind speeds that shed at the ends [m/s], the higher one first where the shedding frequency falls with the wind;
        None for a window of the frequency at one fixed lift.
    law : WindExcitation or None
        Shedding frequency and lift over the wind.
    lift : float
        Lift at the wind of the case [N], which `factor` counts from.
    site : (float, float)
        Lowest and highest wind that can occur [m/s]; nothing is asked beyond.
    basis : tuple of str
        Sentences that say where the ends come from.
    moves : bool
        Whether the range was made from the natural frequencies, so that it moves with them.
    doubts : tuple of str
        Sentences that say why nothing found over the range is verified; empty if it is what the site asks for.
    held : float
        Wind [m/s] that is locked in to the mode over the range, with its own lift; NaN where there is none.
    band : (float, float) or None
        Frequencies [rad/s] that are asked about where the site has the winds for them; None: those of the range.
    """

    frequency: tuple[float, float]
    reference: float
    wind: tuple[float, float] | None = None
    law: WindExcitation | None = None
    lift: float = 1.0
    site: tuple[float, float] = (0.0, math.inf)
    basis: tuple[str, ...] = ()
    moves: bool = False
    doubts: tuple[str, ...] = ()
    band: tuple[float, float] | None = None
    held: float = math.nan

    @property
    def asked(self) -> tuple[float, float]:
        """Frequencies [rad/s] of the range, and those that only the site's winds keep out of it."""
        band = self.band or self.frequency
        return min(band[0], self.frequency[0]), max(band[1], self.frequency[1])

    @property
    def over_wind(self) -> bool:
        """Whether shedding frequency and lift follow the wind."""
        return self.wind is not None

    @property
    def winds(self) -> tuple[float, float] | None:
        """Lowest and highest wind [m/s]; None for a window of the frequency at one fixed lift."""
        return None if self.wind is None else (min(self.wind), max(self.wind))

    @property
    def detuning(self) -> tuple[float, float]:
        """Lowest and highest detuning sigma = Omega - omega [rad/s]."""
        return self.frequency[0] - self.reference, self.frequency[1] - self.reference

    @functools.cached_property
    def factor(self) -> Floats | None:
        """Lift over `lift` as a function of Omega; None where it is fixed.

        Shape (knots, 5): Omega [rad/s] and the coefficients of a cubic from there on; none where there is no lift.
        """
        if self.wind is None or self.law is None:
            return None
        return _factor(self.law, self.lift, *self.wind)

    def lift_factor(self, frequency: float) -> float:
        """Lift over `lift` [-] at Omega [rad/s], by the cubics of `factor`."""
        rows = self.factor
        if rows is None:
            return 1.0
        if not len(rows):
            return 0.0
        row = int(np.clip(np.searchsorted(rows[:, 0], frequency, side="right") - 1, 0, len(rows) - 2))
        return float(np.polyval(rows[row, :0:-1], frequency - rows[row, 0]))

    def speed(self, frequency: Any) -> Floats:
        """Wind speed [m/s] that sheds at Omega [rad/s], inside the range; NaN where the lift is fixed."""
        W = np.asarray(frequency, dtype=float)
        if self.wind is None or self.law is None:
            return np.full(W.shape, self.held)
        return self.law.speed(np.clip(W, *self.frequency), *self.wind)

    def part(self, lo: float, hi: float) -> OperatingRange:
        """The part of the range between two frequencies [rad/s]."""
        ends = max(lo, self.frequency[0]), min(hi, self.frequency[1])
        if self.wind is None:
            return replace(self, frequency=ends)
        speeds = self.speed(np.array(ends))
        wind = tuple(old if edge == W else float(U)
                     for old, W, edge, U in zip(self.wind, ends, self.frequency, speeds, strict=True))  # fmt: skip
        return replace(self, frequency=ends, wind=wind)  # type: ignore[arg-type]

    def stretched(self, low: float, high: float) -> OperatingRange:
        """The range that holds this one with its frequencies times every factor between two, `low` <= 1 <= `high`.

        Where the site has the winds for it: what they keep out of this range may be in that one.
        """
        ends = self.asked[0] * low, self.asked[1] * high
        if self.wind is None or self.law is None:
            return replace(self, frequency=ends, band=self.asked)
        first, last = self._reach
        whole = float(self.law.frequency(first)), float(self.law.frequency(last))
        lo = first if whole[0] >= ends[0] else float(self.law.speed(ends[0], first, last))
        hi = last if whole[1] <= ends[1] else float(self.law.speed(ends[1], first, last))
        found = over_winds(self.law, self.lift, (lo, hi), self.reference, self.site, self.basis, self.moves)
        return replace(found, doubts=self.doubts, band=self.asked)

    @property
    def _reach(self) -> tuple[float, float]:
        """The longest stretch of winds [m/s] around the range on which the shedding frequency goes on as in it."""
        if self.wind is None or self.law is None:
            raise RuntimeError("a window at one fixed lift has no winds")
        inner = sorted(self.wind)
        least, most = (f(a, b) for f, a, b in zip((max, min), self.site, self.law.speed_range, strict=True))
        least = min(max(least, _CALM * inner[0]), inner[0])
        most = max(min(most, _STORM * inner[1]), inner[1])
        stretches = self.law.stretches(least, most)
        own = max(stretches, key=lambda one: min(max(one), inner[1]) - max(min(one), inner[0]))
        ascending = own[0] <= own[1]
        lo, hi = min(own[0], own[1], inner[0]), max(own[0], own[1], inner[1])
        return (lo, hi) if ascending else (hi, lo)

    def widened(self, share: float = HALF) -> OperatingRange:
        """The range with its width grown by a share, as far as the site and the tables of the case reach."""
        if self.wind is None or self.law is None:
            lo, hi = self.frequency
            more = 0.5 * share * (hi - lo)
            return replace(self, frequency=(lo - more if lo > more else _NEAR_ZERO * lo, hi + more))
        lo, hi = self.wind
        more = 0.5 * share * (hi - lo)
        outer = [lo - more, hi + more]
        least, most = (f(a, b) for f, a, b in zip((max, min), self.site, self.law.speed_range, strict=True))
        for end, inner in enumerate(self.wind):
            lowest = outer[end] if outer[end] > 0 else _NEAR_ZERO * inner
            outer[end] = min(max(lowest, min(least, inner)), max(most, inner))
            if not self.law.is_monotone(*((outer[0], inner) if end == 0 else (inner, outer[1]))):
                outer[end] = inner
        return over_winds(self.law, self.lift, (outer[0], outer[1]), self.reference, self.site, self.basis, self.moves)

    def closed(self, end: int) -> bool:
        """Whether nothing lies beyond an end (0 or 1).

        Because the site has no such winds, or because the shedding frequency turns there: what is beyond is another
        range.
        """
        if self.wind is None or self.law is None:
            return False
        rising, here = self.wind[0] < self.wind[1], self.wind[end]
        upwards = rising == (end == 1)
        if here >= self.site[1] * (1 - SAME) if upwards else here <= self.site[0] * (1 + SAME):
            return True
        return not self.law.goes_on(here, upwards, rising)

    def place(self, frequency: float) -> str:
        """Where in the range a frequency is, for a sentence."""
        if self.wind is not None:
            return f"{float(self.speed(frequency)):.4g} m/s"
        if math.isnan(self.reference):
            return f"{frequency:.5g} rad/s"
        return f"detuning {frequency - self.reference:.4g} rad/s"

    @property
    def text(self) -> str:
        """The range in words."""
        if self.wind is not None:
            return f"winds of {min(self.wind):.4g} ... {max(self.wind):.4g} m/s, each with its own lift"
        if not math.isnan(self.held):
            return f"lock-in of {self.held:.4g} m/s, the wind of the site nearest to the resonance"
        if math.isnan(self.reference):
            return (
                f"excitation frequencies of {self.frequency[0]:.5g} ... {self.frequency[1]:.5g} rad/s, one lift for all"
            )
        lo, hi = self.detuning
        return f"detunings of {lo:.4g} ... {hi:.4g} rad/s, one lift for all"


def frequency_range(lo: float, hi: float, reference: float = math.nan) -> OperatingRange:
    """A window of Omega [rad/s] at one fixed lift."""
    return OperatingRange((lo, hi), reference)


def over_winds(
    law: WindExcitation, lift: float, wind: tuple[float, float], reference: float, site: tuple[float, float],
    basis: tuple[str, ...], moves: bool,
) -> OperatingRange:  # fmt: skip
    """The range of the winds between two [m/s], with the frequencies that they shed at."""
    ends = float(law.frequency(wind[0])), float(law.frequency(wind[1]))
    return OperatingRange(ends, reference, wind, law, lift, site, basis, moves)


def _factor(law: WindExcitation, lift: float, lo: float, hi: float) -> Floats:
    """Pieces of F_L(Omega)/lift, one cubic between neighbouring knots; smooth between the kinks of the tables."""
    from scipy.interpolate import CubicHermiteSpline  # takes long to load

    if lift == 0:
        return np.zeros((0, 5))
    low, high = min(lo, hi), max(lo, hi)
    kinks = [U for U in law.kinks(low, high) if low < U * (1 - SAME) < U * (1 + SAME) < high]
    edges = np.concatenate([[low], kinks, [high]])
    rows = []
    for a, b in pairwise(edges if lo < hi else edges[::-1]):
        U = np.linspace(a, b, _KNOTS)
        inner = np.clip(U, *sorted((a + 1e-9 * (b - a), b - 1e-9 * (b - a))))  # one-sided slopes at the kinks
        W, slope = law.frequency(U), law.lift_slope(inner) / law.frequency_slope(inner)
        spline = CubicHermiteSpline(W, law.lift(U) / lift, slope / lift)
        rows.append(np.column_stack([W[:-1], spline.c[::-1].T]))
    last = rows[-1][-1]
    x = W[-1] - last[0]
    end = [W[-1], np.polyval(last[:0:-1], x), np.polyval(np.polyder(last[:0:-1]), x), 0.0, 0.0]
    return np.vstack([*rows, end])
