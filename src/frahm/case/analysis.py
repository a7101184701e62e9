"""The section `analysis` of a case: what is computed."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, field_validator

from frahm.case.quantities import Choice, Count, Quantity, refusal
from frahm.case.section import Section


class Analysis(Section):
    """What is computed for the case."""

    detuning: tuple[
        Annotated[float, Quantity("rad/s", "sigma")],
        Annotated[float, Quantity("rad/s", "sigma")],
    ] = Field(
        default=(-0.4, 0.4),
        title="Window of detuning",
        description="Lowest and highest excitation frequency, counted from the natural frequency of the pipe.",
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

    @field_validator("detuning", mode="after")
    @classmethod
    def _ascending(cls, window: tuple[float, float]) -> tuple[float, float]:
        if not window[0] < window[1]:
            raise refusal("two numbers (lo, hi) with lo < hi [rad/s]")
        return window
