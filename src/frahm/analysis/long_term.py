"""Steps `attractors` and `worst`: every lasting motion at the design wind, and the worst over the range."""

from __future__ import annotations

from typing import Any

import numpy as np

from frahm import readable
from frahm.analysis.linear import others_of
from frahm.analysis.section import PASS, UNVERIFIED, Check, Section, Work
from frahm.assessment import with_stress
from frahm.attractors import Attractor, WorstCase, WorstMotion, find_attractors, joined, lasting_motions, worst_over
from frahm.case import Case
from frahm.errors import ParameterError
from frahm.harmonic_balance import is_linear
from frahm.loads import OperatingRange, vortex_shedding
from frahm.systems import build_system

_SETTLED = "Motions from sampled states settle on an attractor"


def attractors(work: Work) -> Section:
    """Long-term motions at the shedding frequency of the case's wind, with the share of initial states of each."""
    if not _nonlinear(work):
        return Section()
    settings = work.case.analysis
    detuning = float(vortex_shedding(work.case).detuning)
    try:
        found = find_attractors(work.system, detuning=detuning, samples=settings.samples, seed=settings.seed)
    except ParameterError as refused:
        return Section(notes=(f"Attractors at the design wind were not searched: {refused}",))
    open_share = sum(a.basin_fraction for a in found if a.kind == "unsettled")
    detail = f"At the design wind {100 * open_share:.3g} % of {found.samples} sampled initial states ended on none."
    return Section(
        results={"attractors": [_row(attractor, work.range) for attractor in found]},
        data={"attractors": found.to_dataset()},
        checks=(Check(_SETTLED, PASS if open_share == 0 else UNVERIFIED, detail),),
        unverified=(*(() if open_share == 0 else (detail,)), *found.unverified),
        notes=(f"Basin fractions are statistics of a sample: {found.statement}",),
    )


def worst(work: Work) -> Section:
    """The worst lasting motion over the range of operation: every attractor met, however small its basin."""
    settings = work.case.analysis
    parts: list[WorstCase] = []
    motions: list[WorstMotion] = []
    try:
        for case, within in ((work.case, work.range), *others_of(work)):
            part = worst_over(build_system(case), within, samples=settings.samples, min_basin=0.0, seed=settings.seed)
            parts.append(part)
            motions.append(with_stress(case, part))
    except ParameterError as refused:
        return Section(unverified=(f"The worst case over the range of operation was not found: {refused}",))
    motion, first = joined(motions), parts[0]
    reference = motion.frequency - motion.detuning
    row = _worst_row(motion) | {
        "relative_detuning": motion.relative_frequency - reference,
        "min_basin": first.min_basin,
        "not_excluded": max(part.not_excluded for part in parts),
        "of_governing_mode": motions[0].pipe_peak,
    }
    modes = [_mode_row(case, m) for (case, _), m in zip(others_of(work), motions[1:], strict=True)]
    several = (
        []
        if motion.tier == "exact linear response"
        else [_row(attractor, work.range) for survey in first.surveys if len(survey) > 1 for attractor in survey]
    )
    return Section(
        results={"range": _range_row(work), "worst_case": row, "other_modes": modes, "coexisting": several},
        data={"lasting": lasting_motions(parts)},
        unverified=motion.unverified,
        notes=work.range.basis,
    )


def _range_row(work: Work) -> dict[str, Any]:
    """The range of operation as plain data."""
    within = work.range
    return {
        "text": within.text,
        "wind": None if within.wind is None else list(within.wind),
        "frequency": list(within.frequency),
        "detuning": list(within.detuning),
        "basis": list(within.basis),
    }


def _mode_row(case: Case, motion: WorstMotion) -> dict[str, Any]:
    return {"mode": case.pipe.governing_mode, "natural_frequency": case.pipe.frequency, **_worst_row(motion)}


def _worst_row(motion: WorstMotion) -> dict[str, Any]:
    return motion.row() | {"kind": readable.motion(motion.kind)}


def _nonlinear(work: Work) -> bool:
    return not is_linear(work.system) and bool(np.any(work.system.forcing))


def _row(attractor: Attractor, within: OperatingRange) -> dict[str, Any]:
    return {
        "kind": readable.motion(attractor.kind),
        "pipe_peak": attractor.pipe_peak,
        "relative_peak": attractor.relative_peak,
        "pipe_rms": attractor.pipe_rms,
        "pipe_envelope": list(attractor.envelope),
        "period_multiple": attractor.period_multiple,
        "basin_fraction": attractor.basin_fraction,
        "basin_interval": list(attractor.basin_interval),
        "from_rest": attractor.from_rest,
        "detuning": attractor.detuning,
        "wind_speed": float(within.speed(attractor.frequency)),
        "outcome": attractor.outcome.name.lower(),
    }
