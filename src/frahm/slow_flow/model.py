"""The slow flow of one mode with one cubic sink: its parameters, read from a `System`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from frahm.errors import ParameterError, check_choice
from frahm.slow_flow.kernels import AVERAGED, PAPER
from frahm.systems import System

FORMS = {"averaged": AVERAGED, "paper": PAPER}


@dataclass(frozen=True)
class SlowFlow:
    """Parameters of the slow flow, normalised by the pipe's mass m1.

    Attributes
    ----------
    omega : float
        Natural frequency of the pipe [rad/s].
    xi1, xi2 : float
        Damping c1/m1 of the pipe and c_nes/m1 of the sink [1/s].
    kappa : float
        Cubic stiffness k_nes/m1 [1/(m^2 s^2)].
    rho2 : float
        Mass ratio m_nes/m1 [-].
    force : float
        F_L/m1 [m/s^2].
    form : str
        "averaged" keeps the exact forcing frequency: its equilibria are the one-harmonic solutions of the exact
        equations. "paper" is the mixed multiple-scales / harmonic-balance form of doi 10.3390/app12147272.
    """

    omega: float
    xi1: float
    xi2: float
    kappa: float
    rho2: float
    force: float
    form: str = "averaged"

    @property
    def code(self) -> int:
        """Integer code of the form for the compiled kernels."""
        return FORMS[self.form]

    @property
    def host(self) -> tuple[float, float, float, float, float]:
        """omega, xi1, xi2, linear spring (none), rho2: the arguments of the kernels."""
        return self.omega, self.xi1, self.xi2, 0.0, self.rho2

    @property
    def limits(self) -> tuple[float, float]:
        """Range of Omega [rad/s] in which the form makes sense and beyond which nothing is searched."""
        lowest = 0.501 * self.omega if self.form == "paper" else 1e-3 * self.omega
        return lowest, 20.0 * self.omega

    def with_values(self, **changes: Any) -> SlowFlow:
        """Copy with some parameters changed."""
        return replace(self, **changes)


def slow_flow_of(system: System, form: str = "averaged") -> SlowFlow:
    """Slow flow of a `System` that is one mode with one cubic sink on it.

    Raises
    ------
    ParameterError
        If the system is anything else, saying what stands in the way.
    """
    check_choice("form", form, tuple(FORMS))
    _check_shape(system)
    (element,) = system.elements
    kappa = element.law.cubic_only
    if kappa is None:
        raise _refused("an absorber whose spring is not purely cubic")
    a, b = -element.direction[0], element.direction[1]
    m1, m2 = system.mass[0, 0] / a**2, system.mass[1, 1] / b**2
    return SlowFlow(
        omega=float(np.sqrt(system.stiffness[0, 0] / system.mass[0, 0])),
        xi1=float(system.damping[0, 0] / system.mass[0, 0]),
        xi2=element.law.damping / m1,
        kappa=kappa / m1,
        rho2=m2 / m1,
        force=abs(float(system.forcing[0] / a)) / m1,
        form=form,
    )


def pipe_scale(system: System) -> float:
    """Pipe displacement per unit of x1 in z = x2 - x1 (1 for the one-mode pipe)."""
    return abs(float(system.output[0] / system.elements[0].direction[0]))


def _check_shape(system: System) -> None:
    if len(system.elements) != 1 or system.size != 2:
        raise _refused(f"{system.size} coordinates and {len(system.elements)} local elements")
    host = np.array([[True, False], [False, False]])
    for matrix in (system.damping, system.stiffness):
        if np.any(matrix[~host]):
            raise _refused("linear springs or dampers besides those of the pipe")
    if np.any(system.mass[[0, 1], [1, 0]]) or system.forcing[1] or system.output[1]:
        raise _refused("coupled masses, or a force or an output on the sink")
    if not np.all(system.elements[0].direction):
        raise _refused("a sink that is not between the pipe and its own mass")
    if not system.stiffness[0, 0] > 0:
        raise _refused("a pipe without stiffness")


def _refused(found: str) -> ParameterError:
    return ParameterError(
        "method", "slow-flow", f"one mode with one cubic sink; this system has {found}",
        hint='Use method="harmonic-balance", which takes any system.',
    )  # fmt: skip
