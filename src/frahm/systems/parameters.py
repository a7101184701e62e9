"""A system as a function of one of its parameters, with the exact derivatives of its matrices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.absorbers import Law
from frahm.arrays import Floats
from frahm.errors import ParameterError, check_number, nearest
from frahm.systems.system import Element, System

PARAMETERS = {
    "kappa": "1/(m^2 s^2)",
    "xi2": "1/s",
    "rho2": "1",
    "force": "1",
    "pipe_frequency": "rad/s",
}


@dataclass(frozen=True)
class Derivative:
    """Derivatives of a system by a parameter: matrices, forcing, and the nonlinear part of the first element's law."""

    mass: Floats
    damping: Floats
    stiffness: Floats
    forcing: Floats
    law: Law | None


def check_parameter(system: System, name: str) -> str:
    """Return the name of a parameter that the system has.

    "kappa" [1/(m^2 s^2)], "xi2" [1/s] and "rho2" [-] are cubic stiffness, damping and mass of the first element's
    absorber per host mass (M[0, 0]); the cubic stiffness scales the nonlinear spring and leaves its linear part, stops,
    friction and weight. "force" is a factor on the forcing and "pipe_frequency" [rad/s] moves the
    reference frequency with K as its square and C in proportion.
    """
    if name not in PARAMETERS:
        near = nearest(str(name), PARAMETERS)
        raise ParameterError(
            "parameter", name, "one of " + ", ".join(PARAMETERS), hint=f"Did you mean {near!r}?" if near else None
        )
    if name in ("kappa", "xi2", "rho2") and not system.elements:
        raise ParameterError("parameter", name, "a parameter of a system with an element")
    if name == "kappa" and _cubic(system) == 0:
        raise ParameterError("parameter", name, "a parameter of a system whose first element has a cubic spring")
    if name == "rho2":
        _absorber(system)
    return name


def parameter_value(system: System, name: str) -> float:
    """Present value of a parameter."""
    host = system.mass[0, 0]
    if name == "kappa":
        return _cubic(system) / host
    if name == "xi2":
        return system.elements[0].law.damping / host
    if name == "rho2":
        return float(system.mass[_absorber(system), _absorber(system)] / host)
    return 1.0 if name == "force" else system.reference_frequency


def with_parameters(system: System, **values: float) -> System:
    """Copy of a system with some parameters changed."""
    M, C, K, f = (np.array(part) for part in (system.mass, system.damping, system.stiffness, system.forcing))
    elements, reference = list(system.elements), system.reference_frequency
    for name, value in values.items():
        check_number(name, value, at_least=0.0, unit=PARAMETERS[name])
        if name == "force":
            f *= value
        elif name == "pipe_frequency":
            K *= (value / reference) ** 2
            C *= value / reference
        elif name == "rho2":
            a = _absorber(system)
            M[a, a] = value * M[0, 0]
        else:
            law, amount = elements[0].law, value * M[0, 0]
            law = law.with_cubic_stiffness(amount) if name == "kappa" else law.with_damping(amount)
            elements[0] = Element(elements[0].direction, law)
    reference = values.get("pipe_frequency", reference)
    return System(M, C, K, f, elements, system.output, reference, system.name)


def derivative_of(system: System, original: System, name: str) -> Derivative:
    """Derivatives by one parameter at the system that `with_parameters` made from `original`."""
    n = system.size
    zero = np.zeros((n, n))
    none = np.zeros(n)
    if name == "force":
        return Derivative(zero, zero, zero, np.array(original.forcing), None)
    if name == "kappa":
        return Derivative(zero, zero, zero, none, system.elements[0].law.by_cubic_stiffness(system.mass[0, 0]))
    if name == "xi2":
        direction = system.elements[0].direction
        return Derivative(zero, system.mass[0, 0] * np.outer(direction, direction), zero, none, None)
    if name == "rho2":
        mass = zero.copy()
        mass[_absorber(system), _absorber(system)] = system.mass[0, 0]
        return Derivative(mass, zero, zero, none, None)
    omega = system.reference_frequency
    return Derivative(zero, system.damping / omega, 2 * system.stiffness / omega, none, None)


def _cubic(system: System) -> float:
    return system.elements[0].law.cubic_stiffness


def _absorber(system: System) -> int:
    """Coordinate of the first element's own mass: where its direction is not the pipe's, coupled to nothing by mass."""
    direction = system.elements[0].direction
    for a in np.argsort(-np.abs(direction)):
        alone = np.count_nonzero(system.mass[a]) == 1
        if a != 0 and direction[a] != 0 and alone and not np.any(system.stiffness[a]):
            return int(a)
    raise ParameterError("parameter", "rho2", "a parameter of a system whose first element carries a mass of its own")
