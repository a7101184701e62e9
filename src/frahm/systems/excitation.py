"""The frequency axis: detuning or frequency in, excitation frequency out."""

from __future__ import annotations

from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.errors import ParameterError, check_number
from frahm.systems.system import System


def excitation_frequency(system: System, *, detuning: float | None = None, frequency: float | None = None) -> float:
    """Omega [rad/s] from either `detuning` sigma = Omega - omega [rad/s] or `frequency` Omega [rad/s]."""
    if (detuning is None) == (frequency is None):
        raise ParameterError("detuning, frequency", (detuning, frequency), "exactly one of the two")
    if frequency is not None:
        return check_number("frequency", frequency, above=0, unit="rad/s")
    omega = system.reference_frequency
    return omega + check_number("detuning", detuning, above=-omega, unit="rad/s")


def excitation_window(system: System, *, detuning: Any = None, frequency: Any = None) -> tuple[float, float]:
    """Window (lo, hi) of Omega [rad/s] from a window in detuning or frequency; the bounds must ascend."""
    if (detuning is None) == (frequency is None):
        raise ParameterError("detuning, frequency", (detuning, frequency), "exactly one of the two, as (lo, hi)")
    name, window = ("detuning", detuning) if frequency is None else ("frequency", frequency)
    try:
        lo, hi = window
    except (TypeError, ValueError):
        raise ParameterError(name, window, "two numbers (lo, hi) [rad/s]") from None
    start = system.reference_frequency if name == "detuning" else 0.0
    lo = check_number(f"{name}[0]", lo, above=-start, unit="rad/s")
    hi = check_number(f"{name}[1]", hi, above=-start, unit="rad/s")
    if not lo < hi:
        raise ParameterError(name, (lo, hi), "two numbers (lo, hi) with lo < hi [rad/s]")
    return start + lo, start + hi


def detuning_of(system: System, frequency: Floats | float) -> Floats:
    """Detuning sigma [rad/s] of excitation frequencies; NaN where the system has no reference frequency."""
    try:
        return np.asarray(frequency, dtype=float) - system.reference_frequency
    except ParameterError:
        return np.full(np.shape(frequency), np.nan)
