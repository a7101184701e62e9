"""The section `limits` of a case: what the member must keep to pass."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from frahm.case.quantities import Quantity, QuantityOrNothing
from frahm.case.section import CaseSection


class Limits(CaseSection):
    """What the worst lasting motion must keep; each of them may be left out."""

    displacement: Annotated[float | None, QuantityOrNothing("m", "x_max", above=0)] = Field(
        default=None, title="Largest displacement", description="Of the pipe, from rest to one side."
    )
    amplitude_ratio: Annotated[float | None, QuantityOrNothing("", "A/D", above=0)] = Field(
        default=None, title="Largest amplitude over diameter", description="Of the pipe, from rest to one side."
    )
    stress_range: Annotated[float | None, QuantityOrNothing("Pa", "S", above=0)] = Field(
        default=None,
        title="Largest stress range",
        description="Nominal bending stress from its lowest to its highest value.",
    )
    yield_strength: Annotated[float | None, QuantityOrNothing("Pa", "f_y", above=0)] = Field(
        default=None,
        title="Yield strength",
        description="The static stress and half the stress range together must stay below it.",
    )
    static_stress: Annotated[float, Quantity("Pa", "sigma_0", at_least=0)] = Field(
        default=0.0,
        title="Static stress",
        description="Of weight and other loads, where bending is largest.",
    )
    stroke: Annotated[float | None, QuantityOrNothing("m", "z_max", above=0)] = Field(
        default=None, title="Largest stroke", description="Between absorber and pipe."
    )
    damage: Annotated[float, Quantity("", "D_max", above=0)] = Field(
        default=1.0,
        title="Largest fatigue damage",
        description="Of the damage times fatigue.design_fatigue_factor, in a case with the section fatigue.",
    )
