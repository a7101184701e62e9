"""`design_absorber`: screening, exact responses, attractors; then the comparison nobody may skip."""

from __future__ import annotations

import functools
import math
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import __version__
from frahm.assessment import accepted, device_row, utilisations
from frahm.attractors import WorstCase, WorstMotion, joined
from frahm.case import FAMILIES, Case, Design, load_case
from frahm.design.absorber import DesignedAbsorber, absorber_of, parameters_text, with_design, without_first
from frahm.design.completing import fatigue_row, worst_motion
from frahm.design.disturbance import Disturbance
from frahm.design.exact import ExcitedMode, conditions_of, exact_birth
from frahm.design.finalists import FAR, Finalist, finalists
from frahm.design.hardware import Hardware, as_built, hardware
from frahm.design.objective import Objective
from frahm.design.problem import Problem, governed
from frahm.design.robustness import Sensitivity, ToleranceBand, sensitivities, tolerance_band
from frahm.design.search import Limits
from frahm.design.settings import DesignSettings, settings_for
from frahm.design.study import DesignStudy, MarginPoint, Rival, first_of, headline
from frahm.design.verdict import verdict
from frahm.design.verification import Verification, climate_verification, verification
from frahm.errors import ParameterError
from frahm.systems import build_system

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

Progress = Callable[[str, int, int], None]
_MOST_FINALISTS = 4
_WORSE, _WORSE_MEAN = 1.25, 2.0  # verified over expected value from where on a finalist is worse than it looked
_STROKE_SLACK = 1.001
_ATTEMPTS = 3  # searches of a family whose finalists all fail
_ALIKE = 0.01  # relative difference of all parameters below which two finalists are one
_JUMP = 1.1  # a design whose peak grows by more than this beside the force has met a detached curve
_MARGIN_SAMPLES = 40
_TABLE_SAMPLES = 16
_DEVICES = {"sink": "sink", "tuned": "tuned mass damper", "mixed": "mixed"}


@dataclass(eq=False)
class _Found:
    """What is known so far: an interruption leaves it as it is."""

    best: Rival | None = None
    rivals: dict[str, Rival] = field(default_factory=dict)
    lasting: dict[str, xr.Dataset] = field(default_factory=dict)
    table: dict[str, tuple[float, ...]] = field(default_factory=dict)
    sure: dict[str, tuple[bool, ...]] = field(default_factory=dict)
    trade_off: list[MarginPoint] = field(default_factory=list)
    with_margin: Verification | None = None
    hardware: Hardware | None = None
    tolerance: ToleranceBand | None = None
    sensitivities: tuple[Sensitivity, ...] = ()
    built: Verification | None = None
    built_margin: float = math.nan
    discarded: list[str] = field(default_factory=list)


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
    work = _Designing(case, asked, progress)
    interrupted = False
    try:
        work.run()
    except KeyboardInterrupt:
        if work.found.best is None:
            raise
        interrupted = True
    return work.study(interrupted)


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
    work = _Designing(case, settings_for(case, settings=settings), progress)
    for family in families:
        rival = work.designed(family)
        if rival is not None:
            work.found.rivals[rival.name] = rival
    return tuple(work.found.rivals.values())


