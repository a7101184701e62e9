"""The section `pipe` of a case: what vibrates."""

from __future__ import annotations

import functools
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Discriminator, Field, Tag

from frahm.arrays import frozen
from frahm.case.mode_table import ModeTable
from frahm.case.quantities import Quantity
from frahm.case.section import CaseSection
from frahm.case.tube import Tube
from frahm.structure import ModalPipe


class Pipe(CaseSection):
    """The pipe as one mode of vibration."""

    is_default_kind: ClassVar[bool] = True

    kind: Literal["mode"] = Field(
        default="mode",
        title="Kind of pipe",
        description="One mode; the others are tube, and modes for a table of them.",
    )
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

    @property
    def mass_per_length(self) -> float:
        """Mass over length [kg/m]."""
        return self.mass / self.length

    @property
    def governing_mode(self) -> int:
        """The only mode there is."""
        return 1

    @functools.cached_property
    def modal(self) -> ModalPipe:
        """The pipe as its single mode."""
        return ModalPipe(
            frequencies=frozen([self.frequency]),
            masses=frozen([self.mass]),
            damping_ratios=frozen([self.damping_ratio]),
            lift_lengths=frozen([self.length]),
        )


def _kind(pipe: Any) -> Any:
    """Kind of a pipe in a case file; one mode if nothing is said."""
    return pipe.get("kind", "mode") if isinstance(pipe, dict) else getattr(pipe, "kind", "mode")


AnyPipe = Annotated[
    Annotated[Pipe, Tag("mode")] | Annotated[Tube, Tag("tube")] | Annotated[ModeTable, Tag("modes")],
    Discriminator(_kind),
]
