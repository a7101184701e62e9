"""Room `loads`: what the wind does to the pipe."""

from frahm.loads.over_wind import (
    ExcitationOverWind,
    WindExcitation,
    excitation_over_wind,
    speed_window,
    wind_excitation,
)
from frahm.loads.reynolds import ReynoldsCurve, lift_curve, strouhal_curve
from frahm.loads.vortex import (
    AIR_VISCOSITY,
    VortexShedding,
    lift_amplitude,
    reduced_velocity,
    reynolds_number,
    shedding_frequency,
    vortex_shedding,
)

__all__ = [
    "AIR_VISCOSITY",
    "ExcitationOverWind",
    "ReynoldsCurve",
    "VortexShedding",
    "WindExcitation",
    "excitation_over_wind",
    "lift_amplitude",
    "lift_curve",
    "reduced_velocity",
    "reynolds_number",
    "shedding_frequency",
    "speed_window",
    "strouhal_curve",
    "vortex_shedding",
    "wind_excitation",
]
