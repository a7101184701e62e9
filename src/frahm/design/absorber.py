"""The absorbers that are designed: each a mass on a spring with linear, cubic and quintic parts, beside a damper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from frahm.case import Absorber, Case, CubicLaw, LinearLaw, PolynomialLaw
from frahm.case.absorber import free_name
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
    beside : tuple of DesignedAbsorber
        Further absorbers designed together with it.
    """

    rho2: float
    linear: float
    kappa: float
    xi2: float
    quintic: float = 0.0
    position: float | None = None
    beside: tuple[DesignedAbsorber, ...] = ()

    def __post_init__(self) -> None:
        check_number("rho2", self.rho2, above=0)
        for name in ("linear", "kappa", "xi2", "quintic"):
            check_number(name, getattr(self, name), at_least=0, unit=UNITS[name])
        if not self.linear and not self.nonlinear:
            raise ParameterError("linear, kappa", (0.0, 0.0), "a spring: at least one of the two above 0")

    @property
    def absorbers(self) -> tuple[DesignedAbsorber, ...]:
        """It and those designed together with it, each alone."""
        return (replace(self, beside=()), *self.beside)

    @property
    def count(self) -> int:
        """Number of absorbers."""
        return 1 + len(self.beside)

    @property
    def nonlinear(self) -> bool:
        """Whether the spring of any of them is not linear."""
        return bool(self.kappa or self.quintic) or any(other.nonlinear for other in self.beside)

    @property
    def family(self) -> str:
        """Corner of the family they belong to: "sink", "tuned" or "mixed"."""
        if not self.nonlinear:
            return "tuned"
        return "mixed" if any(one.linear for one in self.absorbers) else "sink"

    @property
    def row(self) -> tuple[float, ...]:
        """m, k1, k3, c, k5 of every absorber, divided by the mass of the pipe."""
        return tuple(v for a in self.absorbers for v in (a.rho2, a.linear, a.kappa, a.xi2, a.quintic))

    @property
    def parameters(self) -> dict[str, float]:
        """Parameters by name, those of the spring's fifth power and of the place only where there are any.

        Those of the second absorber end in `_2`, and so on.
        """
        found = self._own_parameters
        for number, other in enumerate(self.beside, start=2):
            found |= {f"{name}_{number}": value for name, value in other._own_parameters.items()}
        return found

    def changed(self, name: str, factor: float) -> DesignedAbsorber:
        """The same with one of `parameters` multiplied by a factor."""
        plain, _, number = name.rpartition("_")
        if not number.isdigit():
            return replace(self, **{name: factor * getattr(self, name)})
        at = int(number) - 2
        others = list(self.beside)
        others[at] = others[at].changed(plain, factor)
        return replace(self, beside=tuple(others))

    @property
    def _own_parameters(self) -> dict[str, float]:
        found = {"rho2": self.rho2, "linear": self.linear, "kappa": self.kappa, "xi2": self.xi2}
        if self.quintic:
            found["quintic"] = self.quintic
        return found if self.position is None else found | {"position": self.position}

    def law(self, host_mass: float) -> Law:
        """Force law of the first absorber in SI units for a pipe of the given mass [kg]."""
        damping = host_mass * self.xi2
        if not (self.kappa or self.quintic):
            return LinearLaw(stiffness=host_mass * self.linear, damping=damping)
        if not (self.linear or self.quintic):
            return CubicLaw(stiffness=host_mass * self.kappa, damping=damping)
        powers = (self.linear, 0.0, self.kappa, 0.0, self.quintic)[: 5 if self.quintic else 3]
        return PolynomialLaw(coefficients=tuple(host_mass * power for power in powers), damping=damping)


def together(absorbers: Sequence[DesignedAbsorber]) -> DesignedAbsorber:
    """Absorbers as one design."""
    return replace(absorbers[0], beside=tuple(absorbers[1:]))


def parameters_text(design: DesignedAbsorber) -> str:
    """Parameters for a sentence."""
    units = UNITS | {"position": "m", "rho2": ""}
    texts = []
    for one in design.absorbers:
        given = {name: value for name, value in one.parameters.items() if value or name in ("rho2", "xi2")}
        texts.append(", ".join(f"{name} {value:.5g} {units[name]}".rstrip() for name, value in given.items()))
    if len(texts) == 1:
        return texts[0]
    return "; ".join(f"absorber {number}: {text}" for number, text in enumerate(texts, start=1))


def absorber_of(case: Case) -> DesignedAbsorber | None:
    """The case's own absorbers, if they are of the family; None otherwise."""
    found = [_of_family(absorber, case.pipe.mass) for absorber in case.absorbers]
    known = [one for one in found if one is not None]
    return together(known) if known and len(known) == len(found) else None


def _of_family(absorber: Absorber, host: float) -> DesignedAbsorber | None:
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


def with_design(case: Case, design: DesignedAbsorber, name: str | None = None, replaced: int | None = None) -> Case:
    """The case with these absorbers in place of its first ones, by default of as many.

    One that takes the place of none hangs where the first one does.
    """
    others = case.absorbers[design.count if replaced is None else replaced :]
    host, taken = case.pipe.mass, [absorber.name for absorber in others]
    new: list[Absorber] = []
    for number, one in enumerate(design.absorbers):
        known = number < len(case.absorbers) - len(others)
        old = case.absorbers[number if known else 0] if case.absorbers else None
        fields = set() if old is None else old.model_fields_set - {"stops", "friction", "gravity"}
        kept = {key: getattr(old, key) for key in fields}
        changes: dict[str, Any] = {"mass": host * one.rho2, "law": one.law(host)}
        if name is not None or not known:
            base = name or (case.absorbers[0].name if case.absorbers else Absorber.model_fields["name"].default)
            changes["name"] = free_name(base, [*taken, *(other.name for other in new)])
        changes |= {} if one.position is None else {"position": one.position}
        new.append(Absorber(**(kept | changes)))
    return Case(**_fields(case, (*new, *others)))


def without_designed(case: Case, count: int = 1) -> Case:
    """The case without the absorbers that are designed; others stay."""
    return Case(**_fields(case, case.absorbers[count:]))


def _fields(case: Case, absorbers: tuple[Absorber, ...]) -> dict[str, Any]:
    return {key: getattr(case, key) for key in case.model_fields_set} | {"absorbers": absorbers}


def left_out(case: Case, count: int = 1) -> list[str]:
    """What the case's absorbers have that the design in their place does not, in sentences."""
    return [sentence for old in case.absorbers[:count] for sentence in _left_out(old)]


def _left_out(old: Absorber) -> list[str]:
    found = []
    if old.stops is not None:
        found.append(f"The end stops of the case are left out; their gap of {old.stops.gap:.4g} m limits the stroke.")
    if old.friction is not None:
        found.append("The dry friction of the case's absorber is left out: run best.yaml with it put back.")
    if old.gravity:
        found.append("The gravity along the motion of the case's absorber is left out: see the sag.")
    return found
