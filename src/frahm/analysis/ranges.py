"""Ranges of detuning read off a response curve: with unstable, without stable, with detached responses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from frahm.arrays import Floats

if TYPE_CHECKING:
    import xarray as xr

Range = tuple[float, float]


def unstable_ranges(curve: xr.Dataset) -> list[Range]:
    """Ranges of detuning [rad/s] in which at least one response is unstable."""
    detuning, place, stable = _by_frequency(curve)
    unstable = np.zeros(detuning.size, dtype=bool)
    np.logical_or.at(unstable, place, ~stable)
    return _runs(detuning, unstable)


def ranges_without_stable_response(curve: xr.Dataset) -> list[Range]:
    """Ranges of detuning [rad/s] in which no periodic response is stable."""
    detuning, place, stable = _by_frequency(curve)
    some = np.zeros(detuning.size, dtype=bool)
    np.logical_or.at(some, place, stable)
    return _runs(detuning, ~some)


def detached_ranges(curve: xr.Dataset) -> list[Range]:
    """Ranges of detuning [rad/s] over which a detached branch exists."""
    if "detached" not in curve:
        return []
    detuning, branch = curve["detuning"].values, curve["branch"].values
    numbers = np.flatnonzero(curve["detached"].values)
    return [(float(detuning[branch == n].min()), float(detuning[branch == n].max())) for n in numbers]


def _by_frequency(curve: xr.Dataset) -> tuple[Floats, np.ndarray, np.ndarray]:
    """Distinct detunings, the place of every point among them, and its stability; folds are left out.

    A fold lies between two frequencies of the grid and stands alone there: it says nothing about the other roots.
    """
    detuning, stable = curve["detuning"].values, curve["stable"].values.astype(bool)
    if "special_detuning" in curve:
        gap = np.abs(detuning[:, None] - curve["special_detuning"].values[None, :])
        keep = np.all(gap > 1e-12 * (1 + np.abs(detuning[:, None])), axis=1)
        detuning, stable = detuning[keep], stable[keep]
    distinct, place = np.unique(detuning, return_inverse=True)
    return distinct, place, stable


def _runs(detuning: Floats, inside: np.ndarray) -> list[Range]:
    """First and last detuning of every run of True that is more than one point long."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], inside.astype(int), [0]])))
    pairs = zip(edges[::2], edges[1::2] - 1, strict=True)
    return [(float(detuning[a]), float(detuning[b])) for a, b in pairs if b > a]
