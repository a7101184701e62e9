"""Vortex shedding from a pipe in the wind: Strouhal frequency and harmonic lift."""

from __future__ import annotations

import math
from dataclasses import dataclass

from frahm.case import Case
from frahm.case.wind import AIR_DENSITY, AIR_VISCOSITY
from frahm.errors import ParameterError, check_number
from frahm.loads.reynolds import EDGE, lift_curve, strouhal_curve


def shedding_frequency(speed: float, diameter: float, strouhal: float) -> float:
    """Angular frequency of vortex shedding, Omega = 2 pi St U / D [rad/s].

    Parameters
    ----------
    speed : float
        Wind speed U [m/s].
    diameter : float
        Outer diameter D [m].
    strouhal : float
        Strouhal number St [-].
    """
    D = check_number("diameter", diameter, above=0, unit="m")
    St = check_number("strouhal", strouhal, above=0)
    return 2 * math.pi * St * check_number("speed", speed, at_least=0, unit="m/s") / D


def lift_amplitude(
    speed: float, diameter: float, lift_coefficient: float, air_density: float = AIR_DENSITY, length: float = 1.0
) -> float:
    """Amplitude of the harmonic lift, F_L = 1/2 C_L rho U^2 D l [N].

    Parameters
    ----------
    speed : float
        Wind speed U [m/s].
    diameter : float
        Outer diameter D [m].
    lift_coefficient : float
        Amplitude of the lift coefficient C_L [-].
    air_density : float
        rho [kg/m^3].
    length : float
        Length of pipe l the lift acts on, in phase all along [m].
    """
    U = check_number("speed", speed, at_least=0, unit="m/s")
    D = check_number("diameter", diameter, above=0, unit="m")
    CL = check_number("lift_coefficient", lift_coefficient, at_least=0)
    rho = check_number("air_density", air_density, above=0, unit="kg/m^3")
    return 0.5 * CL * rho * U * U * D * check_number("length", length, above=0, unit="m")


def reduced_velocity(speed: float, frequency: float, diameter: float) -> float:
    """V_R = U / (f D) [-], with the natural frequency omega = 2 pi f given in rad/s.

    Parameters
    ----------
    speed : float
        Wind speed U [m/s].
    frequency : float
        Natural frequency omega [rad/s].
    diameter : float
        Outer diameter D [m].
    """
    omega = check_number("frequency", frequency, above=0, unit="rad/s")
    D = check_number("diameter", diameter, above=0, unit="m")
    return 2 * math.pi * check_number("speed", speed, at_least=0, unit="m/s") / omega / D


def reynolds_number(speed: float, diameter: float, viscosity: float = AIR_VISCOSITY) -> float:
    """Re = U D / nu [-].

    Parameters
    ----------
    speed : float
        Wind speed U [m/s].
    diameter : float
        Outer diameter D [m].
    viscosity : float
        Kinematic viscosity nu [m^2/s].
    """
    nu = check_number("viscosity", viscosity, above=0, unit="m^2/s")
    D = check_number("diameter", diameter, above=0, unit="m")
    return check_number("speed", speed, at_least=0, unit="m/s") * D / nu


@dataclass(frozen=True)
class VortexShedding:
    """What the wind of a case does to its pipe.

    Attributes
    ----------
    frequency : float
        Shedding frequency Omega [rad/s].
    detuning : float
        Omega minus the natural frequency of the pipe [rad/s].
    lift : float
        Amplitude of the lift F_L on the length of pipe of the case [N].
    reduced_velocity : float
        U / (f D) [-].
    reynolds_number : float
        U D / nu [-].
    speed : float
        Wind speed U [m/s].
    strouhal, lift_coefficient : float
        St and C_L at this Reynolds number [-].
    """

    frequency: float
    detuning: float
    lift: float
    reduced_velocity: float
    reynolds_number: float
    speed: float
    strouhal: float
    lift_coefficient: float

    @property
    def frequency_hz(self) -> float:
        """Shedding frequency [Hz]."""
        return self.frequency / (2 * math.pi)


def vortex_shedding(case: Case, speed: float | None = None) -> VortexShedding:
    """Frequency, lift and similarity numbers of a case.

    Parameters
    ----------
    case : Case
    speed : float, optional
        Wind speed [m/s]; that of the case by default.

    Raises
    ------
    ParameterError
        If the Strouhal number or the lift coefficient is not given at this speed: they are never extrapolated.
    """
    wind, pipe = case.wind, case.pipe
    U = wind.speed if speed is None else check_number("speed", speed, above=0, unit="m/s")
    check_speeds(case, "speed", U, U)
    Re = reynolds_number(U, pipe.diameter, wind.viscosity)
    St, CL = float(strouhal_curve(wind).value(Re)), float(lift_curve(wind).value(Re))
    frequency = shedding_frequency(U, pipe.diameter, St)
    return VortexShedding(
        frequency=frequency,
        detuning=frequency - pipe.frequency,
        lift=lift_amplitude(U, pipe.diameter, CL, wind.air_density, pipe.length),
        reduced_velocity=reduced_velocity(U, pipe.frequency, pipe.diameter),
        reynolds_number=Re,
        speed=U,
        strouhal=St,
        lift_coefficient=CL,
    )


def check_speeds(case: Case, name: str, low: float, high: float) -> None:
    """Refuse wind speeds [m/s] for which the Strouhal number or the lift coefficient of a case is not given."""
    for field, (lowest, highest) in case.wind.speed_ranges(case.pipe.diameter).items():
        if low < lowest * (1 - EDGE) or high > highest * (1 + EDGE):
            raise ParameterError(
                name, low if low == high else (low, high), f"speeds within {lowest:g} ... {highest:g} m/s",
                hint=f"Beyond them wind.{field} is not given, and it is not extrapolated.",
            )  # fmt: skip
