"""What the shape of a mode does to the estimates of the amplitude at resonance."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from frahm.arrays import Floats
from frahm.case import Case, ModeTable, Tube
from frahm.errors import check_number
from frahm.loads.correlation import Antinodes, antinodes

_CELLS = 8192  # along the pipe: 1e-4 of K_w with the sixty antinodes of the highest mode
_CANTILEVER = 1.305  # gamma of the first mode of a cantilever
_LIFT = 0.01  # how far int |phi| of a table may be from its lift length
_GAP = 1 / 3  # of the range of an antinode: the widest gap between the sections of a table that resolves it


@dataclass(frozen=True)
class ModeFactors:
    """Factors of a mode; the defaults are those of a rigid pipe, see `mode_factors`.

    Parameters
    ----------
    load : float
        g = int |phi| / int phi^2 [-].
    amplitude : float
        gamma = max |phi| sqrt(int phi^2 / int phi^4) [-], of the estimates of Griffin and Skop and of Sarpkaya.
    antinodes : Antinodes, optional
        Where along the pipe vortices shed in step; without it they do all along, which is the safe side.
    cantilever_slenderness : float, optional
        Length over diameter of a cantilever in its first mode [-]; None for every other pipe.
    mass_per_length : float, optional
        m_e = int m phi^2 / int phi^2 [kg/m]; that of the case by default.
    """

    load: float = 1.0
    amplitude: float = 1.0
    antinodes: Antinodes | None = None
    cantilever_slenderness: float | None = None
    mass_per_length: float | None = None

    def __post_init__(self) -> None:
        check_number("load", self.load, above=0)
        check_number("amplitude", self.amplitude, above=0)
        for name in ("cantilever_slenderness", "mass_per_length"):
            if getattr(self, name) is not None:
                check_number(name, getattr(self, name), above=0)


def mode_factors(case: Case) -> ModeFactors:
    """Factors of the governing mode of a case, integrated over its shape.

    One mode of `kind: mode` has no shape: it moves, and sheds in step, all along. A table of modes knows its shapes at
    some sections. A cubic spline through them is integrated if it has the lift length of the table to 1 %, and every
    antinode sections no wider apart than a third of its range: then K_w is true to 2 % for modes of beams. Otherwise
    the lift is in step all along, and gamma is that of a cantilever, the largest of the usual shapes: the safe side.
    """
    pipe = case.pipe
    if isinstance(pipe, Tube):
        mode = pipe.governing_mode - 1
        shape = pipe.beam_modes.shape(_middles(0.0, pipe.length))[:, mode]
        slenderness = pipe.length / pipe.diameter
        return ModeFactors(
            load=float(pipe.beam_modes.participations[mode]),
            amplitude=_amplitude_factor(shape),
            antinodes=antinodes(shape, slenderness),
            cantilever_slenderness=slenderness if _is_cantilever(pipe) else None,
        )
    if isinstance(pipe, ModeTable):
        modal, mass = pipe.modal, pipe.mass_per_length
        load = 1.0 if mass is None else float(modal.lift_lengths[0] * mass / modal.masses[0])
        return _of_table(pipe, load) or ModeFactors(load=load, amplitude=_CANTILEVER)
    return ModeFactors()


def _middles(first: float, last: float) -> Floats:
    """Middles of the cells between two sections [m]."""
    return first + (last - first) * (np.arange(_CELLS) + 0.5) / _CELLS


def _amplitude_factor(shape: Floats) -> float:
    """gamma of a shape on equal cells whose largest displacement is 1 [-]."""
    return float(np.sqrt(np.sum(shape**2) / np.sum(shape**4)))


def _is_cantilever(tube: Tube) -> bool:
    """Whether a tube is held at one end only and vibrates in its first mode."""
    held = [support.at for support in tube.supports if support.kind != "free"]
    return tube.governing_mode == 1 and len(held) == 1 and held[0] in (0.0, tube.length)


def _of_table(table: ModeTable, load: float) -> ModeFactors | None:
    """Factors of the governing mode of a table between its outer sections; None if they do not resolve the shape."""
    from scipy.interpolate import CubicSpline  # takes long to load

    order = np.argsort(table.sections)
    sections = np.array(table.sections)[order]
    length = float(sections[-1] - sections[0])
    if length == 0:
        return None
    displacements = np.array(table.modes[table.governing_mode - 1].displacements)[order]
    shape = CubicSpline(sections, displacements)(_middles(sections[0], sections[-1]))
    found = antinodes(shape, length / table.diameter)
    lift = float(table.modal.lift_lengths[0])
    if abs(length * np.mean(np.abs(shape)) - lift) > _LIFT * lift:
        return None
    known = _is_resolved(found, (sections - sections[0]) / length)
    return ModeFactors(load, _amplitude_factor(shape), found) if known else None


def _is_resolved(found: Antinodes, places: Floats) -> bool:
    """Whether sections, from 0 to 1, leave no wide gap in the range of any antinode."""
    for first, last in pairwise(found.edges):
        inside = places[(places > first) & (places < last)]
        if np.max(np.diff([first, *inside, last])) > _GAP * (last - first) * (1 + 1e-9):
            return False
    return True
