import numpy as np
import pytest

import frahm
from frahm.assessment import constant_range_damage, rainflow_cycles, turning_points
from frahm.published.dnv_rp_c203 import sn_curve


@pytest.mark.parametrize("per_period", [16, 32, 64])
def test_peaks_of_a_sine_between_its_samples(per_period):
    step = 2 * np.pi / per_period
    t = (np.arange(10 * per_period + 1) + 0.37) * step
    points = turning_points(np.sin(t), np.cos(t), step)
    assert points.size == 22  # ten maxima, ten minima, both ends
    assert np.max(np.abs(np.abs(points[1:-1]) - 1)) < step**4 / 384  # the error of cubic Hermite interpolation


def test_two_extremes_between_two_samples():
    """The cubic s (1 - s) (1 - 2 s) between two zeros turns at (3 -+ sqrt 3)/6."""
    points = turning_points([0.0, 0.0], [1.0, 1.0], 1.0)
    s = np.array([3 - np.sqrt(3), 3 + np.sqrt(3)]) / 6
    assert points == pytest.approx([0.0, *(s * (1 - s) * (1 - 2 * s)), 0.0])


def test_a_constant_and_a_straight_line_have_no_turning_points():
    assert turning_points([2.0, 2.0, 2.0], [0, 0, 0], 0.1).tolist() == [2.0]
    assert rainflow_cycles([2.0, 2.0, 2.0]).power_sum(3) == 0
    assert turning_points([0.0, 1.0, 2.0], [1, 1, 1], 1.0).tolist() == [0.0, 2.0]


@pytest.mark.parametrize("stress", [20e6, 49.2e6, 52.63e6, 120e6])
def test_constant_amplitude(stress):
    """A thousand cycles of one range: rainflow counting and the curve itself agree."""
    curve, periods = sn_curve("D"), 1000
    t = np.linspace(0, 2 * np.pi * periods, 32 * periods + 1)
    points = turning_points(0.5 * stress * np.cos(t), -0.5 * stress * np.sin(t), t[1])
    assert rainflow_cycles(points).damage(curve) == pytest.approx(periods / float(curve.cycles(stress)), rel=1e-5)
    assert constant_range_damage(curve, stress, periods) == periods / float(curve.cycles(stress))


def test_a_beat_is_more_than_its_mean_and_less_than_its_largest_range():
    curve = sn_curve("D")
    t = np.linspace(0, 2 * np.pi * 400, 400 * 64 + 1)
    beat = 30e6 * (1 + 0.5 * np.cos(t / 40)) * np.cos(t)
    damage = rainflow_cycles(beat).damage(curve)
    assert constant_range_damage(curve, 60e6, 400) < damage < constant_range_damage(curve, 90e6, 400)


@pytest.mark.parametrize("history", [[1.0, np.nan], "abc", [[1.0, 2.0]]])
def test_bad_histories(history):
    with pytest.raises(frahm.ParameterError, match="history"):
        rainflow_cycles(history)
    with pytest.raises(frahm.ParameterError, match="slopes"):
        turning_points([1.0, 2.0], [1.0], 0.1)
