"""The wind speed as the axis of a response: excitation frequency and lift both follow it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.case import Case
from frahm.loads import WindExcitation, speed_window, vortex_shedding, wind_excitation

_KNOTS = 200  # of the lift over the frequency where a table bends it; a cubic between them is exact to about 1e-10


@dataclass(frozen=True)
class WindAxis:
    """A window of wind speed, as the harmonic balance sees it.

    Attributes
    ----------
    window : (float, float)
        Lowest and highest wind speed U [m/s].
    frequency : (float, float)
        Shedding frequency Omega there [rad/s].
    factor : ndarray, shape (knots, 5)
        Lift over the lift at the wind of the case: Omega [rad/s] and the coefficients of a cubic from there on.
    law : WindExcitation
    """

    window: tuple[float, float]
    frequency: tuple[float, float]
    factor: Floats
    law: WindExcitation

    def speed(self, frequency: Floats) -> Floats:
        """Wind speed [m/s] that sheds at Omega [rad/s], inside the window."""
        return self.law.speed(np.clip(frequency, *self.frequency), *self.window)

    def lift_factor(self, frequency: float) -> float:
        """Lift over that at the wind of the case [-] at Omega [rad/s], by the cubics of `factor`."""
        if not len(self.factor):
            return 0.0
        row = int(np.clip(np.searchsorted(self.factor[:, 0], frequency, side="right") - 1, 0, len(self.factor) - 2))
        return float(np.polyval(self.factor[row, :0:-1], frequency - self.factor[row, 0]))


def wind_axis(case: Case, window: Any) -> WindAxis:
    """The axis of a case over wind speeds (lo, hi) [m/s].

    Raises
    ------
    ParameterError
        If the bounds do not ascend, lie beyond the tables of Strouhal number and lift coefficient, or the shedding
        frequency does not ascend between them.
    """
    lo, hi = speed_window(case, window)
    law = wind_excitation(case)
    if not law.is_monotone(lo, hi):
        law.speed(1.0, lo, hi)  # refuses, and says why
    ends = float(law.frequency(lo)), float(law.frequency(hi))
    return WindAxis((lo, hi), ends, _factor(law, vortex_shedding(case).lift, lo, hi), law)


def _factor(law: WindExcitation, lift: float, lo: float, hi: float) -> Floats:
    """Pieces of F_L(Omega)/lift, one cubic between neighbouring knots; smooth between the kinks of the tables."""
    from scipy.interpolate import CubicHermiteSpline  # takes long to load

    if lift == 0:
        return np.zeros((0, 5))
    edges = np.concatenate([[lo], law.kinks(lo, hi), [hi]])
    rows = []
    for a, b in pairwise(edges):
        U = np.linspace(a, b, _KNOTS)
        inner = np.clip(U, a + 1e-9 * (b - a), b - 1e-9 * (b - a))  # one-sided slopes at the kinks
        W, slope = law.frequency(U), law.lift_slope(inner) / law.frequency_slope(inner)
        spline = CubicHermiteSpline(W, law.lift(U) / lift, slope / lift)
        rows.append(np.column_stack([W[:-1], spline.c[::-1].T]))
    last = rows[-1][-1]
    x = W[-1] - last[0]
    end = [W[-1], np.polyval(last[:0:-1], x), np.polyval(np.polyder(last[:0:-1]), x), 0.0, 0.0]
    return np.vstack([*rows, end])
