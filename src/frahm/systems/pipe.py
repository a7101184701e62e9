"""The pipe of a case as a `System`: its modes, and a coordinate for every absorber."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from frahm.absorbers import Bistable, Cubic, Friction, Law, Linear, Polynomial, Stops, TransverseSprings
from frahm.arrays import Floats
from frahm.case import Absorber, Case, load_case
from frahm.errors import ParameterError
from frahm.loads import vortex_shedding
from frahm.systems.system import Element, System

_LAWS: dict[str, Callable[..., Law]] = {
    "cubic": Cubic, "linear": Linear, "polynomial": Polynomial, "bistable": Bistable,
    "transverse-springs": TransverseSprings,
}  # fmt: skip


def build_system(case: Case | str | os.PathLike[str] | Mapping[str, Any]) -> System:
    """Equations of motion of a case: the modes of the pipe, each absorber hung where it sits.

    Parameters
    ----------
    case : Case, str, Path or dict
        A case, or whatever `load_case` reads.

    Returns
    -------
    System
        Coordinates: the displacement x_k of every mode of the pipe at the section where that mode moves most, the
        governing mode first, then the absolute displacement of every absorber. An absorber at the section s feels
        z = x_a - sum_k phi_k(s) x_k. The output is the pipe's displacement where its governing mode moves most; the
        forcing is the lift on every mode [N]; detuning counts from the natural frequency of the governing mode
        without absorbers.

    Raises
    ------
    ParameterError
        If the case cannot be read.
    """
    case = load_case(case)
    modal = case.pipe.modal
    n, count = modal.count, len(case.absorbers)
    damping, stiffness = np.zeros((n + count, n + count)), np.zeros((n + count, n + count))
    host = np.arange(n)
    damping[host, host] = 2 * modal.damping_ratios * modal.masses * modal.frequencies
    stiffness[host, host] = modal.masses * modal.frequencies**2
    lift = vortex_shedding(case).lift * (modal.lift_lengths / case.pipe.length)
    return System(
        mass=np.diag([*modal.masses, *(absorber.mass for absorber in case.absorbers)]),
        damping=damping,
        stiffness=stiffness,
        forcing=np.concatenate([lift, np.zeros(count)]),
        elements=[
            Element(direction=_relative(modal.displacement(absorber.position), i, count), law=_force_law(absorber))
            for i, absorber in enumerate(case.absorbers)
        ],
        output=np.concatenate([modal.displacement(), np.zeros(count)]),
        reference_frequency=case.pipe.frequency,
        name=case.name,
    )


def stress_row(case: Case | str | os.PathLike[str] | Mapping[str, Any], section: float | None = None) -> Floats:
    """Bending stress at a section of an elastic pipe as a row over the coordinates of its `System`.

    Parameters
    ----------
    case : Case, str, Path or dict
        A case whose pipe is a tube, or a table of modes with stresses.
    section : float, optional
        Position along the pipe [m]; by default where the governing mode alone causes the largest stress.

    Returns
    -------
    ndarray, shape (n,)
        The stress of the outermost fibre is ``row @ x`` [Pa] at displacements x (n,) of the system of `build_system`.

    Raises
    ------
    ParameterError
        If the case cannot be read, the section is off the pipe, or the pipe is one rigid mode without stress.
    """
    case = load_case(case)
    return np.concatenate([case.pipe.modal.stress(section), np.zeros(len(case.absorbers))])


def stress_rows(case: Case | str | os.PathLike[str] | Mapping[str, Any]) -> tuple[Floats, Floats]:
    """Sections [m] all along an elastic pipe, shape (s,), and the rows of `stress_row` at each, shape (s, n)."""
    case = load_case(case)
    sections = case.pipe.modal.stress_sections()
    return sections, np.pad(case.pipe.modal.stresses(sections), ((0, 0), (0, len(case.absorbers))))


def as_system(case_or_system: Any) -> System:
    """Return the `System` of a case, or the system itself.

    Parameters
    ----------
    case_or_system : System, Case, str, Path or dict
        A system, a case, or whatever `load_case` reads.

    Raises
    ------
    ParameterError
        If it is none of these, or the case cannot be read.
    """
    if isinstance(case_or_system, System):
        return case_or_system
    if not isinstance(case_or_system, Case | Mapping | str | os.PathLike):
        raise ParameterError("case_or_system", case_or_system, "a frahm.Case, a frahm.System, or what load_case reads")
    return build_system(case_or_system)


def _relative(motion: Floats, absorber: int, count: int) -> Floats:
    """Direction n with n.x = x_absorber - motion . (modal displacements)."""
    own = np.zeros(count)
    own[absorber] = 1.0
    return np.concatenate([-motion, own])


def _force_law(absorber: Absorber) -> Law:
    law, weight = absorber.law, absorber.mass * absorber.gravity
    stops = None if absorber.stops is None else Stops(**dict(absorber.stops))
    friction = None if absorber.friction is None else Friction(**dict(absorber.friction))
    given = {name: value for name, value in law if name != "kind"}
    return _LAWS[law.kind](**given, stops=stops, friction=friction, weight=weight)
