"""Where over a range of frequencies the largest motion is, between frequencies whose attractors are known.

Gaps beside the largest are halved. In the middle of one the attractors of its ends are carried on, a few motions from
each, and only the sizes of what these show are kept; where the largest is in the end, all attractors are looked for.
"""

from __future__ import annotations

import bisect
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from frahm.arrays import Floats, frozen
from frahm.attractors.attractor import Attractor, AttractorSet
from frahm.attractors.clouds import MEMBERS, STAY, WATCH
from frahm.attractors.stroboscope import Stroboscope
from frahm.tolerances import ALIKE

FINE = 3.3e-4  # how near its neighbours the largest is looked at in the end, of a frequency
_ROUNDS = 24
_NUDGE = 1e-7  # of a state: motions so near each other tell as much as any of a chaotic set


@dataclass(frozen=True, eq=False)
class Carried:
    """What motions from an attractor of another frequency show here.

    Attributes
    ----------
    pipe_peak, relative_peak, pipe_rms : float
        [m].
    basin_fraction : float
        Of the attractor they come from [-].
    representative_state : ndarray, shape (2n,)
        Where one of them ended [m, m/s].
    """

    pipe_peak: float
    relative_peak: float
    pipe_rms: float
    basin_fraction: float
    representative_state: Floats

    def is_like(self, other: Carried) -> bool:
        """Whether the sizes of both agree."""
        pairs = [(size(self), size(other)) for size in (pipe_size, stroke_size, rms_size)]
        return all(abs(a - b) <= ALIKE * max(a, b) for a, b in pairs)


Motion = Attractor | Carried
M = TypeVar("M", bound=Motion)
Size = Callable[[Motion], float]


def pipe_size(motion: Motion) -> float:
    """Largest displacement of the pipe [m]."""
    return motion.pipe_peak


def stroke_size(motion: Motion) -> float:
    """Largest stroke of the first element [m]."""
    return motion.relative_peak


def rms_size(motion: Motion) -> float:
    """Root mean square of the pipe [m]."""
    return motion.pipe_rms


def largest(motions: Mapping[float, Sequence[M]], size: Size, min_basin: float) -> tuple[float, M]:
    """Frequency and attractor of the largest motion that counts."""
    every = [(W, motion) for W in sorted(motions) for motion in motions[W]]
    counting = [
        (W, motion) for W, motion in every if not motion.basin_fraction < min_basin and not np.isnan(size(motion))
    ]
    return max(counting or every, key=lambda item: size(item[1]))


def bracket(
    surveys: dict[float, AttractorSet], survey: Callable[[float, Sequence[Floats]], AttractorSet],
    strobe: Callable[[float], Stroboscope], min_basin: float, sizes: Sequence[Size],
) -> bool:  # fmt: skip
    """Halve the gaps beside the largest until they are fine; whether they are.

    Parameters
    ----------
    surveys : dict
        The attractors by frequency; those of further ones are put in.
    survey : callable
        All attractors at a frequency; further states to start motions from are handed to it.
    strobe : callable
        The stroboscope at a frequency.
    min_basin : float
        Least basin that counts.
    sizes : sequence of callable
        What is to be largest.
    """
    met: dict[float, Sequence[Motion]] = dict(surveys)
    for _ in range(_ROUNDS):
        where = {largest(met, size, min_basin)[0] for size in sizes}
        middles = {middle for W in where for middle in _gaps(met, W)}
        for W in sorted(middles):
            met[W] = _carried(strobe(W), _beside(met, W))
        to_survey = {W for W in middles if not met[W]} if middles else where - surveys.keys()
        if not middles and not to_survey:
            return True
        for W in sorted(to_survey):
            met[W] = surveys[W] = survey(W, [motion.representative_state for motion in met[W]])
    return False


def _gaps(grid: Iterable[float], W: float) -> list[float]:
    """Middles of the gaps beside a frequency of the grid that are not fine."""
    grid = sorted(grid)
    at = grid.index(W)
    return [
        0.5 * (W + grid[other])
        for other in (at - 1, at + 1)
        if 0 <= other < len(grid) and abs(grid[other] - W) > FINE * W
    ]


def _beside(met: Mapping[float, Sequence[Motion]], W: float) -> list[Motion]:
    """What is known at the next frequencies below and above."""
    grid = sorted(met)
    at = bisect.bisect(grid, W)
    return [motion for other in grid[max(at - 1, 0) : at + 1] for motion in met[other]]


def _carried(strobe: Stroboscope, beside: Sequence[Motion]) -> list[Carried]:
    """What motions from each of the attractors `beside` show, of those alike one; nothing if any is lost."""
    starts = np.array([motion.representative_state for motion in beside])
    nudges = 1 + _NUDGE * np.random.default_rng(0).uniform(-1, 1, (MEMBERS, *starts.shape))
    ended = strobe.run((nudges * starts).reshape(-1, starts.shape[1]), STAY + WATCH, window=WATCH)
    if np.any(ended.codes):
        return []
    seen = ended.seen.reshape(MEMBERS, len(beside), -1)
    pipe, stroke, rms = np.max(seen[..., 0], axis=0), np.max(seen[..., 3], axis=0), np.mean(seen[..., 2] ** 2, axis=0)
    kept: list[Carried] = []
    for k in sorted(range(len(beside)), key=lambda k: -beside[k].basin_fraction):
        motion = Carried(
            float(pipe[k]), float(stroke[k]), float(np.sqrt(rms[k])), beside[k].basin_fraction, frozen(ended.states[k])
        )
        if not any(motion.is_like(other) for other in kept):
            kept.append(motion)
    return kept
