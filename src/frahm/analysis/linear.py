"""Closed-form response of linear systems: the bare pipe, and pipes whose absorbers are all linear.

An undamped resonance is part of it, with an infinite amplitude.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import minimize_scalar

from frahm.analysis.curve_summary import summary_of
from frahm.analysis.section import Section, Work
from frahm.arrays import Complexes, Floats, labelled
from frahm.assessment import with_stress
from frahm.attractors import WorstMotion, joined, worst_over
from frahm.case import Case
from frahm.harmonic_balance import linear_growth, resonant_grid
from frahm.harmonic_balance.condensation import linear_part
from frahm.loads import OperatingRange, other_ranges
from frahm.response import ResponseCurve, with_winds
from frahm.systems import System, build_system

if TYPE_CHECKING:
    import xarray as xr


def linear_amplitudes(system: System, frequency: Floats) -> Complexes:
    """Complex amplitudes X [m] with x = Re X e^{i Omega t}, shape (points, n); infinite at an undamped resonance."""
    damping, stiffness = linear_part(system)
    W = np.asarray(frequency, dtype=float)[:, None, None]
    dynamic = stiffness - W**2 * system.mass + 1j * W * damping
    forcing = np.broadcast_to(system.forcing.astype(complex)[:, None], (*dynamic.shape[:2], 1))
    try:
        return np.asarray(np.linalg.solve(dynamic, forcing)[..., 0])
    except np.linalg.LinAlgError:
        return np.array([_solved(matrix, system.forcing) for matrix in dynamic])


def bare_amplitude(case: Case, frequency: Floats | float, within: OperatingRange | None = None) -> Floats:
    """Amplitude of the pipe without absorbers [m] at Omega [rad/s]; infinite at the resonance without damping.

    With the lift of the wind of the case, or with that of every wind of a range.
    """
    bare, W = build_system(case.without_absorbers()), np.atleast_1d(np.asarray(frequency, dtype=float))
    return _factors(within, W) * _magnitude(linear_amplitudes(bare, W), bare.output)


def _factors(within: OperatingRange | None, frequency: Floats) -> Floats:
    if within is None or not within.over_wind:
        return np.ones(frequency.size)
    return np.array([within.lift_factor(float(W)) for W in frequency])


def bare_resonance(case: Case) -> tuple[float, float]:
    """Largest amplitude of the pipe without absorbers [m] at the resonance of its governing mode, and its frequency.

    The other modes of an elastic pipe take part; the frequency [rad/s] is within 1e-9 of the largest amplitude.
    """
    pipe = case.pipe
    if pipe.damping_ratio == 0:
        driven = build_system(case.without_absorbers()).forcing[0]
        return float("inf") if driven else 0.0, pipe.frequency
    inside = 1 - 2 * pipe.damping_ratio**2
    frequency = pipe.frequency * float(np.sqrt(inside)) if inside > 0 else 1e-9 * pipe.frequency
    if pipe.modal.count > 1:
        frequency = _summit(case, frequency)
    return float(bare_amplitude(case, frequency)[0]), frequency


def _summit(case: Case, frequency: float) -> float:
    """Frequency of the largest amplitude near the resonance of one mode [rad/s], where others shift it a little."""
    width = 2 * case.pipe.damping_ratio * case.pipe.frequency
    found = minimize_scalar(
        lambda W: -float(bare_amplitude(case, W)[0]), method="bounded", options={"xatol": 1e-9 * frequency},
        bounds=(max(frequency - width, 1e-9 * frequency), frequency + width),
    )  # fmt: skip
    return float(found.x)


def without_absorber(work: Work) -> Section:
    """What the pipe does without absorbers, over the range of operation."""
    case, within = work.case, work.range
    bare = build_system(case.without_absorbers())
    W = resonant_grid(bare, *within.frequency)
    amplitude = bare_amplitude(case, W, within)
    found: dict[str, Any] = {}
    peak, frequency = bare_resonance(case)
    if np.isfinite(peak):
        worst = bare_worst(work)
        found = {"worst": worst.row()}
        if within.over_wind:
            peak, frequency = worst.pipe_peak, worst.frequency
    results = {
        "pipe_peak_max": peak,
        "frequency": frequency,
        "detuning": frequency - case.pipe.frequency,
        **found,
    }
    notes = () if np.isfinite(peak) else ("Without damping the bare pipe has no bounded response at resonance.",)
    return Section(
        results={"without_absorber": results},
        data={"without_absorber": _curve(W, case.pipe.frequency, amplitude, within)},
        notes=notes,
    )


def bare_worst(work: Work) -> WorstMotion:
    """Worst motion without absorbers over the range of operation, every mode that winds of the site excite included."""
    return joined([motion for _, motion in bare_motions(work)])


def bare_motions(work: Work) -> list[tuple[Case, WorstMotion]]:
    """Worst motion without absorbers in the range of operation, and in each other range that winds of the site excite.

    Each with the case whose governing mode the lift is in step with.
    """
    parts = [(work.case, work.range), *others_of(work)]
    bare = [(case.without_absorbers() if case.absorbers else case, part) for case, part in parts]
    return [(case, with_stress(case, worst_over(build_system(case), part, samples=1, min_basin=0.0, seed=1)))
            for case, part in bare]  # fmt: skip


def others_of(work: Work) -> tuple[tuple[Case, OperatingRange], ...]:
    """What else winds of the site excite, see `frahm.loads.other_ranges`; nothing if the range was given."""
    return other_ranges(work.case) if work.range.moves else ()


def linear_response(work: Work) -> Section:
    """Exact response of a linear system over the window: there is one response, and no other motion lasts."""
    system, within = work.system, work.range
    W = resonant_grid(system, *within.frequency)
    detuning = W - system.reference_frequency
    X, factors = linear_amplitudes(system, W), _factors(within, W)
    pipe = factors * _magnitude(X, system.output)
    relative = factors * _magnitude(X, system.elements[0].direction if system.elements else np.zeros(system.size))
    growth, none = linear_growth(system), np.zeros(W.size, dtype=int)
    inventory = "All laws of the case are linear: the response is exact, and the only one."
    curve = ResponseCurve(
        frequency=W, detuning=detuning, pipe_amplitude=pipe,
        relative_amplitude=relative, pipe_peak=pipe, relative_peak=relative, branch=none, piece=none,
        stable=np.full(W.size, growth < 0), growth_rate=np.full(W.size, growth), detached=(False,),
        asymmetric=(False,), special_points=(), unverified=(), system=system.name,
        settings={"method": "harmonic-balance", "harmonics": 1, "inventory": inventory},
    )  # fmt: skip
    curve = with_winds(curve, within) if within.over_wind else curve
    found = summary_of(curve) | {"inventory": inventory, "harmonics": 1, "growth_rate": growth}
    data = curve.to_dataset() if system.elements else _without_stroke(curve)
    doubt = () if growth < 0 else (f"The linear response does not attract: the growth rate is {growth:.3g} 1/s.",)
    return Section(
        results={"response": {"harmonic-balance": found}},
        data={"response": data},
        unverified=doubt,
        notes=(inventory,),
    )


def _without_stroke(curve: ResponseCurve) -> xr.Dataset:
    """The curve of a pipe that carries nothing that could move relative to it."""
    return curve.to_dataset().drop_vars(["relative_amplitude", "relative_peak", "special_relative_peak"])


def _curve(W: Floats, reference: float, pipe: Floats, within: OperatingRange) -> xr.Dataset:
    import xarray as xr

    wind = {"wind_speed": labelled("point", within.speed(W), "wind speed U", "m/s")} if within.over_wind else {}
    return xr.Dataset(
        {
            "frequency": labelled("point", W, "excitation frequency Omega", "rad/s"),
            "detuning": labelled("point", W - reference, "detuning sigma = Omega - omega", "rad/s"),
            "pipe_peak": labelled("point", pipe, "largest pipe displacement over a period", "m"),
            **wind,
        }
    )


def _magnitude(X: Complexes, row: Floats) -> Floats:
    """|row . X| [m]; infinite where an amplitude is."""
    known = np.all(np.isfinite(X), axis=1)
    return np.where(known, np.abs(np.where(known[:, None], X, 0) @ row), np.inf)


def _solved(matrix: Complexes, forcing: Floats) -> Complexes:
    try:
        return np.asarray(np.linalg.solve(matrix, forcing.astype(complex)))
    except np.linalg.LinAlgError:
        return np.full(forcing.size, np.inf + 0j)
