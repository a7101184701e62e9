"""Attractors by brute force: many random states, each carried by the oracle and known by what it shows in the end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.attractors.regions import states_of

WINDOW = 256  # periods a motion is looked at in the end
HIGHEST = 64  # multiples of the period at which it may repeat
MOST = 16  # multiples of the period up to which what repeats is no locked beat
_REPEATS = 1e-4  # distance of strobes, in sizes of the motion: what repeats is periodic
NEARLY = 0.03  # the same of a motion that still approaches an orbit
ALIKE = 0.02  # of peaks that are one
_STRETCH, _ALIGNED, _APART = 10, 20, 1e-7  # of the Lyapunov exponent: periods, stretches, distance


@dataclass(frozen=True)
class Ends:
    """How N motions end.

    `states` (N, 2n) the last ones; `multiple` (N,) periods after which each repeats, 0 if it does not; `nearly` the
    same to 3 %; `looks` (N, 4) largest and mean peak of a period of pipe and first element; `lost` (N,) not finite.
    """

    states: np.ndarray
    multiple: np.ndarray
    nearly: np.ndarray
    looks: np.ndarray
    lost: np.ndarray

    def __getitem__(self, at):
        return Ends(self.states[at], self.multiple[at], self.nearly[at], self.looks[at], self.lost[at])


def random_states(system, region, count, random):
    """`count` states of a region."""
    return states_of(system, {name: random.uniform(lo, hi, count) for name, (lo, hi) in region.items()})


def ends(oracle, states, frequency, periods, factor=1.0):
    """How motions from the states (N, 2n) end."""
    seen = oracle.watch(states, frequency, periods, WINDOW, factor)
    lost = ~np.isfinite(seen.states).all(axis=1)
    return Ends(seen.strobes[:, -1], *repeating(seen.strobes, frequency), looks_of(seen.peaks), lost)


def repeating(strobes, frequency):
    """Periods after which each of the motions with strobes (N, K, 2n) repeats, and nearly repeats; 0 for none."""
    sizes, last = size_of(strobes, frequency), strobes[:, -HIGHEST:]
    distance = np.empty((len(strobes), HIGHEST))
    for multiple in range(1, HIGHEST + 1):
        before = strobes[:, -HIGHEST - multiple : -multiple]
        distance[:, multiple - 1] = np.max(np.abs(last - before) / sizes[:, None], axis=(1, 2))
    return _first(distance < _REPEATS), _first(distance < NEARLY)


def looks_of(peaks):
    """Largest and mean peak of a period (N, 4) of pipe and first element, of peaks (N, K, 2)."""
    largest, mean = peaks.max(axis=1), peaks.mean(axis=1)
    return np.stack([largest[:, 0], mean[:, 0], largest[:, 1], mean[:, 1]], axis=1)


def size_of(strobes, frequency):
    """Size (N, 2n) of displacements and velocities of motions with strobes (N, K, 2n)."""
    displacement = np.max(np.abs(strobes[..., 0::2]), axis=(1, 2))
    velocity = np.max(np.abs(strobes[..., 1::2]), axis=(1, 2)) / frequency
    size = np.maximum(displacement, velocity)
    return np.tile(np.stack([size, size * frequency], axis=1), strobes.shape[2] // 2)


def _first(repeats):
    return np.where(repeats.any(axis=1), 1 + np.argmax(repeats, axis=1), 0)


def looks_apart(looks, others):
    """Largest difference of looks (..., 4), over the peak of pipe or element that it belongs to."""
    peaks = np.maximum(looks[..., [0, 0, 2, 2]], others[..., [0, 0, 2, 2]])
    return np.max(np.abs(looks - others) / np.maximum(peaks, 1e-300), axis=-1)


def exponent(oracle, states, frequency, counted=200):
    """Largest Lyapunov exponent per period of the forcing from neighbours of the states, and its standard error.

    It is that of `counted` stretches of ten periods, of the motions that have not come to an orbit by then.
    """
    size = size_of(states[:, None], frequency)
    random = np.random.default_rng(1).standard_normal(states.shape)
    apart = random / np.linalg.norm(random, axis=1, keepdims=True)
    growth = []
    for stretch in range(_ALIGNED + counted):
        seen = oracle.watch(np.concatenate([states, states + _APART * apart * size]), frequency, _STRETCH, 0)
        states, beside = np.split(seen.states, 2)
        apart = (beside - states) / size
        distance = np.linalg.norm(apart, axis=1, keepdims=True)
        apart /= distance
        if stretch >= _ALIGNED:
            growth.append(np.log(distance[:, 0] / _APART) / _STRETCH)
    last = oracle.watch(states, frequency, 2 * HIGHEST, 2 * HIGHEST).strobes
    multiple = repeating(last, frequency)[0]
    each = np.mean(growth, axis=0)[(multiple == 0) | (multiple > MOST)]
    return float(np.mean(each)), float(np.std(each, ddof=1) / np.sqrt(len(each)))


def scattered(state, frequency, count, amount, seed=0):
    """`count` states beside one, by `amount` of its size."""
    size = size_of(state[None, None], frequency)
    return state + amount * size * np.random.default_rng(seed).standard_normal((count, state.size))
