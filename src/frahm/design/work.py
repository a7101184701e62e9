"""One run of a design: what is asked for, what is known so far, and how a device is judged."""

from __future__ import annotations

import functools
import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.attractors import WorstCase, joined
from frahm.case import Case
from frahm.design.absorber import DesignedAbsorber, parameters_text, without_designed
from frahm.design.exact import ExcitedMode
from frahm.design.hardware import Hardware
from frahm.design.objective import Objective
from frahm.design.problem import Problem, governed
from frahm.design.robustness import Sensitivity, ToleranceBand
from frahm.design.settings import DesignSettings
from frahm.design.study import MarginPoint, Rival
from frahm.design.verification import Verification, climate_verification, verification
from frahm.systems import build_system

if TYPE_CHECKING:
    import xarray as xr

Progress = Callable[[str, int, int], None]
_STROKE_SLACK = 1.001  # a stroke that is beyond its limit by less keeps it


@dataclass(eq=False)
class Findings:
    """What is known so far: an interruption leaves it as it is."""

    best: Rival | None = None
    rivals: dict[str, Rival] = field(default_factory=dict)
    by_count: list[Rival] = field(default_factory=list)  # the best of every family and number of absorbers
    lasting: dict[str, xr.Dataset] = field(default_factory=dict)
    table: dict[str, tuple[float, ...]] = field(default_factory=dict)
    table_doubts: dict[str, tuple[tuple[str, ...], ...]] = field(default_factory=dict)
    trade_off: list[MarginPoint] = field(default_factory=list)
    with_margin: Verification | None = None
    hardware: Hardware | None = None
    tolerance: ToleranceBand | None = None
    sensitivities: tuple[Sensitivity, ...] = ()
    built: Verification | None = None
    built_margin: float = math.nan
    discarded: list[str] = field(default_factory=list)


class DesignWork:
    """What the steps of a design share; each leaves what it found in `found`."""

    def __init__(self, case: Case, settings: DesignSettings, progress: Progress | None):
        self.case, self.settings, self.progress = case, settings, progress
        self.found = Findings()
        self.problem = Problem.of(case, settings)
        self.objective = self.problem.objective
        self.limits = self.problem.limits
        self.done, self.total = 0, 0
        self.nominal: dict[DesignedAbsorber | str | None, tuple[WorstCase, ...]] = {}
        # modes by their number, None being the governing one
        self.worst_mode: dict[DesignedAbsorber, int | None] = {}
        self.sized_for: dict[DesignedAbsorber, int | None] = {}

    def step(self, title: str) -> None:
        """Tell what is begun, and the best so far."""
        if self.progress:
            best = self.found.best
            so_far = f"; best so far {best.value:#.3g} {self.objective.unit_text}".rstrip() if best else ""
            self.progress(title + so_far, min(self.done, self.total), self.total)
        self.done += 1

    @functools.cached_property
    def bare(self) -> Verification | None:
        """The pipe without the absorber to be designed; None where nothing bounds its resonance."""
        case = self.without_designed
        if np.any(np.linalg.eigvalsh(build_system(case).damping) > 0):
            return self.verify(case)
        self.found.discarded.append("none: without damping nothing bounds the resonance of the pipe: not compared.")
        return None

    @functools.cached_property
    def without_designed(self) -> Case:
        """The case without the absorbers to be designed; others stay."""
        return without_designed(self.case, self.settings.counts[-1])

    def case_of(self, rival: Rival) -> Case:
        """The case with a device of the comparison."""
        if rival.name == "none":
            return self.without_designed
        if rival.name == "case" or rival.design is None:
            return self.case
        return self.problem.case_with(rival.design)

    def verify(self, case: Case) -> Verification:
        """Value of the objective for a case, over all attractors."""
        if self.objective.over_climate:
            return climate_verification(
                case, self.problem.disturbances, self.objective, samples=self._climate_samples,
                seed=self.settings.seed, counted=[(governed(case, k), winds) for k, winds in self.problem.counted()],
            )  # fmt: skip
        return self.worst(self.problem.modes(case))

    @property
    def _climate_samples(self) -> int:
        """Initial states at every wind: those of the section `fatigue` if the samples of the design were left alone."""
        fatigue = self.case.fatigue
        if fatigue is not None and "samples" not in self.settings.model_fields_set:
            return fatigue.samples
        return self.settings.samples

    def worst(self, modes: Sequence[ExcitedMode], *, force: float = 1.0, samples: int | None = None) -> Verification:
        """The worst motion of a pipe in its modes; the peak counts where the objective is a mean over the climate."""
        problem = self.problem
        worst = self.objective if not self.objective.over_climate else Objective("peak", self.objective.quantile)
        return verification(
            modes, problem.disturbances, worst, force=force, seed=self.settings.seed,
            samples=self.settings.samples if samples is None else samples,
        )  # fmt: skip

    def mode_of_worst(self, checked: Verification | None) -> int | None:
        """Number of the mode in which the pipe moves most; None for the governing one."""
        governing = self.case.pipe.governing_mode
        mode = governing if not checked or not checked.mode else self.problem.others[checked.mode - 1][0]
        return None if mode == governing else mode

    def beyond(self, design: DesignedAbsorber, stroke: float) -> str:
        """Which limit the stroke [m] of all attractors, force margin included, breaks; empty if none."""
        limits = self.limits
        if stroke > limits.stroke * _STROKE_SLACK:
            return f"its stroke is {stroke:.4g} m, force margin included, beyond {limits.stroke:.4g} m"
        if limits.filling(self.problem.row(design)[None], np.array([stroke]))[0] > _STROKE_SLACK:
            return f"coil springs for its stroke of {stroke:.4g} m do not fit into their length"
        return ""

    def discard(self, rival: Rival, why: str) -> None:
        """Note why a device is not the chosen one."""
        d = rival.design
        if d is not None:
            self.found.discarded.append(
                f"{rival.name}: {parameters_text(d)} has a {self.objective.title} of {rival.value:.4g}"
                f" {self.objective.unit_text}over all attractors; {why}."
            )


def rival_of(
    name: str, design: DesignedAbsorber | None, checked: Verification, force_margin: float, count: int | None = None
) -> Rival:
    """A device as far as the search has come; the step `whole_comparison` adds what the comparison needs."""
    number = count if count is not None else (0 if design is None else design.count)
    nominal = joined([part.motion for part in checked.nominal]) if checked.nominal else checked.motion
    return Rival(
        name, design, checked.value, nominal, checked.motion, checked.disturbance, float(force_margin), count=number
    )


def in_threads(function: Callable[[Any], Any], items: Sequence[Any]) -> list[Any]:
    """The function of every item, in their order; a thread per core."""
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        try:
            return list(pool.map(function, items))
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)
            raise
