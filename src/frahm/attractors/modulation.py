"""What a motion that never repeats is like: its beat, its base frequencies, and whether neighbours stay together.

Largest exponent from renormalised neighbours: Benettin et al. (1980), doi 10.1007/BF02128236.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.stats import t as student

from frahm.arrays import Floats
from frahm.attractors.orbits import orbit_size
from frahm.attractors.stroboscope import Stroboscope

_APART = 1e-7  # distance of neighbours, in sizes of the motion
_STRETCH, _SKIPPED, _STRETCHES = 12, 8, 60  # periods between renormalisations, how many are skipped and counted
_FINE = 1e-11  # tolerance of motions whose growth apart is measured
_LEAST_APART = 1e-9  # share of `_APART`: neighbours are never taken for nearer, so that growth has a logarithm
_LEAST_BEATS = 5  # within the window
_CHAOTIC = 2e-3  # least growth per period that counts as chaos: neighbours e times apart within 500 periods


class Exponent(NamedTuple):
    """Largest Lyapunov exponent [1/s] with its 95 % interval, and whether it says chaos."""

    value: float
    interval: tuple[float, float]
    chaotic: bool


def lyapunov(strobe: Stroboscope, states: Floats) -> Exponent:
    """Largest Lyapunov exponent from the growth between neighbours of states (m, 2n) on the attractor.

    The interval is that of Student's t over the m motions, each followed for 720 periods after 96 of alignment.
    """
    size = orbit_size(strobe, states)
    directions = np.random.default_rng(0).standard_normal(states.shape)
    directions *= _APART / np.linalg.norm(directions, axis=1, keepdims=True)
    growth = np.zeros((_STRETCHES, len(states)))
    for stretch in range(-_SKIPPED, _STRETCHES):
        both = np.concatenate([states, states + directions * size])
        both = strobe.run(both, _STRETCH, tolerance=_FINE).states
        states, apart = both[: len(states)], (both[len(states) :] - both[: len(states)]) / size
        distance = np.linalg.norm(apart, axis=1, keepdims=True)
        distance = np.maximum(distance, _LEAST_APART * _APART)
        directions = apart * _APART / distance
        if stretch >= 0:
            growth[stretch] = np.log(distance[:, 0] / _APART) / _STRETCH
    each = np.mean(growth, axis=0)
    value = float(np.mean(each))
    half = float(student.ppf(0.975, len(each) - 1) * np.std(each, ddof=1) / np.sqrt(len(each)))
    rate = 1 / strobe.period
    return Exponent(value * rate, ((value - half) * rate, (value + half) * rate), value - half > _CHAOTIC)


def beat_frequency(strobe: Stroboscope, members: Floats) -> float:
    """Strongest frequency [rad/s] in the pipe's amplitude, from strobes (m, K, 2n); NaN if it does not vary."""
    output = strobe.system.output
    amplitude = np.hypot(members[..., 0::2] @ output, members[..., 1::2] @ output / strobe.frequency)
    amplitude = amplitude - np.mean(amplitude, axis=1, keepdims=True)
    count = amplitude.shape[1]
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(count) / count)
    power = np.mean(np.abs(np.fft.rfft(window * amplitude, 8 * count, axis=1)) ** 2, axis=0)
    power[: 8 * _LEAST_BEATS] = 0.0  # slower ones cannot be told from a drift
    at = int(np.argmax(power))
    if not power[at] > 0:
        return float("nan")
    return at / (8 * count) * strobe.frequency
