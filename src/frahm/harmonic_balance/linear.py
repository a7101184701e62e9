"""Systems without a nonlinear element, or without forcing: one branch, known in closed form."""

from __future__ import annotations

import numpy as np

from frahm.arrays import Complexes, Floats
from frahm.errors import ParameterError
from frahm.harmonic_balance.condensation import linear_part
from frahm.systems import System

_EVEN, _AROUND = 1001, 201  # points over the range, and around every resonance
_NARROWEST = 1e-9  # of the frequency: half width of a resonance without damping


def is_linear(system: System) -> bool:
    """Whether every element of the system has a linear law."""
    return all(element.law.is_linear for element in system.elements)


def check_rest(system: System) -> None:
    """Refuse a system at rest whose elements carry weight: it sags, and is not linear about where it hangs."""
    if any(element.law.weight for element in system.elements):
        raise ParameterError(
            "forcing", system.forcing.tolist(), "a force that is not zero where an element carries weight",
            hint="Without a force there is nothing but the sag: see frahm.absorbers.sag.",
        )  # fmt: skip


def linear_response(system: System, frequency: Floats) -> Complexes:
    """Complex amplitudes (points, n) [m] of the linear part: x = Re X e^{i Omega t}.

    Raises
    ------
    ParameterError
        If the linear part is undamped and in resonance at one of the frequencies.
    """
    C, K = linear_part(system)
    W = np.asarray(frequency, dtype=float)[:, None, None]
    D = K - W**2 * system.mass + 1j * W * C
    worst = np.max(np.linalg.cond(D)) if W.size else 0.0
    if not worst < 1e14:
        raise ParameterError(
            "damping", "none at a resonance inside the window", "a damped structure, or a window without its resonance",
            hint="An undamped linear structure has no bounded response at its natural frequency.",
        )  # fmt: skip
    return np.asarray(np.linalg.solve(D, system.forcing.astype(complex)[None, :, None])[..., 0])


def linear_exponents(system: System) -> Complexes:
    """Eigenvalues [1/s] of the linear part, elements' linear springs and dampers included."""
    C, K = linear_part(system)
    n = system.size
    inverse = np.linalg.inv(system.mass)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ K, -inverse @ C]])
    return np.asarray(np.linalg.eigvals(A), dtype=complex)


def resonant_grid(system: System, lo: float, hi: float) -> Floats:
    """Frequencies [rad/s] from lo to hi on which a linear response is drawn true to its resonances.

    Evenly spread, and around every eigenvalue -delta + i omega_d of the linear part at omega_d + delta tan(theta) with
    theta evenly spread, which is evenly along the circle that a resonance draws in the complex plane.
    """
    values = linear_exponents(system)
    around = [around_resonance(value.imag, -value.real, _AROUND) for value in values[values.imag > 0]]
    parts = [np.linspace(lo, hi, _EVEN), *around]
    undamped = system.natural_frequencies
    grid = np.unique(np.concatenate([*parts, undamped]))
    return grid[(grid >= lo) & (grid <= hi)]


def around_resonance(omega: float, decay: float, points: int) -> Floats:
    """Frequencies [rad/s] evenly along the circle that a resonance draws in the complex plane."""
    turns = np.tan(np.linspace(-0.5, 0.5, points + 2)[1:-1] * np.pi)
    return np.asarray(omega + max(decay, _NARROWEST * omega) * turns)


def linear_growth(system: System) -> float:
    """Largest growth rate of a disturbance [1/s]; a coordinate that rests wherever it is put does not count."""
    values = linear_exponents(system)
    moving = values[np.abs(values) > 1e-9 * np.max(np.abs(values), initial=1.0)]
    return float(np.max(moving.real, initial=-np.inf))
