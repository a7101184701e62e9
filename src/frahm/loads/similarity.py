"""Similarity numbers of a pipe in the wind, and the band of wind speeds in which the shedding locks in."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from frahm.arrays import Floats
from frahm.case import Case
from frahm.case.wind import AIR_DENSITY
from frahm.errors import check_number
from frahm.loads.over_wind import wind_excitation
from frahm.loads.vortex import VortexShedding, vortex_shedding


@dataclass(frozen=True)
class Similarity:
    """The dimensionless numbers vortex-induced vibration depends on.

    Attributes
    ----------
    reduced_velocity : float
        V_R = U / (f D) [-].
    reynolds_number : float
        Re = U D / nu [-].
    strouhal : float
        St at this Reynolds number [-].
    mass_ratio : float
        m_e / (rho D^2) [-].
    logarithmic_decrement : float
        delta = 2 pi zeta [-].
    scruton_number : float
        K_s = 2 m_e delta / (rho D^2) [-].
    skop_griffin_number : float
        S_G = 2 pi St^2 K_s [-].
    """

    reduced_velocity: float
    reynolds_number: float
    strouhal: float
    mass_ratio: float
    logarithmic_decrement: float
    scruton_number: float
    skop_griffin_number: float


@dataclass(frozen=True)
class LockInBand:
    """Wind speeds in which the shedding may lock to the natural frequency.

    Attributes
    ----------
    low, high : float
        [m/s]; NaN if the tables over the Reynolds number do not reach the band.
    resonance : float
        Lowest speed at which vortices are shed at the natural frequency [m/s]; NaN if the tables do not reach it.
    clipped : bool
        Whether a table over the Reynolds number ends inside the band, so that the band may be wider.
    ratios : (float, float)
        Shedding frequency over natural frequency at both ends [-].
    standing, source : str
        Where the ratios come from.
    """

    low: float
    high: float
    resonance: float
    clipped: bool
    ratios: tuple[float, float]
    standing: str
    source: str


LOCK_IN_RATIOS = (1 / 1.2, 1 / 0.8)
LOCK_IN_SOURCE = "shedding frequency within 0.8 ... 1.2 of the natural one, as in DNV-RP-C205 (quoted from memory)"


def scruton_number(
    mass_per_length: float, damping_ratio: float, diameter: float, air_density: float = AIR_DENSITY
) -> float:
    """K_s = 2 m_e delta / (rho D^2) [-], delta = 2 pi zeta; also called mass damping parameter.

    Parameters
    ----------
    mass_per_length : float
        Equivalent mass m_e = int m phi^2 / int phi^2 [kg/m]; for a rigid pipe its mass per length.
    damping_ratio : float
        zeta [-].
    diameter : float
        D [m].
    air_density : float
        rho [kg/m^3].
    """
    m = check_number("mass_per_length", mass_per_length, above=0, unit="kg/m")
    D = check_number("diameter", diameter, above=0, unit="m")
    rho = check_number("air_density", air_density, above=0, unit="kg/m^3")
    return 4 * math.pi * m * check_number("damping_ratio", damping_ratio, at_least=0) / (rho * D**2)


def skop_griffin_number(scruton: float, strouhal: float) -> float:
    """S_G = 2 pi St^2 K_s [-].

    Parameters
    ----------
    scruton : float
        K_s [-].
    strouhal : float
        St [-].
    """
    return 2 * math.pi * check_number("strouhal", strouhal, above=0) ** 2 * check_number("scruton", scruton, at_least=0)


def similarity(case: Case, speed: float | None = None, *, mass_per_length: float | None = None) -> Similarity:
    """Similarity numbers of a case.

    Parameters
    ----------
    case : Case
    speed : float, optional
        Wind speed [m/s]; that of the case by default.
    mass_per_length : float, optional
        Equivalent mass m_e of the mode [kg/m]; that of the case by default. Where neither says it, mass ratio, K_s and
        S_G are NaN.

    Raises
    ------
    ParameterError
        If the Strouhal number is not given at this speed.
    """
    pipe, rho, shedding = case.pipe, case.wind.air_density, vortex_shedding(case, speed)
    mass = pipe.mass_per_length if mass_per_length is None else mass_per_length
    K = math.nan if mass is None else scruton_number(mass, pipe.damping_ratio, pipe.diameter, rho)
    return Similarity(
        reduced_velocity=shedding.reduced_velocity,
        reynolds_number=shedding.reynolds_number,
        strouhal=shedding.strouhal,
        mass_ratio=math.nan if mass is None else mass / (rho * pipe.diameter**2),
        logarithmic_decrement=2 * math.pi * pipe.damping_ratio,
        scruton_number=K,
        skop_griffin_number=math.nan if mass is None else skop_griffin_number(K, shedding.strouhal),
    )


def lock_in_band(case: Case, ratios: tuple[float, float] | None = None) -> LockInBand:
    """Band of wind speeds around 1/St in which the shedding may lock to the natural frequency.

    Parameters
    ----------
    case : Case
    ratios : (float, float), optional
        Shedding frequency of the pipe at rest over its natural frequency at both ends; by default 1/1.2 and 1/0.8,
        which stand on a secondary source.

    Raises
    ------
    ParameterError
        If the ratios do not enclose 1.
    """
    low, high = LOCK_IN_RATIOS if ratios is None else ratios
    low = check_number("ratios[0]", low, above=0, at_most=1)
    high = check_number("ratios[1]", high, at_least=1)
    law, omega = wind_excitation(case), case.pipe.frequency
    first, middle, last = (law.speeds_of(ratio * omega) for ratio in (low, 1.0, high))
    ends = law.speed_range
    reached = first.size + middle.size + last.size > 0
    given = ratios is not None
    return LockInBand(
        low=_end(first, min, ends[0] if reached else math.nan),
        high=_end(last, max, ends[1] if reached else math.nan),
        resonance=_end(middle, min, math.nan),
        clipped=not (first.size and last.size),
        ratios=(low, high),
        standing="of the user" if given else "secondary",
        source="given" if given else LOCK_IN_SOURCE,
    )


def resonant_shedding(case: Case) -> VortexShedding:
    """What the wind does in resonance with the governing mode: the lift by which a case is asked about.

    That of the wind that sheds there; that of the wind of the case where one lift is asked for at every frequency
    (`analysis.detuning`), or where the tables of the case do not reach the resonance.

    Parameters
    ----------
    case : Case
    """
    one_lift = case.analysis.detuning is not None and case.analysis.wind is None
    speed = lock_in_band(case).resonance
    return vortex_shedding(case, None if one_lift or math.isnan(speed) else speed)


def _end(speeds: Floats, choose: Callable[[Floats], float], otherwise: float) -> float:
    return float(choose(speeds)) if speeds.size else otherwise
