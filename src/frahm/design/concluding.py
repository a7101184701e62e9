"""What a run of a design comes to: a `DesignStudy` with its acceptance, decision, verdict and doubts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from frahm import __version__
from frahm.assessment import accepted, device_row, utilisations
from frahm.attractors import joined
from frahm.case import Case
from frahm.design.absorber import DesignedAbsorber
from frahm.design.study import NAMES, DesignStudy, Rival, first_of, headline
from frahm.design.verdict import verdict
from frahm.design.work import DesignWork


def concluded(work: DesignWork, interrupted: bool) -> DesignStudy:
    """The study of what was found; says so if it was interrupted."""
    found, best = work.found, work.found.best
    if best is None or best.design is None:
        raise RuntimeError("no design")
    rivals = tuple(found.rivals[name] for name in NAMES if name in found.rivals)
    name = f"{work.case.name}-{best.name.replace(' ', '-')}"[:60]
    first = first_of(rivals)
    title = f"Designed for {work.case.name}. {headline(best, first, work.objective)}"[:200]
    return DesignStudy(
        case=work.case,
        settings=work.settings,
        best=best,
        best_case=_best_case(work, best.design).with_name(name, title),
        acceptance=_acceptance(work, best),
        decision=_decision(work, rivals),
        lasting={rival.name: found.lasting[rival.name] for rival in rivals if rival.name in found.lasting},
        comparison=rivals,
        by_count=tuple(found.by_count),
        errors=work.settings.errors,
        error_table=found.table,
        error_verified={name: tuple(not cell for cell in row) for name, row in found.table_doubts.items()},
        trade_off=tuple(found.trade_off),
        with_margin=found.with_margin.pipe_peak if found.with_margin else math.nan,
        hardware=found.hardware,
        tolerance=found.tolerance,
        sensitivities=found.sensitivities,
        as_built=found.built.pipe_peak if found.built else math.nan,
        as_built_margin=found.built_margin,
        screened=work.problem.screened,
        discarded=tuple(dict.fromkeys(found.discarded)),
        verdict="Interrupted before the devices could be compared."
        if interrupted
        else verdict(rivals, work.settings.errors, found.table, work.settings.scatter, work.objective),
        unverified=_doubts(work, rivals, interrupted),
        interrupted=interrupted,
        version=__version__,
    )


def _doubts(work: DesignWork, rivals: Sequence[Rival], interrupted: bool) -> tuple[str, ...]:
    """What speaks against the numbers of the study, each sentence once."""
    found = work.found
    doubts = [f"{rival.name}: {sentence}" for rival in rivals for sentence in rival.unverified]
    if found.with_margin is not None:
        doubts += [f"With the margin on the force: {sentence}" for sentence in found.with_margin.unverified]
    if found.built is not None:
        doubts += [f"With the exact force of transverse springs: {sentence}" for sentence in found.built.unverified]
    doubts += [
        f"Table of frequency errors: {name} at {100 * (error - 1):+.3g} % is unverified: {cell[0]}"
        for name, row in found.table_doubts.items()
        for error, cell in zip(work.settings.errors, row, strict=True)
        if cell and not any(cell[0] in doubt for doubt in doubts)
    ]
    if interrupted:
        doubts.append("Interrupted: the comparison is not complete.")
    return tuple(dict.fromkeys(doubts))


def _acceptance(work: DesignWork, best: Rival) -> dict[str, Any]:
    """The best device held against the limits, over everything that scatters."""
    worst = joined([best.worst, best.scattered])
    found = accepted(utilisations(work.case_of(best), worst.row(), best.fatigue), best.verified)
    if work.settings.scatter.names and found["rows"]:
        found["sentence"] += " The worst over the scatter asked for is what was judged."
    return found


def _decision(work: DesignWork, rivals: Sequence[Rival]) -> dict[str, Any]:
    """Every device in one table, as `frahm run` has it."""
    rows = []
    for rival in rivals:
        case = work.case_of(rival)
        rows.append(device_row(rival.name, case, rival.worst.row(), rival.fatigue, rival.unverified))
    over = "wind" if work.problem.within.over_wind else "detuning"
    return {"over": over, "range": work.problem.within.text, "rows": rows, "remarks": {}}


def _best_case(work: DesignWork, design: DesignedAbsorber) -> Case:
    """The case with a design, asked about the same range with the same states, so that a run of it agrees."""
    asked: dict[str, Any] = {"samples": work.settings.samples, "seed": work.settings.seed}
    if work.settings.wind is not None:
        asked |= {"wind": work.settings.wind, "detuning": None}
    case = work.problem.case_with(design)
    same = all(getattr(case.analysis, key) == value for key, value in asked.items())
    return case if same else case.with_analysis(**asked)
