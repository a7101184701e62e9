"""Closed-form response of linear systems: the bare pipe, and pipes whose absorbers are all linear."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy.linalg

from frahm.analysis.section import Section, Work
from frahm.arrays import Complexes, Floats, labelled
from frahm.case import Case
from frahm.systems import System, build_system

if TYPE_CHECKING:
    import xarray as xr

_POINTS = 2001


def is_linear(system: System) -> bool:
    """Whether every element has a linear spring."""
    return all(element.law.is_linear for element in system.elements)


def linear_amplitudes(system: System, frequency: Floats) -> Complexes:
    """Complex amplitudes X [m] with x = Re X e^{i Omega t}, shape (points, n); infinite at an undamped resonance."""
    stiffness, damping = _matrices(system)
    W = np.asarray(frequency, dtype=float)[:, None, None]
    dynamic = stiffness - W**2 * system.mass + 1j * W * damping
    forcing = np.broadcast_to(system.forcing.astype(complex)[:, None], (*dynamic.shape[:2], 1))
    try:
        return np.asarray(np.linalg.solve(dynamic, forcing)[..., 0])
    except np.linalg.LinAlgError:
        return np.array([_solved(matrix, system.forcing) for matrix in dynamic])


def bare_amplitude(case: Case, frequency: Floats | float) -> Floats:
    """Amplitude of the pipe without absorbers [m] at Omega [rad/s]; infinite at the resonance without damping."""
    bare = build_system(case.without_absorbers())
    return np.abs(linear_amplitudes(bare, np.atleast_1d(frequency))[:, 0])


def bare_resonance(case: Case) -> tuple[float, float]:
    """Largest amplitude of the pipe without absorbers [m] over all frequencies, and its frequency [rad/s]."""
    pipe = case.pipe
    if pipe.damping_ratio == 0:
        return float("inf"), pipe.frequency
    inside = 1 - 2 * pipe.damping_ratio**2
    frequency = pipe.frequency * float(np.sqrt(inside)) if inside > 0 else 1e-9 * pipe.frequency
    return float(bare_amplitude(case, frequency)[0]), frequency


def without_absorber(work: Work) -> Section:
    """What the pipe does without absorbers, over the window of detuning."""
    case = work.case
    lo, hi = case.analysis.detuning
    detuning = np.linspace(lo, hi, _POINTS)
    amplitude = bare_amplitude(case, case.pipe.frequency + detuning)
    peak, frequency = bare_resonance(case)
    results = {
        "pipe_peak_max": peak,
        "frequency": frequency,
        "detuning": frequency - case.pipe.frequency,
    }
    notes = () if np.isfinite(peak) else ("Without damping the bare pipe has no bounded response at resonance.",)
    return Section(
        results={"without_absorber": results},
        data={"without_absorber": _curve(detuning, case.pipe.frequency, amplitude)},
        notes=notes,
    )


def linear_response(work: Work) -> Section:
    """Exact response of a linear system over the window: there is one response, and no other motion lasts."""
    system, case = work.system, work.case
    lo, hi = case.analysis.detuning
    detuning = np.linspace(lo, hi, _POINTS)
    X = linear_amplitudes(system, system.reference_frequency + detuning)
    pipe = _magnitude(X, system.output)
    curve = _curve(detuning, system.reference_frequency, pipe)
    if system.elements:
        relative = _magnitude(X, system.elements[0].direction)
        curve["relative_peak"] = labelled("point", relative, "largest relative displacement over a period", "m")
    growth = _growth_rate(system)
    stable = growth < 0
    curve["stable"] = labelled("point", np.full(detuning.size, stable), "locally stable", "1")
    curve["branch"] = labelled("point", np.zeros(detuning.size, dtype=int), "number of the branch", "1")
    curve["piece"] = labelled("point", np.zeros(detuning.size, dtype=int), "piece of the branch inside the window", "1")
    curve.attrs["method"] = "linear"
    found = {"pipe_peak_max": float(np.max(pipe)), "special_points": [], "growth_rate": growth}
    doubt = () if stable else (f"The linear response does not attract: the growth rate is {growth:.3g} 1/s.",)
    return Section(
        results={"response": {"linear": found}},
        data={"response": curve},
        unverified=doubt,
        notes=("All laws of the case are linear: the response is exact, and the only one.",),
    )


def _curve(detuning: Floats, reference: float, pipe: Floats) -> xr.Dataset:
    import xarray as xr

    return xr.Dataset(
        {
            "frequency": labelled("point", reference + detuning, "excitation frequency Omega", "rad/s"),
            "detuning": labelled("point", detuning, "detuning sigma = Omega - omega", "rad/s"),
            "pipe_peak": labelled("point", pipe, "largest pipe displacement over a period", "m"),
        }
    )


def _matrices(system: System) -> tuple[Floats, Floats]:
    """K and C with the linear elements added."""
    stiffness, damping = system.stiffness.copy(), system.damping.copy()
    for element in system.elements:
        n = np.outer(element.direction, element.direction)
        stiffness = stiffness + float(element.law.coefficients[0]) * n
        damping = damping + element.law.damping * n
    return stiffness, damping


def _growth_rate(system: System) -> float:
    """Largest real part of the eigenvalues of the linear system [1/s]."""
    stiffness, damping = _matrices(system)
    zero, one = np.zeros((system.size, system.size)), np.eye(system.size)
    A = np.block([[zero, one], [-stiffness, -damping]])
    B = scipy.linalg.block_diag(one, system.mass)
    return float(np.max(scipy.linalg.eigvals(A, B).real))


def _magnitude(X: Complexes, row: Floats) -> Floats:
    """|row . X| [m]; infinite where an amplitude is."""
    known = np.all(np.isfinite(X), axis=1)
    return np.where(known, np.abs(np.where(known[:, None], X, 0) @ row), np.inf)


def _solved(matrix: Complexes, forcing: Floats) -> Complexes:
    try:
        return np.asarray(np.linalg.solve(matrix, forcing.astype(complex)))
    except np.linalg.LinAlgError:
        return np.full(forcing.size, np.inf + 0j)
