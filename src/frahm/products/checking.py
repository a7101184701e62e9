"""A member with its device against all attractors: the numbers `frahm run` of its case comes to."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from frahm.assessment import (
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
    unverified : tuple of str
        What speaks against it.
    """

    motion: WorstMotion
    damage: dict[str, Any] | None
    limits: tuple[Utilisation, ...]
    unverified: tuple[str, ...]

    @property
    def utilisation(self) -> float:
        """The largest utilisation of a limit [-]; NaN where none is known."""
        return max((row.ratio for row in self.limits if not math.isnan(row.ratio)), default=math.nan)


def checked(case: Case) -> MemberCheck:
    """The worst motion and the damage of a member with its device, as `frahm run` finds them.

    Raises
    ------
    KeyboardInterrupt
        If the search was interrupted.
    """
    motion = joined([_worst(one, within) for one, within in ((case, operating_range(case)), *other_ranges(case))])
    damage, doubts = _damage(case)
    return MemberCheck(motion, damage, tuple(utilisations(case, motion.row(), damage)), (*motion.unverified, *doubts))


def _worst(case: Case, within: Any) -> WorstMotion:
    system, settings = build_system(case), case.analysis
    found = worst_over(system, within, samples=settings.samples, min_basin=0.0, seed=settings.seed)
    if Outcome.INTERRUPTED.value in found.unverified:
        raise KeyboardInterrupt
    return with_stress(case, found, system)


def _damage(case: Case) -> tuple[dict[str, Any] | None, tuple[str, ...]]:
    """Damage, and what speaks against it; what winds outside all bands do is held against the limit, as in a screen."""
    if case.fatigue is None:
        return None, ()
    try:
        parts = damage_of_modes(case)
    except ParameterError as refused:
        return None, (f"The fatigue damage could not be counted: {refused}",)
    rest, total = doubts_of_the_rest(parts), total_damage(parts)
    outside = max(part.outside_without for part in parts)
    doubts = tuple(doubt for doubt in doubts_of_modes(parts) if doubt not in rest)
    limit = 1.0 if case.limits is None else case.limits.damage
    factor = case.fatigue.design_fatigue_factor
    if total["utilisation_with"] <= limit < total["utilisation_with"] + factor * outside:
        doubts += rest
    return total | {"outside": outside}, doubts
