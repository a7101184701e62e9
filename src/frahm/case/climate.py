"""The section `climate` of a case: how often the wind blows how fast, and for how long the pipe stands in it."""

from __future__ import annotations

import math
from typing import Annotated, Any

from pydantic import Field, field_validator, model_validator

from frahm.case.quantities import Quantity, refusal
from frahm.case.section import CaseSection
from frahm.case.table_files import Column, table_rows
from frahm.readable import DAY

SUM_TOLERANCE = 1e-3  # a printed table of a few hundred rounded probabilities misses one by less
_COLUMNS = (
    Column("speed", "m/s"),
    Column("probability", ""),
    Column("direction", "rad", required=False, say_unit=True),
)


class Weibull(CaseSection):
    """Wind speeds with P(speed > U) = exp[-(U/scale)^shape]."""

    scale: Annotated[float, Quantity("m/s", "c", above=0)] = Field(
        title="Scale of the Weibull distribution", description="Wind speed that is exceeded 36.8 % of the time."
    )
    shape: Annotated[float, Quantity("", "k", at_least=0.5, at_most=20)] = Field(
        title="Shape of the Weibull distribution", description="Exponent; 2 is the Rayleigh distribution."
    )


class ClimateRow(CaseSection):
    """One class of wind: its middle speed, the direction it blows from, and how probable it is."""

    speed: Annotated[float, Quantity("m/s", "U", at_least=0)] = Field(
        title="Middle speed of the class", description="The class reaches half-way to the next speeds of the table."
    )
    probability: Annotated[float, Quantity("", "P", at_least=0, at_most=1)] = Field(
        title="Probability of the class", description="Share of the time; all rows together make one."
    )
    direction: Annotated[float, Quantity("rad", "theta", at_least=-2 * math.pi, at_most=2 * math.pi)] | None = Field(
        default=None, title="Direction of the class", description="Where the wind blows from; as text in deg."
    )


class Climate(CaseSection):
    """How often the wind blows how fast, by a Weibull distribution or by a table, and for how long."""

    duration: Annotated[float, Quantity("s", "T", at_least=DAY)] = Field(
        title="Duration", description="Time the pipe stands in this wind; as text in years."
    )
    weibull: Weibull | None = Field(
        default=None, title="Weibull distribution", description="Of the wind speed, all directions together."
    )
    table: tuple[ClimateRow, ...] = Field(
        default=(),
        title="Table of winds",
        description="Classes of wind, or the name of a CSV or MAT file with columns speed, probability, direction.",
    )
    direction_factor: Annotated[float, Quantity("", "f", at_least=0, at_most=1)] = Field(
        default=1.0,
        title="Direction factor",
        description="Share of the winds that blow across the pipe; 1 counts all of them.",
    )
    sector: (
        tuple[
            Annotated[float, Quantity("rad", "theta", at_least=-2 * math.pi, at_most=2 * math.pi)],
            Annotated[float, Quantity("rad", "theta", at_least=-2 * math.pi, at_most=2 * math.pi)],
        ]
        | None
    ) = Field(
        default=None,
        title="Sector of directions",
        description="Only winds of the table from this sector count, from the first direction clockwise to the second.",
    )
    correlation_time: Annotated[float, Quantity("s", "T_c", above=0)] = Field(
        default=6 * 3600.0,
        title="Correlation time of the wind speed",
        description="How long the wind remembers its speed; for the persistence in the band only.",
    )

    @field_validator("table", mode="before")
    @classmethod
    def _from_file(cls, value: Any) -> Any:
        if value is None:
            return ()
        return table_rows(value, _COLUMNS) if isinstance(value, str) else value

    @field_validator("table", mode="after")
    @classmethod
    def _complete(cls, rows: tuple[ClimateRow, ...]) -> tuple[ClimateRow, ...]:
        if not rows:
            return rows
        if len({row.speed for row in rows}) < 2:
            raise refusal("a table of at least two different speeds")
        if len({row.direction is None for row in rows}) > 1:
            raise refusal("a table with a direction in every row, or in none")
        places = [(row.speed, None if row.direction is None else row.direction % (2 * math.pi)) for row in rows]
        twice = next((place for index, place in enumerate(places) if place in places[:index]), None)
        if twice is not None:
            raise refusal("a table with every speed and direction once", hint=f"{twice[0]:g} m/s is there twice.")
        total = math.fsum(row.probability for row in rows)
        if abs(total - 1) > SUM_TOLERANCE:
            raise refusal("probabilities that sum to one", hint=f"These sum to {total:.6g}.")
        return rows

    @model_validator(mode="after")
    def _one_distribution(self) -> Climate:
        given = [name for name, there in (("weibull", self.weibull is not None), ("table", bool(self.table))) if there]
        if len(given) != 1:
            raise refusal("exactly one of weibull and table", path="climate", value=" and ".join(given) or "neither")
        if self.sector is not None:
            if not self.table or self.table[0].direction is None:
                allowed = "a sector only with a table that has directions"
                raise refusal(allowed, path="climate.sector", value=self.sector)
            if self.direction_factor != 1:
                hint = "The table knows its directions."
                raise refusal(
                    "1 with a sector", hint=hint, path="climate.direction_factor", value=self.direction_factor
                )
        return self
