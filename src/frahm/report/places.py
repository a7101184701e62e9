"""Where something is, as text ready to be read: by the wind where the lift follows it, else by the detuning."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from frahm import readable
from frahm.analysis import CaseAnalysis
from frahm.report.numbers import number


def over_wind(analysis: CaseAnalysis) -> bool:
    """Whether the case was asked about winds, each with its own lift."""
    curve = analysis.data.get("response", analysis.data.get("without_absorber"))
    return curve is not None and "wind_speed" in curve


def place_head(analysis: CaseAnalysis) -> str:
    """Head of the column that says where something is."""
    return "Wind [m/s]" if over_wind(analysis) else "\N{GREEK SMALL LETTER SIGMA} [rad/s]"


def where(found: Mapping[str, Any]) -> str:
    """Wind speed, or the detuning where the lift is fixed."""
    speed = _speed(found)
    return number(found["detuning"] if math.isnan(speed) else speed)


def at(found: Mapping[str, Any]) -> str:
    """The same in a sentence."""
    speed = _speed(found)
    return f"at {number(found['detuning'])} rad/s" if math.isnan(speed) else f"at {readable.speed(speed)}"


def span(found: Mapping[str, Sequence[float]]) -> str:
    """Range of wind speeds, or of detunings."""
    ends = found["wind_speed"] or found["detuning"]
    return " \N{HORIZONTAL ELLIPSIS} ".join(number(end) for end in sorted(ends))


def _speed(found: Mapping[str, Any]) -> float:
    """Wind speed [m/s]; NaN where the lift is fixed."""
    speed = found.get("wind_speed")
    return math.nan if speed is None else float(speed)
