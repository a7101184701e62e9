"""How far the guarantee of a design reaches: tolerances of its parameters, and the slopes at the optimum."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from frahm.design.absorber import DesignedAbsorber
from frahm.design.disturbance import Disturbance
from frahm.design.exact import ExcitedMode, exact_judgement
from frahm.design.objective import Objective
from frahm.design.screening import Screening
from frahm.design.verification import verification

TOLERANCES = (0.005, 0.01, 0.02, 0.03, 0.05, 0.08, 0.1, 0.15)
SLACK = 1.1  # the guarantee holds while the worst peak stays within ten per cent of the promise
_STEP = 0.02
_SAMPLES = 16  # initial states per frequency at the worst corner
_MOST_CORNERS = 16  # as many as two values of four parameters have


@dataclass(frozen=True)
class ToleranceBand:
    """Within which errors of all parameters at once the guarantee holds.

    Attributes
    ----------
    tolerance : float
        Largest relative error [-] of `TOLERANCES` at all whose corners no detached curve exists and the worst pipe peak
        stays within 1.1 of the promise; 0 if not even the smallest.
    pipe_peak : float
        Worst pipe peak at the corners of that tolerance [m].
    corner : DesignedAbsorber
        Where it occurs.
    verified : bool
        Whether the attractors at that corner agree.
    breaks : str
        What ends the band; empty if the largest tolerance is kept.
    corners : int
        Number of corners looked at.
    of_corners : int
        Number of corners there are.
    """

    tolerance: float
    pipe_peak: float
    corner: DesignedAbsorber
    verified: bool
    breaks: str
    corners: int = 0
    of_corners: int = 0


@dataclass(frozen=True)
class Sensitivity:
    """Relative change of the worst pipe peak and of the birth factor over that of one parameter [-]."""

    parameter: str
    pipe_peak: float
    force_margin: float


def tolerance_band(
    design: DesignedAbsorber, promise: float, modes_of: Callable[[DesignedAbsorber], Sequence[ExcitedMode]],
    disturbances: Sequence[Disturbance], seed: int,
) -> ToleranceBand:  # fmt: skip
    """The band by exact responses at all corners, held against attractors at the worst corner."""
    kept = (0.0, promise, design)
    breaks = ""
    for tolerance in TOLERANCES:
        found = []
        for corner in corners(design, tolerance):
            exact = exact_judgement(modes_of(corner), disturbances)
            found.append((exact.pipe_peak, corner, exact.detached))
        peak, worst, _ = max(found, key=lambda item: item[0])
        if any(detached for _, _, detached in found):
            breaks = f"at {100 * tolerance:g} % a detached curve exists at a corner"
        elif peak > SLACK * promise:
            breaks = f"at {100 * tolerance:g} % the worst pipe peak is {peak:.4g} m"
        if breaks:
            break
        kept = tolerance, peak, worst
    tolerance, peak, worst = kept
    seen = verification(
        modes_of(worst), disturbances, Objective(), samples=_SAMPLES, seed=seed, refine=False, quick=True
    )
    agree = seen.verified and seen.pipe_peak <= SLACK * promise
    return ToleranceBand(tolerance, peak, worst, agree, breaks, len(corners(design, 0.0)), 2 ** len(_varied(design)))


def corners(design: DesignedAbsorber, tolerance: float) -> list[DesignedAbsorber]:
    """Designs whose every parameter is off by the tolerance one way or the other.

    All of them; where there are more than `_MOST_CORNERS`, as many drawn from them, the two with all parameters off
    alike among them.
    """
    there = _varied(design)
    return [_off(design, there, signs, tolerance) for signs in _signs(len(there))]


def _varied(design: DesignedAbsorber) -> list[str]:
    """Names of the parameters that can be off: all but places."""
    return [name for name, value in design.parameters.items() if value and name.split("_")[0] != "position"]


def _signs(count: int) -> np.ndarray:
    """Rows (n, count) of -1 and 1."""
    if 2**count <= _MOST_CORNERS:
        return np.array(list(itertools.product((-1, 1), repeat=count)))
    drawn = np.random.default_rng(0).choice((-1, 1), size=(_MOST_CORNERS - 2, count))
    return np.vstack([-np.ones(count), np.ones(count), drawn])


def _off(design: DesignedAbsorber, names: Sequence[str], signs: np.ndarray, tolerance: float) -> DesignedAbsorber:
    for name, sign in zip(names, signs, strict=True):
        design = design.changed(name, 1 + float(sign) * tolerance)
    return design


def sensitivities(
    design: DesignedAbsorber, modes_of: Callable[[DesignedAbsorber], Sequence[ExcitedMode]],
    disturbances: Sequence[Disturbance], screening: Screening, host_mass: float,
) -> tuple[Sensitivity, ...]:  # fmt: skip
    """Slopes over +-2 % of every parameter: peaks by the exact responses, births by the closed form."""
    found = []
    for name in _varied(design):
        ends = [design.changed(name, 1 + sign * _STEP) for sign in (-1, 1)]
        low, high = (exact_judgement(modes_of(end), disturbances).pipe_peak for end in ends)
        rows = host_mass * np.array([end.row for end in ends])
        births = screening.births(rows) if design.nonlinear else np.array([math.inf, math.inf])
        slope = math.log(births[1] / births[0]) / (2 * _STEP) if np.all(np.isfinite(births)) else math.nan
        found.append(Sensitivity(name, math.log(high / low) / (2 * _STEP), slope))
    return tuple(found)
