"""The section `fatigue` of a case: the detail whose damage is counted."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator

from frahm.case.quantities import Choice, Count, Quantity, refusal
from frahm.case.section import CaseSection

SN_CURVE_NAMES = ("B1", "B2", "C", "C1", "C2", "D", "E", "F", "F1", "F3", "G", "W1", "W2", "W3", "T")  # DNV-RP-C203
_Curve = Literal["B1", "B2", "C", "C1", "C2", "D", "E", "F", "F1", "F3", "G", "W1", "W2", "W3", "T"]


class Fatigue(CaseSection):
    """The detail whose fatigue damage is counted, and how its stress follows from the motion of the pipe."""

    curve: Annotated[_Curve, Choice(SN_CURVE_NAMES)] = Field(
        title="S-N curve", description="Curve of DNV-RP-C203 in air."
    )
    stress_per_displacement: Annotated[float, Quantity("Pa/m", "s", above=0)] | None = Field(
        default=None,
        title="Stress per displacement",
        description="Nominal stress at the detail over displacement of the pipe; a pipe given as one mode needs it.",
    )
    stress_concentration: Annotated[float, Quantity("", "SCF", at_least=1, at_most=50)] = Field(
        default=1.0, title="Stress concentration factor", description="Hot-spot stress over nominal stress."
    )
    thickness: Annotated[float, Quantity("m", "t", above=0)] = Field(
        default=0.025,
        title="Thickness at the detail",
        description="Through which a crack would grow; up to the reference thickness it changes nothing.",
    )
    reference_thickness: Annotated[float, Quantity("m", "t_ref", above=0)] = Field(
        default=0.025,
        title="Reference thickness of the S-N curve",
        description="25 mm, and 16 mm for tubular joints.",
    )
    design_fatigue_factor: Annotated[float, Quantity("", "DFF", at_least=1, at_most=100)] = Field(
        default=1.0,
        title="Design fatigue factor",
        description="Factor on the damage before it is held against one; up to 10 where nobody can inspect.",
    )
    wind_speeds: (
        tuple[
            Annotated[float, Quantity("m/s", "U", above=0)],
            Annotated[float, Quantity("m/s", "U", above=0)],
        ]
        | None
    ) = Field(
        default=None,
        title="Band of wind speeds",
        description="Winds whose damage is counted; by default those that shed inside the window of detuning.",
    )
    position: Annotated[float, Quantity("m", "s", at_least=0)] | None = Field(
        default=None,
        title="Position of the detail",
        description="Along an elastic pipe, counted as its supports are; by default where the stress is largest.",
    )
    bins: Annotated[int, Count(at_least=4, at_most=2000)] = Field(
        default=40, title="Wind bins", description="Number of classes the band of wind speeds is divided into."
    )
    samples: Annotated[int, Count(at_least=1, at_most=100_000)] = Field(
        default=32, title="Initial states per wind bin", description="In the search for attractors at every wind."
    )

    @field_validator("wind_speeds", mode="after")
    @classmethod
    def _ascending(cls, band: tuple[float, float] | None) -> tuple[float, float] | None:
        if band is not None and not band[0] < band[1]:
            raise refusal("two wind speeds (lo, hi) with lo < hi [m/s]")
        return band
