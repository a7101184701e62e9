"""What the comparison of devices adds to a design: other modes, stress and fatigue, as `frahm run` finds them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from frahm.assessment import damage_of_modes, doubts_of_modes, total_damage, with_stress
from frahm.attractors import WorstCase, WorstMotion, joined, lasting_motions, worst_over
from frahm.case import Case
from frahm.design.disturbance import Disturbance
from frahm.design.problem import Problem, governed

if TYPE_CHECKING:
    import xarray as xr


def worst_motion(case: Case, problem: Problem, nominal: tuple[WorstCase, ...]) -> tuple[WorstMotion, xr.Dataset]:
    """The worst motion of the pipe as given with a device, by the very search of `frahm run`, and all that last.

    Parameters
    ----------
    case : Case
        With the device.
    problem : Problem
    nominal : tuple of WorstCase
        What is known already, in every mode; empty if nothing is.
    """
    settings = problem.settings
    if not nominal:
        ranges = (problem.within, *(windows.range(Disturbance()) for *_, windows in problem.others))
        asked: dict[str, Any] = {"samples": settings.samples, "seed": settings.seed, "min_basin": 0.0}
        modes = zip(problem.modes(case), ranges, strict=True)
        nominal = tuple(worst_over(mode.system, within, **asked) for mode, within in modes)
    cases = [case, *(governed(case, mode, speed) for mode, speed, _ in problem.others)]
    motions = [with_stress(one, part) for one, part in zip(cases, nominal, strict=True)]
    return joined(motions), lasting_motions(nominal)


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
