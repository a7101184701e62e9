"""What a design came to: the chosen absorber, its rivals, and what every number rests on."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm import readable
from frahm.arrays import labelled
from frahm.attractors import WorstMotion
from frahm.design.absorber import UNITS, DesignedAbsorber
from frahm.design.disturbance import Disturbance
from frahm.design.hardware import Hardware
from frahm.design.objective import Objective
from frahm.design.robustness import Sensitivity, ToleranceBand
from frahm.design.settings import DesignSettings
from frahm.tolerances import NO_BETTER

if TYPE_CHECKING:
    import xarray as xr

    from frahm.case import Case

SIMPLEST_FIRST = ("none", "case", "tuned mass damper", "sink", "mixed")
_AS_PROMISED, _SHORT_OF = 1.01, 0.01  # of the peak, and of the force margin: by how little more springs keep a promise
NAMES = ("none", "case", "sink", "tuned mass damper", "mixed")


@dataclass(frozen=True, eq=False)
class Rival:
    """One device of the comparison.

    Attributes
    ----------
    name : str
        One of `NAMES`.
    design : DesignedAbsorber or None
        Its parameters; None for no absorber, or for one of the case that is not of the family.
    value : float
        Of the objective: the worst pipe peak, or whatever was asked for, over the scatter.
    worst : WorstMotion
        The worst motion of the pipe as given, over the range of operation and every mode that it includes: what
        `frahm run` finds for the same case.
    scattered : WorstMotion
        The worst over everything that scatters.
    disturbance : Disturbance
        Under which that occurs.
    force_margin : float
        Largest factor on the force up to which no detached curve was met [-]; infinite where none can be, NaN if
        not searched.
    fatigue : dict or None
        Damage, life and utilisation over the climate of a case that asks for them.
    count : int
        Number of absorbers.
    """

    __repr__ = readable.summary

    name: str
    design: DesignedAbsorber | None
    value: float
    worst: WorstMotion
    scattered: WorstMotion
    disturbance: Disturbance
    force_margin: float
    fatigue: dict[str, Any] | None = None
    count: int = 1

    @property
    def worst_pipe_peak(self) -> float:
        """Largest pipe peak of the pipe as given [m]."""
        return self.worst.pipe_peak

    @property
    def relative_peak(self) -> float:
        """Largest stroke over the scatter [m]."""
        return max(self.worst.relative_peak, self.scattered.relative_peak)

    @property
    def pipe_rms(self) -> float:
        """Largest pipe rms over the scatter [m]."""
        return max(self.worst.pipe_rms, self.scattered.pipe_rms)

    @property
    def frequency(self) -> float:
        """Where the worst pipe peak occurs [rad/s]."""
        return self.worst.frequency

    @property
    def kind(self) -> str:
        """Of the motion that causes the worst pipe peak."""
        return self.worst.kind

    @property
    def tier(self) -> str:
        """What the worst pipe peak rests on."""
        return self.worst.tier

    @property
    def samples(self) -> int:
        """Initial states per frequency behind it."""
        return self.worst.samples

    @property
    def unverified(self) -> tuple[str, ...]:
        """What speaks against any of it."""
        doubts = () if self.fatigue is None else tuple(self.fatigue["unverified"])
        return tuple(dict.fromkeys((*self.worst.unverified, *self.scattered.unverified, *doubts)))

    @property
    def verified(self) -> bool:
        """Whether nothing speaks against it."""
        return self.worst.verified and self.scattered.verified and not self.unverified


@dataclass(frozen=True)
class MarginPoint:
    """The best design under one force margin: value of the objective and `worst_pipe_peak` [m] by the tier named."""

    force_margin: float
    design: DesignedAbsorber
    value: float
    worst_pipe_peak: float
    verified: bool
    tier: str


@dataclass(frozen=True, eq=False)
class DesignStudy:
    """Result of `design_absorber`.

    Attributes
    ----------
    case : Case
        What was designed for.
    settings : DesignSettings
    best : Rival
        The chosen design, of the family asked for.
    best_case : Case
        The case with it, ready to run.
    comparison : tuple of Rival
        Of every family the best number of absorbers that were asked for.
    by_count : tuple of Rival
        The best design of every family and every number of absorbers.
    errors : tuple of float
        Frequencies of the pipe over the nominal one, of `error_table` [-].
    error_table : dict of str to tuple of float
        Largest pipe peak [m] of every device at every frequency error, not retuned.
    error_verified : dict of str to tuple of bool
    trade_off : tuple of MarginPoint
        Worst peak against force margin.
    with_margin : float
        Worst pipe peak [m] of the best design with `force_margin` times the force; NaN if not searched.
    hardware : Hardware or None
        Springs, damper, strokes of the best design.
    tolerance : ToleranceBand or None
        Within which errors of its parameters the guarantee holds.
    sensitivities : tuple of Sensitivity
    as_built : float
        Worst pipe peak [m] with the exact force of the transverse springs of the sheet; NaN if there are none.
    as_built_margin : float
        Largest factor on the force [-] up to which these springs have no detached curve.
    screened : int
        Designs judged by the closed form.
    discarded : tuple of str
        Finalists that failed, with the reason.
    verdict : str
    unverified : tuple of str
    interrupted : bool
    version : str
    acceptance : dict
        The best design against the limits of the case: verdict and utilisations.
    decision : dict
        Rows of the table that decides, see `frahm.assessment.device_row`.
    lasting : dict of str to Dataset
        Largest lasting motions of every device over the range, see `frahm.attractors.lasting_motions`.
    """

    __repr__ = readable.summary

    case: Case
    settings: DesignSettings
    best: Rival
    best_case: Case
    comparison: tuple[Rival, ...]
    errors: tuple[float, ...]
    error_table: dict[str, tuple[float, ...]]
    error_verified: dict[str, tuple[bool, ...]]
    trade_off: tuple[MarginPoint, ...]
    with_margin: float
    hardware: Hardware | None
    tolerance: ToleranceBand | None
    sensitivities: tuple[Sensitivity, ...]
    as_built: float
    as_built_margin: float
    screened: int
    discarded: tuple[str, ...]
    verdict: str
    unverified: tuple[str, ...]
    interrupted: bool
    version: str
    acceptance: dict[str, Any] = field(default_factory=dict)
    decision: dict[str, Any] = field(default_factory=dict)
    lasting: dict[str, xr.Dataset] = field(default_factory=dict)
    by_count: tuple[Rival, ...] = ()

    @property
    def objective(self) -> Objective:
        """What was made small."""
        return Objective(self.settings.objective, self.settings.quantile)

    @property
    def verified(self) -> bool:
        """Whether nothing in the study is in doubt."""
        return not self.unverified and not self.interrupted

    @property
    def best_of_all(self) -> Rival:
        """The device with the least value of the objective, verified ones first, whatever family was asked for."""
        return first_of(self.comparison)

    @property
    def headline(self) -> str:
        """What was chosen, and whether another device does better."""
        return headline(self.best, self.best_of_all, self.objective)

    @property
    def as_built_note(self) -> str:
        """A sentence where the springs of the sheet keep less than was promised of the cubic law; empty if not."""
        peak, margin, asked = self.as_built, self.as_built_margin, self.settings.force_margin
        more = peak > _AS_PROMISED * self.best.worst_pipe_peak
        less = margin < min(asked, self.best.force_margin) - _SHORT_OF
        if not (more or less):  # NaN where no such springs were looked at
            return ""
        promised = readable.length(self.best.worst_pipe_peak)
        told = [f"the worst pipe peak is {readable.length(peak)}, not {promised}"] if more else []
        told += [f"they have a detached curve from {margin:.4g} times the force on"] if less else []
        return (
            f"With the exact force of the springs of the sheet {' and '.join(told)}: longer springs are nearer to the"
            " cubic law (spring_length)."
        )

    def ranking(self, error: float) -> list[str]:
        """Devices by the worst pipe peak where the pipe's frequency is this much of the nominal one, best first."""
        at = self.errors.index(error)
        return sorted(self.error_table, key=lambda name: (self.error_table[name][at], SIMPLEST_FIRST.index(name)))

    def frequency_errors(self) -> dict[str, Any]:
        """Worst pipe peaks [m] of the devices at every error of the pipe's frequency [-], and whether each holds."""
        return {
            "error": [error - 1.0 for error in self.errors],
            "pipe_peak": {name: list(values) for name, values in self.error_table.items()},
            "verified": {name: list(values) for name, values in self.error_verified.items()},
        }

    def results(self) -> dict[str, Any]:
        """Plain data for the summary, in SI units."""
        return {
            "family": self.settings.family,
            "objective": {"name": self.settings.objective, "title": self.objective.title, "unit": self.objective.unit},
            "settings": self.settings.model_dump(mode="json"),
            "best": rival_row(self.best),
            "with_margin": {"force": self.settings.force_margin, "pipe_peak": self.with_margin},
            "comparison": [rival_row(rival) for rival in self.comparison],
            "by_count": [
                {"name": r.name, "count": r.count, "absorbers": absorber_rows(r.design), "value": r.value,
                 "verified": r.verified}
                for r in self.by_count
            ],
            "headline": self.headline,
            "acceptance": self.acceptance,
            "ranking": {f"{100 * (error - 1):+.3g} %": self.ranking(error) for error in self.errors},
            "frequency_errors": self.frequency_errors(),
            "trade_off": [
                {"force_margin": p.force_margin, **p.design.parameters, "absorbers": absorber_rows(p.design),
                 "value": p.value, "worst_pipe_peak": p.worst_pipe_peak, "verified": p.verified, "tier": p.tier}
                for p in self.trade_off
            ],
            "hardware": hardware_rows(self.hardware),
            "warnings": [*(self.hardware.warnings if self.hardware else ()), *filter(None, [self.as_built_note])],
            "as_built": {"pipe_peak": self.as_built, "force_margin": self.as_built_margin},
            "tolerance": tolerance_row(self.tolerance),
            "sensitivities": [vars(item) for item in self.sensitivities],
            "screened": self.screened,
            "discarded": list(self.discarded),
            "verdict": self.verdict,
            "interrupted": self.interrupted,
        }  # fmt: skip

    def to_dataset(self) -> xr.Dataset:
        """Comparison, table over frequency errors and trade-off as arrays."""
        import xarray as xr

        devices = list(self.error_table)
        table = np.array([self.error_table[name] for name in devices]).reshape(len(devices), len(self.errors))
        sure = np.array([self.error_verified[name] for name in devices], dtype=bool).reshape(table.shape)
        curve, rivals = self.trade_off, self.comparison
        peak, margin = "largest pipe peak over all attractors", "factor on the force without detached curve"
        variables = {
            "error": labelled("error_index", [e - 1.0 for e in self.errors], "error of the pipe's frequency", "1"),
            "error_pipe_peak": labelled(("device", "error_index"), table, peak, "m", names=", ".join(devices)),
            "error_verified": labelled(("device", "error_index"), sure, "verified", "1"),
            "comparison_pipe_peak": labelled(
                "rival", [r.worst_pipe_peak for r in rivals], peak, "m", names=", ".join(r.name for r in rivals)
            ),
            "comparison_value": labelled("rival", [r.value for r in rivals], self.objective.title, self.objective.unit),
            "comparison_relative_peak": labelled("rival", [r.relative_peak for r in rivals], "largest stroke", "m"),
            "comparison_verified": labelled("rival", [r.verified for r in rivals], "verified", "1"),
            "force_margin": labelled("margin_index", [p.force_margin for p in curve], margin, "1"),
            "margin_value": labelled(
                "margin_index", [p.value for p in curve], self.objective.title, self.objective.unit
            ),
            "margin_pipe_peak": labelled("margin_index", [p.worst_pipe_peak for p in curve], peak, "m"),
        }
        most = max([1, *(r.design.count for r in rivals if r.design is not None)])
        variables["comparison_count"] = labelled("rival", [r.count for r in rivals], "number of absorbers", "1")
        for name, unit in UNITS.items():
            values = [math.nan if r.design is None else getattr(r.design, name) for r in rivals]
            variables[f"comparison_{name}"] = labelled("rival", values, f"{name} over mass of the pipe", unit)
            each = np.full((len(rivals), most), math.nan)
            for at, rival in enumerate(rivals):
                for number, row in enumerate(absorber_rows(rival.design)):
                    each[at, number] = row[name]
            variables[f"comparison_each_{name}"] = labelled(
                ("rival", "absorber"), each, f"{name} over mass of the pipe, of each absorber", unit
            )
            values = [getattr(p.design, name) for p in curve]
            variables[f"margin_{name}"] = labelled("margin_index", values, f"{name} over mass of the pipe", unit)
        return xr.Dataset(variables, attrs={"frahm": self.version, "case": self.case.name, "verdict": self.verdict})


