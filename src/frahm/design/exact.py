"""Tier 2: one design by the exact equations, under all disturbances, with the force given and with more of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from frahm.design.disturbance import Disturbance
from frahm.loads import OperatingRange, frequency_range, locking_wind
from frahm.response import ResponseCurve
from frahm.response.exact import exact_curve
from frahm.systems import System

_STEPS = 9
_FINE = 1e-3


@dataclass(frozen=True)
class Windows:
    """Where the response counts and where detached curves are looked for, as Omega [rad/s] of the undisturbed pipe.

    Attributes
    ----------
    window, wide : tuple of float
        Both move with the frequency of the pipe if `moving`; at a fixed lift the wide one always does.
    axis : OperatingRange, optional
        Winds instead: both windows are shedding frequencies, and the force follows the wind. It holds the window of
        every pipe, as far as the site has such winds.
    nominal : OperatingRange, optional
        The range of operation of the undisturbed pipe.
    """

    window: tuple[float, float]
    wide: tuple[float, float]
    moving: bool
    axis: OperatingRange | None = None
    nominal: OperatingRange | None = None

    def at(self, disturbance: Disturbance) -> tuple[tuple[float, float], tuple[float, float]]:
        """Window of the response, and the one in which the complete curve is followed."""
        r = disturbance.pipe_frequency
        scale = r if self.moving else 1.0
        lo, hi = self.window[0] * scale, self.window[1] * scale
        if self.axis is not None:
            first, last = self.axis.frequency
            inside = max(lo, first), min(hi, last)
            return inside, inside
        return (lo, hi), (min(lo, self.wide[0] * r), max(hi, self.wide[1] * r))

    def includes(self, disturbance: Disturbance) -> bool:
        """Whether any wind of the site excites the pipe under a disturbance."""
        if self.nominal is not None and self.nominal.law is not None and math.isfinite(self.nominal.held):
            omega = disturbance.pipe_frequency * self.nominal.reference
            return locking_wind(self.nominal.law, omega, self.nominal.site) is not None
        (lo, hi), _ = self.at(disturbance)
        return lo < hi

    def range(self, disturbance: Disturbance, reference: float = math.nan) -> OperatingRange:
        """Range of operation of a pipe under a disturbance, whose detuning counts from `reference` [rad/s]."""
        if self.nominal is not None and disturbance.pipe_frequency == 1:
            return self.nominal
        window, _ = self.at(disturbance)
        if self.axis is None:
            return frequency_range(*window, reference)
        return replace(self.axis.part(*window), reference=reference)

    def curve(self, system: System, disturbance: Disturbance) -> ResponseCurve:
        """The complete response under a disturbance."""
        _, wide = self.at(disturbance)
        changed = disturbance.of(system)
        return exact_curve(changed, *wide, None, None if self.axis is None else self.axis.factor)


class ExcitedMode(NamedTuple):
    """A pipe with a device, as winds excite one of its modes: the system that mode governs, and where it is judged."""

    system: System
    windows: Windows

    def is_detached(self, disturbance: Disturbance) -> bool:
        """Whether it has a detached curve under a disturbance."""
        return self.windows.includes(disturbance) and has_detached(self.windows.curve(self.system, disturbance))


@dataclass(frozen=True)
class ExactJudgement:
    """What the exact periodic responses of a design come to.

    Attributes
    ----------
    pipe_peak, relative_peak : float
        Largest over all branches, frequencies, modes and disturbances with the force given [m].
    disturbance : Disturbance
    frequency : float
        Where the pipe peak occurs.
    growth_rate : float
        Largest growth rate of a disturbance [1/s], saddles of multivalued responses left out.
    detached : bool
        Whether there is a detached curve with the force given.
    peaks : tuple of float
        Largest pipe peak over the factor on the force [m], for every mode, every force and every disturbance.
    unverified : tuple of str
    """

    pipe_peak: float
    relative_peak: float
    disturbance: Disturbance
    frequency: float
    growth_rate: float
    detached: bool
    peaks: tuple[float, ...]
    unverified: tuple[str, ...]

    @property
    def stable(self) -> bool:
        """Whether every response outside the saddles is stable."""
        return self.growth_rate < 0


def exact_judgement(
    modes: Sequence[ExcitedMode], disturbances: Sequence[Disturbance], forces: Sequence[float] = (1.0,)
) -> ExactJudgement:
    """All periodic responses of a design under all disturbances, with the first of the forces and with the others.

    A response that jumps up before the force has its margin shows in `peaks`.
    """
    looks, given = [], []
    for mode in modes:
        here = [_look(*mode, one, force) for force in forces for one in disturbances]
        looks += here
        given += here[: len(disturbances)]
    worst = max(given, key=lambda look: look.pipe_peak)
    return ExactJudgement(
        pipe_peak=worst.pipe_peak,
        relative_peak=max(look.relative_peak for look in given),
        disturbance=worst.disturbance,
        frequency=worst.frequency,
        growth_rate=max(look.growth_rate for look in looks),
        detached=any(look.detached for look in given),
        peaks=tuple(peak for look in looks for peak in look.peaks),
        unverified=tuple(dict.fromkeys(doubt for look in looks for doubt in look.unverified)),
    )


def _look(system: System, windows: Windows, disturbance: Disturbance, force: float) -> ExactJudgement:
    if not windows.includes(disturbance):
        return ExactJudgement(0.0, 0.0, disturbance, math.nan, -math.inf, False, (0.0,), ())
    window, _ = windows.at(disturbance)
    curve = windows.curve(system, disturbance.at_force(force))
    inside = (curve.frequency >= window[0]) & (curve.frequency <= window[1])
    peak = np.where(inside, curve.pipe_peak, -1.0)
    index = int(np.argmax(peak))
    return ExactJudgement(
        pipe_peak=float(peak[index]),
        relative_peak=float(np.max(np.where(inside, curve.relative_peak, 0.0))),
        disturbance=disturbance,
        frequency=float(curve.frequency[index]),
        growth_rate=_growth(curve, inside),
        detached=has_detached(curve),
        peaks=(float(peak[index]) / force,),
        unverified=curve.unverified,
    )


def has_detached(curve: ResponseCurve) -> bool:
    """Whether a curve has a detached branch (of its own symmetry)."""
    return any(detached and not odd for detached, odd in zip(curve.detached, curve.asymmetric, strict=True))


def conditions_of(
    modes: Sequence[ExcitedMode], disturbances: Sequence[Disturbance]
) -> list[tuple[ExcitedMode, Disturbance]]:
    """Every mode under every disturbance."""
    return [(mode, one) for mode in modes for one in disturbances]


def exact_birth(
    conditions: Sequence[tuple[ExcitedMode, Disturbance]], guess: float, most: float
) -> tuple[float, float]:
    """Largest factor on the force known to be without, and least known to be with a detached curve, around a guess.

    Bisected to a thousandth; (most, inf) if none is met up to `most`. Starts from the guess, so that a detached curve
    that ends again at more force is not stepped over if the guess is near its birth. The first of the conditions is the
    one expected to be critical; the others are asked at the end.
    """

    def detached(at: int, force: float) -> bool:
        mode, one = conditions[at]
        return mode.is_detached(one.at_force(force))

    critical = 0
    for _ in conditions:
        free, taken = _bisected(lambda force, at=critical: detached(at, force), guess, most)  # type: ignore[misc]
        other = next((at for at in range(len(conditions)) if at != critical and detached(at, free)), None)
        if other is None or free == 0.0:
            break
        critical, guess = other, free
    return free, taken


def _bisected(detached: Callable[[float], bool], guess: float, most: float) -> tuple[float, float]:
    step, free, taken = 0.02, math.nan, math.nan
    force = min(max(guess, 0.5), most)
    for _ in range(_STEPS):
        if detached(force):
            taken = force
            if not math.isnan(free):
                break
            force = max(force - step, 0.3)
        else:
            free = force
            if not math.isnan(taken) or force >= most:
                break
            force = min(force + step, most)
        step *= 2
    if math.isnan(taken):
        return free, math.inf
    if math.isnan(free):
        return 0.0, taken
    while taken - free > _FINE:
        middle = 0.5 * (free + taken)
        free, taken = (free, middle) if detached(middle) else (middle, taken)
    return free, taken


def _growth(curve: ResponseCurve, inside: np.ndarray) -> float:
    """Largest growth rate [1/s] in the window, where no saddle-node alone makes the response unstable."""
    kinds = {point.kind for point in curve.special_points}
    counts = inside & np.isfinite(curve.growth_rate)
    if kinds <= {"saddle-node"} and np.any(curve.stable[counts]):
        counts &= curve.stable
    return float(np.max(curve.growth_rate[counts], initial=-math.inf))
