"""A product: a few kinds of absorber, which member takes which, and how each then fares."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from frahm import readable
from frahm.arrays import Floats
from frahm.case import Case
from frahm.products.checking import MemberCheck
from frahm.products.served import ServedMember

PASS, FAIL, NOT_VERIFIED = "PASS", "FAIL", "NOT VERIFIED"
_UNSUITED = "No kind is light enough for it and without a detached curve up to the force margin."
DEVICES = {"tuned": "tuned mass damper", "sink": "sink", "mixed": "mixed absorber"}


@dataclass(frozen=True, eq=False)
class Kind:
    """One device for several members.

    Attributes
    ----------
    number : int
        From 1, the heaviest first.
    device : ndarray, shape (5,)
        Mass [kg], linear stiffness [N/m], cubic stiffness [N/m^3], damping [N s/m] and a fifth power of 0.
    members : tuple of str
        Who takes it.
    """

    __repr__ = readable.summary

    number: int
    device: Floats
    members: tuple[str, ...]

    def row(self) -> dict[str, Any]:
        """Plain data for the summary, in SI units of the device itself."""
        mass, linear, cubic, damping, _ = (float(value) for value in self.device)
        frequency = math.sqrt(linear / mass) / (2 * math.pi)
        return {"kind": self.number, "mass": mass, "linear": linear, "kappa": cubic, "xi2": damping,
                "frequency_hz": frequency or None, "members": list(self.members)}  # fmt: skip

    @property
    def text(self) -> str:
        """Its parameters in a sentence."""
        row = self.row()
        springs = [f"{row[name]:.4g} {unit}" for name, unit in (("linear", "N/m"), ("kappa", "N/m3")) if row[name]]
        return f"{row['mass']:.4g} kg on {' and '.join(springs)} beside {row['xi2']:.4g} N s/m"


@dataclass(frozen=True, eq=False)
class FittedMember:
    """A member with the kind it takes.

    Attributes
    ----------
    member : ServedMember
    kind : Kind
    expected : float
        Utilisation by the closed form [-].
    check : MemberCheck or None
        Against all attractors; None where that was not asked.
    why_not : str
        Why it was not asked.
    """

    member: ServedMember
    kind: Kind
    expected: float
    check: MemberCheck | None = None
    why_not: str = ""

    @property
    def name(self) -> str:
        """Of the member."""
        return self.member.name

    @property
    def case(self) -> Case:
        """The member with its device, ready for `frahm run`."""
        return self.member.with_device(self.kind.device)

    @property
    def utilisation(self) -> float:
        """Largest utilisation of a limit: by the check, or what is expected [-]."""
        return self.expected if self.check is None else self.check.utilisation

    @property
    def unverified(self) -> tuple[str, ...]:
        """What speaks against its utilisation."""
        found = (self.why_not,) if self.check is None else self.check.unverified
        return found if math.isfinite(self.expected) else (_UNSUITED, *found)

    @property
    def verified(self) -> bool:
        """Whether all attractors were asked and nothing speaks against the answer."""
        return self.check is not None and not self.unverified and math.isfinite(self.utilisation)

    @property
    def verdict(self) -> str:
        """FAIL if a limit is exceeded, PASS if all are kept and that is verified."""
        if self.check is not None and self.check.exceeds:
            return FAIL
        return PASS if self.verified else NOT_VERIFIED

    def row(self) -> dict[str, Any]:
        """Plain data for the summary, in SI units."""
        check = self.check
        motion = None if check is None else check.motion
        return {
            "member": self.name,
            "kind": self.kind.number,
            "natural_frequency_hz": self.member.frequency / (2 * math.pi),
            "mass_ratio": float(self.kind.device[0] / self.member.case.pipe.mass),
            "utilisation": self.utilisation,
            "expected": self.expected,
            "utilisation_without": self.member.screened.utilisation,
            "pipe_peak": None if motion is None else motion.pipe_peak,
            "stroke": None if motion is None else motion.relative_peak,
            "stress_range": None if motion is None else motion.stress_range,
            "damage": None if check is None or check.damage is None else check.damage["damage_with"],
            "verdict": self.verdict,
            "verified": self.verified,
            "unverified": list(self.unverified),
        }


@dataclass(frozen=True, eq=False)
class Product:
    """The best kinds of one family, as many as asked for.

    Attributes
    ----------
    family : {"sink", "tuned", "mixed"}
    count : int
        Number of kinds asked for; `kinds` has fewer where more are no better.
    kinds : tuple of Kind
    members : tuple of FittedMember
        The most used first.
    """

    __repr__ = readable.summary

    family: str
    count: int
    kinds: tuple[Kind, ...]
    members: tuple[FittedMember, ...]

    @property
    def binds(self) -> FittedMember:
        """The member that is used most, of those that were checked."""
        return self.members[0]

    @property
    def worst(self) -> float:
        """Largest utilisation of a member [-]."""
        return self.binds.utilisation

    @property
    def complete(self) -> bool:
        """Whether every member was checked against all attractors."""
        return all(one.check is not None for one in self.members)

    @property
    def verified(self) -> bool:
        """Whether every member is verified."""
        return all(one.verified for one in self.members)

    @property
    def passes(self) -> bool:
        """Whether every member passes."""
        return all(one.verdict == PASS for one in self.members)

    @property
    def fails(self) -> bool:
        """Whether a member exceeds a limit against all attractors."""
        return any(one.verdict == FAIL for one in self.members)

    @property
    def unverified(self) -> tuple[str, ...]:
        """A sentence for every member that is not verified, doubts that are the same said once."""
        doubts: dict[str, list[str]] = {}
        for one in self.members:
            if not one.verified:
                doubts.setdefault(" ".join(one.unverified), []).append(one.name)
        return tuple(f"{', '.join(names)}: {text}" for text, names in doubts.items())

    @property
    def title(self) -> str:
        """Number and family, in words."""
        number = len(self.kinds)
        return f"{number} kind{'s' * (number > 1)} of {DEVICES[self.family]}"

    def row(self) -> dict[str, Any]:
        """Plain data for the summary."""
        return {
            "family": self.family,
            "count": self.count,
            "kinds": [kind.row() for kind in self.kinds],
            "worst_utilisation": self.worst,
            "expected_worst": max(one.expected for one in self.members),
            "binds": self.binds.name,
            "passes": self.passes,
            "verified": self.verified,
            "unverified": list(self.unverified),
            "members": [one.row() for one in self.members],
        }


def product_of(family: str, count: int, members: tuple[ServedMember, ...], devices: Floats, takes: np.ndarray,
               used: Floats) -> Product:  # fmt: skip
    """A product as the closed form expects it, nothing checked."""
    order = np.argsort(-devices[:, 0], kind="stable")
    kinds = {
        int(at): Kind(number, devices[at], tuple(one.name for one, k in zip(members, takes, strict=True) if k == at))
        for number, at in enumerate(order, start=1)
    }
    fitted = [FittedMember(one, kinds[int(k)], float(u)) for one, k, u in zip(members, takes, used, strict=True)]
    return Product(family, count, tuple(kinds.values()), in_order(fitted))


def in_order(fitted: list[FittedMember]) -> tuple[FittedMember, ...]:
    """The most used first; of members that were not asked none stands before those that were."""
    return tuple(sorted(fitted, key=lambda one: (one.check is None, -one.utilisation)))
