"""Room `loads`: what the wind does to the pipe."""

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
    "VortexShedding",
    "lift_amplitude",
    "reduced_velocity",
    "reynolds_number",
    "shedding_frequency",
    "vortex_shedding",
]
