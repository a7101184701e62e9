"""The best verified design of a family: finalists of the closed form, held against all attractors."""

from __future__ import annotations

import math
from dataclasses import replace

from frahm.case import FAMILIES
from frahm.design.absorber import DesignedAbsorber
from frahm.design.families import DEVICES, MIXED, devices
from frahm.design.finalists import Finalist, finalists
from frahm.design.search import DesignLimits
from frahm.design.study import Rival
from frahm.design.verification import Verification
from frahm.design.work import DesignWork, rival_of
from frahm.errors import ParameterError
from frahm.tolerances import NO_BETTER

_MOST_FINALISTS = 4
_WORSE, _WORSE_MEAN = 1.25, 2.0  # verified over expected value from where on a finalist is worse than it looked
_ATTEMPTS = 3  # searches of a family whose finalists all fail
_ALIKE = 0.01  # relative difference of all parameters below which two finalists are one
_JUMP = 1.1  # a design whose peak grows by more than this beside the force has met a detached curve
_MARGIN_SAMPLES = 40  # most initial states at every frequency with the margin on the force


def best_of_family(work: DesignWork, family: str) -> Rival | None:
    """Best verified design of a family: of the numbers of absorbers asked for, the one that does best.

    Where two do as well, the smaller one.
    """
    best: Rival | None = None
    for count in work.settings.counts:
        found = _best_of_count(work, family, count)
        if found is None:
            continue
        work.found.by_count.append(found)
        better = best is None or (found.verified, -found.value) > (best.verified, -NO_BETTER * best.value)
        best = found if better else best
    return best


def _best_of_count(work: DesignWork, family: str, count: int) -> Rival | None:
    """Best verified design of so many absorbers: finalists in the order of what is expected of them."""
    work.step(f"search: {devices(family, count)}")
    best, mode, tried = _cornered(work, family, count), work.mode_of_worst(work.bare), set[int | None]()
    # where the pipe then moves most in another mode, a device that suits that one may do better
    while mode not in tried:
        tried.add(mode)
        best = _searched(work, family, best, count, mode)
        mode = None if best is None or best.design is None else work.worst_mode.get(best.design)
    if best is not None and best.design is not None and count == 1:
        work.problem.singles.setdefault(family, []).append(best.design)
    return best


def _searched(
    work: DesignWork, family: str, best: Rival | None, count: int, sized_for: int | None = None
) -> Rival | None:
    """Best verified design of a family among those sized for a mode, and what was best before."""
    corner = best
    for attempt in range(_ATTEMPTS):
        waiting, discarded = family_finalists(work, family, work.limits, count, attempt > 0, sized_for)
        work.found.discarded += discarded
        best, failed = _tried(work, family, _apart(waiting)[:_MOST_FINALISTS], best, sized_for)
        if not failed and (attempt > 0 or best is not corner):
            break
        # the closed form does not see what is wrong with these: what is best elsewhere is looked for
        for design in failed:
            work.problem.avoid(family, design, sized_for)
    return best


def _tried(
    work: DesignWork, family: str, waiting: list[Finalist], best: Rival | None, sized_for: int | None
) -> tuple[Rival | None, list[DesignedAbsorber]]:
    """Best of the finalists by all attractors, and those that are worse than they looked or unverified."""
    failed: list[DesignedAbsorber] = []
    for finalist in waiting:
        if best is not None and best.verified and finalist.predicted >= best.value:
            continue
        checked = work.verify(work.problem.case_with(finalist.design))
        rival = rival_of(DEVICES[family], finalist.design, checked, finalist.force_margin)
        work.nominal[finalist.design] = checked.nominal
        work.worst_mode[finalist.design] = work.mode_of_worst(checked)
        work.sized_for[finalist.design] = sized_for
        more = _with_margin(work, rival)
        reason = _unfit(work, finalist.design, checked, more)
        worse = _WORSE_MEAN if work.objective.over_climate else _WORSE
        if reason or not rival.verified or checked.value > worse * finalist.predicted:
            failed.append(finalist.design)
        if reason:
            work.discard(rival, reason)
            continue
        if best is None or (rival.verified, -rival.value) > (best.verified, -best.value):
            if best is not None and not best.verified:
                work.discard(best, _unverified(best))
            best = rival
            if family == work.settings.family:
                work.found.with_margin = more
        else:
            work.discard(rival, _why_not(rival, best))
    return best, failed


