"""Step `over_wind`: the response over the wind speed, where shedding frequency and lift both follow the wind."""

from __future__ import annotations

from typing import Any

import numpy as np

from frahm.analysis.section import Section, Work
from frahm.errors import ParameterError
from frahm.loads import wind_excitation
from frahm.response import frequency_response
from frahm.response.own_lift import winds_of_window


def over_wind(work: Work) -> Section:
    """Every periodic response over the wind speeds of the range of operation, with and without absorbers."""
    case, window = work.case, winds_of_window(work.case, work.range)
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