class _Designing:
    """One run through all steps."""

    def __init__(self, case: Case, settings: DesignSettings, progress: Progress | None):
        self.case, self.settings, self.progress = case, settings, progress
        self.found = _Found()
        self.problem = Problem.of(case, settings)
        self.objective = self.problem.objective
        self.limits = self.problem.limits
        self.done, self.total = 0, 0
        self.nominal: dict[DesignedAbsorber | str | None, tuple[WorstCase, ...]] = {}
        # modes by their number, None being the governing one
        self.worst_mode: dict[DesignedAbsorber, int | None] = {}
        self.sized_for: dict[DesignedAbsorber, int | None] = {}

    def run(self) -> None:
        # the mixture is held against its corners, so they come first
        families = ["sink", "tuned", "mixed"]
        if self.settings.family == "tuned":
            families = ["tuned", "sink", "mixed"]
        self.total = len(families) + 5 + 5
        for family in families:
            rival = self.designed(family)
            if family == self.settings.family:
                if rival is None:
                    raise self._none_keeps(family)
                self.found.best = rival
            if rival is not None:
                self.found.rivals[rival.name] = rival
        self._others()
        self._whole()
        self._made()
        self._error_table()
        self._trade_off()

    def _step(self, title: str) -> None:
        if self.progress:
            best = self.found.best
            so_far = f"; best so far {best.value:#.3g} {self.objective.unit_text}".rstrip() if best else ""
            self.progress(title + so_far, min(self.done, self.total), self.total)
        self.done += 1

    def _binding(self, family: str) -> str:
        return self.problem.tier(family).binding(self.limits)

    def _none_keeps(self, family: str) -> ParameterError:
        """The refusal if no design of a family keeps the limits: what binds, and which other family has one."""
        reasons = "".join(f" {reason}" for reason in self.found.discarded[-1:])
        hint = f"No design keeps them; what binds: {self._binding(family)}.{reasons}"
        for other in FAMILIES:
            name = _DEVICES[other]
            rival = None if other in (family, "mixed") else self.found.rivals.get(name) or self.designed(other)
            if rival is not None and rival.verified:
                hint += f" The best {name} keeps them, with a {self.objective.title} of"
                hint += f" {self.objective.shown(rival.value)}: --family {other}."
        return ParameterError("limits", self._limits_text(), "limits that a design can keep", hint=hint)

    def _limits_text(self) -> str:
        parts = [f"force margin {self.settings.force_margin:g}"]
        if math.isfinite(self.limits.stroke):
            parts.append(f"stroke {self.limits.stroke:g} m")
        if self.limits.stress is not None:
            parts.append(f"spring stress {self.limits.stress:g} Pa")
        return ", ".join(parts)

    def _finalists(
        self, family: str, limits: Limits, wary: bool = False, sized_for: int | None = None
    ) -> tuple[list[Finalist], list[str]]:
        """Finalists of a family under limits, and why others were discarded."""
        problem = self.problem
        tier = problem.tier(family, limits.force_margin, sized_for)
        kept, discarded = finalists(tier, problem.modes_of, problem.disturbances, limits, wary)
        return kept, [f"{_DEVICES[family]}: {reason}" for reason in discarded]

    def designed(self, family: str) -> Rival | None:
        """Best verified design of a family: finalists in the order of what is expected of them."""
        self._step(f"search: {_DEVICES[family]}")
        best, mode, tried = self._cornered(family), self._worst_mode(self.bare), set[int | None]()
        # where the pipe then moves most in another mode, a device that suits that one may do better
        while mode not in tried:
            tried.add(mode)
            best = self._searched(family, best, mode)
            mode = None if best is None or best.design is None else self.worst_mode.get(best.design)
        return best

    def _searched(self, family: str, best: Rival | None, sized_for: int | None = None) -> Rival | None:
        """Best verified design of a family among those sized for a mode, and what was best before."""
        corner = best
        for attempt in range(_ATTEMPTS):
            waiting, discarded = self._finalists(family, self.limits, attempt > 0, sized_for)
            self.found.discarded += discarded
            best, failed = self._tried(family, _apart(waiting)[:_MOST_FINALISTS], best, sized_for)
            if not failed and (attempt > 0 or best is not corner):
                break
            # the closed form does not see what is wrong with these: what is best elsewhere is looked for
            for design in failed:
                self.problem.avoid(family, design, sized_for)
        return best

    def _tried(
        self, family: str, waiting: list[Finalist], best: Rival | None, sized_for: int | None
    ) -> tuple[Rival | None, list[DesignedAbsorber]]:
        """Best of the finalists by all attractors, and those that are worse than they looked or unverified."""
        failed: list[DesignedAbsorber] = []
        for finalist in waiting:
            if best is not None and best.verified and finalist.predicted >= best.value:
                continue
            checked = self._verify(with_design(self.case, finalist.design))
            rival = _rival(_DEVICES[family], finalist.design, checked, finalist.force_margin)
            self.nominal[finalist.design] = checked.nominal
            self.worst_mode[finalist.design] = self._worst_mode(checked)
            self.sized_for[finalist.design] = sized_for
            more = self._with_margin(rival)
            reason = self._beyond(rival.design, max(checked.relative_peak, more.relative_peak if more else 0.0))
            if reason:
                self._discard(rival, reason)
                failed.append(finalist.design)
                continue
            if more is not None and more.pipe_peak > _JUMP * self.settings.force_margin * checked.pipe_peak:
                self._discard(
                    rival, f"with {self.settings.force_margin:g} times the force it is {more.pipe_peak:.4g} m"
                )
                failed.append(finalist.design)
                continue
            worse = _WORSE_MEAN if self.objective.over_climate else _WORSE
            if not rival.verified or checked.value > worse * finalist.predicted:
                failed.append(finalist.design)
            if best is None or (rival.verified, -rival.value) > (best.verified, -best.value):
                if best is not None and not best.verified:
                    self._discard(best, f"unverified: {' '.join(best.unverified[:1])}")
                best = rival
                if family == self.settings.family:
                    self.found.with_margin = more
            else:
                self._discard(rival, "it is not better")
        return best, failed

    @functools.cached_property
    def bare(self) -> Verification | None:
        """The pipe without the absorber to be designed; None where nothing bounds its resonance."""
        case = without_first(self.case)
        if np.any(np.linalg.eigvalsh(build_system(case).damping) > 0):
            return self._verify(case)
        self.found.discarded.append("none: without damping nothing bounds the resonance of the pipe: not compared.")
        return None

    def _worst_mode(self, checked: Verification | None) -> int | None:
        """Number of the mode in which the pipe moves most; None for the governing one."""
        governing = self.case.pipe.governing_mode
        mode = governing if not checked or not checked.mode else self.problem.others[checked.mode - 1][0]
        return None if mode == governing else mode

    def _cornered(self, family: str) -> Rival | None:
        """For the mixture, the better of its corners: the optimum over the family is never worse than either."""
        corners = [self.found.rivals[n] for n in ("sink", "tuned mass damper") if n in self.found.rivals]
        if self.settings.family == "mixed":
            corners = [rival for rival in corners if rival.design and self.problem.admits(rival.design)]
        if family != "mixed" or not corners:
            return None
        corner = min(corners, key=lambda rival: (not rival.verified, rival.value))
        return replace(corner, name="mixed")

    def _beyond(self, design: DesignedAbsorber | None, stroke: float) -> str:
        """Which limit the stroke [m] of all attractors, force margin included, breaks; empty if none."""
        limits, host = self.limits, self.case.pipe.mass
        if design is None:
            return ""
        if stroke > limits.stroke * _STROKE_SLACK:
            return f"its stroke is {stroke:.4g} m, force margin included, beyond {limits.stroke:.4g} m"
        row = np.array([[0.0, host * design.linear, host * design.kappa, 0.0, 0.0]])
        if limits.filling(row, np.array([stroke]))[0] > _STROKE_SLACK:
            return f"coil springs for its stroke of {stroke:.4g} m do not fit into their length"
        return ""

    def _with_margin(self, rival: Rival) -> Verification | None:
        """Worst case with the margin on the force; None where there is none, or no nonlinear spring."""
        if rival.design is None or not rival.design.nonlinear or self.settings.force_margin == 1:
            return None
        samples = min(_MARGIN_SAMPLES, self.settings.samples)
        return self._worst(self.problem.modes_of(rival.design), force=self.settings.force_margin, samples=samples)

    def _discard(self, rival: Rival, why: str) -> None:
        d = rival.design
        if d is not None:
            self.found.discarded.append(
                f"{rival.name}: {parameters_text(d)} has a {self.objective.title} of {rival.value:.4g}"
                f" {self.objective.unit_text}over all attractors; {why}."
            )

    def _verify(self, case: Case) -> Verification:
        """Value of the objective for a case, over all attractors."""
        if self.objective.over_climate:
            return climate_verification(
                case, self.problem.disturbances, self.objective, samples=self._climate_samples,
                seed=self.settings.seed, counted=[(governed(case, k), winds) for k, winds in self.problem.counted()],
            )  # fmt: skip
        return self._worst(self.problem.modes(case))

    @property
    def _climate_samples(self) -> int:
        """Initial states at every wind: those of the section `fatigue` if the samples of the design were left alone."""
        fatigue = self.case.fatigue
        if fatigue is not None and "samples" not in self.settings.model_fields_set:
            return fatigue.samples
        return self.settings.samples

    def _worst(self, modes: Sequence[ExcitedMode], *, force: float = 1.0, samples: int | None = None) -> Verification:
        problem = self.problem
        worst = self.objective if not self.objective.over_climate else Objective("peak", self.objective.quantile)
        return verification(
            modes, problem.disturbances, worst, force=force, seed=self.settings.seed,
            samples=self.settings.samples if samples is None else samples,
        )  # fmt: skip

    def _others(self) -> None:
        """The pipe without absorber, and the case's own."""
        self._step("no absorber")
        if self.bare is not None:
            self.nominal["none"] = self.bare.nominal
            self.found.rivals["none"] = _rival("none", None, self.bare, math.inf)
        if self.case.absorbers:
            self._step("the case's own absorber")
            problem, most = self.problem, FAR * self.settings.force_margin
            checked = self._verify(self.case)
            self.nominal["case"] = checked.nominal
            free, _ = exact_birth(conditions_of(problem.modes(self.case), problem.disturbances), 1.0, most)
            self.found.rivals["case"] = _rival("case", absorber_of(self.case), checked, free)

    def _whole(self) -> None:
        """Every device with its worst motion as `frahm run` finds it, with every mode, the stress and the fatigue."""
        self._step("other modes, stress and fatigue")
        for name, rival in list(self.found.rivals.items()):
            case = self._rival_case(rival)
            nominal = self.nominal.get(name if name in ("none", "case") else rival.design, ())
            worst, self.found.lasting[name] = worst_motion(case, self.problem, nominal)
            whole = replace(rival, worst=worst, fatigue=fatigue_row(case))
            self.found.rivals[name] = whole
            if self.found.best is not None and name == self.found.best.name:
                self.found.best = whole

    def _acceptance(self, best: Rival) -> dict[str, Any]:
        """The best device held against the limits, over everything that scatters."""
        worst = joined([best.worst, best.scattered])
        found = accepted(utilisations(self._rival_case(best), worst.row(), best.fatigue), best.verified)
        if self.settings.scatter.names and found["rows"]:
            found["sentence"] += " The worst over the scatter asked for is what was judged."
        return found

    def _decision(self, rivals: Sequence[Rival]) -> dict[str, Any]:
        """Every device in one table, as `frahm run` has it."""
        rows = []
        for rival in rivals:
            case = self._rival_case(rival)
            rows.append(device_row(rival.name, case, rival.worst.row(), rival.fatigue, rival.unverified))
        over = "wind" if self.problem.within.over_wind else "detuning"
        return {"over": over, "range": self.problem.within.text, "rows": rows, "remarks": {}}

    def _made(self) -> None:
        """The chosen design as hardware, with its tolerances and slopes, and with the force the springs really have."""
        best, more = self.found.best, self.found.with_margin
        if best is None or best.design is None:
            return
        self._step("hardware, tolerances and sensitivities")
        design, found, problem, settings = best.design, self.found, self.problem, self.settings
        stroke = max(best.relative_peak, more.relative_peak if more else 0.0)
        room, stress = settings.spring_length, settings.spring_stress
        found.hardware = hardware(self.case, design, stroke, best.frequency, room, stress)
        found.tolerance = tolerance_band(
            design, best.worst_pipe_peak, problem.modes_of, problem.disturbances, settings.seed
        )
        found.sensitivities = sensitivities(
            design, problem.modes_of, problem.disturbances, problem.tier(settings.family).screening,
            self.case.pipe.mass,
        )  # fmt: skip
        if design.kappa and not design.quintic:
            built, most = problem.modes(as_built(self.case, design, stroke, room)), FAR * settings.force_margin
            found.built = self._worst(built)
            found.built_margin, _ = exact_birth(conditions_of(built, problem.disturbances), best.force_margin, most)

    def _error_table(self) -> None:
        """Every device at every frequency error, not retuned."""
        lock_in = not self.problem.within.over_wind
        if not self.settings.errors:
            return
        for name, rival in sorted(self.found.rivals.items()):
            self._step(f"frequency errors: {name}")
            modes = self.problem.modes_of_errors(self._rival_case(rival))

            def row(error: float, modes: list[ExcitedMode] = modes, rival: Rival = rival) -> WorstMotion:
                if error == 1:  # known already, and better
                    return rival.worst
                one = Disturbance(pipe_frequency=error, lock_in=lock_in)
                return verification(
                    modes, [one], Objective(), samples=_TABLE_SAMPLES, seed=self.settings.seed, quick=True
                ).motion

            rows = in_threads(row, self.settings.errors)
            self.found.table[name] = tuple(row.pipe_peak for row in rows)
            self.found.sure[name] = tuple(row.verified for row in rows)

    def _rival_case(self, rival: Rival) -> Case:
        if rival.name == "none":
            return without_first(self.case)
        if rival.name == "case" or rival.design is None:
            return self.case
        return with_design(self.case, rival.design)

    def _trade_off(self) -> None:
        """The best design under other force margins."""
        family = self.settings.family
        if family == "tuned":
            return
        best = self.found.best
        if best is None or best.design is None:
            return
        self._step("force margins")
        sized_for = self.sized_for.get(best.design)
        self.problem.tier(family)  # finds its place once

        def candidate(margin: float) -> tuple[Rival | None, list[str]]:
            kept, discarded = self._finalists(family, replace(self.limits, force_margin=margin), sized_for=sized_for)
            if not kept:
                return None, discarded
            design = kept[0].design
            checked = self._verify(with_design(self.case, design))
            reason = self._beyond(design, checked.relative_peak)
            if reason:
                return None, [*discarded, f"With a force margin of {margin:g}: {reason}."]
            return _rival(_DEVICES[family], design, checked, margin), discarded

        # what is best with a margin and keeps more of it is best with more
        asked = self.settings.force_margin
        best = replace(best, force_margin=max(best.force_margin, asked))
        others = [margin for margin in self.settings.margins if not asked <= margin <= best.force_margin]
        candidates = [best]
        for found, discarded in in_threads(candidate, others):
            self.found.discarded += discarded
            candidates += [] if found is None else [found]
        for margin in self.settings.margins:
            keeping = [one for one in candidates if one.force_margin >= margin]
            if keeping:
                least = min(keeping, key=lambda one: (not one.verified, one.value))
                self.found.trade_off.append(_margin_point(margin, least))

    def _best_case(self, design: DesignedAbsorber) -> Case:
        """The case with a design, asked about the same range with the same states, so that a run of it agrees."""
        asked: dict[str, Any] = {"samples": self.settings.samples, "seed": self.settings.seed}
        if self.settings.wind is not None:
            asked |= {"wind": self.settings.wind, "detuning": None}
        case = with_design(self.case, design)
        same = all(getattr(case.analysis, key) == value for key, value in asked.items())
        return case if same else case.with_analysis(**asked)

    def study(self, interrupted: bool) -> DesignStudy:
        found, best = self.found, self.found.best
        if best is None or best.design is None:
            raise RuntimeError("no design")
        rivals = tuple(found.rivals[name] for name in ("none", "case", "sink", "tuned mass damper", "mixed")
                       if name in found.rivals)  # fmt: skip
        doubts = [f"{rival.name}: {sentence}" for rival in rivals for sentence in rival.unverified]
        if found.with_margin is not None:
            doubts += [f"With the margin on the force: {sentence}" for sentence in found.with_margin.unverified]
        if found.built is not None:
            doubts += [f"With the exact force of transverse springs: {sentence}" for sentence in found.built.unverified]
        doubts += [
            f"Table of frequency errors: {name} at {100 * (error - 1):+.3g} % is unverified."
            for name, sure in found.sure.items()
            for error, holds in zip(self.settings.errors, sure, strict=True)
            if not holds
        ]
        if interrupted:
            doubts.append("Interrupted: the comparison is not complete.")
        name = f"{self.case.name}-{best.name.replace(' ', '-')}"[:60]
        first = first_of(rivals)
        title = f"Designed for {self.case.name}. {headline(best, first, self.objective)}"[:200]
        return DesignStudy(
            case=self.case,
            settings=self.settings,
            best=best,
            best_case=self._best_case(best.design).with_name(name, title),
            acceptance=self._acceptance(best),
            decision=self._decision(rivals),
            lasting={rival.name: found.lasting[rival.name] for rival in rivals if rival.name in found.lasting},
            comparison=rivals,
            errors=self.settings.errors,
            error_table=found.table,
            error_verified=found.sure,
            trade_off=tuple(found.trade_off),
            with_margin=found.with_margin.pipe_peak if found.with_margin else math.nan,
            hardware=found.hardware,
            tolerance=found.tolerance,
            sensitivities=found.sensitivities,
            as_built=found.built.pipe_peak if found.built else math.nan,
            as_built_margin=found.built_margin,
            screened=self.problem.screened,
            discarded=tuple(dict.fromkeys(found.discarded)),
            verdict="Interrupted before the devices could be compared."
            if interrupted
            else verdict(rivals, self.settings.errors, found.table, self.settings.scatter, self.objective),
            unverified=tuple(dict.fromkeys(doubts)),
            interrupted=interrupted,
            version=__version__,
        )


