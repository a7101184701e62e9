"""The input of a sweep: one frozen `Study`."""

from __future__ import annotations

import functools
import hashlib
import json
import math
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import Field, ValidationError, field_serializer, field_validator, model_validator

from frahm.case import Case
from frahm.case.design import MOST_ABSORBERS
from frahm.case.problems import parameter_error
from frahm.case.quantities import Count, Label, Quantity, refusal
from frahm.case.section import CaseSection
from frahm.errors import ParameterError, check_count
from frahm.sweep.field_types import WINDOW, AxisValues, BaseCase, Place, WholeAxisValues

MOST_POINTS = 5_000_000
_NOT_WITH_FATIGUE = ("wind_speed", "force", "detuning")


def _axis(title: str, what: str) -> Any:
    return Field(default=None, title=title, description=what)


Values = tuple[float, ...] | None


class Axes(CaseSection):
    """What varies. The last axis named here is the one that runs fastest."""

    pipe_frequency: Annotated[Values, AxisValues("rad/s", "omega", above=0, name="pipe_frequency")] = _axis(
        "Natural frequency of the pipe", "Of a pipe given as one mode; its damping ratio stays."
    )
    pipe_damping: Annotated[Values, AxisValues("", "zeta", at_least=0, below=1, name="pipe_damping")] = _axis(
        "Damping ratio of the pipe", "Fraction of critical damping without absorbers."
    )
    wind_speed: Annotated[Values, AxisValues("m/s", "U", above=0, name="wind_speed")] = _axis(
        "Wind speed", "The lift follows it; the frequency too where a quantity is asked for at the detuning 'wind'."
    )
    lift_coefficient: Annotated[Values, AxisValues("", "C_L", at_least=0, name="lift_coefficient")] = _axis(
        "Lift coefficient", "Amplitude of the lift over 1/2 rho U^2 D per length."
    )
    force: Annotated[Values, AxisValues("", "", at_least=0, name="force")] = _axis(
        "Factor on the force", "1 is the lift of the wind."
    )
    position: Annotated[Values, AxisValues("m", "s", at_least=0, name="position")] = _axis(
        "Position of the absorber", "Distance from the first end of an elastic pipe."
    )
    rho2: Annotated[Values, AxisValues("", "rho_2", above=0, name="rho2")] = _axis(
        "Mass ratio", "Mass of the absorber over mass of the pipe."
    )
    count: Annotated[Values, WholeAxisValues("", "N", at_least=1, at_most=MOST_ABSORBERS, name="count")] = _axis(
        "Number of equal absorbers",
        "In place of the one that varies, of the same mass, stiffness and damping together.",
    )
    kappa: Annotated[Values, AxisValues("1/(m^2 s^2)", "kappa", above=0, name="kappa")] = _axis(
        "Cubic stiffness", "Cubic stiffness of the absorber over mass of the pipe."
    )
    xi2: Annotated[Values, AxisValues("1/s", "xi_2", at_least=0, name="xi2")] = _axis(
        "Absorber damping", "Damping of the absorber over mass of the pipe."
    )
    detuning: Annotated[Values, AxisValues("rad/s", "sigma", name="detuning")] = _axis(
        "Detuning", "Excitation frequency minus natural frequency; every quantity is then computed there."
    )


_PLACE = Field(
    default=WINDOW,
    title="Detuning",
    description="At one detuning, over a window [lo, hi], over the window of the case, or where the wind sheds.",
)


class SlowFlowAsked(CaseSection):
    """The slow flow of one mode with one cubic sink, in the form of the case: cheap, approximate."""

    detuning: Annotated[float | tuple[float, float] | str, Place()] = _PLACE


class ResponseAsked(CaseSection):
    """Every exact periodic response, by harmonic balance."""

    detuning: Annotated[float | tuple[float, float] | str, Place()] = _PLACE


class AttractorsAsked(CaseSection):
    """The largest of all lasting motions, as `worst_case` over a window or `find_attractors` at a detuning."""

    detuning: Annotated[float | tuple[float, float] | str, Place()] = _PLACE
    samples: Annotated[int, Count(at_most=1_000_000)] = Field(
        default=60, title="Initial states", description="Sampled at every frequency."
    )
    min_basin: Annotated[float, Quantity("", "", at_least=0, at_most=1)] = Field(
        default=0.01, title="Least basin fraction", description="Of a motion that counts."
    )


class FatigueAsked(CaseSection):
    """Fatigue damage over the wind climate of the case."""


class Quantities(CaseSection):
    """What is computed at every point."""

    slow_flow: SlowFlowAsked | None = Field(
        default=None, title="Slow flow", description="Equilibria of the slow flow and their stability."
    )
    response: ResponseAsked | None = Field(
        default=None, title="Exact response", description="Peaks, branches and stability of the periodic responses."
    )
    attractors: AttractorsAsked | None = Field(
        default=None, title="Attractors", description="The worst of all lasting motions, and whether it is verified."
    )
    fatigue: FatigueAsked | None = Field(
        default=None, title="Fatigue", description="Damage with and without absorbers."
    )

    @model_validator(mode="before")
    @classmethod
    def _empty_means_asked(cls, data: Any) -> Any:
        return {key: {} if value is None else value for key, value in data.items()} if isinstance(data, dict) else data


