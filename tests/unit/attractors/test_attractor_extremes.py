"""The bound of a motion that never repeats: levels of known distributions, and of motions not seen."""

import pickle

import numpy as np
import pytest
from scipy.stats import genextreme

import frahm
from frahm.attractors.clouds import peaks_of_long_motions
from frahm.attractors.extremes import enough, expected_peak, poisson_interval
from frahm.time_integration import integrate_batch

# Two coordinates and one cubic spring, excited near the first frequency: chaos in bursts.
BURSTS = frahm.System(
    [[1.0, 0.0], [0.0, 0.05]], [[0.006, 0.0], [0.0, 0.0]], [[1.0, 0.0], [0.0, 0.0]], [0.012, 0.0],
    [frahm.Element([-1.0, 1.0], frahm.Cubic(0.05, 0.0005))],
)  # fmt: skip


@pytest.mark.parametrize("k", [0.0, 0.2, 0.5])
def test_the_level_of_a_known_distribution_lies_in_the_interval(k):
    """1 - 1/200 quantile; a bounded motion has k >= 0, in the sign of scipy."""
    distribution = genextreme(k, loc=1.0, scale=0.05)
    truth, random = distribution.ppf(1 - 1 / 200), np.random.default_rng(5)
    levels = [expected_peak(distribution.rvs((64, 20), random_state=random), 200) for _ in range(200)]
    assert np.mean([level.value for level in levels]) == pytest.approx(truth, rel=0.01)
    assert np.mean([level.interval[0] <= truth <= level.interval[1] for level in levels]) >= 0.93
    assert np.mean([level.interval[1] for level in levels]) < truth + 0.2


@pytest.mark.parametrize("kept", [0.5, 0.8])
def test_the_level_of_peaks_that_come_in_bursts_lies_in_the_interval(kept):
    """A peak is kept in the next stretch with a given probability, so that they count for fewer than they are."""
    random, held = np.random.default_rng(2), []
    for _ in range(200):
        peaks = random.uniform(size=(128, 20))
        for at in range(1, 20):
            same = random.uniform(size=128) < kept
            peaks[same, at] = peaks[same, at - 1]
        low, high = expected_peak(peaks, 200).interval
        held.append(low <= 1 - 1 / 200 <= high)
    assert np.mean(held) >= 0.93


def test_two_kinds_of_stretches_do_not_mislead():
    """Rare bursts far above the quiet stretches, on either side of one in two hundred: no tail is fitted to them."""
    random = np.random.default_rng(4)
    for share, truth in ((0.02, 4.9 + 0.2 * 0.75), (0.001, 0.9 + 0.1 * (0.999 - 0.004) / 0.999)):
        held = []
        for _ in range(100):
            burst = random.uniform(size=(64, 20)) < share
            peaks = np.where(burst, random.uniform(4.9, 5.1, (64, 20)), random.uniform(0.9, 1.0, (64, 20)))
            low, high = expected_peak(peaks, 200).interval
            held.append(low <= truth <= high)
        assert np.mean(held) >= 0.93


def test_too_few_stretches_leave_the_level_open_above():
    peaks = np.random.default_rng(0).uniform(size=(8, 20))
    assert expected_peak(peaks, 200).interval[1] == np.inf
    assert not enough(peaks, 200)
    assert enough(np.random.default_rng(0).uniform(size=(64, 20)), 200)


def test_the_level_of_equal_peaks_is_that_peak():
    assert expected_peak(np.full((8, 20), 0.017), 200).interval == pytest.approx((0.017, 0.017))
    assert enough(np.full((8, 20), 0.017), 200)


def test_rates_of_rare_events():
    """Exact Poisson limits (tables): none seen, 0 to 3.689; 5 seen, 1.623 to 11.668."""
    assert poisson_interval(0, 1.0) == pytest.approx((0.0, 3.689), abs=1e-3)
    assert poisson_interval(5, 10.0) == pytest.approx((0.1623, 1.1668), abs=1e-4)


def test_the_peak_is_the_largest_and_the_expected_one_is_exceeded_once_in_its_time():
    found = frahm.find_attractors(BURSTS, frequency=1.0, samples=16)
    chaos = found[0]
    assert chaos.kind == "chaotic"
    assert chaos.pipe_peak == chaos.envelope[1]
    assert chaos.relative_peak == chaos.relative_envelope[1]
    assert chaos.return_time == pytest.approx(10_000 * 2 * np.pi)
    states = np.tile(chaos.representative_state, (40, 1)) * np.random.default_rng(1).uniform(0.999, 1.001, (40, 1))
    states = integrate_batch(BURSTS, frequency=1.0, initial_states=states, periods=500).final_states
    peaks = []
    for _ in range(80):  # windows of 50 periods of motions the package has not seen
        batch = integrate_batch(BURSTS, frequency=1.0, initial_states=states, periods=50, window=50)
        states = batch.final_states
        peaks.append(batch.pipe_peak)
    peaks = np.array(peaks)  # 3200 windows: 16 return times
    low, high = chaos.pipe_peak_expected_interval
    assert 2 <= np.count_nonzero(peaks > chaos.pipe_peak_expected) <= 48
    assert np.count_nonzero(peaks > low) >= 8
    assert np.count_nonzero(peaks > high) <= 32
    windows = peaks.reshape(4, 20, 40).max(axis=1)  # of 1000 periods each, as once was called the peak
    assert np.median(windows) < chaos.pipe_peak
    assert np.mean(windows > chaos.pipe_peak) < 0.25


def test_long_motions_are_followed_only_where_rare_peaks_are_asked_for(monkeypatch):
    followed = []

    def follow(*asked):
        followed.append(asked)
        return peaks_of_long_motions(*asked)

    monkeypatch.setattr("frahm.attractors.finding.peaks_of_long_motions", follow)
    chaos = frahm.find_attractors(BURSTS, frequency=1.0, samples=8)[0]
    assert chaos.kind == "chaotic"
    assert not followed
    low, high = chaos.pipe_peak_expected_interval
    assert low <= chaos.pipe_peak_expected <= high
    assert chaos.relative_peak_expected > 0
    assert len(followed) == 1


def test_rare_peaks_are_found_before_an_attractor_goes_to_another_process():
    """The stroboscope that would find them later holds addresses of this process."""
    chaos = frahm.find_attractors(BURSTS, frequency=1.0, samples=8)[0]
    sent = pickle.dumps(chaos)
    assert b"Stroboscope" not in sent
    assert pickle.loads(sent).pipe_peak_expected_interval == chaos.pipe_peak_expected_interval


def test_the_bound_of_a_periodic_motion_is_its_peak():
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
    found = frahm.find_attractors(case, detuning=-0.144, samples=16)
    for attractor in found:
        assert attractor.pipe_peak_expected == attractor.pipe_peak
        assert attractor.pipe_peak_expected_interval == (attractor.pipe_peak, attractor.pipe_peak)
        assert attractor.relative_peak_expected == attractor.relative_peak
    assert found.to_dataset().pipe_peak_expected.attrs["units"] == "m"


def test_the_bound_of_a_linear_motion_is_its_peak():
    system = frahm.System([[1.0]], [[0.05]], [[1.0]], [0.1])
    worst = frahm.worst_case(system, frequency=(0.8, 1.2)).attractor
    assert worst.pipe_peak_expected == worst.pipe_peak == pytest.approx(2.0, rel=1e-3)
    assert worst.return_time == pytest.approx(10_000 * 2 * np.pi / worst.frequency)
    assert not worst.leaks
