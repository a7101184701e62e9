"""Stress cycles of an absorber's own springs, from the history of its displacement relative to the pipe."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats, finite_array
from frahm.assessment.rainflow_cycles import Cycles, rainflow_cycles
from frahm.errors import check_number


def transverse_spring_cycles(relative: ArrayLike, length: float, stress_per_extension: float) -> Cycles:
    """Stress cycles of a spring or wire that stands across the motion of the absorber.

    It is stretched by sqrt(L^2 + z^2) - L, twice in every cycle of z: at both ends of the stroke, with nothing between.

    Parameters
    ----------
    relative : array_like, shape (s,)
        Displacement z of the absorber relative to the pipe [m]: samples or turning points.
    length : float
        Length L of the spring at z = 0 [m].
    stress_per_extension : float
        Stress per extension [Pa/m]: E/L for a wire, whose stress is then about E z^2/(2 L^2).
    """
    z = finite_array("relative", relative, (-1,))
    L = check_number("length", length, above=0, unit="m")
    per_metre = check_number("stress_per_extension", stress_per_extension, above=0, unit="Pa/m")
    through = _with_zeros(z)
    extension = through**2 / (np.hypot(L, through) + L)  # sqrt(L^2 + z^2) - L without cancellation
    return rainflow_cycles(per_metre * extension)


def _with_zeros(z: Floats) -> Floats:
    """The history with a zero wherever its sign changes: there the spring is at its shortest."""
    crossings = np.flatnonzero(z[1:] * z[:-1] < 0) + 1
    return np.insert(z, crossings, 0.0)
