"""The section `analysis` of a case: what is computed."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from frahm.case.quantities import Choice, Count, Range, refusal
from frahm.case.section import CaseSection


class Analysis(CaseSection):
    """What is computed for the case."""

    wind: Annotated[tuple[float, float] | None, Range("m/s", "U", above=0)] = Field(
        default=None,
        title="Window of wind speed",
        description="Winds looked at, each with its own lift; left out: all winds of the site that excite a mode.",
    )
    detuning: Annotated[tuple[float, float] | None, Range("rad/s", "sigma")] = Field(
        default=None,
        title="Window of detuning",
        description="In place of winds: excitation frequency minus natural frequency, all with the lift of wind.speed.",
    )
    harmonics: Annotated[int | Literal["auto"], Count(at_most=199, words=("auto",))] = Field(
        default="auto",
        title="Harmonics",
        description="Highest harmonic of the harmonic balance; with auto as many as the accuracy needs.",
    )
    form: Annotated[Literal["averaged", "paper"], Choice(("averaged", "paper"))] = Field(
        default="averaged",
        title="Form of the slow flow",
        description="averaged keeps the exact excitation frequency, paper is the published expansion.",
    )
    periods: Annotated[int, Count(at_most=1_000_000)] = Field(
        default=1000,
        title="Periods of time integration",
        description="Excitation periods a motion is followed for before it is judged.",
    )
    samples: Annotated[int, Count(at_most=1_000_000)] = Field(
        default=200,
        title="Initial states",
        description="Number of initial states in the search for attractors.",
    )
    seed: Annotated[int, Count(at_least=0)] = Field(
        default=1,
        title="Seed",
        description="Seed of the random initial states: the same seed gives the same result.",
    )

    @model_validator(mode="after")
    def _one_window(self) -> Analysis:
        if self.wind is not None and self.detuning is not None:
            hint = "The lift follows the wind, or it stays that of wind.speed over a window of detuning."
            raise refusal("at most one of wind and detuning", hint=hint, path="analysis.wind", value=list(self.wind))
        return self
