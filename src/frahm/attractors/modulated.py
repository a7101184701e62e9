"""`modulated_response`: the envelope of the motion that does not repeat, over a window of the frequency.

Modulated motion is carried from frequency to frequency by the exact equations, upwards and downwards, so that it is
followed to where it ends, also where the motion from rest or the stability of the periodic response say nothing of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from frahm.arrays import Floats, labelled
from frahm.attractors.seeds import jump_states
from frahm.attractors.stroboscope import stroboscope
from frahm.errors import check_count
from frahm.response import ResponseCurve, frequency_response
from frahm.systems import System, as_system, detuning_of, excitation_window

if TYPE_CHECKING:
    import xarray as xr

    from frahm.case import Case

_SETTLE, _WATCH = 600, 400  # periods before the first of two windows, and of each window
_DEPTH, _KEPT = 0.03, 0.7  # least modulation depth, and the share of it that must be left in the second window
_MEMBERS = 8
_BISECTIONS = 10


@dataclass(frozen=True, eq=False)
class _Modulation:
    """Motions that stay modulated: their states (m, 2n) and what they show (m, 6), see `Glimpse.seen`."""

    states: Floats
    seen: Floats


def modulated_response(
    case_or_system: Case | System | str,
    *,
    detuning: tuple[float, float] | None = None,
    frequency: tuple[float, float] | None = None,
    points: int = 61,
    workers: int | None = None,
) -> xr.Dataset:
    """Envelope of modulated (quasi-periodic or chaotic) motion over a window of the excitation frequency.

    At every frequency motions are started from rest, from the jumps of the slow manifold and from the modulated motion
    at the neighbouring frequency. A motion is modulated if the peaks of its periods differ by more than 3 % and still
    do so, undiminished, 400 periods later; so may a subharmonic. The ends of every range are bisected.

    Parameters
    ----------
    case_or_system : Case, System or str
        What is excited.
    detuning, frequency : tuple of float
        Window (lo, hi) of sigma or Omega [rad/s]; give one of the two.
    points : int
        Frequencies over the window; the ends of ranges are added.
    workers : int, optional
        Threads; one per core by default.

    Returns
    -------
    xarray.Dataset
        Over `point`, ascending in `frequency`, where there is modulated motion: `pipe_peak` and `pipe_least_peak`,
        `relative_peak` and `relative_least_peak` [m], the number `range` of the range, and whether a stable periodic
        response coexists.

    Raises
    ------
    ParameterError
        For bad input.
    """
    system = as_system(case_or_system)
    lo, hi = excitation_window(system, detuning=detuning, frequency=frequency)
    points = check_count("points", points, at_least=2, at_most=100_000)
    workers = None if workers is None else check_count("workers", workers, at_most=1024)
    curve = frequency_response(system, frequency=(lo, hi))

    def look(W: float, beside: _Modulation | None) -> _Modulation | None:
        return _modulation(system, W, beside, workers)

    grid = [float(W) for W in np.linspace(lo, hi, points)]
    found = _swept(grid, look)
    ranges = _ranges(grid, found)
    numbers = {W: number for number, run in enumerate(ranges) for W in run}
    for number, run in enumerate(ranges):
        for end, step in ((run[0], -1), (run[-1], 1)):
            at = grid.index(end) + step
            if 0 <= at < len(grid):
                W, motion = _end(end, found[end], grid[at], look)
                found[W], numbers[W] = motion, number
    return _dataset(system, curve, {W: found[W] for W in sorted(numbers)}, numbers)


def _swept(
    grid: list[float], look: Callable[[float, _Modulation | None], _Modulation | None]
) -> dict[float, _Modulation | None]:
    """Modulation at every frequency, first upwards, then downwards where none was met."""
    found: dict[float, _Modulation | None] = {}
    last = None
    for W in grid:
        last = found[W] = look(W, last)
    for W in reversed(grid):
        if found[W] is None and last is not None:
            found[W] = look(W, last)
        last = found[W]
    return found


def _modulation(
    system: System, frequency: float, beside: _Modulation | None, workers: int | None
) -> _Modulation | None:
    strobe = stroboscope(system, frequency, workers)
    starts = [np.zeros((1, 2 * system.size)), jump_states(strobe)]
    if beside is not None:
        starts = [beside.states]
    first = strobe.run(np.concatenate(starts), _SETTLE + _WATCH, window=_WATCH)
    lively = (first.codes == 0) & (_depth(first.seen) > _DEPTH)
    if not np.any(lively):
        return None
    kept = np.flatnonzero(lively)[:_MEMBERS]
    second = strobe.run(first.states[kept], _WATCH, window=_WATCH)
    good = (second.codes == 0) & (_depth(second.seen) > np.maximum(_DEPTH, _KEPT * _depth(first.seen[kept])))
    return _Modulation(second.states[good], second.seen[good]) if np.any(good) else None


def _depth(seen: Floats) -> Floats:
    """Difference of the largest and the smallest peak of a period, relative to the largest."""
    peak = seen[:, 0]
    return np.asarray((peak - seen[:, 1]) / np.where(peak > 0, peak, 1.0))


def _ranges(grid: list[float], found: dict[float, _Modulation | None]) -> list[list[float]]:
    """Runs of neighbouring frequencies with modulation."""
    ranges: list[list[float]] = []
    open_ = False
    for W in grid:
        if found[W] is None:
            open_ = False
            continue
        if not open_:
            ranges.append([])
        ranges[-1].append(W)
        open_ = True
    return ranges


def _end(
    inside: float,
    motion: _Modulation | None,
    outside: float,
    look: Callable[[float, _Modulation | None], _Modulation | None],
) -> tuple[float, _Modulation | None]:
    """Last frequency, towards `outside`, to which the modulation can be carried."""
    for _ in range(_BISECTIONS):
        middle = 0.5 * (inside + outside)
        there = look(middle, motion)
        if there is None:
            outside = middle
        else:
            inside, motion = middle, there
    return inside, motion


def _coexists(curve: ResponseCurve, W: float) -> bool:
    """Whether a stable periodic response exists at Omega = W."""
    neighbours = (
        (curve.branch[:-1] == curve.branch[1:])
        & (curve.piece[:-1] == curve.piece[1:])
        & ((curve.frequency[:-1] - W) * (curve.frequency[1:] - W) <= 0)
    )
    return bool(np.any(neighbours & curve.stable[:-1] & curve.stable[1:]))


def _dataset(
    system: System, curve: ResponseCurve, found: dict[float, _Modulation | None], numbers: dict[float, int]
) -> xr.Dataset:
    import xarray as xr

    from frahm import __version__

    frequency = np.array(list(found))
    seen = [motion.seen for motion in found.values() if motion is not None]
    largest = np.array([np.max(rows, axis=0) for rows in seen]).reshape(-1, 6)
    least = np.array([np.min(rows, axis=0) for rows in seen]).reshape(-1, 6)
    coexists = np.array([_coexists(curve, W) for W in found], dtype=np.int8)
    name = "of a period of the"
    return xr.Dataset(
        {
            "detuning": labelled("point", detuning_of(system, frequency), "detuning", "rad/s"),
            "pipe_peak": labelled("point", largest[:, 0], f"largest peak {name} pipe", "m"),
            "pipe_least_peak": labelled("point", least[:, 1], f"smallest peak {name} pipe", "m"),
            "relative_peak": labelled("point", largest[:, 3], f"largest peak {name} first element", "m"),
            "relative_least_peak": labelled("point", least[:, 4], f"smallest peak {name} first element", "m"),
            "range": labelled("point", np.array([numbers[W] for W in found], dtype=int), "number of the range", "1"),
            "coexists": labelled("point", coexists, "whether a stable periodic response coexists", "1"),
        },
        {"frequency": labelled("point", frequency, "excitation frequency", "rad/s")},
        {"frahm": __version__, "system": system.name, "window": [float(curve.frequency.min(initial=np.inf)),
         float(curve.frequency.max(initial=-np.inf))]},
    )  # fmt: skip
