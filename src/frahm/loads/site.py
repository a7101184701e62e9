"""What winds a site has, and which of them excite a mode.

Vortices lock in within a band around each natural frequency (`similarity.LOCK_IN_RATIOS`), and an absorber of mass
ratio mu, however its spring is tuned, splits a resonance at 1 into two at lambda with
lambda^4 - (2 + mu) lambda^2 + 1 = 0 (Den Hartog, Mechanical Vibrations, section 3.2), so that the band of a mode
reaches from its lower end times the lower of them to its upper end times the upper one.
"""

from __future__ import annotations

import math

import numpy as np

from frahm.case import Case
from frahm.loads.climate import wind_climate
from frahm.loads.over_wind import WindExcitation
from frahm.loads.similarity import LOCK_IN_RATIOS


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


def split_resonances(mass_ratio: float) -> tuple[float, float]:
    """Both resonances of a mode that carries an absorber tuned to it, over its frequency [-].

    Parameters
    ----------
    mass_ratio : float
        mu, mass of the absorber over modal mass [-].
    """
    root = math.sqrt(mass_ratio * mass_ratio + 4 * mass_ratio)
    return math.sqrt((2 + mass_ratio - root) / 2), math.sqrt((2 + mass_ratio + root) / 2)


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


def winds_of(law: WindExcitation, band: tuple[float, float]) -> list[float]:
    """Winds that shed at the ends of a band, and the ends of the tables that lie within it; none if none excites."""
    edges = [U for U in law.speed_range if 0 < U < math.inf and band[0] <= float(law.frequency(U)) <= band[1]]
    return [*(float(U) for W in band for U in law.speeds_of(W)), *edges]


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
