"""The section `absorbers` of a case: masses on the pipe and their force laws."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from frahm.case.quantities import Coefficients, Label, Quantity, QuantityOrNothing
from frahm.case.section import Section


class CubicLaw(Section):
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


class LinearLaw(Section):
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


class PolynomialLaw(Section):
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


Law = Annotated[CubicLaw | LinearLaw | PolynomialLaw, Field(discriminator="kind")]


class Absorber(Section):
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
