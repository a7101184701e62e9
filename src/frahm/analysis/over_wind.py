"""Step `over_wind`: the response over the wind speed, where shedding frequency and lift both follow the wind."""

from __future__ import annotations

from typing import Any

import numpy as np

from frahm.analysis.section import Section, Work
from frahm.errors import ParameterError
from frahm.loads import wind_excitation
from frahm.response import frequency_response


def over_wind(work: Work) -> Section:
    """Every periodic response over the wind speeds of the range of operation, with and without absorbers."""
    case, window = work.case, _speeds(work)
    if window is None or not np.any(work.system.forcing):
        return Section(notes=("No response over the wind: the window of detuning belongs to no one range of speeds.",))
    try:
        curve = frequency_response(case, wind=window)
        bare = frequency_response(case.without_absorbers(), wind=window)
    except ParameterError as refused:
        return Section(notes=(f"The response over the wind was not computed. {refused}",))
    law, found = wind_excitation(case), dict[str, Any](wind=list(window))
    for name, one in (("with", curve), ("without", bare)):
        peak, frequency = one.largest(stable_only=True)
        found[f"pipe_peak_max_{name}"] = peak
        found[f"wind_speed_{name}"] = float(law.speed(frequency, *window))
    data = {"response_over_wind": curve.to_dataset(), "without_absorber_over_wind": bare.to_dataset()}
    return Section(results={"response_over_wind": found}, data=data, unverified=curve.unverified)


def _speeds(work: Work) -> tuple[float, float] | None:
    """Wind speeds [m/s] of the range, or those that shed at the edges of its window of detuning, if one range does."""
    if work.range.wind is not None:
        return work.range.wind
    law = wind_excitation(work.case)
    ends = [law.speeds_of(W) for W in work.range.frequency]
    if any(found.size != 1 for found in ends):
        return None
    lo, hi = (float(found[0]) for found in ends)
    return (lo, hi) if lo < hi else None