class Study(CaseSection):
    """A case, what varies, and what is computed at every point. SI units, frequencies in rad/s.

    Raises
    ------
    ParameterError
        Naming the field, what was given and what is allowed.
    """

    name: Annotated[str, Label(shortest=1, longest=60)] = Field(
        default="study", title="Name of the study", description="Short name."
    )
    title: Annotated[str, Label()] = Field(
        default="", title="Title of the study", description="One line that says what the study is."
    )
    case: Annotated[Case, BaseCase()] = Field(
        title="Case", description="What is varied: a built-in case, a file beside this one, or a case written here."
    )
    absorber: Annotated[str, Label(longest=60)] = Field(
        default="", title="Absorber", description="Name of the absorber that varies; left out: the first."
    )
    axes: Axes = Field(title="Axes", description="What varies, and its values.")
    quantities: Quantities = Field(title="Quantities", description="What is computed at every point.")
    seed: Annotated[int, Count(at_least=0)] = Field(
        default=1, title="Seed", description="Every point has its own seed, made of this one and its number."
    )

    def __init__(self, /, **data: Any) -> None:
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise parameter_error(error, type(self)) from error

    @field_validator("axes", "quantities", mode="before")
    @classmethod
    def _empty_section(cls, value: Any) -> Any:
        return {} if value is None else value

    @model_validator(mode="after")
    def _consistent(self) -> Study:
        if not self.axes_given:
            raise refusal("at least one of " + ", ".join(Axes.model_fields), path="axes", value={})
        if not self.asked:
            raise refusal("at least one of " + ", ".join(Quantities.model_fields), path="quantities", value={})
        if self.size > MOST_POINTS:
            raise refusal(f"at most {MOST_POINTS} points in all", path="axes", value=f"{self.size} points")
        for name, asked in self.asked.items():
            if "detuning" in self.axes_given and "detuning" in asked.model_fields_set:
                path = f"quantities.{name}.detuning"
                raise refusal("nothing, because the detuning is an axis", path=path, value=asked.detuning)
        if self.quantities.fatigue is not None:
            self._fatigue_fits()
        self._can_be_built()
        return self

    def _fatigue_fits(self) -> None:
        for axis in _NOT_WITH_FATIGUE:
            if axis in self.axes_given:
                allowed = f"nothing, because the damage over a wind climate does not depend on the axis {axis}"
                raise refusal(allowed, path="quantities.fatigue", value={})
        if self.case.fatigue is None:
            allowed = "nothing, because the case has no section fatigue"
            raise refusal(allowed, path="quantities.fatigue", value={})

    def _can_be_built(self) -> None:
        """A mistake that every point would repeat is one of the study; one of some points stays with them."""
        from frahm.sweep.points import StudyPoint

        try:
            StudyPoint(self, 0).check()
        except ParameterError as first:
            try:
                StudyPoint(self, self.size - 1).check()
            except ParameterError:
                allowed, hint = "axes and quantities that fit the case", f"The first point says: {first}."
                raise refusal(allowed, path="axes", value=self.values_at(0), hint=hint) from None

    @field_serializer("case")
    def _case_as_data(self, case: Case) -> dict[str, Any]:
        return case.to_dict()

    @functools.cached_property
    def axes_given(self) -> dict[str, tuple[float, ...]]:
        """Values of every axis [SI], the last one running fastest."""
        values = {name: getattr(self.axes, name) for name in Axes.model_fields}
        return {name: given for name, given in values.items() if given is not None}

    @functools.cached_property
    def asked(self) -> dict[str, Any]:
        """The quantities asked for, with their settings."""
        found = {name: getattr(self.quantities, name) for name in Quantities.model_fields}
        return {name: asked for name, asked in found.items() if asked is not None}

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of every axis."""
        return tuple(len(values) for values in self.axes_given.values())

    @property
    def size(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    def values_at(self, index: int) -> dict[str, float]:
        """Value of every axis at a point; points are counted with the last axis running fastest."""
        index = check_count("index", index, at_least=0, at_most=self.size - 1)
        places = np.unravel_index(index, self.shape)
        return {name: values[int(i)] for (name, values), i in zip(self.axes_given.items(), places, strict=True)}

    def case_at(self, index: int) -> Case:
        """The case of one point. A factor on the force and the detuning are no part of a case."""
        from frahm.sweep.points import StudyPoint

        return StudyPoint(self, index).case

    def seed_at(self, index: int) -> int:
        """The seed of one point: it depends on the seed of the study and the number of the point alone."""
        return int(np.random.SeedSequence((self.seed, index)).generate_state(1)[0] >> 1)

    def to_dict(self) -> dict[str, Any]:
        """Plain dictionary with every value in SI units; `load_study` gives an equal study back."""
        data = self.model_dump(mode="json", exclude={"axes", "quantities"})
        data["axes"] = {name: list(values) for name, values in self.axes_given.items()}
        over = "detuning" in self.axes_given
        data["quantities"] = {
            name: asked.model_dump(mode="json", exclude={"detuning"} if over else None)
            for name, asked in self.asked.items()
        }
        return data

    @property
    def text(self) -> str:
        """The study as one line of JSON."""
        return _canonical(self.to_dict())

    @property
    def digest(self) -> str:
        """SHA-256 of what is computed: studies that differ in name and title only have the same one."""
        data: Mapping[str, Any] = {k: v for k, v in self.to_dict().items() if k not in ("name", "title")}
        return hashlib.sha256(_canonical(data).encode()).hexdigest()


def _canonical(data: Mapping[str, Any]) -> str:
    return json.dumps(data, separators=(",", ":"), sort_keys=False, allow_nan=False)
