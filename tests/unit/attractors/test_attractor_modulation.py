"""Exponents and beats of motions where they are known exactly or were computed by others."""

import numpy as np
import pytest

import frahm
from frahm.attractors.attractor import clopper_pearson
from frahm.attractors.modulation import beat_frequency, lyapunov
from frahm.attractors.stroboscope import stroboscope


def ueda(damping=0.05, force=7.5):
    """Ueda's oscillator x'' + k x' + x^3 = B cos t."""
    return frahm.System(
        [[1.0]], [[damping]], [[0.0]], [force], [frahm.Element([1.0], frahm.Cubic(1.0))], reference_frequency=1.0
    )


def test_exponent_of_uedas_chaos():
    strobe = stroboscope(ueda(), 1.0)
    states = strobe.run(np.random.default_rng(0).uniform(-2, 2, (8, 2)), 200).states
    exponent = lyapunov(strobe, states)
    assert exponent.chaotic
    assert 0.08 < exponent.value < 0.13  # 0.1034: Sprott, Chaos and Time-Series Analysis (2003)
    assert exponent.interval[0] < exponent.value < exponent.interval[1]


def test_exponent_of_a_damped_linear_oscillator_is_its_decay():
    system = frahm.System([[1.0]], [[0.1]], [[1.0]], [1.0])
    exponent = lyapunov(stroboscope(system, 1.3), np.random.default_rng(0).standard_normal((8, 2)))
    assert exponent.value == pytest.approx(-0.05, rel=0.02)
    assert not exponent.chaotic


def test_beat_of_a_given_modulation():
    strobe = stroboscope(frahm.System([[1.0]], [[0.1]], [[1.0]], [1.0]), 2.0)
    turns = np.arange(1000)
    amplitude = 1 + 0.4 * np.cos(2 * np.pi * turns / 37.0 + 1.0) + 0.2 * np.cos(4 * np.pi * turns / 37.0)
    phase = 0.3 * np.sin(2 * np.pi * turns / 37.0)
    strobes = np.stack([amplitude * np.cos(phase), -2.0 * amplitude * np.sin(phase)], axis=-1)[None]
    assert beat_frequency(strobe, strobes) == pytest.approx(2.0 / 37.0, rel=5e-3)


@pytest.mark.parametrize(
    ("hits", "samples", "low", "high"),
    # Clopper and Pearson (1934) as tabulated for 95 %: 0 of 10, 1 of 10, 5 of 10, 10 of 10.
    [(0, 10, 0.0, 0.3085), (1, 10, 0.0025, 0.4450), (5, 10, 0.1871, 0.8129), (10, 10, 0.6915, 1.0)],
)
def test_intervals_of_clopper_and_pearson(hits, samples, low, high):
    np.testing.assert_allclose(clopper_pearson(hits, samples), (low, high), atol=1e-4)
