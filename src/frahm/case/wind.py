"""The section `wind` of a case: what excites."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from frahm.case.quantities import Quantity
from frahm.case.reynolds import LIFT, LIFT_CURVES, STROUHAL, STROUHAL_CURVES, Coefficient, reynolds_range
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
    viscosity: Annotated[float, Quantity("m^2/s", "nu", above=0)] = Field(
        default=1.5e-5,
        title="Kinematic viscosity of the air",
        description="It makes the Reynolds number U D / nu of the wind speed.",
    )
    strouhal: Annotated[Coefficient, STROUHAL] = Field(
        default=0.2,
        title="Strouhal number",
        description="Shedding frequency [Hz] times diameter over wind speed; a number, a table or a published curve.",
    )
    lift_coefficient: Annotated[Coefficient, LIFT] = Field(
        title="Lift coefficient",
        description="Amplitude of the lift over 1/2 rho U^2 D per length; a number, a table or a published curve.",
    )

    def speed_ranges(self, diameter: float) -> dict[str, tuple[float, float]]:
        """Lowest and highest speed [m/s] that `strouhal` and `lift_coefficient` are given for, by the field's name."""
        scale = self.viscosity / diameter
        ranges = {
            "strouhal": reynolds_range(self.strouhal, STROUHAL_CURVES),
            "lift_coefficient": reynolds_range(self.lift_coefficient, LIFT_CURVES),
        }
        return {name: (scale * low, scale * high) for name, (low, high) in ranges.items()}
