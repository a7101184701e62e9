"""`design_absorber`: screening, exact responses, attractors; then the comparison nobody may skip."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import __version__
from frahm.case import Case, load_case
from frahm.design.absorber import FAMILIES, DesignedAbsorber, absorber_of, with_design
from frahm.design.exact import Windows, exact_birth
from frahm.design.finalists import Finalist, finalists
from frahm.design.hardware import Hardware, as_built, hardware
from frahm.design.host import Host, host_of
from frahm.design.robustness import Sensitivity, ToleranceBand, sensitivities, tolerance_band
from frahm.design.screening import Screening
from frahm.design.search import Limits, TierOne
from frahm.design.settings import DesignSettings
from frahm.design.space import design_space
from frahm.design.study import DesignStudy, MarginPoint, Rival
from frahm.design.verdict import verdict
from frahm.design.verification import Verification, glimpse, verification
from frahm.errors import ParameterError
from frahm.systems import System, build_system

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

Progress = Callable[[str, int, int], None]
_WIDE = (0.7, 1.3)  # of the pipe's frequency: where the lift may lock in
_RESPONSE_POINTS, _BIRTH_POINTS = 121, 481
_STEP = (
    0.05  # of the pipe's frequency: errors a design with scatter is searched and verified at, refined beside the worst
)
_MOST_FINALISTS = 4
_JUMP = 1.1  # a design whose peak grows by more than this beside the force has met a detached curve
_MARGIN_SAMPLES = 40
_TABLE_SAMPLES, _TABLE_PERIODS = 8, 1000
_DEVICES = {"sink": "sink", "tuned": "tuned mass damper", "mixed": "mixed"}


@dataclass(eq=False)
class _Found:
    """What is known so far: an interruption leaves it as it is."""

    best: Rival | None = None
    rivals: dict[str, Rival] = field(default_factory=dict)
    table: dict[str, tuple[float, ...]] = field(default_factory=dict)
    sure: dict[str, tuple[bool, ...]] = field(default_factory=dict)
    trade_off: list[MarginPoint] = field(default_factory=list)
    with_margin: Verification | None = None
    hardware: Hardware | None = None
    tolerance: ToleranceBand | None = None
    sensitivities: tuple[Sensitivity, ...] = ()
    built: Verification | None = None
    discarded: list[str] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)


def design_absorber(
    case: Case | str | os.PathLike[str] | Mapping[str, Any],
    mass_ratio: float | None = None,
    *,
    settings: DesignSettings | None = None,
    progress: Progress | None = None,
    **changes: Any,
) -> DesignStudy:
    """Best absorber of a family for a case, verified over all attractors and compared with its rivals.

    Three tiers: every one-harmonic response of many designs in closed form; exact harmonic balance with stability and
    births of detached curves of the best; all attractors from sampled states of the finalists. The peaks promised
    are those of the last tier.

    Parameters
    ----------
    case : Case, str, Path or dict
        A pipe in the wind; its first absorber, if it has one, is replaced. The window of the detuning counts.
    mass_ratio : float, optional
        Mass of the absorber over that of the pipe [-]; by default that of the case's absorber, or 0.02.
    settings : DesignSettings, optional
        Everything else; `changes` name single settings, such as ``family="mixed"`` or ``scatter=0.1``.
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
    asked = _settings(case, mass_ratio, settings, changes)
    work = _Designing(case, asked, progress)
    interrupted = False
    try:
        work.run()
    except KeyboardInterrupt:
        if work.found.best is None:
            raise
        interrupted = True
    return work.study(interrupted)


def verified_designs(
    case: Case | str | os.PathLike[str] | Mapping[str, Any],
    settings: DesignSettings,
    families: Sequence[str] = FAMILIES,
    progress: Progress | None = None,
) -> tuple[Rival, ...]:
    """Best verified design of every family under the settings, without the comparison of `design_absorber`.

    A family of which no design keeps the limits is left out.
    """
    work = _Designing(load_case(case), settings, progress)
    for family in families:
        rival = work.designed(family)
        if rival is not None:
            work.found.rivals[rival.name] = rival
    return tuple(work.found.rivals.values())


def _settings(
    case: Case, mass_ratio: float | None, settings: DesignSettings | None, changes: dict[str, Any]
) -> DesignSettings:
    known = DesignSettings.__dataclass_fields__
    for name in changes:
        if name not in known:
            from frahm.errors import nearest

            near = nearest(name, known)
            hint = f"Did you mean {near!r}?" if near else None
            raise ParameterError(name, changes[name], "one of " + ", ".join(known), hint=hint)
    base = {} if settings is None else {name: getattr(settings, name) for name in known}
    if mass_ratio is not None:
        changes = changes | {"mass_ratio": mass_ratio}
    elif settings is None and "mass_ratio" not in changes and case.absorbers:
        changes = changes | {"mass_ratio": case.absorbers[0].mass / case.pipe.mass}
    return DesignSettings(**(base | changes))


