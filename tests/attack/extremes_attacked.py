"""Peaks that a chaotic motion is expected to reach, against peaks of far longer motions."""

from __future__ import annotations

import numpy as np

from brute_force import HIGHEST, scattered, size_of
from frahm.attractors.extremes import expected_peak

STRETCH, DURATION = 50, 10_000  # periods of a stretch and of the return time, as the documentation states them
MEMBERS, LENGTH = 48, 8_000  # motions and the periods each is followed
_FORGOTTEN = 1000  # periods after which the members know nothing of each other
_DRAWS, _EACH, _BLOCK = 40, 12, 20  # samples taken from the long motions: how many, motions of each, stretches together
_ERROR = 1e-4  # of a peak, by parabolas through 64 samples a period
_BATCH = 1000  # periods carried at once


def stretch_peaks(oracle, attractor, frequency, members=MEMBERS, length=LENGTH):
    """Largest displacement of pipe and first element, (m, S, 2), of motions on the attractor that stay on it."""
    states = scattered(np.array(attractor.representative_state), frequency, members, 1e-3)
    states = oracle.watch(states, frequency, _FORGOTTEN, 0).states
    found = []
    for _ in range(length // _BATCH):
        seen = oracle.watch(states, frequency, _BATCH, _BATCH)
        found.append(seen.peaks.reshape(members, -1, STRETCH, 2).max(axis=2))
        states = seen.states
    last, size = seen.strobes[:, -2 * HIGHEST :], size_of(seen.strobes, frequency)[:, None]
    stays = np.isfinite(states).all(axis=1)
    for multiple in range(1, HIGHEST + 1):
        repeats = np.abs(last[:, multiple:] - last[:, :-multiple]) / size
        stays &= ~(np.max(repeats[:, -HIGHEST:], axis=(1, 2)) < 1e-3)
    return np.concatenate(found, axis=1)[stays]


def expected_peaks_attacked(oracle, attractor, frequency):
    """Whether the printed intervals hold the level of the long motions, and how often those of other samples would."""
    peaks = stretch_peaks(oracle, attractor, frequency)
    rows = {"stay": len(peaks)}
    if len(peaks) < MEMBERS // 2:
        return rows
    for column, name in enumerate(("pipe_peak", "relative_peak")):
        level = float(np.quantile(peaks[..., column], 1 - STRETCH / DURATION))
        low, high = getattr(attractor, f"{name}_expected_interval")
        rows[name] = {
            "level": level, "expected": getattr(attractor, f"{name}_expected"), "interval": [low, high],
            "holds": bool((1 - _ERROR) * low <= level <= (1 + _ERROR) * high),
            "coverage": coverage(peaks[..., column], level),
        }  # fmt: skip
    return rows


def coverage(peaks, level, draws=_DRAWS):
    """Share of samples of a quarter of the motions (m, S) whose interval holds the level."""
    random, held = np.random.default_rng(3), 0
    for _ in range(draws):
        chosen = random.choice(len(peaks), _EACH, replace=False)
        low, high = expected_peak(peaks[chosen].reshape(-1, _BLOCK), DURATION / STRETCH).interval
        held += low <= level <= high
    return held / draws
