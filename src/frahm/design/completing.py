"""What the comparison of devices adds to a design: other modes, stress and fatigue, as `frahm run` finds them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from frahm.assessment import damage_of_modes, doubts_of_modes, total_damage, with_stress
from frahm.attractors import WorstCase, WorstMotion, joined, lasting_motions, worst_over
from frahm.case import Case
from frahm.design.disturbance import Disturbance
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


def other_motions_at(case: Case, ratio: float, most_mass_ratio: float = 0.0) -> list[WorstMotion]:
    """Worst motions of the other modes where all frequencies of the pipe are `ratio` times as high.

    By the stable periodic responses; their ranges move with the pipe, as far as the site has such winds.
    """
    found, off = [], Disturbance(pipe_frequency=ratio, lock_in=False)
    for other, part in other_modes(case, most_mass_ratio):
        lo, hi = (ratio * W for W in part.asked)
        wide = part.stretched(min(ratio, 1.0), max(ratio, 1.0))
        if max(lo, wide.frequency[0]) < min(hi, wide.frequency[1]):
            changed = off.of(build_system(other))
            moved = replace(wide.part(lo, hi), reference=changed.reference_frequency)
            found.append(worst_over(changed, moved, samples=1, min_basin=0.0, seed=1, sampled=False).motion)
    return found


def fatigue_row(case: Case) -> dict[str, Any] | None:
    """Fatigue over the climate with a device as plain data; None for a case that does not ask for it."""
    if case.fatigue is None or case.climate is None:
        return None
    parts = damage_of_modes(case)
    found, total = parts[0], total_damage(parts)
    factor = found.design_fatigue_factor
    return {
        "damage": total["damage_with"],
        "utilisation_with": total["utilisation_with"],
        "life_years": total["life_years"],
        "stress_range": total["stress_range_with"],
        "design_fatigue_factor": factor,
        "duration_years": found.duration_years,
        "unverified": list(doubts_of_modes(parts)),
    }
