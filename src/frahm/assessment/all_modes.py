"""Fatigue damage over every mode that winds of the site excite, each with the lift in step with it."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np

from frahm.assessment.counting import Counting, counted_band
from frahm.assessment.damage import FatigueDamage
from frahm.assessment.fatigue import damage_beside
from frahm.assessment.verdict import doubts_of_the_rest
from frahm.case import Case
from frahm.loads import operating_range, other_ranges


def damage_of_modes(case: Case) -> tuple[FatigueDamage, ...]:
    """The damage in the range of operation of a case, and that of each other mode over the winds that excite it.

    A case that names its winds (`fatigue.wind_speeds`, `analysis.wind` or `analysis.detuning`) is counted over these
    alone. What winds in none of these bands do speaks against the first part.
    """
    named = case.fatigue is not None and case.fatigue.wind_speeds is not None
    others = () if named or not operating_range(case).moves else other_ranges(case)
    wanted = [(case, counted_band(case)), *((other, part.winds) for other, part in others if part.winds is not None)]
    bands = [band for _, band in wanted]
    first, *rest = (damage_beside(one, bands, Counting.of(one, wind=band)) for one, band in wanted)
    doubts = doubts_of_the_rest((first, *rest))
    return (dataclasses.replace(first, unverified=(*first.unverified, *doubts)), *rest)


def total_damage(parts: tuple[FatigueDamage, ...]) -> dict[str, Any]:
    """Sums over the modes as plain data: every mode at the section it stresses most, which is the safe side."""
    first = parts[0]
    factor, years = first.design_fatigue_factor, first.duration_years
    sums = {
        name: float(sum(getattr(part, name) for part in parts))
        for name in ("damage_with", "damage_without", "damage_with_weighted", "locked_in_with", "locked_in_without")
    }
    return {
        **sums,
        "utilisation_with": factor * sums["damage_with"],
        "utilisation_without": factor * sums["damage_without"],
        "life_years": _life(years, factor * sums["damage_with"]),
        "life_years_without": _life(years, factor * sums["damage_without"]),
        "stress_range_with": max(float(np.max(part.range_with, initial=0.0)) for part in parts),
        "stress_range_without": max(part.stress_range_without for part in parts),
        "verified": all(part.verified for part in parts),
    }


def doubts_of_modes(parts: tuple[FatigueDamage, ...]) -> tuple[str, ...]:
    """What speaks against the damage of any mode."""
    return tuple(dict.fromkeys(doubt for part in parts for doubt in part.unverified))


def _life(years: float, damage: float) -> float:
    """Years until the damage, design fatigue factor included, is one."""
    return years / damage if damage > 0 else math.inf
