"""The pipe of a case as a `System`: one mode, and a coordinate for every absorber."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from frahm.absorbers import Cubic, Linear, Polynomial
from frahm.arrays import Floats
from frahm.case import Absorber, Case, CubicLaw, LinearLaw, load_case
from frahm.errors import ParameterError
from frahm.loads import vortex_shedding
from frahm.systems.system import Element, Law, System


def build_system(case: Case | str | os.PathLike[str] | Mapping[str, Any]) -> System:
    """Equations of motion of a case: the pipe as one mode, each absorber hung on it.

    Parameters
    ----------
    case : Case, str, Path or dict
        A case, or whatever `load_case` reads.

    Returns
    -------
    System
        Absolute coordinates (x_1 of the pipe, then one per absorber), the lift on the pipe as forcing [N], detuning
        counted from the natural frequency of the pipe without absorbers.

    Raises
    ------
    ParameterError
        If the case cannot be read.
    """
    case = load_case(case)
    pipe, size = case.pipe, 1 + len(case.absorbers)
    damping, stiffness, forcing = np.zeros((size, size)), np.zeros((size, size)), np.zeros(size)
    damping[0, 0] = 2 * pipe.damping_ratio * pipe.mass * pipe.frequency
    stiffness[0, 0] = pipe.mass * pipe.frequency**2
    forcing[0] = vortex_shedding(case).lift
    return System(
        mass=np.diag([pipe.mass, *(absorber.mass for absorber in case.absorbers)]),
        damping=damping,
        stiffness=stiffness,
        forcing=forcing,
        elements=[
            Element(direction=_relative(i, size), law=_force_law(absorber))
            for i, absorber in enumerate(case.absorbers, start=1)
        ],
        output=0,
        reference_frequency=pipe.frequency,
        name=case.name,
    )


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


def _relative(coordinate: int, size: int) -> Floats:
    """Direction n with n.x = x_coordinate - x_0."""
    direction = np.zeros(size)
    direction[0], direction[coordinate] = -1.0, 1.0
    return direction


def _force_law(absorber: Absorber) -> Law:
    law = absorber.law
    if isinstance(law, CubicLaw):
        return Cubic(stiffness=law.stiffness, damping=law.damping)
    if isinstance(law, LinearLaw):
        return Linear(stiffness=law.stiffness, damping=law.damping)
    return Polynomial(law.coefficients, damping=law.damping)