def first_of(rivals: Sequence[Rival]) -> Rival:
    """Best verified device; of those as good, the simplest."""
    best = min(rivals, key=lambda rival: (not rival.verified, rival.value))
    alike = [one for one in rivals if one.verified == best.verified and NO_BETTER * one.value <= best.value]
    return min(alike, key=lambda rival: SIMPLEST_FIRST.index(rival.name))


def headline(best: Rival, first: Rival, objective: Objective) -> str:
    """What was chosen, and whether another device does better."""
    many = "" if best.count == 1 else f", {best.count} absorbers"
    text = f"Best {best.name}{many}{_corner(best)}: {objective.title} {objective.shown(best.value)}"
    if first.name in (best.name, "none") or not first.value < NO_BETTER * best.value:
        return f"{text}; no device compared does better."
    return f"{text}; the {first.name} does better, {objective.shown(first.value)}, and is not what was asked for."


def _corner(best: Rival) -> str:
    """What a mixture is that needs only one of its springs."""
    if best.name != "mixed" or best.design is None:
        return ""
    if not best.design.nonlinear:
        return ", which is a tuned mass damper without a cubic spring"
    return "" if best.design.family == "mixed" else ", which is a sink without a linear spring"


def absorber_rows(design: DesignedAbsorber | None) -> list[dict[str, Any]]:
    """Parameters of every absorber of a device as plain data; empty for one that is not of the family."""
    names = ("kappa", "linear", "xi2", "rho2", "quintic", "position")
    return [] if design is None else [{name: getattr(one, name) for name in names} for one in design.absorbers]


