import numpy as np
import pytest

import frahm
from frahm.errors import Outcome
from frahm.time_integration import integrate_batch


@pytest.fixture(scope="module")
def states():
    random = np.random.default_rng(7)
    x, v = random.uniform(-0.08, 0.08, 21), random.uniform(-0.4, 0.4, 21)
    return np.stack([x, v, x, v], axis=1)


def test_a_lane_is_its_single_run_to_the_last_bit(jacket_pipe, states):
    detunings = np.linspace(-0.2, 0.2, states.shape[0])
    batch = integrate_batch(jacket_pipe(), detuning=detunings, initial_states=states, periods=40, window=0)
    assert np.all(batch.ok)
    for row, (state, detuning) in enumerate(zip(states, detunings, strict=True)):
        alone = integrate_batch(jacket_pipe(), detuning=detuning, initial_states=state, periods=40, window=0)
        np.testing.assert_array_equal(batch.final_states[row], alone.final_states[0])
        np.testing.assert_array_equal(batch.steps[row], alone.steps[0])
        history = frahm.integrate(jacket_pipe(), detuning=detuning, initial_state=state, periods=40)
        np.testing.assert_allclose(history.x[-1], alone.final_states[0, 0::2], rtol=1e-13)
        assert history.steps == tuple(alone.steps[0])


def test_threads_and_order_change_nothing(jacket_pipe):
    random = np.random.default_rng(3)
    states = np.repeat(random.uniform(-0.08, 0.08, (300, 2)), 2, axis=1)[:, [0, 2, 1, 3]]
    one = integrate_batch(jacket_pipe(), detuning=0.0, initial_states=states, periods=5, window=2, workers=1)
    order = random.permutation(300)
    many = integrate_batch(jacket_pipe(), detuning=0.0, initial_states=states[order], periods=5, window=2, workers=4)
    np.testing.assert_array_equal(many.final_states, one.final_states[order])
    np.testing.assert_array_equal(many.pipe_rms, one.pipe_rms[order])
    np.testing.assert_array_equal(many.relative_least_peak, one.relative_least_peak[order])


def test_each_lane_may_have_its_own_system_and_force(jacket_pipe):
    systems = [jacket_pipe(kappa, xi2) for kappa, xi2 in ((24.425, 0.0085), (97.97, 0.0044), (367.38, 0.0117))]
    scales = np.array([1.0, 0.5, 2.0])
    batch = integrate_batch(systems, detuning=0.01, force_scale=scales, periods=30, window=0)
    for row, (system, scale) in enumerate(zip(systems, scales, strict=True)):
        scaled = frahm.System(system.mass, system.damping, system.stiffness, scale * system.forcing, system.elements)
        alone = frahm.integrate(scaled, detuning=0.01, periods=30, samples_per_period=1)
        np.testing.assert_allclose(batch.final_states[row, 0::2], alone.x[-1], rtol=1e-9)


def test_a_failing_lane_leaves_its_neighbours_alone():
    system = frahm.System(np.eye(1), [[0.1]], [[1.0]], [0.1], [frahm.Element([1.0], frahm.Cubic(-1.0, 0.0))])
    states = np.zeros((11, 2))
    states[3, 0], states[7, 0] = 5.0, -40.0
    batch = integrate_batch(system, frequency=0.5, initial_states=states, periods=30)
    failed = [3, 7]
    assert [row for row, outcome in enumerate(batch.outcomes) if outcome is Outcome.DIVERGED] == failed
    assert np.all(np.isnan(batch.pipe_peak[failed]))
    assert np.all(np.isfinite(batch.final_states))
    assert np.all(batch.turns[failed] < 30)
    quiet = np.delete(np.arange(11), failed)
    alone = integrate_batch(system, frequency=0.5, periods=30)
    for row in quiet:
        np.testing.assert_array_equal(batch.final_states[row], alone.final_states[0])
        assert batch.pipe_peak[row] == alone.pipe_peak[0]


def test_window_agrees_with_a_sampled_history(jacket_pipe):
    system = jacket_pipe()
    history = frahm.integrate(system, detuning=0.0, periods=120, samples_per_period=256, tolerance=1e-10)
    batch = integrate_batch(system, detuning=0.0, periods=120, window=60, tolerance=1e-10)
    tail = history.last(60)
    assert batch.pipe_peak[0] == pytest.approx(tail.peaks().pipe, rel=1e-6)
    assert batch.relative_peak[0] == pytest.approx(tail.peaks().relative, rel=1e-6)
    duration = tail.time[-1] - tail.time[0]
    assert batch.pipe_rms[0] == pytest.approx(np.sqrt(np.trapezoid(tail.pipe**2, tail.time) / duration), rel=1e-6)
    assert batch.relative_rms[0] == pytest.approx(np.sqrt(np.trapezoid(tail.z**2, tail.time) / duration), rel=1e-6)
    by_period = np.abs(tail.pipe[:-1]).reshape(60, 256).max(axis=1)
    assert by_period.min() * 0.9 <= batch.pipe_least_peak[0] <= by_period.min() * 1.3


def test_least_peak_of_a_steady_state_is_its_peak(jacket_pipe):
    batch = integrate_batch(jacket_pipe(24.425), detuning=0.1, periods=1500, window=20)
    assert batch.pipe_least_peak[0] == pytest.approx(batch.pipe_peak[0], rel=1e-4)
    assert batch.pipe_rms[0] == pytest.approx(batch.pipe_peak[0] / np.sqrt(2), rel=5e-3)


def test_strobes_are_the_states_at_whole_periods(jacket_pipe):
    batch = integrate_batch(jacket_pipe(), detuning=0.02, periods=25, window=3, strobes=6)
    section = frahm.integrate(jacket_pipe(), detuning=0.02, periods=25).poincare()
    np.testing.assert_allclose(batch.strobes[0, :, 0::2], section.displacement[-6:], atol=1e-8)
    np.testing.assert_allclose(batch.strobes[0, -1], batch.final_states[0], rtol=1e-12)
    every = integrate_batch(jacket_pipe(), detuning=0.02, periods=25, strobes=25)
    np.testing.assert_allclose(every.strobes[0, :, 1::2], section.velocity[1:], atol=5e-8)


def test_a_batch_goes_on_where_another_ended(jacket_pipe, states):
    def run(periods, start, phase):
        return integrate_batch(
            jacket_pipe(), detuning=-0.05, initial_states=start, periods=periods, phase=phase, tolerance=1e-11
        )

    whole = run(20, states, 0.7)
    first = run(8, states, 0.7)
    np.testing.assert_allclose(first.final_phase, 0.7)
    second = run(12, first.final_states, first.final_phase)
    np.testing.assert_allclose(second.final_states, whole.final_states, atol=1e-7)


def test_phase_shifts_the_force():
    system = frahm.System([[1.0]], [[0.3]], [[2.0]], [1.0])
    quarter = integrate_batch(system, frequency=1.0, periods=60, phase=[0.0, np.pi / 2], window=1)
    X = 1.0 / (2.0 - 1.0 + 0.3j)
    np.testing.assert_allclose(quarter.final_states[:, 0], [X.real, -X.imag], atol=1e-6)
    np.testing.assert_allclose(quarter.pipe_peak, abs(X), rtol=1e-6)
    np.testing.assert_allclose(quarter.pipe_rms, abs(X) / np.sqrt(2), rtol=1e-6)
    assert np.all(np.isnan(quarter.relative_peak))
