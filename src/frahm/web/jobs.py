"""What takes longer than a drag of a slider: functions from a case to plain data, run in a process of their own."""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.case import Case, load_case
from frahm.errors import Outcome, ParameterError
from frahm.harmonic_balance import PeriodicResponse
from frahm.tolerances import TINY
from frahm.web.deciding import decision
from frahm.web.scope import Axis, range_of

Progress = Callable[[str, int, int], None]

_SAMPLES_PER_PERIOD = 32
_PERIODS = 600
_LAST_PERIODS = 40
_MOST_POINTS = 1000
_SLIDES = 8  # a period: places of the sliding amplitude


def exact_response(case: Case, progress: Progress) -> dict[str, Any]:
    """Exact response curve by harmonic balance over the range of operation of the case."""
    from frahm.harmonic_balance import is_linear
    from frahm.response import frequency_response
    from frahm.systems import build_system
    from frahm.web.figures import curve_part
    from frahm.web.looks import EXACT_KINDS

    harmonics = case.analysis.harmonics
    curve = frequency_response(case, harmonics=harmonics)
    stable, at = curve.largest(stable_only=True)
    return {
        "part": curve_part("exact", EXACT_KINDS, curve),
        "largest": curve.largest()[0],
        "largest_stable": None if np.isnan(stable) else [stable, float(_place(case, at))],
        "branches": len(curve.branches),
        "detached": sum(branch.detached for branch in curve.branches),
        "linear": is_linear(build_system(case)),
        "unverified": list(curve.unverified),
    }


def _place(case: Case, frequency: float) -> float:
    """Where on the axis of the response a frequency is."""
    within = range_of(case)
    return float(within.speed(frequency)) if within.over_wind else frequency - within.reference


def exact_table(case: Case, progress: Progress) -> dict[str, Any]:
    """The exact response curve as CSV text."""
    from frahm.exchange import csv_text
    from frahm.response import frequency_response

    curve = frequency_response(case, harmonics=case.analysis.harmonics)
    return {"csv": csv_text(curve.to_dataset())}


