"""Largest stress range of the lasting motions over a range of operation, anywhere along the pipe."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from frahm.arrays import Floats
from frahm.assessment.motion_damage import largest_place
from frahm.attractors import WorstCase, WorstMotion, driven_at
from frahm.case import Case
from frahm.errors import Outcome, ParameterError
from frahm.harmonic_balance import is_linear, linear_response, resonant_grid
from frahm.systems import System, build_system, stress_rows


def stress_places(case: Case) -> tuple[Floats, Floats] | None:
    """Sections [m] and rows (sections, n) [Pa/m] of the nominal bending stress of a case; None if it is not known.

    A pipe given as one mode has its stress where `fatigue.stress_per_displacement` says so, at no named section.
    """
    if case.pipe.kind == "mode":
        slope = None if case.fatigue is None else case.fatigue.stress_per_displacement
        return None if slope is None else (np.array([math.nan]), slope * build_system(case).output[None, :])
    try:
        return stress_rows(case)
    except ParameterError:  # a table of modes without stresses
        return None


def with_stress(case: Case, worst: WorstCase, system: System | None = None) -> WorstMotion:
    """The worst motion of a case with the largest stress range of any lasting motion met in its range.

    Of every attractor at every frequency searched; a linear system over all frequencies of the range.
    """
    places = stress_places(case)
    if places is None:
        return worst.motion
    system = build_system(case) if system is None else system
    find = _linear if is_linear(system) or not np.any(system.forcing) else _of_attractors
    stress, W, section = find(system, worst, *places)
    return dataclasses.replace(worst.motion, stress_range=stress, stress_frequency=W, stress_section=section)


def _linear(system: System, worst: WorstCase, sections: Floats, rows: Floats) -> tuple[float, float, float]:
    grid = np.unique([*resonant_grid(system, *worst.range.frequency), *(survey.frequency for survey in worst.surveys)])
    if not np.any(system.forcing):
        return 0.0, worst.frequency, float(sections[0])
    factors = np.array([worst.range.lift_factor(W) for W in grid])
    stresses = np.einsum("pn,sn->ps", linear_response(system, grid), rows)  # without the threads of a matrix product
    ranges = 2 * np.abs(stresses) * factors[:, None]
    at, place = np.unravel_index(int(np.argmax(ranges)), ranges.shape)
    return float(ranges[at, place]), float(grid[at]), float(sections[place])


def _of_attractors(system: System, worst: WorstCase, sections: Floats, rows: Floats) -> tuple[float, float, float]:
    at, best = driven_at(system, worst.range), (math.nan, math.nan, math.nan)
    for survey in worst.surveys:
        driven = at(survey.frequency)
        for attractor in survey:
            if attractor.outcome is Outcome.DIVERGED:
                return math.inf, survey.frequency, math.nan
            if attractor.basin_fraction < worst.min_basin:
                continue
            if attractor.outcome in _FAILED:
                return math.nan, survey.frequency, math.nan
            section, ranges = largest_place(driven, attractor, sections, rows)
            if math.isnan(ranges.max()):
                return math.nan, survey.frequency, math.nan
            if not float(ranges.max()) <= best[0]:
                best = float(ranges.max()), survey.frequency, section
    return best


_FAILED = (Outcome.STEP_LIMIT, Outcome.STEP_TOO_SMALL)
