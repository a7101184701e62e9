"""Step `acceptance`: the worst motion and the damage against the limits of the case."""

from __future__ import annotations

import math

from frahm.analysis.section import Section, Work
from frahm.assessment import Utilisation, utilisations


def acceptance(work: Work) -> Section:
    """What the case gives limits for and lacks the data of; the verdict itself waits until everything is done."""
    if work.done.results.get("worst_case") is None:
        return Section()  # that it was not found is said by the step that looked for it
    missing = [row for row in judged_limits(work) if math.isnan(row.ratio)]
    return Section(unverified=tuple(f"{row.text} cannot be judged: the case does not say enough." for row in missing))


def judged_limits(work: Work) -> list[Utilisation]:
    """Utilisation of every limit of the case; damage counts wherever a case has the section fatigue."""
    results = work.done.results
    return utilisations(work.case, results.get("worst_case"), results.get("fatigue"))
