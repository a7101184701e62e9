"""The lasting motion that is known without a sample: the one of a linear system."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from frahm.arrays import Floats, frozen
from frahm.attractors.attractor import Attractor, AttractorSet
from frahm.attractors.extremes import DURATION, RarePeaks
from frahm.errors import Outcome
from frahm.harmonic_balance import linear_growth, linear_response
from frahm.loads import OperatingRange
from frahm.response import ResponseCurve
from frahm.systems import System, detuning_of

_EXACT = 1e-12  # relative tolerance of the frequency of a peak


def linear_motions(system: System, curve: ResponseCurve, within: OperatingRange) -> dict[float, AttractorSet]:
    """The motion at the ends of a range and at the largest peaks of pipe and stroke, by frequency [rad/s].

    The peaks are maximised between the points of the curve, so that they do not depend on its points.
    """
    lo, hi = within.frequency
    inside = (curve.frequency >= lo) & (curve.frequency <= hi)
    first = system.elements[0].direction if system.elements else np.zeros(system.size)
    places = {lo, hi}
    for row, peaks in ((system.output, curve.pipe_peak), (first, curve.relative_peak)):
        if np.any(peaks[inside] > 0):
            at = int(np.argmax(np.where(inside, peaks, -1.0)))
            places.add(_summit(_amplitude(system, row, within), curve.frequency, at, lo, hi))
    growth = linear_growth(system)
    return {W: _alone(system, W, within, first, growth) for W in sorted(places)}


def _amplitude(system: System, row: Floats, within: OperatingRange) -> Callable[[float], float]:
    def at(W: float) -> float:
        if not np.any(system.forcing):
            return 0.0
        return abs(complex(linear_response(system, np.array([W]))[0] @ row)) * within.lift_factor(W)

    return at


def _summit(amplitude: Callable[[float], float], grid: Floats, at: int, lo: float, hi: float) -> float:
    from scipy.optimize import minimize_scalar  # takes long to load

    left, right = max(lo, float(grid[max(at - 1, 0)])), min(hi, float(grid[min(at + 1, grid.size - 1)]))
    here = float(grid[at])
    if not left < right:
        return here
    found = minimize_scalar(lambda W: -amplitude(W), bounds=(left, right), method="bounded",
                            options={"xatol": _EXACT * here})  # fmt: skip
    return max((float(found.x), here), key=amplitude)


def _alone(system: System, W: float, within: OperatingRange, first: Floats, growth: float) -> AttractorSet:
    """The one motion at a frequency, as the set of attractors there."""
    factor = within.lift_factor(W)
    X = factor * linear_response(system, np.array([W]))[0] if np.any(system.forcing) else np.zeros(system.size, complex)
    pipe, stroke = abs(complex(X @ system.output)), abs(complex(X @ first))
    state = frozen(np.column_stack([X.real, (1j * W * X).real]).ravel())
    sizes = (pipe, stroke, pipe / math.sqrt(2), stroke / math.sqrt(2))
    alone = _periodic(system, W, sizes, state, growth)
    return AttractorSet((alone,), W, alone.detuning, {}, 0, 0, 0, Outcome.DONE)


def _periodic(system: System, W: float, sizes: tuple[float, ...], state: Floats, growth: float) -> Attractor:
    """The only motion, with the period of the excitation; `sizes` are peaks and rms of pipe and stroke [m]."""
    pipe, stroke, pipe_rms, stroke_rms = sizes
    return Attractor(
        kind="periodic", frequency=W, detuning=float(detuning_of(system, W)), pipe_peak=pipe, relative_peak=stroke,
        rare_peaks=RarePeaks.known(pipe, stroke), return_time=DURATION * 2 * math.pi / W,
        escape_rate=0.0, escape_interval=(0.0, 0.0), pipe_rms=pipe_rms, relative_rms=stroke_rms,
        envelope=(pipe, pipe), relative_envelope=(stroke, stroke), period_multiple=1, beat_period=math.nan,
        frequencies=(W,), lyapunov=growth, lyapunov_interval=(growth, growth), basin_fraction=1.0,
        basin_interval=(1.0, 1.0), representative_state=state, from_rest=False, outcome=Outcome.DONE,
    )  # fmt: skip