def motion(
    case: Case, progress: Progress, *, at: float, near: tuple[float | None, float | None] | None = None
) -> dict[str, Any]:
    """Motion of the exact equations at one place of the axis of the response, as a figure.

    Parameters
    ----------
    case : Case
    progress : callable
        Told what is done.
    at : float
        Detuning [rad/s], or the wind speed [m/s] where every wind has its own lift.
    near : tuple of float, optional
        Pipe and relative peak [m] of the periodic response to start on, None for one that does not matter; from rest
        if not given.
    """
    from frahm.analysis.settling import judge
    from frahm.plotting.interactive import motion_plot
    from frahm.response import periodic_responses
    from frahm.time_integration import integrate

    start, about = None, "from rest"
    (case, detuning), hanging = Axis(case).driven(at), bool(case.absorbers)
    if near is not None:
        responses = periodic_responses(case, detuning=detuning, harmonics=case.analysis.harmonics)
        if responses:
            found = min(responses, key=lambda response: _distance(response, near))
            start = found.state
            kind = "stable" if found.stable else "unstable"
            about = f"from the {kind} periodic response with a pipe peak of {found.pipe_peak:.4g} m"
    progress("integrating", 0, 1)
    history = integrate(
        case, detuning=detuning, periods=_PERIODS, initial_state=start, samples_per_period=_SAMPLES_PER_PERIOD
    )
    tail = history.last(_PERIODS // 4) if history.outcome is Outcome.DONE else history
    view = _view(history, tail, judge(history)[0], about, detuning)
    figure = motion_plot(view)
    figure.update_layout(height=None, legend={"yref": "container", "yanchor": "bottom", "y": 0})
    peaks = tail.peaks()
    return {
        "figure": json.loads(figure.to_json()),
        "kind": view.kind,
        "about": about,
        "at": at,
        "pipe_peak": _finite(peaks.pipe),
        "relative_peak": _finite(peaks.relative) if hanging else None,
        "outcome": history.outcome.value if history.outcome is not Outcome.DONE else "",
        "slow": [values.tolist() for values in view.slow] if view.slow else None,
        "history": _table(history),
    }


def _distance(response: PeriodicResponse, near: tuple[float | None, float | None]) -> float:
    """Relative distance of a response from the peaks clicked at."""
    pairs = zip((response.pipe_peak, response.relative_peak), near, strict=True)
    return sum(abs(math.log(max(now, TINY) / max(wanted, TINY))) for now, wanted in pairs if wanted is not None)


def _view(history: Any, tail: Any, kind: str, about: str, detuning: float) -> Any:
    from frahm.analysis.settling import envelope_of
    from frahm.plotting.views import MotionView

    signals = {"x1": history.pipe, "z": history.z}
    period = 2 * np.pi / history.frequency
    envelopes = {name: envelope_of(values, history.samples_per_period) for name, values in signals.items()}
    middles = period * (0.5 + np.arange(envelopes["x1"][0].size))
    window = slice(max(0, history.time.size - _LAST_PERIODS * history.samples_per_period - 1), None)
    spectrum = tail.spectrum()
    shown = spectrum["frequency_hz"].values < 4.0 / period
    names = {"x1": "pipe_amplitude", "z": "relative_amplitude"}
    return MotionView(
        facts={
            "key": "motion", "reason": about, "detuning": detuning, "kind": kind,
            "frequency": history.frequency,
        },
        envelope={name: (middles, low, high) for name, (low, high) in envelopes.items()},
        last={name: _at_most(history.time[window], values[window]) for name, values in signals.items()},
        spectrum={
            name: (spectrum["frequency_hz"].values[shown], spectrum[column].values[shown])
            for name, column in names.items()
        },
        slow=(_amplitude(history, history.z), _amplitude(history, history.pipe)),
    )  # fmt: skip


def _amplitude(history: Any, values: Floats) -> Floats:
    """First-harmonic amplitude [m] over a period that slides along the last part of the history."""
    from frahm.time_integration.signals import sliding_amplitude

    found = sliding_amplitude(values, history.time, history.frequency, history.samples_per_period, _SLIDES)
    return found[-_MOST_POINTS:]


def _at_most(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    every = -(-x.size // _MOST_POINTS)
    return x[::every], y[::every]


def _table(history: Any) -> str:
    """The history as tab-delimited text for other programs."""
    from frahm.exchange import time_history_text

    return time_history_text(history)


def attractors(case: Case, progress: Progress, *, at: float) -> dict[str, Any]:
    """Every long-term motion at one place of the axis, with the share of initial states that leads to it."""
    from frahm.attractors import find_attractors

    settings = case.analysis
    case, detuning = Axis(case).driven(at)
    found = find_attractors(case, detuning=detuning, samples=settings.samples, seed=settings.seed)
    rows = [
        {
            "kind": one.kind,
            "pipe_peak": _finite(one.pipe_peak),
            "relative_peak": _finite(one.relative_peak),
            "basin_fraction": _finite(one.basin_fraction),
            "basin_interval": list(one.basin_interval),
            "from_rest": one.from_rest,
            "outcome": "" if one.outcome is Outcome.DONE else one.outcome.value,
        }
        for one in found
    ]
    return {"at": at, "samples": found.samples, "seed": found.seed, "attractors": rows}


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def report(case: Case, progress: Progress) -> dict[str, Any]:
    """The report of the whole analysis, as HTML text."""
    from frahm.analysis import analyse
    from frahm.report import write_report

    analysis = analyse(case, progress=progress)
    progress("figures and report", 1, 1)
    with tempfile.TemporaryDirectory(prefix="frahm-") as folder:
        text = write_report(analysis, Path(folder)).read_text(encoding="utf-8")
    return {"html": text, "verified": analysis.verified, "verdict": analysis.verdict}


def first_sink(case: Case, progress: Progress) -> dict[str, Any]:
    """A cubic sink of 2 % of the pipe's mass, the best by one harmonic; the search of `frahm design` starts there."""
    from frahm.design.absorber import with_design
    from frahm.design.problem import Problem
    from frahm.design.search import Corrections
    from frahm.design.settings import settings_for
    from frahm.web.tuned import MASS_RATIO

    problem = Problem.of(case, settings_for(case, MASS_RATIO))
    tier = problem.tier("sink")
    best = tier.best(problem.limits, Corrections())
    if best is None:
        raise ParameterError("absorbers", "none", f"a sink that keeps {tier.binding(problem.limits)}")
    return {"case": with_design(case, tier.space.absorber(best[0]), "sink").to_dict()}


def warm_up(case: Case, progress: Progress) -> dict[str, Any]:
    """Load what the quick jobs need, so that the first one does not have to."""
    exact_response(case, progress)
    motion(case, progress, at=Axis(case).start)
    return {}


JOBS: dict[str, Callable[..., dict[str, Any]]] = {
    "exact response": exact_response,
    "exact table": exact_table,
    "motion": motion,
    "attractors": attractors,
    "decision": decision,
    "first sink": first_sink,
    "report": report,
    "warm-up": warm_up,
}


def do(name: str, case: dict[str, Any], arguments: dict[str, Any], progress: Progress) -> dict[str, Any]:
    """Run a job by name on a case given as plain data."""
    return JOBS[name](load_case(case), progress, **arguments)
