"""Step `wind`: similarity numbers, onset criteria one by one, and published estimates beside the computed amplitude."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

from frahm.analysis.linear import bare_resonance
from frahm.analysis.section import Section, Work
from frahm.loads import (
    AmplitudeEstimates,
    LockInBand,
    amplitude_estimates,
    load_cycles,
    lock_in_band,
    onset_criteria,
    onset_sentence,
    similarity,
)

_ROPES = (
    "The usual remedy is not an absorber but helical ropes or strakes: three 25 mm ropes, 120 degrees apart with a "
    "pitch of 1 m, cured Statfjord A."
)


def wind(work: Work) -> Section:
    """What the numbers of the flow say about the pipe of a case without absorbers."""
    case = work.case
    numbers, criteria = similarity(case), onset_criteria(case)
    estimates, band = amplitude_estimates(case), lock_in_band(case)
    computed = work.done.results.get("without_absorber", {}).get("pipe_peak_max", bare_resonance(case)[0])
    rate = case.pipe.damping_ratio * case.pipe.frequency
    results = {
        "speed": case.wind.speed,
        **dataclasses.asdict(numbers),
        "lock_in_band": dataclasses.asdict(band),
        "criteria": [dataclasses.asdict(criterion) for criterion in criteria],
        "onset": onset_sentence(criteria),
        "estimates": _estimates(estimates),
        "interval": list(estimates.interval),
        "computed": computed,
        "load_cycles": dataclasses.asdict(load_cycles(case)),
        "build_up_time": 1 / rate if rate else math.inf,
    }
    return Section(results={"wind": results}, notes=tuple(_notes(work, band)))


def _estimates(estimates: AmplitudeEstimates) -> list[dict[str, Any]]:
    D = estimates.diameter
    return [dataclasses.asdict(row) | {"amplitude": D * row.ratio} for row in estimates.estimates]


def _notes(work: Work, band: LockInBand) -> list[str]:
    given = work.case.wind
    constant = [
        name.replace("_", " ") for name in ("strouhal", "lift_coefficient") if isinstance(getattr(given, name), float)
    ]
    notes = [
        "Onset criteria and amplitude estimates marked secondary were not read in their sources; "
        "the interval they make is no bound of the amplitude."
    ]
    if constant:
        text = " and ".join(constant).replace("strouhal", "the Strouhal number").replace("lift", "the lift")
        notes.append(f"Over the wind speed {text} of {given.speed:g} m/s {'are' if len(constant) > 1 else 'is'} kept.")
    if band.clipped:
        notes.append("The tables over the Reynolds number do not reach the whole lock-in band.")
    return [*notes, _ROPES]
