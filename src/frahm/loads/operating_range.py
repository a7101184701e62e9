"""The range of operation: every excitation a member can meet, as one object that all verbs take.

Either winds, each with its own shedding frequency and lift, or a window of the excitation frequency at one fixed lift
(the setting of doi 10.3390/app12147272). Left to itself a case is asked about all winds of its site that excite a mode
it has: vortices lock in within a band around each natural frequency (`similarity.LOCK_IN_RATIOS`), and an absorber of
mass ratio mu, however its spring is tuned, splits a resonance at 1 into two at lambda with
lambda^4 - (2 + mu) lambda^2 + 1 = 0 (Den Hartog, Mechanical Vibrations, section 3.2), so that the band of a mode
reaches from its lower end times the lower of them to its upper end times the upper one.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.case import Case, Pipe
from frahm.loads.climate import wind_climate
from frahm.loads.over_wind import WindExcitation, speed_window, wind_excitation
from frahm.loads.similarity import LOCK_IN_RATIOS
from frahm.loads.vortex import vortex_shedding

_KNOTS = 200  # of the lift over the frequency where a table bends it; a cubic between them is exact to about 1e-10
_SAME = 1e-9  # relative difference below which an end of the range is an end of the site's winds
_CALM, _STORM = 1e-3, 1e3  # times the winds of a range: where a site has no bound nothing is stretched beyond
_NEAR_ZERO = 0.5  # a window widened below zero frequency ends at this share of its lower end instead
HALF = 0.5  # what a range is widened by when its worst is put to the test


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
        found = _over(self.law, self.lift, (lo, hi), self.reference, self.site, self.basis, self.moves)
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
        return _over(self.law, self.lift, (outer[0], outer[1]), self.reference, self.site, self.basis, self.moves)

    def closed(self, end: int) -> bool:
        """Whether nothing lies beyond an end (0 or 1).

        Because the site has no such winds, or because the shedding frequency turns there: what is beyond is another
        range.
        """
        if self.wind is None or self.law is None:
            return False
        rising, here = self.wind[0] < self.wind[1], self.wind[end]
        upwards = rising == (end == 1)
        if here >= self.site[1] * (1 - _SAME) if upwards else here <= self.site[0] * (1 + _SAME):
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


def operating_range(case: Case, *, wind: Any = None, most_mass_ratio: float = 0.0) -> OperatingRange:
    """Range of operation of a case.

    Parameters
    ----------
    case : Case
    wind : (float, float), optional
        Winds [m/s] in place of those of the case.
    most_mass_ratio : float
        Largest mass ratio of absorbers the range must hold [-]; those of the case count anyway.

    Returns
    -------
    OperatingRange
        `wind` or `analysis.wind`; else the window `analysis.detuning` at the lift of `wind.speed`; else all winds that
        excite a mode, and the wind of the case, as far as the site has them (`wind.range`, or what the climate says).

    Raises
    ------
    ParameterError
        If the bounds do not ascend, lie beyond the tables of Strouhal number and lift coefficient, or the shedding
        frequency does not ascend between them.
    """
    if wind is not None:
        return _given(case, wind, "wind")
    if case.analysis.wind is not None:
        return _given(case, case.analysis.wind, "analysis.wind")
    omega = case.pipe.frequency
    if case.analysis.detuning is not None:
        lo, hi = case.analysis.detuning
        basis = (f"analysis.detuning asks for the lift of {case.wind.speed:g} m/s at every frequency of the window.",)
        return OperatingRange((omega + lo, omega + hi), omega, lift=vortex_shedding(case).lift, basis=basis)
    return _of_the_site(case, most_mass_ratio)


def frequency_range(lo: float, hi: float, reference: float = math.nan) -> OperatingRange:
    """A window of Omega [rad/s] at one fixed lift."""
    return OperatingRange((lo, hi), reference)


def split_resonances(mass_ratio: float) -> tuple[float, float]:
    """Both resonances of a mode that carries an absorber tuned to it, over its frequency [-].

    Parameters
    ----------
    mass_ratio : float
        mu, mass of the absorber over modal mass [-].
    """
    root = math.sqrt(mass_ratio * mass_ratio + 4 * mass_ratio)
    return math.sqrt((2 + mass_ratio - root) / 2), math.sqrt((2 + mass_ratio + root) / 2)


def site_winds(case: Case) -> tuple[tuple[float, float], str]:
    """Winds the site has [m/s], and the sentence that says so.

    `wind.range`; else the classes of the table of the climate; else up to the largest of as many independent winds as
    the duration has correlation times, by the Weibull distribution; else no bound.
    """
    if case.wind.range is not None:
        lo, hi = case.wind.range
        return (lo, hi), f"The site has winds of {lo:g} ... {hi:g} m/s (wind.range)."
    if case.climate is None:
        return (0.0, math.inf), "Nothing bounds the winds of the site: give wind.range or a climate."
    climate = wind_climate(case)
    if climate.weibull is None:
        lo, hi = float(climate.edges[0]), float(climate.edges[-1])
        return (lo, hi), f"The classes of the climate reach from {lo:g} to {hi:g} m/s."
    count = max(climate.duration / climate.correlation_time, math.e)
    hi = climate.weibull.scale * math.log(count) ** (1 / climate.weibull.shape)
    return (0.0, hi), f"The climate's largest wind, exceeded once in its duration, is {hi:.4g} m/s."


def _given(case: Case, window: Any, name: str) -> OperatingRange:
    lo, hi = speed_window(case, window, name)
    law = wind_excitation(case)
    if not law.is_monotone(lo, hi):
        law.speed(1.0, lo, hi)  # refuses, and says why
    basis = (f"The winds were given: {lo:g} ... {hi:g} m/s.",)
    return _over(law, vortex_shedding(case).lift, (lo, hi), case.pipe.frequency, (0.0, math.inf), basis, False)


def _over(
    law: WindExcitation, lift: float, wind: tuple[float, float], reference: float, site: tuple[float, float],
    basis: tuple[str, ...], moves: bool,
) -> OperatingRange:  # fmt: skip
    ends = float(law.frequency(wind[0])), float(law.frequency(wind[1]))
    return OperatingRange(ends, reference, wind, law, lift, site, basis, moves)


def _of_the_site(case: Case, most_mass_ratio: float) -> OperatingRange:
    law, (site, about_site) = wind_excitation(case), site_winds(case)
    bands, speed = excited_bands(case, most_mass_ratio), case.wind.speed
    reached = law.speed_range
    basis = [_about_band(case, bands[0], _excites_another(law, speed, bands)), about_site]
    if not all(law.speeds_of(W).size for W in bands[0]):
        basis.append(
            f"Strouhal number and lift are given for {reached[0]:.3g} ... {reached[1]:.3g} m/s only: nothing is known"
            " beyond."
        )
    ends = _winds_of(law, bands[0])
    doubts = _beyond_the_site(speed, ends, site)
    lo, hi = _wanted(case, law, bands)
    if doubts:  # none of these winds is one of the site: they are looked at as if they were
        site = (min(lo, site[0]), max(hi, site[1]))
    if not lo < hi * (1 - _SAME):
        hi = max(hi, speed)
        lo = max(hi * LOCK_IN_RATIOS[0], reached[0], site[0] if site[0] < hi else 0.0)
        basis.append(f"No wind of the site excites the mode: the strongest are looked at, {lo:.4g} ... {hi:.4g} m/s.")
    stretch = _main_stretch(law, lo, hi, speed)
    if stretch != (lo, hi):
        basis.append(
            f"The shedding frequency turns over the wind: {min(stretch):.4g} ... {max(stretch):.4g} m/s are one range,"
            " the other winds that excite the mode are others."
        )
    found = _over(law, vortex_shedding(case).lift, stretch, case.pipe.frequency, site, tuple(basis), True)
    return replace(found, doubts=doubts, band=bands[0])


def _excites_another(law: WindExcitation, speed: float, bands: list[tuple[float, float]]) -> bool:
    """Whether a wind [m/s] sheds in the band of another mode than the first [rad/s]."""
    return any(lo <= float(law.frequency(speed)) <= hi for lo, hi in bands[1:])


def _wanted(case: Case, law: WindExcitation, bands: list[tuple[float, float]]) -> tuple[float, float]:
    """Lowest and highest wind [m/s] that excites the governing mode; its design wind, unless it excites another one."""
    site, _ = site_winds(case)
    ends, speed, reached = _winds_of(law, bands[0]), case.wind.speed, law.speed_range
    wanted = ends if ends and _excites_another(law, speed, bands) else [speed, *ends]
    if _beyond_the_site(speed, ends, site):
        site = (min(*wanted, site[0]), max(*wanted, site[1]))
    lo = max(min(wanted), min(site[0], speed), reached[0])
    return lo, min(max(wanted), max(site[1], speed), reached[1])


def _main_stretch(law: WindExcitation, lo: float, hi: float, speed: float) -> tuple[float, float]:
    """The stretch on which the shedding frequency rises that holds a wind [m/s], or is next to it.

    Where it rises nowhere, the nearest on which it falls.
    """
    if law.is_monotone(lo, hi):
        return lo, hi
    stretches = law.stretches(lo, hi)
    rising = [one for one in stretches if one[0] < one[1]]
    return min(rising or stretches, key=lambda one: max(min(one) - speed, speed - max(one), 0.0))


def _beyond_the_site(speed: float, ends: list[float], site: tuple[float, float]) -> tuple[str, ...]:
    """The sentence for a site that has neither the wind of the case nor any that excites the pipe."""
    if not ends or site[0] <= speed <= site[1] or (min(ends) <= site[1] and max(ends) >= site[0]):
        return ()
    return (
        f"The site has winds of {site[0]:g} ... {site[1]:g} m/s: neither the wind of the case, {speed:g} m/s, nor any"
        f" that excites the pipe ({min(ends):.4g} ... {max(ends):.4g} m/s) is one of them. These were looked at all the"
        " same: correct wind.range, the climate or wind.speed.",
    )


def other_ranges(case: Case, most_mass_ratio: float = 0.0) -> tuple[tuple[Case, OperatingRange], ...]:
    """What else winds of the site excite beside the range of operation: a case with the mode that governs, and a range.

    The other modes of an elastic pipe: vortices lock in to the mode they excite, so that the lift is in step with it
    and not with the governing one. And every mode again on each further stretch of winds, where the shedding frequency
    turns over the wind. Only of a case whose range was left to itself; a range that was given is all that is asked
    about.
    """
    if case.analysis.wind is not None or case.analysis.detuning is not None:
        return ()
    law, (site, _) = wind_excitation(case), site_winds(case)
    main, bands = _of_the_site(case, most_mass_ratio), excited_bands(case, most_mass_ratio)
    winds, found = _wanted(case, law, bands), []
    if winds[0] < winds[1] * (1 - _SAME) and not law.is_monotone(*winds):
        stretches = [one for one in law.stretches(*winds) if not _overlap(one, main.wind)]
        found += [(case, part) for part in _ranges_of(case, law, bands[0], stretches, main.site)]
    found += _locked_in(case, law, bands[0], site)
    for other, band, winds in _beside(case, most_mass_ratio):
        stretches = [winds] if law.is_monotone(*winds) else law.stretches(*winds)
        found += [(other, part) for part in _ranges_of(other, law, band, stretches, site)]
        found += _locked_in(other, law, band, site)
    return tuple(found)


def _locked_in(
    case: Case, law: WindExcitation, band: tuple[float, float], site: tuple[float, float]
) -> Iterator[tuple[Case, OperatingRange]]:
    """The lock-in of the wind of a site nearest to the resonance of the governing mode, where the site lacks that one.

    Vortices that lock in are shed at the frequency of the mode: its resonance is met, with the lift of this wind.
    """
    omega = case.pipe.frequency
    speed = locking_wind(law, omega, site)
    if speed is None:
        return
    locked = case.with_wind(speed=speed)
    basis = f"{speed:.4g} m/s, the wind of the site nearest to the resonance, may lock in to the mode."
    shed = float(law.frequency(speed))
    yield locked, OperatingRange(
        (min(band[0], shed), max(band[1], shed)), omega, law=law, lift=vortex_shedding(locked).lift, site=site,
        basis=(basis,), moves=True, band=band, held=speed,
    )  # fmt: skip


def locking_wind(law: WindExcitation, omega: float, site: tuple[float, float]) -> float | None:
    """The wind of a site [m/s] that is nearest to the resonance of a mode [rad/s] and may lock in to it.

    None if the site has the resonant wind itself, or none within the band of lock-in.
    """
    resonant = law.speeds_of(omega)
    if not resonant.size or np.any((site[0] <= resonant) & (resonant <= site[1])):
        return None
    pairs = [(U, float(R)) for U in site for R in resonant if U > 0 and math.isfinite(U)]
    speed, resonance = min(pairs, key=lambda pair: abs(pair[0] - pair[1]))
    return speed if LOCK_IN_RATIOS[0] <= speed / resonance <= LOCK_IN_RATIOS[1] else None


def _overlap(one: tuple[float, float], other: tuple[float, float] | None) -> bool:
    """Whether two stretches of winds have more than an end in common."""
    return other is not None and max(min(one), min(other)) < min(max(one), max(other)) * (1 - _SAME)


def _beside(case: Case, most_mass_ratio: float) -> Iterator[tuple[Case, tuple[float, float], tuple[float, float]]]:
    """The other modes that winds of the site excite: a case that each governs, its band [rad/s], and these winds."""
    if isinstance(case.pipe, Pipe):
        return
    law, (site, _) = wind_excitation(case), site_winds(case)
    reached, governing = law.speed_range, case.pipe.governing_mode
    for mode in range(1, case.pipe.modal.count + 1):
        if mode == governing:
            continue
        other = case.with_pipe(governing_mode=mode)
        band = excited_bands(other, most_mass_ratio * case.pipe.mass / other.pipe.mass)[0]
        ends = _winds_of(law, band)
        lo = max(min(ends, default=math.inf), site[0], reached[0])
        hi = min(max(ends, default=0.0), site[1], reached[1])
        if lo < hi * (1 - _SAME):
            yield other, band, (lo, hi)


def _ranges_of(
    case: Case, law: WindExcitation, band: tuple[float, float], stretches: Iterable[tuple[float, float]],
    site: tuple[float, float],
) -> Iterator[OperatingRange]:  # fmt: skip
    """The parts of stretches of winds that shed in the band of the governing mode [rad/s]."""
    lift, omega = vortex_shedding(case).lift, case.pipe.frequency
    mode = "the governing mode" if isinstance(case.pipe, Pipe) else f"mode {case.pipe.governing_mode}"
    for first, last in stretches:
        low, high = max(band[0], float(law.frequency(first))), min(band[1], float(law.frequency(last)))
        if not low < high * (1 - _SAME):
            continue
        ends = [first if low > band[0] else float(law.speed(low, first, last)),
                last if high < band[1] else float(law.speed(high, first, last))]  # fmt: skip
        basis = f"Winds of {min(ends):.4g} ... {max(ends):.4g} m/s excite {mode}, with the lift in step with it."
        found = _over(law, lift, (ends[0], ends[1]), omega, site, (basis,), True)
        yield replace(found, band=band)


def excited_bands(case: Case, most_mass_ratio: float = 0.0) -> list[tuple[float, float]]:
    """Shedding frequencies [rad/s] that can excite each mode, the governing one first, however absorbers are tuned."""
    modal = case.pipe.modal
    carried = sum(absorber.mass for absorber in case.absorbers)
    # wherever the absorbers hang: where the mode moves most they split it most
    ratios = max(carried, most_mass_ratio * modal.masses[0]) / modal.masses
    low, high = LOCK_IN_RATIOS
    bands = []
    for omega, ratio in zip(modal.frequencies, ratios, strict=True):
        first, second = split_resonances(float(ratio))
        bands.append((float(omega) * low * first, float(omega) * high * second))
    return bands


def _winds_of(law: WindExcitation, band: tuple[float, float]) -> list[float]:
    """Winds that shed at the ends of a band, and the ends of the tables that lie within it; none if none excites."""
    edges = [U for U in law.speed_range if 0 < U < math.inf and band[0] <= float(law.frequency(U)) <= band[1]]
    return [*(float(U) for W in band for U in law.speeds_of(W)), *edges]


def _about_band(case: Case, band: tuple[float, float], elsewhere: bool) -> str:
    low, high = (edge / case.pipe.frequency for edge in band)
    also = "" if elsewhere else f", and the wind of the case, {case.wind.speed:g} m/s"
    return (
        f"All winds that can excite the governing mode, shedding within {low:.3g} ... {high:.3g} of its frequency"
        f" (lock-in, and the resonances an absorber splits it into){also}."
    )


def _factor(law: WindExcitation, lift: float, lo: float, hi: float) -> Floats:
    """Pieces of F_L(Omega)/lift, one cubic between neighbouring knots; smooth between the kinks of the tables."""
    from scipy.interpolate import CubicHermiteSpline  # takes long to load

    if lift == 0:
        return np.zeros((0, 5))
    low, high = min(lo, hi), max(lo, hi)
    kinks = [U for U in law.kinks(low, high) if low < U * (1 - _SAME) < U * (1 + _SAME) < high]
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
