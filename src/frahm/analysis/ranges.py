"""Ranges of detuning read off a response curve: with unstable, without stable, with detached responses."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from frahm.arrays import Floats

if TYPE_CHECKING:
    import xarray as xr

Range = tuple[float, float]
_NARROWEST = 1e-9  # of the window


def unstable_ranges(curve: xr.Dataset) -> list[Range]:
    """Ranges of detuning [rad/s] in which at least one response is unstable."""
    return _ranges(curve, lambda growth: bool(np.any(growth >= 0)))


def ranges_without_stable_response(curve: xr.Dataset) -> list[Range]:
    """Ranges of detuning [rad/s] in which no periodic response is stable."""
    return _ranges(curve, lambda growth: not np.any(growth < 0))


def detached_ranges(curve: xr.Dataset) -> list[Range]:
    """Ranges of detuning [rad/s] over which detached branches exist; overlapping ones are joined."""
    if "detached" not in curve:
        return []
    detuning, branch = curve["detuning"].values, curve["branch"].values
    numbers = np.flatnonzero(curve["detached"].values)
    joined: list[Range] = []
    for lo, hi in sorted((float(detuning[branch == n].min()), float(detuning[branch == n].max())) for n in numbers):
        if joined and lo <= joined[-1][1]:
            lo, hi = joined[-1][0], max(hi, joined.pop()[1])
        joined.append((lo, hi))
    return joined


def growth_rates_at(curve: xr.Dataset, detuning: float) -> Floats:
    """Growth rates [1/s] of all responses at a detuning [rad/s], from the points on both sides of it."""
    sigma, growth = curve["detuning"].values, curve["growth_rate"].values
    same = (np.diff(curve["branch"].values) == 0) & (np.diff(curve["piece"].values) == 0)
    left, right = sigma[:-1], sigma[1:]
    i = np.flatnonzero(same & (np.minimum(left, right) <= detuning) & (np.maximum(left, right) > detuning))
    share = (detuning - left[i]) / (right[i] - left[i])
    return np.asarray((1 - share) * growth[i] + share * growth[i + 1])


def _ranges(curve: xr.Dataset, holds: Callable[[Floats], bool]) -> list[Range]:
    """Ranges between special points in which a statement on the growth rates holds; neighbouring ones are joined.

    Number and stability of the responses change at special points only, so that one look in between is enough.
    """
    sigma = curve["detuning"].values
    if not sigma.size:
        return []
    lo, hi = float(sigma.min()), float(sigma.max())
    special = curve["special_detuning"].values.tolist() if "special_detuning" in curve else []
    found: list[Range] = []
    for a, b in pairwise(sorted({lo, hi, *special})):
        if b - a < _NARROWEST * (hi - lo) or not holds(growth_rates_at(curve, 0.5 * (a + b))):
            continue
        if found and a - found[-1][1] < _NARROWEST * (hi - lo):
            a = found.pop()[0]
        found.append((a, b))
    return found