def _why_not(rival: Rival, best: Rival) -> str:
    """Why a design is not the chosen one, as the end of a sentence."""
    return "it is not better" if rival.verified or rival.value >= best.value else _unverified(rival)


def _unverified(rival: Rival) -> str:
    return f"unverified: {' '.join(rival.unverified[:1]).rstrip('.')}"


def _unfit(work: DesignWork, design: DesignedAbsorber, checked: Verification, more: Verification | None) -> str:
    """Why a design is out of the question, by its motions without and with the margin on the force; empty if not."""
    margin = work.settings.force_margin
    reason = work.beyond(design, max(checked.relative_peak, more.relative_peak if more else 0.0))
    if not reason and more is not None and more.pipe_peak > _JUMP * margin * checked.pipe_peak:
        return f"with {margin:g} times the force it is {more.pipe_peak:.4g} m"
    return reason


def _with_margin(work: DesignWork, rival: Rival) -> Verification | None:
    """Worst case with the margin on the force; None where there is none, or no nonlinear spring."""
    if rival.design is None or not rival.design.nonlinear or work.settings.force_margin == 1:
        return None
    samples = min(_MARGIN_SAMPLES, work.settings.samples)
    return work.worst(work.problem.modes_of(rival.design), force=work.settings.force_margin, samples=samples)


def _cornered(work: DesignWork, family: str, count: int) -> Rival | None:
    """For the mixture, the better of its corners: the optimum over the family is never worse than either."""
    corners = [
        one for one in work.found.by_count if one.design and one.design.count == count and one.name != DEVICES[MIXED]
    ]
    if work.settings.family == MIXED:
        corners = [rival for rival in corners if rival.design and work.problem.admits(rival.design)]
    if family != MIXED or not corners:
        return None
    corner = min(corners, key=lambda rival: (not rival.verified, rival.value))
    return replace(corner, name=DEVICES[MIXED])


def family_finalists(
    work: DesignWork, family: str, limits: DesignLimits, count: int, wary: bool = False, sized_for: int | None = None
) -> tuple[list[Finalist], list[str]]:
    """Finalists of a family under limits, and why others were discarded."""
    problem = work.problem
    tier = problem.tier(family, limits.force_margin, sized_for, count)
    kept, discarded = finalists(tier, problem.modes_of, problem.disturbances, limits, wary)
    return kept, [f"{DEVICES[family]}: {reason}" for reason in discarded]


def _apart(waiting: list[Finalist]) -> list[Finalist]:
    """Finalists in their order, without those that hardly differ from an earlier one."""
    chosen: list[Finalist] = []
    for finalist in waiting:
        if not any(_alike(finalist.design, other.design) for other in chosen):
            chosen.append(finalist)
    return chosen


def _alike(one: DesignedAbsorber, other: DesignedAbsorber) -> bool:
    """Whether two designs hardly differ, in whatever order their absorbers are."""
    here, there = sorted(a.row for a in one.absorbers), sorted(a.row for a in other.absorbers)
    pairs = [pair for ours, theirs in zip(here, there, strict=True) for pair in zip(ours, theirs, strict=True)]
    return all(math.isclose(ours, theirs, rel_tol=_ALIKE) for ours, theirs in pairs)


def none_keeps(work: DesignWork, family: str) -> ParameterError:
    """The refusal if no design of a family keeps the limits: what binds, and which other family has one."""
    reasons = "".join(f" {reason}" for reason in work.found.discarded[-1:])
    hint = f"No design keeps them; what binds: {_binding(work, family)}.{reasons}"
    for other in FAMILIES:
        name = DEVICES[other]
        rival = None if other in (family, MIXED) else work.found.rivals.get(name) or best_of_family(work, other)
        if rival is not None and rival.verified:
            hint += f" The best {name} keeps them, with a {work.objective.title} of"
            hint += f" {work.objective.shown(rival.value)}: --family {other}."
    return ParameterError("limits", _limits_text(work), "limits that a design can keep", hint=hint)


def _limits_text(work: DesignWork) -> str:
    parts = [f"force margin {work.settings.force_margin:g}"]
    if math.isfinite(work.limits.stroke):
        parts.append(f"stroke {work.limits.stroke:g} m")
    if work.limits.stress is not None:
        parts.append(f"spring stress {work.limits.stress:g} Pa")
    return ", ".join(parts)


def _binding(work: DesignWork, family: str) -> str:
    tiers = [work.problem.tier(family, count=count) for count in work.settings.counts]
    return tiers[0].binding(work.limits)
