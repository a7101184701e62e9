"""What a motion from rest tends to, by the judgement that the attractors themselves are found by."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from frahm import readable
from frahm.analysis.points import DESIGN_WIND
from frahm.analysis.section import Work
from frahm.attractors.finding import attractors_reached, settling_periods
from frahm.attractors.stroboscope import stroboscope
from frahm.errors import ParameterError
from frahm.harmonic_balance import is_linear, linear_growth, periodic_responses_of
from frahm.systems import System
from frahm.time_integration import TimeHistory

_TIMES = 32  # of a period


@dataclass(frozen=True)
class Lasting:
    """The lasting motion that one from rest tends to.

    Attributes
    ----------
    kind : str
        "periodic", "modulated" or "chaotic"; "unsettled" where the search for attractors did not see it settle.
    multiple : int
        Periods of the excitation after which it repeats; 0 if it does not.
    sizes : dict
        `pipe_peak`, `pipe_rms`, `pipe_envelope` and, with an absorber, `relative_peak` of it [m]; empty if unknown.
    """

    kind: str
    multiple: int
    sizes: dict[str, Any]


def lasting(work: Work, key: str, history: TimeHistory, judged: str) -> Lasting | None:
    """What the motion of a run from rest tends to; None where the run itself, judged alone, is all that is known.

    That is, in this order: the closed form of a linear system; at the design wind the attractor that the search there
    saw it end on; anywhere else, unless the run repeats every period, the attractor that is reached from its end.
    """
    system = history.system
    if not history.outcome.ok or not np.any(system.forcing):
        return None
    if is_linear(system):
        return _closed_form(system, history.frequency)
    if key == DESIGN_WIND and "attractors" in work.done.results:
        return _searched(work.done.results["attractors"], judged)
    return None if judged == "periodic" else _reached(system, history)


def _closed_form(system: System, frequency: float) -> Lasting | None:
    """The response of a linear system, where every free motion dies out."""
    if not linear_growth(system) < 0:
        return None
    try:
        (response,) = periodic_responses_of(system, frequency, None)
    except ParameterError:
        return None
    pipe = response.pipe_peak
    x = response.x(np.linspace(0.0, response.period, _TIMES, endpoint=False)) @ system.output
    sizes = {"pipe_peak": pipe, "pipe_rms": float(np.sqrt(np.mean(x**2))), "pipe_envelope": [pipe, pipe]}
    return Lasting("periodic", 1, sizes | ({"relative_peak": response.relative_peak} if system.elements else {}))


def _searched(rows: list[dict[str, Any]], judged: str) -> Lasting | None:
    for row in rows:
        if row["from_rest"]:
            sizes = {name: row[name] for name in ("pipe_peak", "relative_peak", "pipe_rms", "pipe_envelope")}
            return Lasting(readable.motion(row["kind"]), row["period_multiple"], sizes)
    return None if judged == "periodic" else Lasting("unsettled", 0, {})


def _reached(system: System, history: TimeHistory) -> Lasting | None:
    frequency = history.frequency
    end = np.column_stack([history.x[-1], history.v[-1]]).reshape(1, -1)
    try:
        responses = periodic_responses_of(system, frequency, None)
        periods = settling_periods(system, frequency)
        found = attractors_reached(stroboscope(system, frequency), responses, end, periods)
    except ParameterError:
        return None
    if not found:
        return Lasting("unsettled", 0, {})
    one = found[0]
    sizes = {"pipe_peak": one.pipe_peak, "relative_peak": one.relative_peak, "pipe_rms": one.pipe_rms}
    kind = readable.motion(one.kind)
    return Lasting(kind, one.period_multiple, {**sizes, "pipe_envelope": list(one.envelope)})
