"""Steps that hold the best design against its rivals: every device with all of its modes, stress and fatigue."""

from __future__ import annotations

import math
from dataclasses import replace

from frahm.case import Case
from frahm.design.absorber import absorber_of
from frahm.design.completing import fatigue_row, worst_motion
from frahm.design.exact import conditions_of, exact_birth
from frahm.design.finalists import FAR
from frahm.design.work import DesignWork, rival_of
from frahm.response.own_lift import own_lift


def no_absorber(work: DesignWork) -> None:
    """The pipe without absorber."""
    work.step("no absorber")
    if work.bare is not None:
        work.nominal["none"] = work.bare.nominal
        work.found.rivals["none"] = rival_of("none", None, work.bare, math.inf)


def own_absorber(work: DesignWork) -> None:
    """The case's own absorber, where it has one."""
    if not work.case.absorbers:
        return
    work.step("the case's own absorber")
    problem, most = work.problem, FAR * work.settings.force_margin
    checked = work.verify(work.case)
    work.nominal["case"] = checked.nominal
    free, _ = exact_birth(conditions_of(problem.modes(work.case), problem.disturbances), 1.0, most)
    work.found.rivals["case"] = rival_of("case", absorber_of(work.case), checked, free, len(work.case.absorbers))


def whole_comparison(work: DesignWork) -> None:
    """Every device with its worst motion as `frahm run` finds it, with every mode, the stress and the fatigue."""
    work.step("other modes, stress and fatigue")
    for name, rival in list(work.found.rivals.items()):
        case = work.case_of(rival)
        nominal = work.nominal.get(name if name in ("none", "case") else rival.design, ())
        worst, work.found.lasting[name] = worst_motion(case, work.problem, nominal)
        if work.found.best is not None and name == work.found.best.name:
            worst = replace(worst, unverified=(*worst.unverified, *_exceeded(work, case, worst.pipe_peak)))
        whole = replace(rival, worst=worst, fatigue=fatigue_row(case))
        work.found.rivals[name] = whole
        if work.found.best is not None and name == work.found.best.name:
            work.found.best = whole


def _exceeded(work: DesignWork, case: Case, worst: float) -> tuple[str, ...]:
    """Where one lift was asked about: a sentence if winds with their own move the pipe with the best design more.

    The others are there to be compared with under what was asked.
    """
    found = own_lift(case, work.problem.within, worst)
    return (found.text,) if found is not None and found.exceeds else ()
