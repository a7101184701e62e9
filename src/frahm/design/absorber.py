"""The absorber that is designed: a mass on a spring with linear, cubic and quintic parts, beside a damper."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from frahm.case import Absorber, Case, CubicLaw, LinearLaw, PolynomialLaw
from frahm.errors import ParameterError, check_number

if TYPE_CHECKING:
    from frahm.case.absorber import Law

UNITS = {"rho2": "1", "linear": "1/s^2", "kappa": "1/(m^2 s^2)", "xi2": "1/s", "quintic": "1/(m^4 s^2)"}


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
    quintic : float
        Stiffness of the fifth power [1/(m^4 s^2)].
    position : float, optional
        Where on an elastic pipe it hangs [m]; None where the case says so.
    """

    rho2: float
    linear: float
    kappa: float
    xi2: float
    quintic: float = 0.0
    position: float | None = None

    def __post_init__(self) -> None:
        check_number("rho2", self.rho2, above=0)
        for name in ("linear", "kappa", "xi2", "quintic"):
            check_number(name, getattr(self, name), at_least=0, unit=UNITS[name])
        if not self.linear and not self.nonlinear:
            raise ParameterError("linear, kappa", (0.0, 0.0), "a spring: at least one of the two above 0")

    @property
    def nonlinear(self) -> bool:
        """Whether its spring is not linear."""
        return bool(self.kappa or self.quintic)

    @property
    def family(self) -> str:
        """Corner of the family it belongs to: "sink", "tuned" or "mixed"."""
        if not self.nonlinear:
            return "tuned"
        return "mixed" if self.linear else "sink"

    @property
    def parameters(self) -> dict[str, float]:
        """Its parameters by name, those of the spring's fifth power and of the place only where there are any."""
        found = {"rho2": self.rho2, "linear": self.linear, "kappa": self.kappa, "xi2": self.xi2}
        if self.quintic:
            found["quintic"] = self.quintic
        return found if self.position is None else found | {"position": self.position}

    def law(self, host_mass: float) -> Law:
        """Force law in SI units for a pipe of the given mass [kg]."""
        damping = host_mass * self.xi2
        if self.family == "tuned":
            return LinearLaw(stiffness=host_mass * self.linear, damping=damping)
        if self.family == "sink" and not self.quintic:
            return CubicLaw(stiffness=host_mass * self.kappa, damping=damping)
        powers = (self.linear, 0.0, self.kappa, 0.0, self.quintic)[: 5 if self.quintic else 3]
        return PolynomialLaw(coefficients=tuple(host_mass * power for power in powers), damping=damping)


def parameters_text(design: DesignedAbsorber) -> str:
    """Parameters for a sentence."""
    units = UNITS | {"position": "m", "rho2": ""}
    given = {name: value for name, value in design.parameters.items() if value or name in ("rho2", "xi2")}
    return ", ".join(f"{name} {value:.5g} {units[name]}".rstrip() for name, value in given.items())


def absorber_of(case: Case) -> DesignedAbsorber | None:
    """The case's own absorber, if it is the only one and of the family; None otherwise."""
    if len(case.absorbers) != 1:
        return None
    absorber, host = case.absorbers[0], case.pipe.mass
    law = absorber.law
    if absorber.stops is not None or absorber.friction is not None or absorber.gravity:
        return None
    if isinstance(law, CubicLaw):
        powers: tuple[float, ...] = (0.0, 0.0, law.stiffness)
    elif isinstance(law, LinearLaw):
        powers = (law.stiffness,)
    elif isinstance(law, PolynomialLaw):
        powers = law.coefficients
    else:
        return None
    if any(power and k not in (0, 2, 4) for k, power in enumerate(powers)) or min(powers) < 0 or not any(powers):
        return None
    linear, _, cubic, _, quintic = (power / host for power in (*powers, 0.0, 0.0, 0.0, 0.0)[:5])
    return DesignedAbsorber(absorber.mass / host, linear, cubic, law.damping / host, quintic)


def with_design(case: Case, design: DesignedAbsorber, name: str | None = None) -> Case:
    """The case with this absorber in place of its first one."""
    host = case.pipe.mass
    old = case.absorbers[0] if case.absorbers else None
    fields = set() if old is None else old.model_fields_set - {"stops", "friction", "gravity"}
    kept = {key: getattr(old, key) for key in fields}
    changes: dict[str, Any] = {"mass": host * design.rho2, "law": design.law(host)}
    changes |= {} if name is None else {"name": name}
    changes |= {} if design.position is None else {"position": design.position}
    new = Absorber(**(kept | changes))
    return Case(
        **({key: getattr(case, key) for key in case.model_fields_set} | {"absorbers": (new, *case.absorbers[1:])})
    )


def without_first(case: Case) -> Case:
    """The case without the absorber that is designed; others stay."""
    return Case(**({key: getattr(case, key) for key in case.model_fields_set} | {"absorbers": case.absorbers[1:]}))


def left_out(case: Case) -> list[str]:
    """What the case's first absorber has that a design does not, in sentences."""
    if not case.absorbers:
        return []
    old, found = case.absorbers[0], []
    if old.stops is not None:
        found.append(f"The end stops of the case are left out; their gap of {old.stops.gap:.4g} m limits the stroke.")
    if old.friction is not None:
        found.append("The dry friction of the case's absorber is left out: run best.yaml with it put back.")
    if old.gravity:
        found.append("The gravity along the motion of the case's absorber is left out: see the sag.")
    return found
