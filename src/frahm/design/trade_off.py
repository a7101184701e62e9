"""The step that designs again under other force margins."""

from __future__ import annotations

from dataclasses import replace

from frahm.design.families import DEVICES
from frahm.design.family_search import family_finalists
from frahm.design.study import MarginPoint, Rival
from frahm.design.work import DesignWork, in_threads, rival_of


def trade_off(work: DesignWork) -> None:
    """The best design under other force margins."""
    family = work.settings.family
    if family == "tuned":
        return
    best = work.found.best
    if best is None or best.design is None:
        return
    work.step("force margins")
    sized_for = work.sized_for.get(best.design)
    count = best.design.count
    work.problem.tier(family, count=count)  # finds its place once

    def candidate(margin: float) -> tuple[Rival | None, list[str]]:
        limits = replace(work.limits, force_margin=margin)
        kept, discarded = family_finalists(work, family, limits, count, sized_for=sized_for)
        if not kept:
            return None, discarded
        design = kept[0].design
        checked = work.verify(work.problem.case_with(design))
        reason = work.beyond(design, checked.relative_peak)
        if reason:
            return None, [*discarded, f"With a force margin of {margin:g}: {reason}."]
        return rival_of(DEVICES[family], design, checked, margin), discarded

    # what is best with a margin and keeps more of it is best with more
    asked = work.settings.force_margin
    best = replace(best, force_margin=max(best.force_margin, asked))
    others = [margin for margin in work.settings.margins if not asked <= margin <= best.force_margin]
    candidates = [best]
    for found, discarded in in_threads(candidate, others):
        work.found.discarded += discarded
        candidates += [] if found is None else [found]
    for margin in work.settings.margins:
        keeping = [one for one in candidates if one.force_margin >= margin]
        if keeping:
            least = min(keeping, key=lambda one: (not one.verified, one.value))
            work.found.trade_off.append(_margin_point(margin, least))


def _margin_point(margin: float, rival: Rival) -> MarginPoint:
    design = rival.design
    if design is None:
        raise RuntimeError("a force margin of no device")
    return MarginPoint(margin, design, rival.value, rival.worst_pipe_peak, rival.verified, rival.tier)
