"""Steps `attractors` and `worst`: every long-term motion at the design wind, and the worst of them over the window."""

from __future__ import annotations

from typing import Any

import numpy as np

from frahm.analysis.section import PASS, UNVERIFIED, Check, Section, Work
from frahm.attractors import Attractor, find_attractors, worst_case
from frahm.errors import ParameterError
from frahm.harmonic_balance import is_linear
from frahm.loads import vortex_shedding

_WORST_SAMPLES = 60
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
        results={"attractors": [_row(attractor) for attractor in found]},
        data={"attractors": found.to_dataset()},
        checks=(Check(_SETTLED, PASS if open_share == 0 else UNVERIFIED, detail),),
        unverified=() if open_share == 0 else (detail,),
        notes=(f"Basin fractions are statistics of a sample: {found.statement}",),
    )


def worst(work: Work) -> Section:
    """The largest pipe peak of any attractor over the window of the detuning."""
    if not _nonlinear(work):
        return Section()
    settings = work.case.analysis
    try:
        found = worst_case(
            work.system, detuning=settings.detuning, samples=min(_WORST_SAMPLES, settings.samples), seed=settings.seed
        )
    except ParameterError as refused:
        return Section(notes=(f"The worst case over the window was not searched: {refused}",))
    return Section(
        results={
            "worst_case": {
                "pipe_peak": found.pipe_peak,
                "detuning": found.detuning,
                "kind": found.attractor.kind,
                "relative_peak": found.relative_peak,
                "relative_detuning": found.relative_detuning,
                "basin_fraction": found.attractor.basin_fraction,
                "min_basin": found.min_basin,
                "not_excluded": found.not_excluded,
                "frequencies_searched": len(found.surveys),
                "verified": found.verified,
            },
            "coexisting": [_row(attractor) for survey in found.surveys if len(survey) > 1 for attractor in survey],
        },
        unverified=found.unverified,
    )


def _nonlinear(work: Work) -> bool:
    return not is_linear(work.system) and bool(np.any(work.system.forcing))


def _row(attractor: Attractor) -> dict[str, Any]:
    return {
        "kind": attractor.kind,
        "pipe_peak": attractor.pipe_peak,
        "relative_peak": attractor.relative_peak,
        "pipe_rms": attractor.pipe_rms,
        "pipe_envelope": list(attractor.envelope),
        "period_multiple": attractor.period_multiple,
        "basin_fraction": attractor.basin_fraction,
        "basin_interval": list(attractor.basin_interval),
        "from_rest": attractor.from_rest,
        "detuning": attractor.detuning,
    }
