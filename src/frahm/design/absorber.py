"""The absorber that is designed: a mass on a spring with a linear and a cubic part, beside a damper."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from frahm.case import Absorber, Case, CubicLaw, LinearLaw, PolynomialLaw
from frahm.errors import ParameterError, check_number

if TYPE_CHECKING:
    from frahm.case.absorber import Law

FAMILIES = ("sink", "tuned", "mixed")


@dataclass(frozen=True)
class DesignedAbsorber:
    """Parameters of an absorber, divided by the mass of the pipe as `Case.with_absorber` takes them.

    Parameters
    ----------
    rho2 : float
        Mass [-].
    linear : float
        Linear stiffness [1/s^2]; 0 for a pure sink.
    kappa : float
        Cubic stiffness [1/(m^2 s^2)]; 0 for a tuned mass damper.
    xi2 : float
        Damping [1/s].
    """

    rho2: float
    linear: float
    kappa: float
    xi2: float

    def __post_init__(self) -> None:
        check_number("rho2", self.rho2, above=0)
        for name, unit in (("linear", "1/s^2"), ("kappa", "1/(m^2 s^2)"), ("xi2", "1/s")):
            check_number(name, getattr(self, name), at_least=0, unit=unit)
        if not self.linear and not self.kappa:
            raise ParameterError("linear, kappa", (0.0, 0.0), "a spring: at least one of the two above 0")

    @property
    def family(self) -> str:
        """Corner of the family it belongs to: "sink", "tuned" or "mixed"."""
        if not self.kappa:
            return "tuned"
        return "mixed" if self.linear else "sink"

    def law(self, host_mass: float) -> Law:
        """Force law in SI units for a pipe of the given mass [kg]."""
        damping = host_mass * self.xi2
        if self.family == "sink":
            return CubicLaw(stiffness=host_mass * self.kappa, damping=damping)
        if self.family == "tuned":
            return LinearLaw(stiffness=host_mass * self.linear, damping=damping)
        return PolynomialLaw(coefficients=(host_mass * self.linear, 0.0, host_mass * self.kappa), damping=damping)


def absorber_of(case: Case) -> DesignedAbsorber | None:
    """The case's own absorber, if it is the only one and of the family; None otherwise."""
    if len(case.absorbers) != 1:
        return None
    absorber, host = case.absorbers[0], case.pipe.mass
    law = absorber.law
    if absorber.stops is not None or absorber.friction is not None or absorber.gravity:
        return None
    if isinstance(law, CubicLaw):
        linear, cubic = 0.0, law.stiffness
    elif isinstance(law, LinearLaw):
        linear, cubic = law.stiffness, 0.0
    elif not isinstance(law, PolynomialLaw):
        return None
    else:
        powers = (*law.coefficients, 0.0, 0.0)
        linear, cubic = powers[0], powers[2]
        odd = all(c == 0 for i, c in enumerate(law.coefficients) if i not in (0, 2))
        if not odd or linear < 0 or cubic < 0 or not (linear or cubic):
            return None
    return DesignedAbsorber(absorber.mass / host, linear / host, cubic / host, law.damping / host)


def with_design(case: Case, design: DesignedAbsorber, name: str | None = None) -> Case:
    """The case with this absorber in place of its first one."""
    host = case.pipe.mass
    old = case.absorbers[0] if case.absorbers else None
    fields = set() if old is None else old.model_fields_set - {"stops", "friction", "gravity"}
    kept = {key: getattr(old, key) for key in fields}
    changes = {"mass": host * design.rho2, "law": design.law(host)} | ({} if name is None else {"name": name})
    new = Absorber(**(kept | changes))
    return Case(
        **({key: getattr(case, key) for key in case.model_fields_set} | {"absorbers": (new, *case.absorbers[1:])})
    )