def hardware_rows(sheet: Hardware | None) -> list[dict[str, Any]]:
    """The hardware sheet as plain data."""
    return [] if sheet is None else [vars(item) for item in sheet.items]


def tolerance_row(band: ToleranceBand | None) -> dict[str, Any] | None:
    """The tolerance band as plain data."""
    if band is None:
        return None
    return {"tolerance": band.tolerance, "pipe_peak": band.pipe_peak, "corner": band.corner.parameters,
            "verified": band.verified, "breaks": band.breaks,
            "corners": band.corners, "of_corners": band.of_corners}  # fmt: skip


def rival_row(rival: Rival) -> dict[str, Any]:
    """One device as plain data: its worst motion whole, and what else was asked of it."""
    return {
        "name": rival.name,
        **rival.worst.row(),
        **(rival.design.parameters if rival.design else {}),
        "count": rival.count,
        "absorbers": absorber_rows(rival.design),
        "value": rival.value,
        "worst_pipe_peak": rival.worst_pipe_peak,
        "worst_over_scatter": rival.scattered.pipe_peak,
        "frequency_error": rival.disturbance.pipe_frequency - 1.0,
        "relative_peak_over_scatter": rival.relative_peak,
        "pipe_rms_over_scatter": rival.pipe_rms,
        "force_margin": rival.force_margin,
        "fatigue": rival.fatigue,
        "verified": rival.verified,
        "unverified": list(rival.unverified),
    }
