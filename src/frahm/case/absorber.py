"""The section `absorbers` of a case: masses on the pipe and their force laws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from frahm.case.quantities import Coefficients, Label, Quantity, QuantityOrNothing, refusal
from frahm.case.section import CaseSection


class CubicLaw(CaseSection):
    """A nonlinear energy sink: force = stiffness z^3 + damping z'."""

    kind: Literal["cubic"] = Field(default="cubic", title="Kind of force law", description="Purely cubic spring.")
    stiffness: Annotated[float, Quantity("N/m^3", "k_nes", above=0)] = Field(
        title="Cubic stiffness",
        description="Force per cubed displacement of the absorber relative to the pipe.",
    )
    damping: Annotated[float, Quantity("N s/m", "c_nes", at_least=0)] = Field(
        title="Damping of the absorber",
        description="Force per velocity of the absorber relative to the pipe.",
    )


class LinearLaw(CaseSection):
    """A tuned mass damper: force = stiffness z + damping z'."""

    kind: Literal["linear"] = Field(default="linear", title="Kind of force law", description="Linear spring.")
    stiffness: Annotated[float, Quantity("N/m", "k", above=0)] = Field(
        title="Linear stiffness",
        description="Force per displacement of the absorber relative to the pipe.",
    )
    damping: Annotated[float, Quantity("N s/m", "c", at_least=0)] = Field(
        title="Damping of the absorber",
        description="Force per velocity of the absorber relative to the pipe.",
    )


class PolynomialLaw(CaseSection):
    """A spring with any polynomial characteristic: force = c_1 z + c_2 z^2 + ... + damping z'."""

    kind: Literal["polynomial"] = Field(
        default="polynomial", title="Kind of force law", description="Polynomial spring."
    )
    coefficients: Annotated[tuple[float, ...], Coefficients()] = Field(
        title="Coefficients of the spring",
        description="c_1, c_2, ... of the relative displacement, its square and so on.",
    )
    damping: Annotated[float, Quantity("N s/m", "c", at_least=0)] = Field(
        title="Damping of the absorber",
        description="Force per velocity of the absorber relative to the pipe.",
    )


class TransverseSpringsLaw(CaseSection):
    """Two equal springs at right angles to the motion, exact geometry: a cubic spring as it is built."""

    kind: Literal["transverse-springs"] = Field(
        default="transverse-springs",
        title="Kind of force law",
        description="Two springs across the motion.",
    )
    stiffness: Annotated[float, Quantity("N/m", "k_s", above=0)] = Field(
        title="Stiffness of one spring", description="Tension per elongation along the spring."
    )
    length: Annotated[float, Quantity("m", "L", above=0)] = Field(
        title="Length of one spring",
        description="From its anchor to the absorber in the middle; the free length if there is no pretension.",
    )
    pretension: Annotated[float, Quantity("N", "T_0")] = Field(
        default=0.0,
        title="Pretension of one spring",
        description="In the middle; pressed together (negative) it makes two wells. Below stiffness times length.",
    )
    damping: Annotated[float, Quantity("N s/m", "c", at_least=0)] = Field(
        title="Damping of the absorber",
        description="Force per velocity of the absorber relative to the pipe.",
    )

    @field_validator("pretension")
    @classmethod
    def _has_a_free_length(cls, value: float, info: ValidationInfo) -> float:
        stiffness, length = info.data.get("stiffness"), info.data.get("length")
        if stiffness is not None and length is not None and value >= stiffness * length:
            raise refusal(f"below stiffness times length, {stiffness * length:g} N: the free length must be positive")
        return value


