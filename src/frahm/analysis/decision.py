"""Step `decision`: the case beside the bare pipe and a textbook tuned mass damper, in one table and one figure."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.analysis.section import Section, Work
from frahm.arrays import labelled
from frahm.assessment import damage_of_modes, device_row, doubts_of_modes, total_damage, with_stress
from frahm.attractors import WorstMotion, joined, lasting_motions, worst_over
from frahm.case import Case
from frahm.design.disturbance import Disturbance
from frahm.design.objective import Objective
from frahm.design.problem import Problem
from frahm.design.settings import settings_for
from frahm.design.tuned import textbook_damper
from frahm.design.verification import verification
from frahm.errors import ParameterError
from frahm.harmonic_balance import is_linear
from frahm.loads import OperatingRange, operating_range, other_ranges, vortex_shedding
from frahm.systems import build_system

if TYPE_CHECKING:
    import xarray as xr

TUNED = "tuned mass damper"
NOT_OPTIMISED = "by the textbook (equal peaks), not optimised: frahm design optimises"
_UNBOUNDED = "Without damping nothing bounds the resonance."


@dataclass(frozen=True, eq=False)
class Device:
    """A linear device as far as the closed form goes: the case with it, its worst motion, what lasts at every wind."""

    name: str
    case: Case
    motion: WorstMotion
    lasting: xr.Dataset


def decision(work: Work) -> Section:
    """Rows of the table that decides, with the largest lasting response of every device over the range."""
    results = work.done.results
    worst = results.get("worst_case")
    if worst is None or not np.any(work.system.forcing):
        return Section()
    devices, notes = _linear_devices(work)
    rows = {device.name: _row(work, device) for device in devices}
    curves = {device.name: device.lasting for device in devices}
    if work.case.absorbers:
        own = _fatigue(results.get("fatigue"), "with")
        doubts = [*worst["unverified"], *(() if worst["verified"] or worst["unverified"] else ("See the checks.",))]
        rows["case"] = device_row("case", work.case, worst, own, [*doubts, *_doubts_of_fatigue(work)])
        curves["case"] = work.done.data["lasting"]
    names = [name for name in ("none", "case", TUNED) if name in rows]
    found: dict[str, Any] = {
        "over": "wind" if work.range.over_wind else "detuning",
        "rows": [rows[name] for name in names],
        "remarks": {TUNED: NOT_OPTIMISED} if TUNED in rows else {},
        "frequency_errors": _frequency_errors(work, devices, rows),
    }
    return Section(
        results={
            "decision": found,
            "natural_frequency": work.case.pipe.frequency,
            "design_detuning": float(vortex_shedding(work.case).detuning),
        },
        data={"decision": together({name: curves[name] for name in names if name in curves})},
        notes=notes,
    )


def together(curves: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Curves of several devices as one dataset, whose variable `device` counts the names of its attribute."""
    import xarray as xr

    parts = [curve.assign(device=labelled("point", np.full(curve.sizes["point"], number), "number of the device", "1"))
             for number, curve in enumerate(curves.values())]  # fmt: skip
    whole = xr.concat(parts, dim="point", combine_attrs="override")
    whole["device"].attrs["names"] = ", ".join(curves)
    return whole


def _linear_devices(work: Work) -> tuple[list[Device], tuple[str, ...]]:
    """The bare pipe, unless its resonance is unbounded, and the tuned mass damper."""
    found, notes = [], []
    bare = work.case.without_absorbers()
    if math.isfinite(work.done.results["without_absorber"]["pipe_peak_max"]):
        found.append(_device("none", bare, work.range))
    else:
        notes.append(f"The pipe without absorber is not compared. {_UNBOUNDED}")
    try:
        tuned = textbook_damper(work.case, settings_mass_ratio(work.case))
        found.append(_device(TUNED, tuned, operating_range(tuned)))
    except ParameterError as refused:
        notes.append(f"No tuned mass damper is compared: {refused}")
    return found, tuple(notes)


def settings_mass_ratio(case: Case) -> float:
    """Mass ratio of the damper beside a pipe without absorber: the largest that its section `design` allows [-]."""
    ratio = settings_for(case).mass_ratio
    return float(max(ratio) if isinstance(ratio, tuple) else ratio or 0.0)


def _device(name: str, case: Case, within: OperatingRange) -> Device:
    asked = [(case, within), *(other_ranges(case) if within.moves else ())]
    parts = [worst_over(build_system(one), part, samples=1, min_basin=0.0, seed=1) for one, part in asked]
    motion = joined([with_stress(one, part) for (one, _), part in zip(asked, parts, strict=True)])
    return Device(name, case, motion, lasting_motions(parts))


def _row(work: Work, device: Device) -> dict[str, Any]:
    counted = work.done.results.get("fatigue")
    fatigue, doubts = _fatigue(counted, "without"), list[str]()
    if device.name != "none" and counted is not None:
        fatigue, doubts = _counted(device.case)
    return device_row(device.name, device.case, device.motion.row(), fatigue, [*device.motion.unverified, *doubts])


def _fatigue(found: Mapping[str, Any] | None, which: str) -> dict[str, Any] | None:
    """Fatigue of the case with its absorbers, or without, from the step before."""
    if found is None:
        return None
    life = "life_years" if which == "with" else "life_years_without"
    return {
        "damage": found[f"damage_{which}"],
        "utilisation_with": found[f"utilisation_{which}"],
        "life_years": found[life],
    }


def _counted(case: Case) -> tuple[dict[str, Any] | None, list[str]]:
    try:
        parts = damage_of_modes(case)
    except ParameterError as refused:
        return None, [f"The fatigue damage could not be counted: {refused}"]
    total = total_damage(parts)
    row = {"damage": total["damage_with"], "utilisation_with": total["utilisation_with"],
           "life_years": total["life_years"]}  # fmt: skip
    return row, list(doubts_of_modes(parts))


def _doubts_of_fatigue(work: Work) -> list[str]:
    found = work.done.results.get("fatigue")
    return [] if found is None or found["verified"] else ["The fatigue damage is unverified."]


def _frequency_errors(work: Work, devices: list[Device], rows: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Worst peaks of the linear devices where the pipe's frequency is off, by the rule of a design, not retuned."""
    try:
        problem = Problem.of(work.case, settings_for(work.case, changes={"objective": "peak"}))
    except ParameterError:
        return {}
    errors, cases = problem.settings.errors, {device.name: device.case for device in devices}
    if "case" in rows and is_linear(work.system):
        cases["case"] = work.case
    peaks = {name: [_at_error(problem, case, r, rows[name]) for r in errors] for name, case in cases.items()}
    return {
        "error": [r - 1.0 for r in errors],
        "pipe_peak": {name: [motion[0] for motion in row] for name, row in peaks.items()},
        "verified": {name: [motion[1] for motion in row] for name, row in peaks.items()},
    }


def _at_error(problem: Problem, case: Case, ratio: float, row: Mapping[str, Any]) -> tuple[float, bool]:
    """Worst peak [m] of a linear device at a frequency of the pipe over the nominal one, and whether it is verified."""
    if ratio == 1:
        return float(row["pipe_peak"]), bool(row["verified"])
    off = Disturbance(pipe_frequency=ratio, lock_in=not problem.within.over_wind)
    worst = verification(problem.modes_of_errors(case), [off], Objective(), samples=1, seed=1)
    return worst.pipe_peak, worst.verified
