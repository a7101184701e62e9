"""The section `pipe` of kind `tube`: an elastic tube on supports, as exact beam modes."""

from __future__ import annotations

import functools
import math
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from frahm.case.quantities import Choice, Count, Quantity, QuantityList, refusal
from frahm.case.section import CaseSection
from frahm.errors import ParameterError
from frahm.structure import Beam, BeamModes, ModalPipe, PointMass, Support, beam_modes, modal_pipe
from frahm.structure.modes import MOST_MODES

STEEL_MODULUS, STEEL_DENSITY = 2.06e11, 7850.0  # of structural steel [Pa, kg/m^3]
SUPPORTS = ("pinned", "clamped", "free", "spring")
LIFTS = ("uniform", "mode-shape")


class TubeSupport(CaseSection):
    """What holds the tube at one section."""

    at: Annotated[float, Quantity("m", "s", at_least=0)] = Field(
        title="Position of the support", description="Distance from the first end of the tube."
    )
    kind: Annotated[Literal["pinned", "clamped", "free", "spring"], Choice(SUPPORTS)] = Field(
        title="Kind of support",
        description="pinned holds the displacement, clamped the rotation too, spring neither, free nothing at all.",
    )
    translation: Annotated[float, Quantity("N/m", "k_t", at_least=0)] = Field(
        default=0.0, title="Spring against displacement", description="Only of a support of kind spring."
    )
    rotation: Annotated[float, Quantity("N m", "k_r", at_least=0)] = Field(
        default=0.0,
        title="Spring against rotation",
        description="Moment per radian, of a support of kind spring or pinned.",
    )

    @property
    def stiffness(self) -> tuple[float, float]:
        """Stiffness against displacement [N/m] and rotation [N m]; infinite where held."""
        translation = self.translation if self.kind in ("spring", "free") else math.inf
        return translation, math.inf if self.kind == "clamped" else self.rotation


class TubePointMass(CaseSection):
    """A mass at one section of the tube."""

    at: Annotated[float, Quantity("m", "s", at_least=0)] = Field(
        title="Position of the mass", description="Distance from the first end of the tube."
    )
    mass: Annotated[float, Quantity("kg", "m_p", above=0)] = Field(
        title="Point mass", description="Mass fixed to the tube at one section, such as a flange."
    )


