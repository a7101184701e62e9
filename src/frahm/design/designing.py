"""`design_absorber`: screening, exact responses, attractors; then the comparison nobody may skip."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from frahm.case import FAMILIES, Case, Design, load_case
from frahm.design.comparison import no_absorber, own_absorber, whole_comparison
from frahm.design.concluding import concluded
from frahm.design.error_table import error_table
from frahm.design.families import in_order
from frahm.design.family_search import best_of_family, none_keeps
from frahm.design.making import made
from frahm.design.problem import Problem
from frahm.design.settings import settings_for
from frahm.design.study import DesignStudy, Rival
from frahm.design.trade_off import trade_off
from frahm.design.work import DesignWork, Progress

if TYPE_CHECKING:
    from collections.abc import Mapping


def best_of_families(work: DesignWork) -> None:
    """The best design of the family asked for and, as its rivals, of the others.

    Raises
    ------
    ParameterError
        If no design of the family asked for keeps the limits.
    """
    for family in in_order(work.settings.family):
        rival = best_of_family(work, family)
        if family == work.settings.family:
            if rival is None:
                raise none_keeps(work, family)
            work.found.best = rival
        if rival is not None:
            work.found.rivals[rival.name] = rival


# In this order; a step reads what the steps before it found, and tells what it begins.
STEPS: tuple[Callable[[DesignWork], None], ...] = (
    best_of_families,
    no_absorber,
    own_absorber,
    whole_comparison,
    made,
    error_table,
    trade_off,
)


def design_absorber(
    case: Case | str | os.PathLike[str] | Mapping[str, Any],
    mass_ratio: float | tuple[float, float] | None = None,
    *,
    settings: Design | None = None,
    progress: Progress | None = None,
    **changes: Any,
) -> DesignStudy:
    """Best absorber of a family for a case, verified over all attractors and compared with its rivals.

    What is asked for stands in the section `design` of the case; `settings` and `changes` take its place. Three tiers:
    every one-harmonic response of many designs in closed form; exact harmonic balance with stability and births of
    detached curves of the best; all attractors from sampled states of the finalists. The values promised are those of
    the last tier.

    Parameters
    ----------
    case : Case, str, Path or dict
        A pipe in the wind; its first absorber, if it has one, is replaced. The window of the detuning counts.
    mass_ratio : float or tuple of float, optional
        Mass of the absorber over that of the pipe [-], or a range of it; by default that of the case's absorber, or
        0.02.
    settings : DesignSettings, optional
        Everything else, in place of the section `design` of the case; `changes` name single settings, such as
        ``family="mixed"``, ``objective="rms"`` or ``scatter=0.1``.
    progress : callable, optional
        Called with what is done, steps done and steps in all.

    Returns
    -------
    DesignStudy
        If interrupted once a design is known: what was found, with `interrupted` set.

    Raises
    ------
    ParameterError
        For bad input, or if no design keeps the limits: the one that binds is named.
    """
    case = load_case(case)
    asked = settings_for(case, mass_ratio, settings, changes)
    work = DesignWork(case, asked, progress)
    interrupted = False
    try:
        _run(work)
    except KeyboardInterrupt:
        if work.found.best is None:
            raise
        interrupted = True
    return concluded(work, interrupted)


def _run(work: DesignWork) -> None:
    work.total = len(FAMILIES) * len(work.settings.counts) + 5 + 5
    for step in STEPS:
        step(work)


def check_design(case: Case, mass_ratio: float | tuple[float, float] | None = None, **changes: Any) -> None:
    """Refuse what `design_absorber` would refuse before it searches.

    Raises
    ------
    ParameterError
        For bad input, or a case that lacks what the objective needs.
    """
    problem = Problem.of(case, settings_for(case, mass_ratio, changes=changes))
    problem.check_host()


def verified_designs(
    case: Case | str | os.PathLike[str] | Mapping[str, Any],
    settings: Design,
    families: Sequence[str] = FAMILIES,
    progress: Progress | None = None,
) -> tuple[Rival, ...]:
    """Best verified design of every family under the settings, without the comparison of `design_absorber`.

    A family of which no design keeps the limits is left out.
    """
    case = load_case(case)
    work = DesignWork(case, settings_for(case, settings=settings), progress)
    for family in families:
        rival = best_of_family(work, family)
        if rival is not None:
            work.found.rivals[rival.name] = rival
    return tuple(work.found.rivals.values())
