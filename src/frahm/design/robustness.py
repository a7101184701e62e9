"""How far the guarantee of a design reaches: tolerances of its parameters, and the slopes at the optimum."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

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
_PARAMETERS = ("rho2", "linear", "kappa", "xi2", "quintic")


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
    """

    tolerance: float
    pipe_peak: float
    corner: DesignedAbsorber
    verified: bool
    breaks: str


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
    return ToleranceBand(tolerance, peak, worst, agree, breaks)


def corners(design: DesignedAbsorber, tolerance: float) -> list[DesignedAbsorber]:
    """All designs whose every parameter is off by the tolerance one way or the other."""
    there = [name for name in _PARAMETERS if getattr(design, name)]
    return [
        replace(
            design, **{name: getattr(design, name) * (1 + s * tolerance) for name, s in zip(there, sign, strict=True)}
        )
        for sign in itertools.product((-1, 1), repeat=len(there))
    ]


def sensitivities(
    design: DesignedAbsorber, modes_of: Callable[[DesignedAbsorber], Sequence[ExcitedMode]],
    disturbances: Sequence[Disturbance], screening: Screening, host_mass: float,
) -> tuple[Sensitivity, ...]:  # fmt: skip
    """Slopes over +-2 % of every parameter: peaks by the exact responses, births by the closed form."""
    found = []
    for name in _PARAMETERS:
        value = getattr(design, name)
        if not value:
            continue
        ends = [replace(design, **{name: value * (1 + sign * _STEP)}) for sign in (-1, 1)]
        low, high = (exact_judgement(modes_of(end), disturbances).pipe_peak for end in ends)
        rows = np.array([[host_mass * getattr(end, key) for key in _PARAMETERS] for end in ends])
        births = screening.births(rows) if design.nonlinear else np.array([math.inf, math.inf])
        slope = math.log(births[1] / births[0]) / (2 * _STEP) if np.all(np.isfinite(births)) else math.nan
        found.append(Sensitivity(name, math.log(high / low) / (2 * _STEP), slope))
    return tuple(found)