class Tube(CaseSection):
    """The pipe as an elastic tube: bending vibration in its exact modes."""

    kind: Literal["tube"] = Field(title="Kind of pipe", description="An elastic tube on supports.")
    diameter: Annotated[float, Quantity("m", "D", above=0)] = Field(
        title="Outer diameter of the tube", description="The diameter the wind sees."
    )
    wall: Annotated[float, Quantity("m", "t", above=0)] = Field(
        title="Wall thickness", description="At most the radius, of a solid bar."
    )
    length: Annotated[float, Quantity("m", "L", above=0)] = Field(
        title="Length of the tube", description="All spans together; the wind blows along all of it."
    )
    youngs_modulus: Annotated[float, Quantity("Pa", "E", above=0)] = Field(
        default=STEEL_MODULUS,
        title="Young's modulus",
        description="Of the tube's material; the default is structural steel.",
    )
    density: Annotated[float, Quantity("kg/m^3", "rho_s", above=0)] = Field(
        default=STEEL_DENSITY,
        title="Density of the tube",
        description="Of its material; the default is structural steel.",
    )
    contained_mass: Annotated[float, Quantity("kg/m", "m_c", at_least=0)] = Field(
        default=0.0, title="Contained mass", description="Mass per length of what is inside."
    )
    added_mass: Annotated[float, Quantity("kg/m", "m_a", at_least=0)] = Field(
        default=0.0,
        title="Added mass",
        description="Mass per length of coating, and of fluid that moves with the tube.",
    )
    supports: tuple[TubeSupport, ...] = Field(
        title="Supports", description="Wherever the tube is held; an end without one is free."
    )
    point_masses: tuple[TubePointMass, ...] = Field(
        default=(), title="Point masses", description="Masses fixed to the tube; none is allowed."
    )
    mode_count: Annotated[int, Count(at_most=MOST_MODES)] = Field(
        default=3, title="Number of modes", description="Modes of the tube that take part in its motion."
    )
    governing_mode: Annotated[int, Count(at_most=MOST_MODES)] = Field(
        default=1,
        title="Governing mode",
        description="The mode vortices lock in to, from 1: mass, frequency and detuning of the pipe are this mode's.",
    )
    damping_ratio: Annotated[float, Quantity("", "zeta", at_least=0, below=1)] = Field(
        title="Damping ratio", description="Fraction of critical damping of every mode, or of the governing one."
    )
    damping_ratios: Annotated[tuple[float, ...], QuantityList("", "zeta", at_least=0, below=1, shortest=0)] = Field(
        default=(), title="Damping ratios of all modes", description="One for each mode, in place of the same for all."
    )
    lift: Annotated[Literal["uniform", "mode-shape"], Choice(LIFTS)] = Field(
        default="uniform",
        title="Lift along the tube",
        description="uniform: as strong everywhere, in phase with the governing mode; mode-shape: in proportion to it.",
    )

    @model_validator(mode="before")
    @classmethod
    def _damping_of_the_governing_mode(cls, data: Any) -> Any:
        """One ratio for each mode is enough: the governing one's is among them."""
        if not isinstance(data, dict) or "damping_ratio" in data:
            return data
        ratios, governing = data.get("damping_ratios"), data.get("governing_mode", 1)
        if isinstance(ratios, list | tuple) and isinstance(governing, int) and 1 <= governing <= len(ratios):
            return data | {"damping_ratio": ratios[governing - 1]}
        return data

    @model_validator(mode="after")
    def _possible(self) -> Tube:
        if self.wall > self.diameter / 2:
            allowed = f"at most the radius, {self.diameter / 2:g} m"
            raise refusal(allowed, path="pipe.wall", value=self.wall)
        if self.governing_mode > self.mode_count:
            allowed = f"a mode that takes part, 1 to {self.mode_count}"
            raise refusal(allowed, path="pipe.governing_mode", value=self.governing_mode)
        self._check_damping()
        for index, support in enumerate(self.supports):
            self._check_support(index, support)
        try:
            self.beam()
        except ParameterError as error:
            raise refusal(error.allowed, hint=error.hint, path=f"pipe.{error.name}", value=error.value) from None
        return self

    def _check_damping(self) -> None:
        ratios = self.damping_ratios
        if not ratios:
            return
        if len(ratios) != self.mode_count:
            allowed = f"{self.mode_count} numbers, one for each mode"
            raise refusal(allowed, path="pipe.damping_ratios", value=list(ratios))
        if ratios[self.governing_mode - 1] != self.damping_ratio:
            allowed = f"{ratios[self.governing_mode - 1]:g}, as in damping_ratios, or nothing"
            raise refusal(allowed, path="pipe.damping_ratio", value=self.damping_ratio)

    def _check_support(self, index: int, support: TubeSupport) -> None:
        path = f"pipe.supports[{index}]"
        allows = {"pinned": ("rotation",), "spring": ("translation", "rotation")}.get(support.kind, ())
        for name in ("translation", "rotation"):
            if getattr(support, name) and name not in allows:
                allowed = f"nothing, for a support of kind {support.kind}"
                raise refusal(allowed, path=f"{path}.{name}", value=getattr(support, name))
        if support.kind == "spring" and not (support.translation or support.rotation):
            raise refusal("a spring with a translation or rotation stiffness", path=path, value=support.kind)
        if support.kind == "free" and support.at not in (0.0, self.length):
            raise refusal("free only at an end of the tube", path=f"{path}.at", value=support.at)

    def beam(self) -> Beam:
        """The tube as a beam: E I, mass per length, supports."""
        outer, inner = self.diameter, self.diameter - 2 * self.wall
        area, inertia = math.pi / 4 * (outer**2 - inner**2), math.pi / 64 * (outer**4 - inner**4)
        return Beam(
            length=self.length,
            bending_stiffness=self.youngs_modulus * inertia,
            mass_per_length=self.density * area + self.contained_mass + self.added_mass,
            supports=tuple(Support(s.at, *s.stiffness) for s in self.supports if s.kind != "free"),
            point_masses=tuple(PointMass(point.at, point.mass) for point in self.point_masses),
            stress_per_curvature=self.youngs_modulus * outer / 2,
        )

    @functools.cached_property
    def beam_modes(self) -> BeamModes:
        """Exact modes of the tube, by ascending frequency."""
        return beam_modes(self.beam(), self.mode_count)

    @functools.cached_property
    def modal(self) -> ModalPipe:
        """The modes as the equations of motion take them, the governing one first."""
        modes, governing = self.beam_modes, self.governing_mode - 1
        lengths = modes.lift_lengths(governing) if self.lift == "uniform" else modes.products(governing)
        ratios = self.damping_ratios or (self.damping_ratio,) * self.mode_count
        largest = float(modes.peak_sections[governing])
        return modal_pipe(modes, governing, ratios, lengths, modes.frequencies, modes.modal_masses, largest)

    @property
    def mass(self) -> float:
        """Modal mass of the governing mode, its shape scaled to a largest displacement of 1 [kg]."""
        return float(self.beam_modes.modal_masses[self.governing_mode - 1])

    @property
    def frequency(self) -> float:
        """Natural frequency of the governing mode [rad/s]."""
        return float(self.beam_modes.frequencies[self.governing_mode - 1])

    @property
    def mass_per_length(self) -> float:
        """Equivalent mass m_e = int m phi^2 / int phi^2 of the governing mode [kg/m]."""
        return float(self.beam_modes.equivalent_masses[self.governing_mode - 1])
