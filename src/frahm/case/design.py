"""The section `design` of a case: what a good absorber is, and what it must keep."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from frahm.case.quantities import Choice, Count, Quantity, QuantityList, QuantityOrNothing, Range, refusal
from frahm.case.section import CaseSection
from frahm.errors import nearest

FAMILIES = ("sink", "tuned", "mixed")
OBJECTIVES = ("peak", "rms", "expected", "damage")


@dataclass(frozen=True)
class NumberOrRange(Range):
    """A quantity, or a range of it; or nothing."""

    @property
    def allowed(self) -> str:
        """What is let in."""
        return f"{Quantity.allowed.fget(self)}; or two of them (lo, hi) with lo < hi; or nothing"  # type: ignore[attr-defined]

    def read(self, value: Any) -> Any:
        """The number in the SI unit, both ends of the range, or None."""
        if value is None or (hasattr(value, "__len__") and not isinstance(value, str)):
            return super().read(value)
        return Quantity.read(self, value)

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        return {"anyOf": [Quantity.json_schema(self), *super().json_schema()["anyOf"]]}


@dataclass(frozen=True)
class CountOrRange(Count):
    """A whole number, or a range of them."""

    @property
    def allowed(self) -> str:
        """What is let in."""
        return f"{super().allowed}; or two of them (lo, hi) with lo <= hi"

    def read(self, value: Any) -> Any:
        """The number, or both ends of the range."""
        if isinstance(value, list | tuple):
            if len(value) != 2:
                raise refusal(self.allowed)
            lo, hi = (int(super(CountOrRange, self).read(item)) for item in value)
            if lo > hi:
                raise refusal(self.allowed)
            return lo if lo == hi else (lo, hi)
        return super().read(value)

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        one = super().json_schema()
        return {"anyOf": [one, {"type": "array", "minItems": 2, "maxItems": 2, "items": one}]}


@dataclass(frozen=True)
class Shares(QuantityList):
    """Shares of a whole, or one of a few words."""

    words: tuple[str, ...] = ()

    @property
    def allowed(self) -> str:
        """What is let in."""
        return "one of " + ", ".join(self.words) + f"; or {super().allowed}, that add up to 1"

    def read(self, value: Any) -> Any:
        """The word, or the shares."""
        if isinstance(value, str):
            if value not in self.words:
                near = nearest(value, self.words)
                raise refusal(self.allowed, hint=f"Did you mean {near!r}?" if near else None)
            return value
        found = super().read(value)
        if abs(sum(found) - 1) > _ADDED_UP:
            raise refusal(self.allowed, hint=f"They add up to {sum(found):.6g}.")
        return tuple(share / sum(found) for share in found)

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        return {"anyOf": [{"enum": list(self.words)}, super().json_schema()]}


_ADDED_UP = 1e-6  # shares are written with a few digits
MOST_ABSORBERS = 6
_Pair = tuple[float, float]
_SHARE = Quantity("", at_least=0, at_most=0.5)


class Scatter(CaseSection):
    """How far what a design meets may be off what it was designed for, as fractions either way."""

    pipe_frequency: Annotated[float, _SHARE] = Field(
        default=0.0, title="Scatter of the pipe's frequency", description="With it the lift, as the square: lock-in."
    )
    pipe_damping: Annotated[float, _SHARE] = Field(
        default=0.0, title="Scatter of the pipe's damping", description="Of its damping ratio."
    )
    kappa: Annotated[float, _SHARE] = Field(
        default=0.0,
        title="Scatter of the absorber's stiffness",
        description="Of its spring, linear and nonlinear part alike.",
    )
    xi2: Annotated[float, _SHARE] = Field(
        default=0.0, title="Scatter of the absorber's damping", description="Of its damper."
    )
    force: Annotated[float, _SHARE] = Field(
        default=0.0, title="Scatter of the force", description="Of the lift at a given wind."
    )

    @property
    def names(self) -> tuple[str, ...]:
        """What scatters."""
        return tuple(name for name in type(self).model_fields if getattr(self, name) > 0)


class Design(CaseSection):
    """What the best absorber is asked for. A value per mass is divided by the mass of the pipe."""

    objective: Annotated[Literal["peak", "rms", "expected", "damage"], Choice(OBJECTIVES)] = Field(
        default="peak",
        title="Objective",
        description="Made as small as can be: peak and rms, the worst of the pipe over all attractors; expected, its"
        " mean peak over wind climate and basins; damage, that of fatigue over the wind climate.",
    )
    family: Annotated[Literal["sink", "tuned", "mixed"], Choice(FAMILIES)] = Field(
        default="sink",
        title="Family",
        description="sink: cubic spring alone; tuned: linear spring alone; mixed: both.",
    )
    mass_ratio: Annotated[float | _Pair | None, NumberOrRange("", "rho2", above=0, at_most=1)] = Field(
        default=None,
        title="Mass ratio",
        description="Mass of all of them together over that of the pipe, or a range; left out: the case's, or 0.02.",
    )
    count: Annotated[int | tuple[int, int], CountOrRange(at_least=1, at_most=MOST_ABSORBERS)] = Field(
        default=1,
        title="Number of absorbers",
        description="Designed together; or the least and the most, of which the best number is chosen. They take the"
        " place of as many absorbers of the case.",
    )
    mass_shares: Annotated[
        Literal["equal", "free"] | tuple[float, ...],
        Shares("", above=0, below=1, shortest=2, longest=MOST_ABSORBERS, words=("equal", "free")),
    ] = Field(
        default="equal",
        title="Masses of several absorbers",
        description="equal; free, their sum being the mass ratio; or the share of each.",
    )
    devices: Annotated[Literal["any", "equal"], Choice(("any", "equal"))] = Field(
        default="any",
        title="Devices of several absorbers",
        description="any: each with its own spring and damper; equal: one drawing for all.",
    )
    linear: Annotated[_Pair | None, Range("1/s^2", "k1/m1", at_least=0)] = Field(
        default=None, title="Range of the linear stiffness", description="Per mass; left out: wide."
    )
    kappa: Annotated[_Pair | None, Range("1/(m^2 s^2)", "kappa", at_least=0)] = Field(
        default=None, title="Range of the cubic stiffness", description="Per mass; left out: wide."
    )
    quintic: Annotated[_Pair | None, Range("1/(m^4 s^2)", "k5/m1", at_least=0)] = Field(
        default=None,
        title="Range of the quintic stiffness",
        description="Per mass, of the fifth power; left out: no such part.",
    )
    xi2: Annotated[_Pair | None, Range("1/s", "xi2", at_least=0)] = Field(
        default=None, title="Range of the damping", description="Of the absorber, per mass; left out: wide."
    )
    position: Annotated[_Pair | None, Range("m", "s", at_least=0)] = Field(
        default=None,
        title="Range of the position",
        description="Along an elastic pipe; left out: where the case has its absorber, or where the pipe moves most.",
    )
    wind: Annotated[_Pair | None, Range("m/s", "U", above=0)] = Field(
        default=None,
        title="Range of the wind speed",
        description="In which the worst is looked for, with the lift of every wind; left out: the window of detuning.",
    )
    scatter: Scatter = Field(
        default=Scatter(),
        title="Scatter",
        description="How far pipe, absorber and force may be off; a number alone is that of the pipe's frequency.",
    )
    quantile: Annotated[float | None, QuantityOrNothing("", "q", at_least=0.5, below=1)] = Field(
        default=None,
        title="Quantile",
        description="Of the objective over the scatter, uniform; left out: the worst over it.",
    )
    scatter_samples: Annotated[int, Count(at_least=4, at_most=4096)] = Field(
        default=16,
        title="Samples of the scatter",
        description="Pipes and absorbers drawn, where more than the pipe's frequency scatters or a quantile is asked.",
    )
    force_margin: Annotated[float, Quantity("", "margin", at_least=1, at_most=3)] = Field(
        default=1.05,
        title="Force margin",
        description="Factor on the force up to which no detached response curve may exist.",
    )
    stroke: Annotated[float | None, QuantityOrNothing("m", "z_max", above=0)] = Field(
        default=None, title="Largest stroke", description="Between absorber and pipe; left out: no limit."
    )
    spring_length: Annotated[float | None, QuantityOrNothing("m", "L", above=0)] = Field(
        default=None,
        title="Room for a transverse spring",
        description="Free length of each of the two springs, which is four times the stroke at least; left out: no"
        " limit.",
    )
    spring_stress: Annotated[float | None, QuantityOrNothing("Pa", "tau", above=0)] = Field(
        default=None,
        title="Shear stress allowed in the springs",
        description="If given, coil springs of this stress must fit into their length.",
    )
    samples: Annotated[int, Count(at_most=1_000_000)] = Field(
        default=200, title="Initial states", description="At every frequency, in the verification."
    )
    seed: Annotated[int, Count(at_least=0)] = Field(
        default=1, title="Seed", description="Of the samples: the same seed gives the same result."
    )
    errors: Annotated[tuple[float, ...], QuantityList("", "r", at_least=0.5, at_most=1.5, shortest=0, longest=50)] = (
        Field(
            default=(0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15),
            title="Frequencies of the comparison",
            description="Of the pipe over the nominal one: there all devices are compared, not retuned.",
        )
    )
    margins: Annotated[tuple[float, ...], QuantityList("", "margin", at_least=1, at_most=3, shortest=0, longest=20)] = (
        Field(
            default=(1.0, 1.05, 1.1, 1.15, 1.2),
            title="Force margins of the trade-off",
            description="For which the best worst peak is looked for, too.",
        )
    )

    @model_validator(mode="before")
    @classmethod
    def _scatter_in_short(cls, data: Any) -> Any:
        if isinstance(data, dict) and isinstance(data.get("scatter"), int | float | str):
            return data | {"scatter": {"pipe_frequency": data["scatter"]}}
        return data

    @model_validator(mode="after")
    def _shares_fit(self) -> Design:
        shares = self.mass_shares
        if isinstance(shares, tuple):
            if self.count != len(shares):
                raise refusal(
                    f"a number of shares that is the number of absorbers, {self.count}", path="design.mass_shares",
                    value=shares,
                )  # fmt: skip
            if self.equal and max(shares) - min(shares) > _ADDED_UP:
                raise refusal(
                    "equal shares where the absorbers are one device", path="design.mass_shares", value=shares
                )
        if self.equal and shares == "free":
            raise refusal("equal where the absorbers are one device", path="design.mass_shares", value=shares)
        return self

    @property
    def equal(self) -> bool:
        """Whether all absorbers designed together are one device."""
        return self.devices == "equal"

    @property
    def counts(self) -> tuple[int, ...]:
        """Numbers of absorbers to be tried, ascending."""
        lo, hi = self.count if isinstance(self.count, tuple) else (self.count, self.count)
        return tuple(range(lo, hi + 1))

    def shares(self, count: int) -> tuple[float, ...] | None:
        """Share of the mass that each of so many absorbers has; None where they are free."""
        if count == 1:
            return (1.0,)
        if isinstance(self.mass_shares, tuple):
            return self.mass_shares
        return (1.0 / count,) * count if self.mass_shares == "equal" else None

    @property
    def mass_range(self) -> tuple[float, float] | None:
        """Range of the mass ratio, if one is given."""
        return self.mass_ratio if isinstance(self.mass_ratio, tuple) else None

    @property
    def most_stroke(self) -> float:
        """Largest stroke that stroke limit and room for the springs leave [m]; infinite without either."""
        room = math.inf if self.spring_length is None else 0.25 * self.spring_length
        return min(room, math.inf if self.stroke is None else self.stroke)