class _Designing:
    """One run through all steps."""

    def __init__(self, case: Case, settings: DesignSettings, progress: Progress | None):
        self.case, self.settings, self.progress = case, settings, progress
        self.found = _Found()
        self.host: Host = host_of(self.system_of(self._any_design()))
        omega = self.host.frequency
        lo, hi = case.analysis.detuning
        moving = settings.scatter > 0
        wide = (_WIDE[0] * omega, _WIDE[1] * omega)
        self.windows = Windows(wide if moving else (omega + lo, omega + hi), wide, moving)
        count = 1 + 2 * math.ceil(settings.scatter / _STEP - 1e-9)
        self.errors = [float(r) for r in np.linspace(1 - settings.scatter, 1 + settings.scatter, count)]
        self.limits = Limits(settings.force_margin, settings.stroke or math.inf, False)
        self.tiers: dict[tuple[str, float], TierOne] = {}
        self.done, self.total = 0, 0

    def system_of(self, design: DesignedAbsorber) -> System:
        return build_system(with_design(self.case, design))

    def _any_design(self) -> DesignedAbsorber:
        return DesignedAbsorber(self.settings.mass_ratio, 0.0, 1.0, 0.0)

    def run(self) -> None:
        # the mixture is held against its corners, so they come first
        families = ["sink", "tuned", "mixed"]
        if self.settings.family == "tuned":
            families = ["tuned", "sink", "mixed"]
        self.total = len(families) + 3 + len(self.settings.margins) + 5
        for family in families:
            rival = self.designed(family)
            if family == self.settings.family:
                if rival is None:
                    hint = f"No design keeps them; what binds: {self._binding(family)}."
                    raise ParameterError("limits", self._limits_text(), "limits that a design can keep", hint=hint)
                self.found.best = rival
            if rival is not None:
                self.found.rivals[rival.name] = rival
        self._others()
        self._made()
        self._error_table()
        self._trade_off()

    def _step(self, title: str) -> None:
        if self.progress:
            best = self.found.best
            so_far = f"; best so far {best.worst_pipe_peak:#.3g} m" if best else ""
            self.progress(title + so_far, min(self.done, self.total), self.total)
        self.done += 1

    def _tier(self, family: str, margin: float | None = None) -> TierOne:
        """Closed form for a family, with the force given and with its margin."""
        most = self.settings.force_margin if margin is None else margin
        if (family, most) not in self.tiers:
            windows = self.windows
            forces = sorted({1.0, most}) if family != "tuned" else [1.0]
            screening = Screening(
                self.host,
                self.host.conditions(
                    self.errors, windows.window, _RESPONSE_POINTS, moving=windows.moving, forces=forces
                ),
                self.host.conditions(self.errors, windows.wide, _BIRTH_POINTS),
            )
            space = design_space(self.host, self.case.pipe.mass, family, self.settings)
            self.tiers[family, most] = TierOne(screening, space)
        return self.tiers[family, most]

    def _binding(self, family: str) -> str:
        return self._tier(family).binding(self.limits)

    def _limits_text(self) -> str:
        parts = [f"force margin {self.settings.force_margin:g}"]
        if self.settings.stroke is not None:
            parts.append(f"stroke {self.settings.stroke:g} m")
        return ", ".join(parts)

    def _finalists(self, family: str, limits: Limits) -> list[Finalist]:
        tier = self._tier(family, limits.force_margin)
        kept, discarded = finalists(tier, self.system_of, self.windows, self.errors, limits)
        self.found.discarded += [f"{_DEVICES[family]}: {reason}" for reason in discarded]
        return kept

    def designed(self, family: str) -> Rival | None:
        """Best verified design of a family: finalists in the order of what is expected of them."""
        self._step(f"search: {_DEVICES[family]}")
        waiting = self._finalists(family, self.limits)
        best = self._cornered(family)
        for finalist in waiting[:_MOST_FINALISTS]:
            if best is not None and best.verified and finalist.predicted >= best.worst_pipe_peak:
                continue
            system = self.system_of(finalist.design)
            checked = self._verify(system)
            rival = _rival(_DEVICES[family], finalist.design, checked, finalist.force_margin)
            more = self._with_margin(rival, system)
            if more is not None and more.pipe_peak > _JUMP * self.settings.force_margin * checked.pipe_peak:
                self._discard(
                    rival, f"with {self.settings.force_margin:g} times the force it is {more.pipe_peak:.4g} m"
                )
                continue
            if best is None or (rival.verified, -rival.worst_pipe_peak) > (best.verified, -best.worst_pipe_peak):
                if best is not None and not best.verified:
                    self._discard(best, f"unverified: {' '.join(best.unverified[:1])}")
                best = rival
                if family == self.settings.family:
                    self.found.with_margin = more
            else:
                self._discard(rival, "it is not better")
        return best

    def _cornered(self, family: str) -> Rival | None:
        """For the mixture, the better of its corners: the optimum over the family is never worse than either."""
        corners = [self.found.rivals[n] for n in ("sink", "tuned mass damper") if n in self.found.rivals]
        if family != "mixed" or not corners:
            return None
        corner = min(corners, key=lambda rival: (not rival.verified, rival.worst_pipe_peak))
        return Rival(**{**vars(corner), "name": "mixed"})

    def _with_margin(self, rival: Rival, system: System) -> Verification | None:
        """Worst case with the margin on the force; None where there is none, or no nonlinear spring."""
        if rival.design is None or not rival.design.kappa or self.settings.force_margin == 1:
            return None
        return self._verify(
            system, force=self.settings.force_margin, samples=min(_MARGIN_SAMPLES, self.settings.samples)
        )

    def _discard(self, rival: Rival, why: str) -> None:
        d = rival.design
        if d is not None:
            self.found.discarded.append(
                f"{rival.name}: kappa {d.kappa:.5g}, linear {d.linear:.4g}, xi2 {d.xi2:.4g} reaches"
                f" {rival.worst_pipe_peak:.4g} m over all attractors; {why}."
            )

    def _verify(self, system: System, *, force: float = 1.0, samples: int | None = None) -> Verification:
        count = self.settings.samples if samples is None else samples
        return verification(system, self.windows, self.errors, samples=count, seed=self.settings.seed, force=force)

    def _others(self) -> None:
        """The pipe without absorber, and the case's own."""
        self._step("no absorber")
        bare = build_system(self.case.without_absorbers())
        self.found.rivals["none"] = _rival("none", None, self._verify(bare), math.inf)
        if self.case.absorbers:
            self._step("the case's own absorber")
            system = build_system(self.case)
            checked = self._verify(system)
            free, _ = exact_birth(system, self.windows, self.errors, 1.0, 1.1 * self.settings.force_margin)
            self.found.rivals["case"] = _rival("case", absorber_of(self.case), checked, free)

    def _made(self) -> None:
        """The chosen design as hardware, with its tolerances and slopes, and with the force the springs really have."""
        best, more = self.found.best, self.found.with_margin
        if best is None or best.design is None:
            return
        self._step("hardware, tolerances and sensitivities")
        design, found = best.design, self.found
        stroke = max(best.relative_peak, more.relative_peak if more else 0.0)
        found.hardware = hardware(self.case, design, stroke, best.frequency)
        found.tolerance = tolerance_band(
            design, best.worst_pipe_peak, self.system_of, self.windows, self.errors, self.settings.seed
        )
        found.sensitivities = sensitivities(
            design, self.system_of, self.windows, self.errors, self._tier(self.settings.family).screening,
            self.case.pipe.mass,
        )  # fmt: skip
        if design.kappa:
            found.built = self._verify(build_system(as_built(self.case, design, stroke)))

    def _error_table(self) -> None:
        """Every device at every frequency error, not retuned."""
        windows = Windows(self.windows.wide, self.windows.wide, True)
        if not self.settings.errors:
            return
        for name, rival in sorted(self.found.rivals.items()):
            self._step(f"frequency errors: {name}")
            system = self._rival_system(rival)
            rows = [
                glimpse(system, windows, r, samples=_TABLE_SAMPLES, seed=self.settings.seed, periods=_TABLE_PERIODS)
                for r in self.settings.errors
            ]
            self.found.table[name] = tuple(row.pipe_peak for row in rows)
            self.found.sure[name] = tuple(row.verified for row in rows)

    def _rival_system(self, rival: Rival) -> System:
        if rival.name == "none":
            return build_system(self.case.without_absorbers())
        if rival.name == "case" or rival.design is None:
            return build_system(self.case)
        return self.system_of(rival.design)

    def _trade_off(self) -> None:
        """The best design under other force margins."""
        family = self.settings.family
        if family == "tuned":
            return
        for margin in self.settings.margins:
            self._step(f"force margin {margin:g}")
            kept = self._finalists(family, Limits(margin, self.limits.stroke, False))
            if not kept:
                continue
            checked = self._verify(self.system_of(kept[0].design))
            self.found.trade_off.append(
                MarginPoint(margin, kept[0].design, checked.pipe_peak, checked.verified, checked.tier)
            )

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
        return DesignStudy(
            case=self.case,
            settings=self.settings,
            best=best,
            best_case=with_design(self.case, best.design).with_name(name, f"Designed for {self.case.name}"[:200]),
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
            screened=sum(tier.count for tier in self.tiers.values()),
            discarded=tuple(dict.fromkeys(found.discarded)),
            verdict=verdict(rivals, self.settings.errors, found.table, self.settings.scatter),
            unverified=tuple(dict.fromkeys(doubts)),
            interrupted=interrupted,
            version=__version__,
        )


def _rival(name: str, design: DesignedAbsorber | None, checked: Verification, force_margin: float) -> Rival:
    return Rival(
        name=name,
        design=design,
        worst_pipe_peak=checked.pipe_peak,
        relative_peak=checked.relative_peak,
        error=checked.error,
        frequency=checked.frequency,
        kind=checked.kind,
        force_margin=force_margin,
        verified=checked.verified,
        tier=checked.tier,
        samples=checked.samples,
        unverified=checked.unverified,
    )
