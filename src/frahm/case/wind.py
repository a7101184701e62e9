"""The section `wind` of a case: what excites."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from frahm.case.quantities import Quantity
from frahm.case.section import Section


class Wind(Section):
    """The wind that sheds vortices from the pipe."""

    speed: Annotated[float, Quantity("m/s", "U", above=0)] = Field(
        title="Wind speed",
        description="Speed across the pipe.",
    )
    air_density: Annotated[float, Quantity("kg/m^3", "rho_air", above=0)] = Field(
        default=1.225,
        title="Density of the air",
        description="Density of the fluid that flows around the pipe.",
    )
    strouhal: Annotated[float, Quantity("", "St", above=0)] = Field(
        default=0.2,
        title="Strouhal number",
        description="Shedding frequency [Hz] times diameter over wind speed.",
    )
    lift_coefficient: Annotated[float, Quantity("", "C_L", at_least=0)] = Field(
        title="Lift coefficient",
        description="Amplitude of the harmonic lift over 1/2 rho U^2 D per length.",
    )
