"""`analyse`: one case through every step, as one frozen result that can be stored and read back."""

from __future__ import annotations

import importlib.metadata
import math
import platform
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import __version__, readable
from frahm.analysis.acceptance import acceptance, judged_limits
from frahm.analysis.cross_check import cross_check
from frahm.analysis.decision import decision
from frahm.analysis.fatigue import fatigue
from frahm.analysis.gusts import gusts
from frahm.analysis.largest import largest_motion
from frahm.analysis.linear import without_absorber
from frahm.analysis.long_term import attractors, worst
from frahm.analysis.manifold import manifold
from frahm.analysis.margin import detached_curve_margin
from frahm.analysis.modes import modes
from frahm.analysis.modulated import basins, modulated
from frahm.analysis.motions import SAMPLES_PER_PERIOD, motions
from frahm.analysis.over_wind import over_wind
from frahm.analysis.response import exact_response, slow_flow_response
from frahm.analysis.section import FAIL, UNVERIFIED, Check, Section, Work
from frahm.analysis.settling import PERIODIC_BELOW
from frahm.analysis.verdict import lock_in, verdict
from frahm.analysis.wind import wind
from frahm.assessment import accepted, nothing_to_judge
from frahm.case import Case, field_values, load_case
from frahm.harmonic_balance.search import GOAL
from frahm.time_integration.batch import TOLERANCE

if TYPE_CHECKING:
    import xarray as xr

SCHEMA = "frahm-summary-1"
Progress = Callable[[str, int, int], None]


@dataclass(frozen=True)
class Step:
    """One step of the analysis: what it is called for people, the function that does it, and its share of the work.

    The share is roughly that of a case with a cubic sink; the time a run takes is judged by it.
    """

    title: str
    run: Callable[[Work], Section]
    weight: float = 0.1


# In this order; a step reads what the steps before it found. A further analysis is one more line here.
STEPS = (
    Step("pipe without absorbers", without_absorber),
    Step("exact response by harmonic balance", exact_response, 1.0),
    Step("modes of the pipe", modes),
    Step("slow flow", slow_flow_response),
    Step("similarity numbers and onset criteria", wind),
    Step("response over the wind speed", over_wind),
    Step("motion in unsteady wind", gusts, 0.5),
    Step("births and merges of detached curves", detached_curve_margin, 3.0),
    Step("slow manifold", manifold),
    Step("modulated responses of the slow flow", modulated, 6.0),
    Step("attractors at the design wind", attractors),
    Step("motions of the exact equations", motions, 0.5),
    Step("slow flow against harmonic balance against integration", cross_check, 0.5),
    Step("worst case over the range of operation", worst, 16.0),
    Step("basins where several motions last", basins, 2.0),
    Step("fatigue over the wind climate", fatigue, 30.0),
    Step("largest motion", largest_motion),
    Step("lock-in", lock_in),
    Step("acceptance", acceptance),
    Step("devices compared", decision),
)


@dataclass(frozen=True, eq=False)
class CaseAnalysis:
    """What is known about a case.

    Attributes
    ----------
    case : Case
        What was analysed.
    results : dict
        Numbers, by step; plain data, SI units.
    data : dict of Dataset
        Arrays, by step; every variable has units and a long name.
    checks : tuple of Check
        What was tested, with status "pass", "fail" or "unverified".
    unverified : tuple of str
        Sentences on what could not be vouched for.
    notes : tuple of str
        Sentences on the limits of what was done.
    interrupted : bool
        Whether steps are missing because the work was stopped.
    version : str
        Version of the package that made it.
    """

    __repr__ = readable.summary

    case: Case
    results: dict[str, Any]
    data: dict[str, xr.Dataset] = field(default_factory=dict)
    checks: tuple[Check, ...] = ()
    unverified: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    interrupted: bool = False
    version: str = __version__

    @property
    def verdict(self) -> str:
        """What the results come to, in a few sentences."""
        return str(self.results["verdict"])

    @property
    def verified(self) -> bool:
        """Whether every check passed and nothing is unverified."""
        return not self.unverified and all(check.status == "pass" for check in self.checks)

    @property
    def accepted(self) -> bool:
        """Whether no limit of the case is exceeded; where nothing was judged, none is."""
        return bool(self.results.get("acceptance", {}).get("verdict") != "fail")

    def summary(self) -> dict[str, Any]:
        """Everything but the arrays, as plain data for strict JSON; numbers that are not finite become None."""
        notes = {"notes": list(self.notes), "interrupted": self.interrupted}
        return {
            "schema": SCHEMA,
            "frahm": self.version,
            "case": self.case.to_dict(),
            "results": plain({**self.results, **notes}),
            "checks": [{"name": c.name, "status": c.status, "detail": c.detail} for c in self.checks],
            "unverified": list(self.unverified),
        }


