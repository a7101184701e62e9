"""Tier 3: a finalist against all attractors, at every frequency error, with the force given and with its margin."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from frahm.attractors import WorstCase, find_attractors, worst_case
from frahm.design.exact import Windows, disturbed, exact_judgement
from frahm.errors import Outcome
from frahm.harmonic_balance import is_linear
from frahm.response import ResponseCurve, frequency_response
from frahm.systems import System

_REFINEMENTS = 4
_MOST_POINTS = 6  # special points looked at on both sides in a glimpse, the largest first
_BESIDE = 3e-3
_CLOSE = 0.006  # frequency errors nearer than this are one


@dataclass(frozen=True)
class Verification:
    """The worst of all attractors of one design.

    Attributes
    ----------
    pipe_peak, relative_peak, pipe_rms : float
        Largest over all attractors, frequencies and frequency errors [m].
    error, frequency : float
        Where the pipe peak occurs.
    kind : str
        Of the attractor that causes it.
    verified : bool
    unverified : tuple of str
        What speaks against it.
    samples : int
        Initial states per frequency; 0 where the equations are linear and the response is unique.
    searched : int
        Frequencies searched, all errors together.
    tier : str
        What the numbers rest on.
    """

    pipe_peak: float
    relative_peak: float
    error: float
    frequency: float
    kind: str
    verified: bool
    unverified: tuple[str, ...]
    samples: int
    searched: int
    tier: str


def verification(
    system: System,
    windows: Windows,
    errors: Sequence[float],
    *,
    samples: int,
    seed: int,
    force: float = 1.0,
    min_basin: float = 0.01,
    periods: int = 3000,
    refine: bool = True,
) -> Verification:
    """Worst case over all attractors at every frequency error, with more errors beside the worst one.

    Raises
    ------
    KeyboardInterrupt
        If the search was interrupted.
    """
    if is_linear(system):
        return _linear(system, windows, errors, force)
    found: dict[float, WorstCase] = {}

    def look(error: float) -> None:
        window, _ = windows.at(error)
        worst = worst_case(
            disturbed(system, error, force), frequency=window, samples=samples, seed=seed, min_basin=min_basin,
            periods=periods,
        )  # fmt: skip
        if Outcome.INTERRUPTED.value in worst.unverified:
            raise KeyboardInterrupt
        found[error] = worst

    for error in errors:
        look(float(error))
    for _ in range(_REFINEMENTS if refine and len(errors) > 1 else 0):
        middles = _beside_worst(found)
        if not middles:
            break
        for error in middles:
            look(error)
    return _joined(found, samples)


def glimpse(system: System, windows: Windows, error: float, *, samples: int, seed: int, periods: int) -> Verification:
    """Worst of few frequencies at one frequency error: all periodic responses, and attractors where the worst may be.

    Attractors are looked for at the largest stable responses, beside the special points and in the middle of unstable
    ranges. Cheaper than `verification` and less sure: for tables.

    Raises
    ------
    KeyboardInterrupt
        If the search was interrupted.
    """
    if is_linear(system):
        return _linear(system, windows, [error], 1.0)
    window, wide = windows.at(error)
    changed = disturbed(system, error)
    curve = frequency_response(changed, frequency=wide)
    inside = (curve.frequency >= window[0]) & (curve.frequency <= window[1])
    best, doubts = None, list(curve.unverified)
    places = _telling_frequencies(curve, inside)
    for frequency in places:
        found = find_attractors(changed, frequency=frequency, samples=samples, seed=seed, periods=periods)
        if found.outcome is Outcome.INTERRUPTED:
            raise KeyboardInterrupt
        for attractor in found:
            if attractor.kind == "unsettled":
                doubts.append(f"Some motions did not settle at Omega = {frequency:.6g} rad/s.")
            if best is None or attractor.pipe_peak > best.pipe_peak:
                best = attractor
    stable = inside & curve.stable
    periodic = float(np.max(curve.pipe_peak[stable], initial=0.0))
    stroke = float(np.max(curve.relative_peak[stable], initial=0.0))
    if best is None or best.pipe_peak < periodic:
        at = int(np.argmax(np.where(stable, curve.pipe_peak, -1.0)))
        peak, kind, frequency = periodic, "periodic", float(curve.frequency[at])
    else:
        peak, kind, frequency = best.pipe_peak, best.kind, best.frequency
        stroke = max(stroke, best.relative_peak)
    return Verification(
        peak, stroke, error, frequency, kind, not doubts, tuple(dict.fromkeys(doubts)), samples, len(places),
        "attractors at few frequencies",
    )  # fmt: skip


def _telling_frequencies(curve: ResponseCurve, inside: np.ndarray) -> list[float]:
    """Frequencies at which the worst attractor of a response curve is likely, no two nearer than 0.2 %."""
    wanted: list[float] = []
    for branch in np.unique(curve.branch[inside]):
        here = np.flatnonzero(inside & (curve.branch == branch))
        for state in (True, False):
            part = here[curve.stable[here] == state]
            if part.size:
                wanted.append(float(curve.frequency[part[np.argmax(curve.pipe_peak[part])]]))
                if not state:
                    ends = curve.frequency[part].min(), curve.frequency[part].max()
                    wanted += [float(W) for W in np.linspace(*ends, 5)[1:-1]]
    lo, hi = curve.frequency[inside].min(), curve.frequency[inside].max()
    for point in sorted(curve.special_points, key=lambda point: -point.pipe_peak)[:_MOST_POINTS]:
        wanted += [point.frequency * (1 - _BESIDE), point.frequency * (1 + _BESIDE)]
    chosen: list[float] = []
    for W in wanted:
        if lo <= W <= hi and all(abs(W / other - 1) > 2e-3 for other in chosen):
            chosen.append(W)
    return sorted(chosen)


def _beside_worst(found: dict[float, WorstCase]) -> list[float]:
    """Middles of the gaps beside the worst frequency error."""
    grid = sorted(found)
    at = max(range(len(grid)), key=lambda i: found[grid[i]].pipe_peak)
    neighbours = [grid[i] for i in (at - 1, at + 1) if 0 <= i < len(grid)]
    return [0.5 * (grid[at] + other) for other in neighbours if abs(grid[at] - other) > _CLOSE]


def _joined(found: dict[float, WorstCase], samples: int) -> Verification:
    error = max(sorted(found), key=lambda r: found[r].pipe_peak)
    worst = found[error]
    doubts = tuple(
        dict.fromkeys(
            (f"With the pipe's frequency {100 * (r - 1):+.3g} %: " if len(found) > 1 else "") + sentence
            for r in sorted(found)
            for sentence in found[r].unverified
        )
    )
    return Verification(
        pipe_peak=worst.pipe_peak,
        relative_peak=max(item.relative_peak for item in found.values()),
        error=error,
        frequency=worst.frequency,
        kind=worst.attractor.kind,
        verified=not doubts and math.isfinite(worst.pipe_peak),
        unverified=doubts,
        samples=samples,
        searched=sum(len(item.surveys) for item in found.values()),
        tier="attractor search",
    )


def _linear(system: System, windows: Windows, errors: Sequence[float], force: float) -> Verification:
    """A damped linear system has one response, which attracts every motion: the exact curve is the proof."""
    fine = np.linspace(min(errors), max(errors), 4 * len(errors) - 3) if len(errors) > 1 else np.array(errors)
    exact = exact_judgement(system, windows, [float(r) for r in fine], (force,))
    stable = exact.growth_rate < 0
    doubts = exact.unverified + (() if stable else ("The linear response is not stable.",))
    return Verification(
        exact.pipe_peak, exact.relative_peak, exact.error, exact.frequency, "periodic", not doubts, doubts, 0,
        len(fine), "exact linear response",
    )  # fmt: skip