def _apart(waiting: list[Finalist]) -> list[Finalist]:
    """Finalists in their order, without those that hardly differ from an earlier one."""
    chosen: list[Finalist] = []
    for finalist in waiting:
        here = finalist.design.parameters
        known = (other.design.parameters for other in chosen)
        if not any(
            all(math.isclose(here[key], there.get(key, 0.0), rel_tol=_ALIKE) for key in here) for there in known
        ):
            chosen.append(finalist)
    return chosen


def in_threads(function: Callable[[Any], Any], items: Sequence[Any]) -> list[Any]:
    """The function of every item, in their order; a thread per core."""
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        try:
            return list(pool.map(function, items))
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)
            raise


def _rival(name: str, design: DesignedAbsorber | None, checked: Verification, force_margin: float) -> Rival:
    """A device as far as the search has come; `_Designing.whole` adds what the comparison needs."""
    nominal = joined([part.motion for part in checked.nominal]) if checked.nominal else checked.motion
    return Rival(name, design, checked.value, nominal, checked.motion, checked.disturbance, float(force_margin))


def _margin_point(margin: float, rival: Rival) -> MarginPoint:
    design = rival.design
    if design is None:
        raise RuntimeError("a force margin of no device")
    return MarginPoint(margin, design, rival.value, rival.worst_pipe_peak, rival.verified, rival.tier)