class BistableLaw(CaseSection):
    """Two wells: force = -negative_stiffness z + stiffness z^3 + damping z'."""

    kind: Literal["bistable"] = Field(
        default="bistable", title="Kind of force law", description="Negative linear and positive cubic stiffness."
    )
    stiffness: Annotated[float, Quantity("N/m^3", "k_3", above=0)] = Field(
        title="Cubic stiffness",
        description="Force per cubed displacement of the absorber relative to the pipe.",
    )
    negative_stiffness: Annotated[float, Quantity("N/m", "k_1", above=0)] = Field(
        title="Size of the negative stiffness",
        description="Of the linear stiffness between the wells, which lie at +-sqrt(negative_stiffness/stiffness).",
    )
    damping: Annotated[float, Quantity("N s/m", "c", at_least=0)] = Field(
        title="Damping of the absorber",
        description="Force per velocity of the absorber relative to the pipe.",
    )


class EndStops(CaseSection):
    """Elastic stops that end the travel of an absorber on both sides."""

    gap: Annotated[float, Quantity("m", "z_s", above=0)] = Field(
        title="Gap to the end stops", description="Free travel of the absorber to either side of the springs' middle."
    )
    stiffness: Annotated[float, Quantity("N/m", "k_s", above=0)] = Field(
        title="Stiffness of an end stop", description="Once its buffer is compressed."
    )
    depth: Annotated[float | None, QuantityOrNothing("m", "d_s", above=0)] = Field(
        default=None,
        title="Depth of the buffer",
        description="Over which the stop hardens smoothly; left out: a tenth of the gap.",
    )


class DryFriction(CaseSection):
    """Coulomb friction of an absorber's guide, regularised as force tanh(velocity/speed)."""

    force: Annotated[float, Quantity("N", "F_f", above=0)] = Field(
        title="Friction force", description="When the absorber slides: coefficient of friction times normal force."
    )
    speed: Annotated[float, Quantity("m/s", "v_s", above=0)] = Field(
        title="Speed of the regularisation",
        description="Below about three times this speed the absorber creeps instead of sticking.",
    )


Law = Annotated[CubicLaw | LinearLaw | PolynomialLaw | TransverseSpringsLaw | BistableLaw, Field(discriminator="kind")]


class Absorber(CaseSection):
    """A mass on the pipe, held by a spring and a damper."""

    name: Annotated[str, Label(shortest=1, longest=60)] = Field(
        default="sink", title="Name of the absorber", description="Unlike the names of the other absorbers."
    )
    mass: Annotated[float, Quantity("kg", "m_nes", above=0)] = Field(
        title="Mass of the absorber",
        description="Moving mass that belongs to the length of pipe of the case.",
    )
    law: Law = Field(title="Force law of the absorber", description="Spring and damper between pipe and absorber.")
    position: Annotated[float | None, QuantityOrNothing("m", "s", at_least=0)] = Field(
        default=None,
        title="Position of the absorber",
        description="Distance from the first end of an elastic pipe; left out: where the pipe moves most.",
    )

    stops: EndStops | None = Field(
        default=None, title="End stops", description="What ends the travel of the absorber; left out: nothing."
    )
    friction: DryFriction | None = Field(
        default=None, title="Dry friction", description="Of the absorber's guide; left out: none."
    )
    gravity: Annotated[float, Quantity("m/s^2", "g", at_least=-100, at_most=100)] = Field(
        default=0.0,
        title="Gravity along the motion",
        description="Component in the direction of positive z = absorber - pipe: 0 for horizontal motion.",
    )

    def normalised(self, host_mass: float) -> dict[str, float]:
        """Parameters divided by the mass of the host.

        Parameters
        ----------
        host_mass : float
            Mass of the pipe m_1 [kg].

        Returns
        -------
        dict
            ``rho2`` = m_nes/m_1 [-], ``xi2`` = c/m_1 [1/s] and, for a cubic law, ``kappa`` = k/m_1 [1/(m^2 s^2)].
        """
        values = {"rho2": self.mass / host_mass, "xi2": self.law.damping / host_mass}
        if isinstance(self.law, CubicLaw):
            values["kappa"] = self.law.stiffness / host_mass
        return values


def free_name(base: str, taken: Sequence[str]) -> str:
    """The name, with a number behind it if it is taken."""
    name, number = base, 2
    while name in taken:
        name, number = f"{base} {number}", number + 1
    return name
