"""The step from the chosen design to hardware: springs and dampers one can buy, tolerances, slopes."""

from __future__ import annotations

from frahm.design.exact import conditions_of, exact_birth
from frahm.design.finalists import FAR
from frahm.design.hardware import as_built, hardware
from frahm.design.robustness import sensitivities, tolerance_band
from frahm.design.work import DesignWork


def made(work: DesignWork) -> None:
    """The chosen design as hardware, with its tolerances and slopes, and with the force the springs really have."""
    best, more = work.found.best, work.found.with_margin
    if best is None or best.design is None:
        return
    work.step("hardware, tolerances and sensitivities")
    design, found, problem, settings = best.design, work.found, work.problem, work.settings
    stroke = max(best.relative_peak, more.relative_peak if more else 0.0)
    room, stress = settings.spring_length, settings.spring_stress
    found.hardware = hardware(work.case, design, stroke, best.frequency, room, stress, settings.counts[-1])
    screening = problem.tier(settings.family, count=design.count).screening
    found.tolerance = tolerance_band(
        design, best.worst_pipe_peak, problem.modes_of, problem.disturbances, settings.seed
    )
    found.sensitivities = sensitivities(design, problem.modes_of, problem.disturbances, screening, work.case.pipe.mass)
    if any(one.kappa for one in design.absorbers) and not any(one.quintic for one in design.absorbers):
        built, most = (
            problem.modes(as_built(work.case, design, stroke, room, settings.counts[-1])),
            FAR * settings.force_margin,
        )
        found.built = work.worst(built)
        found.built_margin, _ = exact_birth(conditions_of(built, problem.disturbances), best.force_margin, most)
