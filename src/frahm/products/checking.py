"""A member with its device against all attractors: the numbers `frahm run` of its case comes to."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from frahm.assessment import (
    FatigueDamage,
    Utilisation,
    damage_of_modes,
    doubts_of_modes,
    doubts_of_the_rest,
    total_damage,
    utilisations,
    with_stress,
)
from frahm.attractors import WorstMotion, joined, worst_over
from frahm.case import Case
from frahm.errors import Outcome, ParameterError
from frahm.loads import operating_range, other_ranges
from frahm.systems import build_system


@dataclass(frozen=True, eq=False)
class MemberCheck:
    """What all attractors of a member with its device come to.

    Attributes
    ----------
    motion : WorstMotion
        The worst over every range that winds of the site excite.
    damage : dict or None
        Fatigue of all modes; None without climate and S-N curve.
    limits : tuple of Utilisation
    outside : float
        Utilisation by damage of winds outside all bands, as they do it without an absorber [-]; 0 where it is small.
    unverified : tuple of str
        What speaks against it.
    """

    motion: WorstMotion
    damage: dict[str, Any] | None
    limits: tuple[Utilisation, ...]
    outside: float
    unverified: tuple[str, ...]

    @property
    def exceeds(self) -> bool:
        """Whether a limit is exceeded by what is counted in `frahm run`."""
        return any(row.ratio > 1 for row in self.limits)

    @property
    def utilisation(self) -> float:
        """The largest utilisation of a limit, winds outside all bands included [-]; NaN where none is known."""
        used = (row.ratio + (self.outside if row.name == "damage" else 0.0) for row in self.limits)
        return max((ratio for ratio in used if not math.isnan(ratio)), default=math.nan)


def checked(case: Case) -> MemberCheck:
    """The worst motion and the damage of a member with its device, as `frahm run` finds them.

    Raises
    ------
    KeyboardInterrupt
        If the search was interrupted.
    """
    motion = joined([_worst(one, within) for one, within in ((case, operating_range(case)), *other_ranges(case))])
    parts, doubts = _damage(case)
    damage = total_damage(parts) if parts else None
    limits, outside = tuple(utilisations(case, motion.row(), damage)), outside_utilisation(case, parts)
    used = next((row.ratio for row in limits if row.name == "damage"), 0.0)
    if used <= 1 < used + outside:  # what an absorber does in these winds is not known
        doubts += doubts_of_the_rest(parts)
    return MemberCheck(motion, damage, limits, outside, (*motion.unverified, *doubts))


def _worst(case: Case, within: Any) -> WorstMotion:
    system, settings = build_system(case), case.analysis
    found = worst_over(system, within, samples=settings.samples, min_basin=0.0, seed=settings.seed)
    if Outcome.INTERRUPTED.value in found.unverified:
        raise KeyboardInterrupt
    return with_stress(case, found, system)


def _damage(case: Case) -> tuple[tuple[FatigueDamage, ...], tuple[str, ...]]:
    """Damage by every mode, and what speaks against it but for winds outside all bands."""
    if case.fatigue is None:
        return (), ()
    try:
        parts = damage_of_modes(case)
    except ParameterError as refused:
        return (), (f"The fatigue damage could not be counted: {refused}",)
    rest = doubts_of_the_rest(parts)
    return parts, tuple(doubt for doubt in doubts_of_modes(parts) if doubt not in rest)


def outside_utilisation(case: Case, parts: tuple[FatigueDamage, ...]) -> float:
    """Utilisation by the damage of winds outside all bands without an absorber [-]; 0 where that is negligible."""
    if case.fatigue is None or not parts or not doubts_of_the_rest(parts):
        return 0.0
    limit = 1.0 if case.limits is None else case.limits.damage
    return case.fatigue.design_fatigue_factor * max(part.outside_without for part in parts) / limit
