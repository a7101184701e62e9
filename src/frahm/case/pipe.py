"""The section `pipe` of a case: what vibrates."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from frahm.case.quantities import Quantity
from frahm.case.section import Section


class Pipe(Section):
    """The pipe as one mode of vibration."""

    mass: Annotated[float, Quantity("kg", "m_1", above=0)] = Field(
        title="Mass of the pipe",
        description="Vibrating mass of the length of pipe given by `length`, added mass included.",
    )
    length: Annotated[float, Quantity("m", "l", above=0)] = Field(
        default=1.0,
        title="Length of pipe",
        description="Length that `mass` and the lift belong to; 1 m when the mass is given per metre.",
    )
    frequency: Annotated[float, Quantity("rad/s", "omega", above=0)] = Field(
        title="Natural frequency of the pipe",
        description="Angular frequency without absorbers; as text it may be given in Hz.",
    )
    damping_ratio: Annotated[float, Quantity("", "zeta", at_least=0, below=1)] = Field(
        title="Damping ratio of the pipe",
        description="Fraction of critical damping without absorbers.",
    )
    diameter: Annotated[float, Quantity("m", "D", above=0)] = Field(
        title="Outer diameter of the pipe",
        description="The diameter the wind sees.",
    )
