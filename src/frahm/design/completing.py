"""What the comparison of devices adds to a design: other modes, stress and fatigue, as `frahm run` finds them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.assessment import fatigue_damage, with_stress
from frahm.attractors import WorstCase, WorstMotion, joined, lasting_motions, worst_over
from frahm.case import Case
from frahm.design.problem import Problem
from frahm.loads import other_modes
from frahm.systems import build_system

if TYPE_CHECKING:
    import xarray as xr


def worst_motion(case: Case, problem: Problem, nominal: WorstCase | None) -> tuple[WorstMotion, xr.Dataset]:
    """The worst motion of the pipe as given with a device, by the very search of `frahm run`, and all that last.

    Parameters
    ----------
    case : Case
        With the device.
    problem : Problem
    nominal : WorstCase or None
        What is known of the governing mode already.
    """
    within, settings = problem.within, problem.settings
    asked: dict[str, Any] = {"samples": settings.samples, "seed": settings.seed, "min_basin": 0.0}
    first = worst_over(build_system(case), within, **asked) if nominal is None else nominal
    parts, motions = [first], [with_stress(case, first)]
    for other, part in other_modes(case, problem.most_mass_ratio) if within.moves else ():
        parts.append(worst_over(build_system(other), part, **asked, sampled=False))
        motions.append(with_stress(other, parts[-1]))
    return joined(motions), lasting_motions(parts)


def fatigue_row(case: Case) -> dict[str, Any] | None:
    """Fatigue over the climate with a device as plain data; None for a case that does not ask for it."""
    if case.fatigue is None or case.climate is None:
        return None
    found = fatigue_damage(case)
    factor = found.design_fatigue_factor
    return {
        "damage": found.damage_with,
        "utilisation_with": factor * found.damage_with,
        "life_years": found.life_years,
        "stress_range": float(np.max(found.range_with, initial=0.0)),
        "design_fatigue_factor": factor,
        "duration_years": found.duration_years,
        "unverified": list(found.unverified),
    }
