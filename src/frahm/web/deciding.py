"""The decision of the page: the worst motion over the range of operation of a device, by the steps of `frahm run`."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from frahm.case import Case
from frahm.web.tuned import MASS_RATIO

# Steps that put nothing to the test, and that the verdict does not read.
_ONLY_SHOWN = ("wind", "detached_curve_margin", "manifold", "basins", "decision")
# Steps that take longer than one waits for a page; what they put to the test only the report says.
_LEFT_TO_THE_REPORT = ("modulated", "cross_check", "attractors")
DEVICES = ("bare", "this", "tuned")


def decision(case: Case, progress: Callable[[str, int, int], None], *, device: str) -> dict[str, Any]:
    """Worst motion, utilisation of the limits and verdict of a device on the pipe of a case.

    Parameters
    ----------
    case : Case
    progress : callable
        Told what is done.
    device : {"bare", "this", "tuned"}
        Without absorbers, with those of the case, or with a tuned mass damper of the same mass.

    Returns
    -------
    dict
        "worst": row of the worst motion, None if there is no bounded one; "acceptance" as in the summary of
        `frahm run`, with the checks of its quick steps; "lock_in" and "range" as there.
    """
    from frahm.analysis import STEPS
    from frahm.analysis.acceptance import judged_limits
    from frahm.analysis.fatigue import fatigue
    from frahm.analysis.linear import without_absorber
    from frahm.analysis.section import FAIL, UNVERIFIED, Work
    from frahm.assessment import accepted, nothing_to_judge, utilisations
    from frahm.design.tuned import textbook_damper

    if device == "bare":
        alone = case.without_absorbers()
        rows_of = functools.partial(utilisations, alone)
        judged = functools.partial(accepted, nothing=nothing_to_judge(alone))
        return _bare(without_absorber(Work(case)), fatigue(Work(alone)), rows_of, judged)
    steps = [step for step in STEPS if step.run.__name__ not in (*_ONLY_SHOWN, *_LEFT_TO_THE_REPORT)]
    work = Work(textbook_damper(case, MASS_RATIO) if device == "tuned" else case)
    for number, step in enumerate(steps):
        progress(device, number, len(steps))
        work = work.with_section(step.run(work))
    doubts = [*work.done.unverified, *(c.detail for c in work.done.checks if c.status in (FAIL, UNVERIFIED))]
    results = work.done.results
    return {
        "worst": results.get("worst_case"),
        "acceptance": accepted(judged_limits(work), not doubts, nothing_to_judge(work.case)),
        "unverified": doubts,
        "lock_in": results.get("lock_in"),
        "range": results.get("range"),
    }


def _bare(found: Any, damaged: Any, utilisations: Any, accepted: Any) -> dict[str, Any]:
    """The pipe without absorbers over the range of the case."""
    worst = found.results["without_absorber"].get("worst")
    rows = utilisations(worst, damaged.results.get("fatigue"))
    doubts = [*found.notes] if worst is None else [*worst["unverified"], *damaged.unverified]
    return {
        "worst": worst,
        "acceptance": accepted(rows, not doubts),
        "unverified": doubts,
        "lock_in": None,
        "range": None,
    }
