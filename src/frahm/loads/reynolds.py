"""Strouhal number and lift coefficient as functions of the Reynolds number, with their exact slopes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats, frozen
from frahm.case import Wind
from frahm.case.reynolds import LIFT_CURVES, STROUHAL_CURVES, Coefficient, PublishedCurve, reynolds_range

EDGE = 1e-12  # rounding of U D / nu at the edge of a table


@dataclass(frozen=True, eq=False)
class ReynoldsCurve:
    """A coefficient over the Reynolds number: linear in ln Re between its knots, not a number beyond its range.

    Attributes
    ----------
    knots : ndarray, shape (k,)
        Natural logarithms of the Reynolds numbers.
    values : ndarray, shape (k,)
        Coefficient at the knots [-].
    lowest, highest : float
        Reynolds numbers between which it is given; left of the first knot it is constant where it is given.
    standing : str
        "verified", "secondary", or "of the case" for what the user gave.
    source : str
        Where it comes from.
    """

    knots: Floats
    values: Floats
    lowest: float
    highest: float
    standing: str
    source: str

    def inside(self, reynolds: ArrayLike) -> np.ndarray:
        """Whether Reynolds numbers are inside the range."""
        Re = np.asarray(reynolds, dtype=float)
        return (Re >= self.lowest * (1 - EDGE)) & (Re <= self.highest * (1 + EDGE))

    def value(self, reynolds: ArrayLike) -> Floats:
        """Coefficient [-]; NaN beyond the range."""
        Re = np.asarray(reynolds, dtype=float)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.inside(Re), np.interp(np.log(Re), self.knots, self.values), np.nan)

    def slope(self, reynolds: ArrayLike) -> Floats:
        """Derivative by ln Re [-], at a knot that of its right side; NaN beyond the range."""
        Re = np.asarray(reynolds, dtype=float)
        slopes = np.concatenate([[0.0], np.diff(self.values) / np.diff(self.knots), [0.0]])
        if self.knots.size > 1:
            slopes[-1] = slopes[-2]  # at the last knot there is a left side only
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.inside(Re), slopes[np.searchsorted(self.knots, np.log(Re), side="right")], np.nan)


def strouhal_curve(wind: Wind) -> ReynoldsCurve:
    """Strouhal number of a wind over the Reynolds number."""
    return reynolds_curve(wind.strouhal, STROUHAL_CURVES)


def lift_curve(wind: Wind) -> ReynoldsCurve:
    """Amplitude of the lift coefficient of a wind over the Reynolds number."""
    return reynolds_curve(wind.lift_coefficient, LIFT_CURVES)


def reynolds_curve(value: Coefficient, curves: Mapping[str, PublishedCurve]) -> ReynoldsCurve:
    """The curve of a coefficient: a number, a table, or one of the published curves by its name."""
    pairs, standing, source = value, "of the case", "given in the case"
    if isinstance(value, str):
        pairs, standing, source = curves[value].pairs, curves[value].standing, curves[value].source
    table = np.array(pairs if isinstance(pairs, tuple) else [(1.0, pairs)], dtype=float)
    return ReynoldsCurve(
        frozen(np.log(table[:, 0])), frozen(table[:, 1]), *reynolds_range(value, curves), standing, source
    )