def step_weights(case: Case) -> list[float]:
    """Share of every step in the work on a case; steps that have nothing to do there have next to none."""
    idle: list[Callable[[Work], Section]] = []
    idle += [] if case.absorbers else [detached_curve_margin, modulated, worst, basins]
    idle += [] if case.fatigue else [fatigue]
    idle += [] if case.wind.record or case.wind.turbulence else [gusts]
    return [0.01 if step.run in idle else step.weight for step in STEPS]


def analyse(case: Any, *, progress: Progress | None = None) -> CaseAnalysis:
    """Analyse a case: responses, slow manifold, motions of the exact equations, checks.

    Parameters
    ----------
    case : Case, str, Path or dict
        A case, or whatever `frahm.load_case` reads.
    progress : callable, optional
        Called with the title of a step, its number from 0 and the number of steps, before each step and at the end.

    Returns
    -------
    CaseAnalysis
        If the work is interrupted from the keyboard: of the steps that were finished, with `interrupted` set.

    Raises
    ------
    ParameterError
        If the case cannot be read.
    """
    work = Work(load_case(case))
    interrupted = False
    for number, step in enumerate(STEPS):
        try:
            if progress:
                progress(step.title, number, len(STEPS))
            work = work.with_section(step.run(work))
        except KeyboardInterrupt:
            missing = ", ".join(left.title for left in STEPS[number:])
            work = work.with_section(Section(unverified=(f"Interrupted before these were finished: {missing}.",)))
            interrupted = True
            break
    if progress and not interrupted:
        progress("done", len(STEPS), len(STEPS))
    return _concluded(work, interrupted)


def _concluded(work: Work, interrupted: bool) -> CaseAnalysis:
    done = work.done
    results = {"has_absorber": bool(work.case.absorbers), **done.results}
    failed = sum(check.status == FAIL for check in done.checks)
    doubts = len(done.unverified) + sum(check.status == UNVERIFIED for check in done.checks)
    results["acceptance"] = accepted(
        judged_limits(work), not failed and not doubts and not interrupted, nothing_to_judge(work.case)
    )
    results["verdict"] = verdict(results, failed, doubts)
    results["provenance"] = provenance(work.case)
    return CaseAnalysis(
        case=work.case,
        results=results,
        data=done.data,
        checks=done.checks,
        unverified=done.unverified,
        notes=done.notes,
        interrupted=interrupted,
    )


def provenance(case: Case) -> dict[str, Any]:
    """Digest of a case, its defaulted fields, what was typed with a unit of its own, versions and tolerances."""
    packages = ("numpy", "scipy", "numba", "xarray")
    return {
        "digest": case.digest,
        "defaulted": defaulted_fields(case),
        "typed": dict(case.typed),
        "versions": {
            "python": platform.python_version(),
            **{name: importlib.metadata.version(name) for name in packages},
        },
        "settings": {
            "slow_flow_form": case.analysis.form,
            "harmonic_balance_residual": GOAL,
            "integration_tolerance": TOLERANCE,
            "integration_periods": case.analysis.periods,
            "samples_per_period": SAMPLES_PER_PERIOD,
            "periodic_below": PERIODIC_BELOW,
        },
    }


def defaulted_fields(case: Case) -> list[str]:
    """Paths of the fields that were left out and took their default."""
    return [field.path for field in field_values(case) if not field.given and field.path not in ("name", "title")]


def plain(value: Any) -> Any:
    """`value` as dictionaries, lists, text, bool, int, float and None only; a number that is not finite is None."""
    if isinstance(value, dict):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry) for entry in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
