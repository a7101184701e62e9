"""Ranges of operation of a case: its own, and what else winds of its site excite.

Left to itself a case is asked about all winds of its site that excite a mode it has, see `excited_bands`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any

from frahm.case import Case, Pipe
from frahm.loads.operating_range import SAME, OperatingRange, over_winds
from frahm.loads.over_wind import WindExcitation, speed_window, wind_excitation
from frahm.loads.similarity import LOCK_IN_RATIOS
from frahm.loads.site import excited_bands, locking_wind, site_winds, winds_of
from frahm.loads.vortex import vortex_shedding


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


def _given(case: Case, window: Any, name: str) -> OperatingRange:
    lo, hi = speed_window(case, window, name)
    law = wind_excitation(case)
    if not law.is_monotone(lo, hi):
        law.speed(1.0, lo, hi)  # refuses, and says why
    basis = (f"The winds were given: {lo:g} ... {hi:g} m/s.",)
    return over_winds(law, vortex_shedding(case).lift, (lo, hi), case.pipe.frequency, (0.0, math.inf), basis, False)


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
    ends = winds_of(law, bands[0])
    doubts = _beyond_the_site(speed, ends, site)
    lo, hi = _wanted(case, law, bands)
    if doubts:  # none of these winds is one of the site: they are looked at as if they were
        site = (min(lo, site[0]), max(hi, site[1]))
    if not lo < hi * (1 - SAME):
        hi = max(hi, speed)
        lo = max(hi * LOCK_IN_RATIOS[0], reached[0], site[0] if site[0] < hi else 0.0)
        basis.append(f"No wind of the site excites the mode: the strongest are looked at, {lo:.4g} ... {hi:.4g} m/s.")
    stretch = _main_stretch(law, lo, hi, speed)
    if stretch != (lo, hi):
        basis.append(
            f"The shedding frequency turns over the wind: {min(stretch):.4g} ... {max(stretch):.4g} m/s are one range,"
            " the other winds that excite the mode are others."
        )
    found = over_winds(law, vortex_shedding(case).lift, stretch, case.pipe.frequency, site, tuple(basis), True)
    return replace(found, doubts=doubts, band=bands[0])


def _excites_another(law: WindExcitation, speed: float, bands: list[tuple[float, float]]) -> bool:
    """Whether a wind [m/s] sheds in the band of another mode than the first [rad/s]."""
    return any(lo <= float(law.frequency(speed)) <= hi for lo, hi in bands[1:])


def _wanted(case: Case, law: WindExcitation, bands: list[tuple[float, float]]) -> tuple[float, float]:
    """Lowest and highest wind [m/s] that excites the governing mode; its design wind, unless it excites another one."""
    site, _ = site_winds(case)
    ends, speed, reached = winds_of(law, bands[0]), case.wind.speed, law.speed_range
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


def _about_band(case: Case, band: tuple[float, float], elsewhere: bool) -> str:
    low, high = (edge / case.pipe.frequency for edge in band)
    also = "" if elsewhere else f", and the wind of the case, {case.wind.speed:g} m/s"
    return (
        f"All winds that can excite the governing mode, shedding within {low:.3g} ... {high:.3g} of its frequency"
        f" (lock-in, and the resonances an absorber splits it into){also}."
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
    if winds[0] < winds[1] * (1 - SAME) and not law.is_monotone(*winds):
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


def _overlap(one: tuple[float, float], other: tuple[float, float] | None) -> bool:
    """Whether two stretches of winds have more than an end in common."""
    return other is not None and max(min(one), min(other)) < min(max(one), max(other)) * (1 - SAME)


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
        ends = winds_of(law, band)
        lo = max(min(ends, default=math.inf), site[0], reached[0])
        hi = min(max(ends, default=0.0), site[1], reached[1])
        if lo < hi * (1 - SAME):
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
        if not low < high * (1 - SAME):
            continue
        ends = [first if low > band[0] else float(law.speed(low, first, last)),
                last if high < band[1] else float(law.speed(high, first, last))]  # fmt: skip
        basis = f"Winds of {min(ends):.4g} ... {max(ends):.4g} m/s excite {mode}, with the lift in step with it."
        found = over_winds(law, lift, (ends[0], ends[1]), omega, site, (basis,), True)
        yield replace(found, band=band)
