"""The section `wind` of a case: what excites."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field

from frahm.case.quantities import Choice, FieldType, Quantity, Range, refusal
from frahm.case.reynolds import LIFT, LIFT_CURVES, STROUHAL, STROUHAL_CURVES, Coefficient, reynolds_range
from frahm.case.section import CaseSection
from frahm.case.table_files import Column, table_rows

AIR_DENSITY, AIR_VISCOSITY = 1.225, 1.5e-5  # kinematic; at sea level and near 20 degrees Celsius [kg/m^3, m^2/s]
SPECTRA = ("kaimal", "en1991", "von-karman")
RECORD_COLUMNS = (Column("time", "s"), Column("speed", "m/s"))
_MOST_SAMPLES = 5000  # the samples become part of the case, which must stay a file that can be read


class Turbulence(CaseSection):
    """Synthetic gusts around the wind speed."""

    intensity: Annotated[float, Quantity("", "I_u", at_least=0, at_most=1)] = Field(
        title="Turbulence intensity", description="Standard deviation of the speed over its mean."
    )
    length_scale: Annotated[float, Quantity("m", "L_u", above=0)] = Field(
        title="Length scale of the turbulence", description="Mean speed times the time a gust lasts."
    )
    spectrum: Annotated[Literal["kaimal", "en1991", "von-karman"], Choice(SPECTRA)] = Field(
        default="kaimal", title="Spectrum of the turbulence", description="How the gusts spread over frequency."
    )


@dataclass(frozen=True)
class Record(FieldType):
    """Pairs of time and wind speed, or the CSV file they are read from when the case is."""

    @property
    def unit(self) -> str:
        """SI units."""
        return "s, m/s"

    @property
    def allowed(self) -> str:
        """What is let in."""
        return (
            f"2 to {_MOST_SAMPLES} pairs [time in s, speed in m/s], times ascending and speeds >= 0, "
            "or the name of a CSV or MAT file with the columns time and speed"
        )

    def read(self, value: Any) -> tuple[tuple[float, float], ...]:
        """Pairs in SI units; none for nothing."""
        if value is None or value in ((), []):
            return ()
        if isinstance(value, str):
            value = [(row["time"], row["speed"]) for row in table_rows(value, RECORD_COLUMNS)]
        if not isinstance(value, list | tuple) or not 2 <= len(value) <= _MOST_SAMPLES:
            hint = "A longer record goes to frahm.unsteady_response(case, record=...)." if value else None
            raise refusal(self.allowed, hint=hint)
        time, speed = Quantity("s"), Quantity("m/s", at_least=0)
        pairs: list[tuple[float, float]] = []
        for place, entry in enumerate(value):
            if not isinstance(entry, list | tuple) or len(entry) != 2:
                raise refusal(self.allowed, hint=f"Entry {place} is no pair.")
            try:
                pairs.append((time.read(entry[0]), speed.read(entry[1])))
            except ValueError:
                raise refusal(self.allowed, hint=f"Entry {place} is {list(entry)!r}.") from None
            if place and not pairs[-1][0] > pairs[-2][0]:
                raise refusal(self.allowed, hint=f"Entry {place}: {pairs[-1][0]:g} s does not ascend.")
        return tuple(pairs)

    def json_schema(self) -> dict[str, Any]:
        """JSON schema: pairs, or the name of a file."""
        pair = {"type": "array", "minItems": 2, "maxItems": 2}
        return {"anyOf": [{"type": "array", "items": pair, "maxItems": _MOST_SAMPLES}, {"type": "string"}]}


class Wind(CaseSection):
    """The wind that sheds vortices from the pipe."""

    speed: Annotated[float, Quantity("m/s", "U", above=0)] = Field(
        title="Wind speed",
        description="Speed across the pipe.",
    )
    air_density: Annotated[float, Quantity("kg/m^3", "rho_air", above=0)] = Field(
        default=AIR_DENSITY,
        title="Density of the air",
        description="Density of the fluid that flows around the pipe.",
    )
    viscosity: Annotated[float, Quantity("m^2/s", "nu", above=0)] = Field(
        default=AIR_VISCOSITY,
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

    range: Annotated[tuple[float, float] | None, Range("m/s", "U", at_least=0)] = Field(
        default=None,
        title="Winds of the site",
        description="Lowest and highest speed the pipe can meet; left out: those of the climate, or no bound.",
    )
    record: Annotated[tuple[tuple[float, float], ...], Record()] = Field(
        default=(),
        title="Wind record",
        description="Pairs of time and speed, or a CSV or MAT file with these columns, for unsteady wind.",
    )
    turbulence: Turbulence | None = Field(
        default=None,
        title="Turbulence",
        description="Synthetic gusts, for the motion in unsteady wind without a record.",
    )

    def speed_ranges(self, diameter: float) -> dict[str, tuple[float, float]]:
        """Lowest and highest speed [m/s] that `strouhal` and `lift_coefficient` are given for, by the field's name."""
        scale = self.viscosity / diameter
        ranges = {
            "strouhal": reynolds_range(self.strouhal, STROUHAL_CURVES),
            "lift_coefficient": reynolds_range(self.lift_coefficient, LIFT_CURVES),
        }
        return {name: (scale * low, scale * high) for name, (low, high) in ranges.items()}
