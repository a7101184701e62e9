"""Shedding frequency and lift as functions of the wind speed, their exact derivatives, and the way back."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats, finite_array, frozen, labelled
from frahm.case import Case
from frahm.errors import ParameterError, check_number
from frahm.loads.reynolds import EDGE, ReynoldsCurve, lift_curve, strouhal_curve
from frahm.loads.vortex import check_speeds

if TYPE_CHECKING:
    import xarray as xr

_ITERATIONS = 100
_ASIDE = 1e-4  # of a stretch, or of a wind: so near a turning point of Omega(U) it has no inverse to work with


@dataclass(frozen=True, eq=False)
class WindExcitation:
    """Omega(U) = 2 pi St U / D and F_L(U) = 1/2 C_L rho U^2 D l of a case, with St and C_L over the Reynolds number.

    Both are smooth but for `kinks`, where a table bends; a derivative there is that of the right side. Beyond the range
    of the tables every value is NaN.

    Attributes
    ----------
    diameter, length : float
        [m].
    air_density : float
        [kg/m^3].
    viscosity : float
        [m^2/s].
    strouhal, lift_coefficient : ReynoldsCurve
    speed_range : (float, float)
        Lowest and highest speed [m/s] both coefficients are given for.
    """

    diameter: float
    length: float
    air_density: float
    viscosity: float
    strouhal: ReynoldsCurve
    lift_coefficient: ReynoldsCurve
    speed_range: tuple[float, float]

    def reynolds_number(self, speed: ArrayLike) -> Floats:
        """Re = U D / nu [-]."""
        return np.asarray(speed, dtype=float) * self.diameter / self.viscosity

    def frequency(self, speed: ArrayLike) -> Floats:
        """Shedding frequency Omega [rad/s]."""
        U = np.asarray(speed, dtype=float)
        return self._turns * U * self.strouhal.value(self.reynolds_number(U))

    def frequency_slope(self, speed: ArrayLike) -> Floats:
        """Derivative dOmega/dU [rad/m]."""
        Re = self.reynolds_number(speed)
        return self._turns * (self.strouhal.value(Re) + self.strouhal.slope(Re))

    def lift(self, speed: ArrayLike) -> Floats:
        """Amplitude of the lift F_L [N]."""
        U = np.asarray(speed, dtype=float)
        return self._pressure * U**2 * self.lift_coefficient.value(self.reynolds_number(U))

    def lift_slope(self, speed: ArrayLike) -> Floats:
        """Derivative dF_L/dU [N s/m]."""
        U = np.asarray(speed, dtype=float)
        Re = self.reynolds_number(U)
        return self._pressure * U * (2 * self.lift_coefficient.value(Re) + self.lift_coefficient.slope(Re))

    def kinks(self, low: float, high: float) -> Floats:
        """Speeds [m/s] strictly between `low` and `high` at which a table bends, ascending."""
        knots = np.concatenate([self.strouhal.knots, self.lift_coefficient.knots])
        speeds = np.unique(np.exp(knots) * self.viscosity / self.diameter)
        return speeds[(speeds > low) & (speeds < high)]

    def is_monotone(self, low: float, high: float) -> bool:
        """Whether Omega(U) ascends strictly on the way from `low` to `high` [m/s], upwards or downwards.

        Exact: between knots dSt/dlnRe is constant.
        """
        edges = self._edges(min(low, high), max(low, high))
        middle, sense = self._slopes(edges), 1.0 if low <= high else -1.0
        left, right = self._strouhal_at(edges[:-1]) + middle, self._strouhal_at(edges[1:]) + middle
        return bool(np.all(sense * left > 0) and np.all(sense * right > 0))

    def stretches(self, low: float, high: float) -> list[tuple[float, float]]:
        """Every stretch of the winds [m/s] between two on which Omega(U) is monotone, as long as each can be.

        From the wind that sheds slowest to the one that sheds fastest: a stretch on which the shedding frequency falls
        with the wind goes downwards. Where it turns between the knots of a table a ten-thousandth is left out.
        """
        edges = self._edges(low, high)
        turns = self._turning(edges)
        ends = np.unique(np.concatenate([edges, turns]))
        rising = self.frequency_slope(np.sqrt(ends[:-1] * ends[1:])) > 0
        runs = np.split(np.arange(len(rising)), np.flatnonzero(np.diff(rising)) + 1)
        found = []
        for run in runs:
            a, b = float(ends[run[0]]), float(ends[run[-1] + 1])
            aside = _ASIDE * (b - a)
            a, b = a + aside * (a in turns), b - aside * (b in turns)
            found.append((a, b) if rising[run[0]] else (b, a))
        return [one for one in found if self.is_monotone(*one)]

    def goes_on(self, speed: float, upwards: bool, rising: bool) -> bool:
        """Whether Omega(U) rises, or falls, on just beyond a wind [m/s] as it does up to it."""
        beyond = float(self.frequency_slope(speed * (1 + _ASIDE if upwards else 1 - _ASIDE)))
        return not (beyond < 0 if rising else beyond > 0)

    def speed(self, frequency: ArrayLike, low: float, high: float) -> Floats:
        """Wind speed U [m/s] that sheds at Omega [rad/s], from `low` to `high` where Omega(U) ascends; else NaN.

        `low` is the higher of the two where the shedding frequency falls with the wind.

        Raises
        ------
        ParameterError
            If Omega(U) does not ascend from `low` to `high`: one frequency then belongs to several speeds.
        """
        if not self.is_monotone(low, high):
            raise ParameterError(
                "wind", (low, high), "a window in which the shedding frequency ascends with the speed",
                hint="The Strouhal number falls faster than 1/U in part of it.",
            )  # fmt: skip
        Omega = np.asarray(frequency, dtype=float)
        edges, sense = self._edges(min(low, high), max(low, high)), 1.0 if low <= high else -1.0
        ends = self._turns * edges * self._strouhal_at(edges)
        piece = np.clip(np.searchsorted(sense * ends, sense * Omega, side="right") - 1, 0, edges.size - 2)
        slope, first = self._slopes(edges)[piece], self._strouhal_at(edges)[piece]
        found = _solve(Omega / self._turns, edges[piece], edges[piece + 1], first, slope, sense)
        inside = (Omega >= np.min(ends) * (1 - EDGE)) & (Omega <= np.max(ends) * (1 + EDGE))
        return np.where(inside, found, np.nan)

    def speeds_of(self, frequency: float) -> Floats:
        """All wind speeds [m/s] that shed at Omega [rad/s], ascending; there may be none, and more than one."""
        from scipy.optimize import brentq  # takes long to load

        low, high = self.speed_range
        if math.isinf(high):  # beyond the last knot Omega is proportional to U
            last = float(np.exp(self.strouhal.knots[-1])) * self.viscosity / self.diameter
            high = 2 * max(last, frequency / self._turns / float(self.strouhal.values[-1]))
        low = max(low, 1e-9 * high)
        edges = self._edges(low, high)
        edges = np.unique(np.concatenate([edges, self._turning(edges)]))
        excess = self.frequency(edges) - frequency
        found = [float(U) for U in edges[excess == 0]]
        for i in np.flatnonzero(excess[:-1] * excess[1:] < 0):
            found.append(brentq(lambda U: float(self.frequency(U)) - frequency, edges[i], edges[i + 1], xtol=1e-15))
        return np.array(sorted(found))

    @property
    def _turns(self) -> float:
        return 2 * np.pi / self.diameter

    @property
    def _pressure(self) -> float:
        return 0.5 * self.air_density * self.diameter * self.length

    def _edges(self, low: float, high: float) -> Floats:
        """Ends of the pieces on which St is linear in ln U [m/s]."""
        speeds = np.exp(self.strouhal.knots) * self.viscosity / self.diameter
        return np.unique(np.concatenate([[low, high], speeds[(speeds > low) & (speeds < high)]]))

    def _turning(self, edges: Floats) -> Floats:
        """Winds [m/s] between the knots at which Omega(U) turns.

        Omega = c U (St + b ln(U/U0)) turns where ln(U/U0) = -1 - St/b.
        """
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            turns = edges[:-1] * np.exp(-1 - self._strouhal_at(edges[:-1]) / self._slopes(edges))
        return np.asarray(turns[(turns > edges[:-1]) & (turns < edges[1:])])

    def _strouhal_at(self, speeds: Floats) -> Floats:
        return self.strouhal.value(self.reynolds_number(speeds))

    def _slopes(self, edges: Floats) -> Floats:
        return self.strouhal.slope(self.reynolds_number(np.sqrt(edges[:-1] * edges[1:])))


def _solve(target: Floats, low: Floats, high: Floats, first: Floats, slope: Floats, sense: float) -> Floats:
    """U with U (first + slope ln(U/low)) = target, by Newton's method held inside [low, high] by bisection.

    The left side rises with U if `sense` is 1, and falls if it is -1.
    """
    start = low
    U = np.clip(target / first, low, high)
    for _ in range(_ITERATIONS):
        excess = U * (first + slope * np.log(U / start)) - target
        low, high = np.where(sense * excess < 0, U, low), np.where(sense * excess > 0, U, high)
        better = U - excess / (first + slope * (1 + np.log(U / start)))
        new = np.where((better >= low) & (better <= high), better, 0.5 * (low + high))
        if np.all(np.abs(new - U) <= 4e-16 * U):
            return new
        U = new
    return U


@dataclass(frozen=True, eq=False)
class ExcitationOverWind:
    """Shedding frequency and lift at given wind speeds.

    Attributes
    ----------
    speed, frequency, lift : ndarray, shape (s,)
        U [m/s], Omega [rad/s], F_L [N].
    frequency_slope, lift_slope : ndarray, shape (s,)
        dOmega/dU [rad/m], dF_L/dU [N s/m].
    reynolds_number, strouhal, lift_coefficient : ndarray, shape (s,)
        [-].
    monotone : bool
        Whether Omega(U) ascends strictly from the lowest to the highest speed, so that U(Omega) exists.
    law : WindExcitation
        The functions behind the arrays.
    case : Case
    """

    speed: Floats
    frequency: Floats
    lift: Floats
    frequency_slope: Floats
    lift_slope: Floats
    reynolds_number: Floats
    strouhal: Floats
    lift_coefficient: Floats
    monotone: bool
    law: WindExcitation
    case: Case

    def speed_at(self, frequency: ArrayLike) -> tuple[Floats, Floats]:
        """U(Omega) [m/s] and dU/dOmega [m/rad]; NaN for frequencies beyond the speeds.

        Raises
        ------
        ParameterError
            If Omega(U) is not monotone over the speeds.
        """
        U = self.law.speed(frequency, float(self.speed.min()), float(self.speed.max()))
        return U, 1 / self.law.frequency_slope(U)

    def lift_at(self, frequency: ArrayLike) -> tuple[Floats, Floats]:
        """F_L(Omega) [N] and dF_L/dOmega [N s/rad]; NaN for frequencies beyond the speeds.

        Raises
        ------
        ParameterError
            If Omega(U) is not monotone over the speeds.
        """
        U, rate = self.speed_at(frequency)
        return self.law.lift(U), self.law.lift_slope(U) * rate

    def to_dataset(self) -> xr.Dataset:
        """All of it over the wind speed, labelled."""
        import xarray as xr

        from frahm import __version__

        return xr.Dataset(
            {
                "frequency": labelled("speed", self.frequency, "shedding frequency Omega", "rad/s"),
                "lift": labelled("speed", self.lift, "amplitude of the lift", "N"),
                "frequency_slope": labelled("speed", self.frequency_slope, "dOmega/dU", "rad/m"),
                "lift_slope": labelled("speed", self.lift_slope, "dF_L/dU", "N s/m"),
                "reynolds_number": labelled("speed", self.reynolds_number, "Reynolds number", "1"),
                "strouhal": labelled("speed", self.strouhal, "Strouhal number", "1"),
                "lift_coefficient": labelled("speed", self.lift_coefficient, "lift coefficient", "1"),
            },
            {"speed": labelled("speed", self.speed, "wind speed", "m/s")},
            {"case": self.case.name, "monotone": int(self.monotone), "frahm": __version__},
        )


def wind_excitation(case: Case) -> WindExcitation:
    """Omega(U) and F_L(U) of a case as functions."""
    wind, pipe = case.wind, case.pipe
    low, high = zip(*wind.speed_ranges(pipe.diameter).values(), strict=True)
    return WindExcitation(
        pipe.diameter, pipe.length, wind.air_density, wind.viscosity, strouhal_curve(wind), lift_curve(wind),
        (max(low), min(high)),
    )  # fmt: skip


def excitation_over_wind(case: Case, speeds: ArrayLike) -> ExcitationOverWind:
    """Shedding frequency and lift of a case over wind speeds.

    Parameters
    ----------
    case : Case
    speeds : array_like, shape (s,)
        Wind speeds U > 0 [m/s], in any order.

    Raises
    ------
    ParameterError
        If a speed is not positive, or the Strouhal number or the lift coefficient is not given for it.
    """
    U = finite_array("speeds", speeds, (-1,))
    if U.size == 0:
        raise ParameterError("speeds", speeds, "at least one wind speed [m/s]")
    check_number("speeds", U.min(), above=0, unit="m/s")
    check_speeds(case, "speeds", float(U.min()), float(U.max()))
    law = wind_excitation(case)
    Re = law.reynolds_number(U)
    return ExcitationOverWind(
        speed=U, frequency=frozen(law.frequency(U)), lift=frozen(law.lift(U)),
        frequency_slope=frozen(law.frequency_slope(U)), lift_slope=frozen(law.lift_slope(U)),
        reynolds_number=frozen(Re), strouhal=frozen(law.strouhal.value(Re)),
        lift_coefficient=frozen(law.lift_coefficient.value(Re)),
        monotone=law.is_monotone(float(U.min()), float(U.max())), law=law, case=case,
    )  # fmt: skip


def speed_window(case: Case, window: Any, name: str = "wind") -> tuple[float, float]:
    """Window (lo, hi) of wind speeds [m/s], ascending, positive and inside the tables of the case."""
    try:
        lo, hi = window
    except (TypeError, ValueError):
        raise ParameterError(name, window, "two wind speeds (lo, hi) [m/s]") from None
    lo = check_number(f"{name}[0]", lo, above=0, unit="m/s")
    hi = check_number(f"{name}[1]", hi, above=0, unit="m/s")
    if not lo < hi:
        raise ParameterError(name, (lo, hi), "two wind speeds (lo, hi) with lo < hi [m/s]")
    check_speeds(case, name, lo, hi)
    return lo, hi
