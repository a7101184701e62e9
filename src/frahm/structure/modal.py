"""A pipe as its modes: what the equations of motion need of it, wherever the modes come from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats, frozen
from frahm.errors import ParameterError
from frahm.structure.modes import BeamModes
from frahm.tolerances import TINY

_NEAR = 1e-9  # of the largest section: positions closer than this are the same
_STRESS_SECTIONS = 201


@dataclass(frozen=True, eq=False)
class ShapeTable:
    """Mode shapes known at a few sections only.

    Attributes
    ----------
    sections : ndarray, shape (s,)
        Positions along the pipe [m].
    displacements : ndarray, shape (s, n)
        phi_k at the sections [-].
    stresses : ndarray, shape (s, n), optional
        Stress per modal displacement at the sections [Pa/m].
    """

    sections: Floats
    displacements: Floats
    stresses: Floats | None = None

    def shape(self, section: float) -> Floats:
        """phi_k at a section of the table [-], shape (n,)."""
        return self.displacements[self._row(section)]

    def stress_per_displacement(self, section: float) -> Floats:
        """Stress per modal displacement at a section of the table [Pa/m], shape (n,)."""
        if self.stresses is None:
            raise ParameterError("pipe.modes", "no stresses", "modes with their stress at every section")
        return self.stresses[self._row(section)]

    def _row(self, section: float) -> int:
        row = int(np.argmin(np.abs(self.sections - section)))
        if abs(self.sections[row] - section) > _NEAR * max(np.max(np.abs(self.sections)), TINY):
            known = ", ".join(f"{value:g}" for value in self.sections)
            raise ParameterError("section", section, f"a section of the table of modes: {known} m")
        return row


@dataclass(frozen=True, eq=False)
class ModalPipe:
    """The modes a pipe moves in: the governing one first, the others by ascending frequency.

    Every modal coordinate is the displacement at the section where its mode moves most [m].

    Attributes
    ----------
    frequencies : ndarray, shape (n,)
        omega_k [rad/s].
    masses : ndarray, shape (n,)
        Modal masses [kg] of shapes scaled to a largest displacement of 1.
    damping_ratios : ndarray, shape (n,)
        zeta_k [-].
    lift_lengths : ndarray, shape (n,)
        Generalised lift over lift per length [m].
    shapes : BeamModes, ShapeTable or None
        Shapes of the modes by ascending frequency; None for a pipe that moves as one.
    order : tuple of int
        Which of those shapes belongs to each coordinate.
    largest : float or None
        Section of the largest motion of the governing mode [m]: the pipe displacement is taken there.
    """

    frequencies: Floats
    masses: Floats
    damping_ratios: Floats
    lift_lengths: Floats
    shapes: BeamModes | ShapeTable | None = None
    order: tuple[int, ...] = (0,)
    largest: float | None = None

    @property
    def count(self) -> int:
        """Number of modes."""
        return self.frequencies.size

    def displacement(self, section: float | None = None) -> Floats:
        """Displacement of a section per modal displacement [-], shape (n,); by default of the section `largest`."""
        if self.shapes is None:
            return np.ones(1)
        where = self.largest if section is None else section
        return self.shapes.shape(where)[list(self.order)]  # type: ignore[arg-type]

    def stress(self, section: float | None = None) -> Floats:
        """Bending stress at a section per modal displacement [Pa/m], shape (n,).

        By default at the section where the governing mode alone causes the largest stress.

        Raises
        ------
        ParameterError
            If the pipe is given without what its stress follows from.
        """
        if self.shapes is None:
            allowed = "a pipe of kind tube, or of kind modes with stresses"
            raise ParameterError("pipe.kind", "mode", allowed, hint="One rigid mode has no curvature and no stress.")
        where = self.most_stressed if section is None else section
        return self.shapes.stress_per_displacement(where)[list(self.order)]

    def stresses(self, sections: Floats) -> Floats:
        """Bending stress at sections [m] per modal displacement [Pa/m], shape (sections, n), as `stress` of each."""
        if isinstance(self.shapes, BeamModes):
            return self.shapes.stress_per_displacement(sections)[:, list(self.order)]
        return np.array([self.stress(float(section)) for section in sections])

    @property
    def most_stressed(self) -> float:
        """Section where the governing mode alone causes the largest stress [m]."""
        if isinstance(self.shapes, BeamModes):
            return float(self.shapes.stressed_sections[self.order[0]])
        stresses = None if self.shapes is None else self.shapes.stresses
        if self.shapes is None or stresses is None:
            self.stress(0.0)  # says what is missing
        assert isinstance(self.shapes, ShapeTable)
        assert stresses is not None
        return float(self.shapes.sections[np.argmax(np.abs(stresses[:, self.order[0]]))])

    def stress_sections(self, count: int = _STRESS_SECTIONS) -> Floats:
        """Sections to look for the largest stress at [m]: a grid with the most stressed ones, or those of a table."""
        if isinstance(self.shapes, BeamModes):
            grid = np.linspace(0.0, self.shapes.beam.length, count)
            return np.union1d(grid, [*self.shapes.beam.nodes, *self.shapes.stressed_sections])
        self.stress()
        assert isinstance(self.shapes, ShapeTable)
        return self.shapes.sections


def governing_first(count: int, governing: int) -> tuple[int, ...]:
    """Numbers 0 ... count - 1 with `governing` (from 0) in front."""
    return (governing, *(k for k in range(count) if k != governing))


def modal_pipe(
    shapes: BeamModes | ShapeTable,
    governing: int,
    damping_ratios: Sequence[float],
    lift_lengths: Floats,
    frequencies: Floats,
    masses: Floats,
    largest: float,
) -> ModalPipe:
    """Modes by ascending frequency, put in the order of the coordinates."""
    order = governing_first(frequencies.size, governing)
    rows = list(order)
    return ModalPipe(
        frequencies=frozen(frequencies[rows]),
        masses=frozen(masses[rows]),
        damping_ratios=frozen(np.asarray(damping_ratios, dtype=float)[rows]),
        lift_lengths=frozen(lift_lengths[rows]),
        shapes=shapes,
        order=order,
        largest=largest,
    )
