"""The section `pipe` of kind `modes`: modes known from a measurement or another program."""

from __future__ import annotations

import functools
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from frahm.case.mode_file import read_modes
from frahm.case.quantities import Count, Quantity, QuantityList, QuantityOrNothing, refusal
from frahm.case.section import CaseSection
from frahm.structure import ModalPipe, ShapeTable, modal_pipe
from frahm.structure.modes import MOST_MODES

_NORM = 1e-3  # how far the largest displacement of a shape may be from 1


class TableMode(CaseSection):
    """One mode, its shape scaled to a largest displacement of 1."""

    mass: Annotated[float, Quantity("kg", "M_k", above=0)] = Field(
        title="Modal mass", description="Of the shape scaled to a largest displacement of 1."
    )
    frequency: Annotated[float, Quantity("rad/s", "omega_k", above=0)] = Field(
        title="Natural frequency", description="Angular frequency without absorbers; as text it may be given in Hz."
    )
    damping_ratio: Annotated[float, Quantity("", "zeta_k", at_least=0, below=1)] = Field(
        title="Damping ratio", description="Fraction of critical damping without absorbers."
    )
    lift_length: Annotated[float, Quantity("m", "l_k")] = Field(
        title="Generalised lift length",
        description="Modal lift over lift per length: integral of the shape with the sign of the governing one.",
    )
    displacements: Annotated[tuple[float, ...], QuantityList("", "phi_k")] = Field(
        title="Shape", description="Displacement at every section, the largest 1 or -1."
    )
    stresses: Annotated[tuple[float, ...], QuantityList("Pa/m", "sigma_k", shortest=0)] = Field(
        default=(), title="Stresses", description="Bending stress at every section per modal displacement."
    )


class ModeTable(CaseSection):
    """The pipe as a table of modes."""

    kind: Literal["modes"] = Field(title="Kind of pipe", description="A table of modes, given here or as a CSV file.")
    diameter: Annotated[float, Quantity("m", "D", above=0)] = Field(
        title="Outer diameter of the pipe", description="The diameter the wind sees."
    )
    length: Annotated[float, Quantity("m", "L", above=0)] = Field(
        title="Length of pipe", description="Length the wind blows along."
    )
    mass_per_length: Annotated[float | None, QuantityOrNothing("kg/m", "m_e", above=0)] = Field(
        default=None,
        title="Equivalent mass per length",
        description="Of the governing mode, for the Scruton number; nothing if it is not known.",
    )
    governing_mode: Annotated[int, Count(at_most=MOST_MODES)] = Field(
        default=1,
        title="Governing mode",
        description="The mode vortices lock in to, from 1: mass, frequency and detuning of the pipe are this mode's.",
    )
    sections: Annotated[tuple[float, ...], QuantityList("m", "s", at_least=0)] = Field(
        title="Sections",
        description="Positions along the pipe at which the shapes are known: absorbers, stresses, largest motion.",
    )
    modes: tuple[TableMode, ...] = Field(
        title="Modes", description="By ascending frequency; or the name of a CSV file that holds the sections too."
    )

    @model_validator(mode="before")
    @classmethod
    def _from_file(cls, data: Any) -> Any:
        """Sections and modes of a CSV file, so that the case is complete without the file."""
        if not isinstance(data, dict) or not isinstance(data.get("modes"), str):
            return data
        if "sections" in data:
            raise refusal("nothing, because the file names the sections", path="pipe.sections", value=data["sections"])
        return data | read_modes(data["modes"])

    @model_validator(mode="after")
    def _consistent(self) -> ModeTable:
        if not 1 <= len(self.modes) <= MOST_MODES:
            raise refusal(f"1 to {MOST_MODES} modes", path="pipe.modes", value=f"{len(self.modes)} modes")
        if self.governing_mode > len(self.modes):
            allowed = f"a mode of the table, 1 to {len(self.modes)}"
            raise refusal(allowed, path="pipe.governing_mode", value=self.governing_mode)
        for index, section in enumerate(self.sections):
            if section > self.length or section in self.sections[:index]:
                allowed = f"a section of the pipe no other entry names, 0 to {self.length:g} m"
                raise refusal(allowed, path=f"pipe.sections[{index}]", value=section)
        for index, mode in enumerate(self.modes):
            self._check(f"pipe.modes[{index}]", index, mode)
        return self

    def _check(self, path: str, index: int, mode: TableMode) -> None:
        count = len(self.sections)
        if index and mode.frequency < self.modes[index - 1].frequency:
            raise refusal("frequencies that ascend", path=f"{path}.frequency", value=mode.frequency)
        if len(mode.displacements) != count:
            allowed = f"{count} numbers, one for each section"
            raise refusal(allowed, path=f"{path}.displacements", value=list(mode.displacements))
        largest = max(map(abs, mode.displacements))
        if abs(largest - 1) > _NORM:
            hint = f"Divide the shape by {largest:g} and the mass by {largest**2:g}." if largest else None
            allowed = "a shape whose largest displacement is 1 or -1, at one of the sections"
            raise refusal(allowed, hint=hint, path=f"{path}.displacements", value=list(mode.displacements))
        if len(mode.stresses) not in (0, count) or bool(mode.stresses) != bool(self.modes[0].stresses):
            allowed = f"{count} numbers, one for each section, in every mode or in none"
            raise refusal(allowed, path=f"{path}.stresses", value=list(mode.stresses))

    @functools.cached_property
    def modal(self) -> ModalPipe:
        """The modes as the equations of motion take them, the governing one first."""
        shapes = np.array([mode.displacements for mode in self.modes]).T
        stresses = np.array([mode.stresses for mode in self.modes]).T if self.modes[0].stresses else None
        governing = self.governing_mode - 1
        return modal_pipe(
            ShapeTable(np.array(self.sections), shapes, stresses),
            governing,
            [mode.damping_ratio for mode in self.modes],
            np.array([mode.lift_length for mode in self.modes]),
            np.array([mode.frequency for mode in self.modes]),
            np.array([mode.mass for mode in self.modes]),
            float(self.sections[int(np.argmax(np.abs(shapes[:, governing])))]),
        )

    @property
    def mass(self) -> float:
        """Modal mass of the governing mode [kg]."""
        return self.modes[self.governing_mode - 1].mass

    @property
    def frequency(self) -> float:
        """Natural frequency of the governing mode [rad/s]."""
        return self.modes[self.governing_mode - 1].frequency

    @property
    def damping_ratio(self) -> float:
        """Damping ratio of the governing mode [-]."""
        return self.modes[self.governing_mode - 1].damping_ratio
