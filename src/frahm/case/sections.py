"""The sections of a case. Every field says what it is, in which unit, and within which bounds."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator

from frahm.case.quantities import Choice, Coefficients, Count, Label, Quantity, refusal


class Section(BaseModel):
    """A frozen part of a case that refuses names it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Pipe(Section):
    """The pipe as one mode of vibration."""

    mass: Annotated[float, Quantity("kg", "m_1", above=0)] = Field(
        title="Mass of the pipe",
        description="Vibrating mass of the length of pipe given by `length`, added mass included.",
    )
    length: Annotated[float, Quantity("m", "l", above=0)] = Field(
        default=1.0,
        title="Length of pipe",
        description="Length that `mass` and the lift belong to; 1 m when the mass is given per metre.",
    )
    frequency: Annotated[float, Quantity("rad/s", "omega", above=0)] = Field(
        title="Natural frequency of the pipe",
        description="Angular frequency without absorbers; as text it may be given in Hz.",
    )
    damping_ratio: Annotated[float, Quantity("", "zeta", at_least=0, below=1)] = Field(
        title="Damping ratio of the pipe",
        description="Fraction of critical damping without absorbers.",
    )
    diameter: Annotated[float, Quantity("m", "D", above=0)] = Field(
        title="Outer diameter of the pipe",
        description="The diameter the wind sees.",
    )


class Wind(Section):
    """The wind that sheds vortices from the pipe."""

    speed: Annotated[float, Quantity("m/s", "U", above=0)] = Field(
        title="Wind speed",
        description="Speed across the pipe.",
    )
    air_density: Annotated[float, Quantity("kg/m^3", "rho_air", above=0)] = Field(
        default=1.225,
        title="Density of the air",
        description="Density of the fluid that flows around the pipe.",
    )
    strouhal: Annotated[float, Quantity("", "St", above=0)] = Field(
        default=0.2,
        title="Strouhal number",
        description="Shedding frequency [Hz] times diameter over wind speed.",
    )
    lift_coefficient: Annotated[float, Quantity("", "C_L", at_least=0)] = Field(
        title="Lift coefficient",
        description="Amplitude of the harmonic lift over 1/2 rho U^2 D per length.",
    )


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
