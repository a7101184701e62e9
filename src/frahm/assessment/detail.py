"""The detail whose damage is counted: how its hot-spot stress follows from the motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats, frozen
from frahm.case import Case, Fatigue
from frahm.errors import ParameterError
from frahm.published.dnv_rp_c203 import SNCurve, sn_curve
from frahm.systems import build_system, stress_row, stress_rows


@dataclass(frozen=True, eq=False)
class Detail:
    """Hot-spot stress = factor (row . x), x the coordinates of the system of the case.

    Attributes
    ----------
    curve : SNCurve
    factor : float
        Stress concentration factor times thickness factor [-].
    row : ndarray, shape (n,)
        Nominal stress per coordinate [Pa/m].
    section : float or None
        Position along the pipe [m]; None for a pipe given as one mode.
    """

    curve: SNCurve
    factor: float
    row: Floats
    section: float | None

    def with_place(self, section: float, row: Floats) -> Detail:
        """The same detail at another section."""
        return Detail(self.curve, self.factor, row, section)


def fatigue_section(case: Case) -> Fatigue:
    """Section `fatigue` of a case, or the refusal."""
    if case.fatigue is None:
        hint = "Name at least the S-N curve: fatigue: {curve: D, ...}."
        raise ParameterError("fatigue", None, "a case with the section fatigue", hint=hint)
    return case.fatigue


def detail_of(case: Case) -> Detail:
    """Detail of a case: at its section, or where the governing mode alone causes the largest stress."""
    fatigue = fatigue_section(case)
    curve = sn_curve(fatigue.curve)
    thick = curve.thickness_factor(fatigue.thickness, fatigue.reference_thickness, fatigue.stress_concentration)
    factor = fatigue.stress_concentration * thick
    if fatigue.stress_per_displacement is not None:
        system = build_system(case)
        return Detail(curve, factor, frozen(fatigue.stress_per_displacement * system.output), None)
    section = case.pipe.modal.most_stressed if fatigue.position is None else fatigue.position
    return Detail(curve, factor, frozen(stress_row(case, section)), section)


def other_places(case: Case) -> tuple[Floats, Floats] | None:
    """Sections [m] and rows [Pa/m] all along the pipe to look for a larger stress; None if one section is given."""
    fatigue = fatigue_section(case)
    if fatigue.stress_per_displacement is not None or fatigue.position is not None:
        return None
    sections, rows = stress_rows(case)
    return np.asarray(sections), np.asarray(rows)
