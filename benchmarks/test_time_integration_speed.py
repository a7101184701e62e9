"""Time integration beside heyoka (adaptive Taylor), same work, same run, CPU time of the process.

The work: the jacket pipe with kappa 367.38, xi2 0.0085, rho2 0.02 at sigma -0.144. The tolerance of each contestant is
its own; the end error it reached, against heyoka at 1e-15, stands in `extra_info` beside the time.
"""

import numpy as np
import pytest

import frahm
from frahm.time_integration import integrate_batch

heyoka = pytest.importorskip("heyoka")

OMEGA = 2 * np.pi * 0.78
FREQUENCY = OMEGA - 0.144
XI1, FORCE, RHO2, KAPPA, XI2 = 2 * 0.0015 * OMEGA, 0.00624696, 0.02, 367.38, 0.0085
SYSTEM = frahm.System(
    np.diag([247.0, 247.0 * RHO2]), np.diag([247.0 * XI1, 0.0]), np.diag([247.0 * OMEGA**2, 0.0]),
    (247.0 * FORCE, 0.0), [frahm.Element((-1, 1), frahm.Cubic(247.0 * KAPPA, 247.0 * XI2))],
)  # fmt: skip
COUNT = 2000


def equations():
    x, v, x2, v2 = heyoka.make_vars("x", "v", "x2", "v2")
    z = x2 - x
    push = XI2 * (v2 - v) + KAPPA * z * z * z
    drive = FORCE * heyoka.cos(FREQUENCY * heyoka.time)
    return [(x, v), (v, drive - XI1 * v - OMEGA**2 * x + push), (x2, v2), (v2, -push / RHO2)]


def taylor(tolerance):
    return heyoka.taylor_adaptive(equations(), [0.0] * 4, tol=tolerance)


def run_taylor(integrator, state, periods):
    integrator.time = 0.0
    integrator.state[:] = state
    integrator.propagate_until(periods * 2 * np.pi / FREQUENCY)
    return integrator.state.copy()


@pytest.fixture(scope="module")
def states():
    random = np.random.default_rng(0)
    x, v = random.uniform(-0.08, 0.08, COUNT), random.uniform(-0.08, 0.08, COUNT) * OMEGA
    return np.stack([x, v, x, v], axis=1)


@pytest.fixture(scope="module")
def truth(states):
    integrator = taylor(1e-15)
    return np.array([run_taylor(integrator, state, 200) for state in states[:100]])


@pytest.mark.parametrize("samples", [1, 64])
def test_one_trajectory_of_2000_periods(benchmark, samples):
    def run():
        return frahm.integrate(SYSTEM, frequency=FREQUENCY, periods=2000, samples_per_period=samples)

    run()
    history = benchmark(run)
    exact = run_taylor(taylor(1e-15), 0.0, 2000)
    error = np.max(np.abs([*(history.x[-1] - exact[0::2]), *(history.v[-1] - exact[1::2])]))
    benchmark.extra_info["end_error"] = error
    assert error < 1e-8


@pytest.mark.parametrize("tolerance", [1e-8])
def test_one_trajectory_of_2000_periods_by_heyoka(benchmark, tolerance):
    integrator = taylor(tolerance)
    final = benchmark(run_taylor, integrator, 0.0, 2000)
    benchmark.extra_info["end_error"] = np.max(np.abs(final - run_taylor(taylor(1e-15), 0.0, 2000)))


def test_many_trajectories_of_200_periods(benchmark, states, truth):
    def run():
        return integrate_batch(SYSTEM, frequency=FREQUENCY, initial_states=states, periods=200, window=0, workers=1)

    batch = benchmark.pedantic(run, rounds=3, warmup_rounds=1)
    error = np.median(np.max(np.abs(batch.final_states[: len(truth)] - truth), axis=1))
    benchmark.extra_info |= {"median_end_error": error, "trajectories_per_s": COUNT / benchmark.stats.stats.median}
    assert error < 1e-8


@pytest.mark.parametrize("width", [4, 8])
def test_many_trajectories_of_200_periods_by_heyoka(benchmark, states, truth, width):
    integrator = heyoka.taylor_adaptive_batch(equations(), np.zeros((4, width)), tol=1e-8)
    count = 400

    def run():
        final = np.empty((count, 4))
        for first in range(0, count, width):
            integrator.set_time(0.0)
            integrator.state[:] = states[first : first + width].T
            integrator.propagate_until(200 * 2 * np.pi / FREQUENCY)
            final[first : first + width] = integrator.state.T
        return final

    final = benchmark.pedantic(run, rounds=3, warmup_rounds=1)
    error = np.median(np.max(np.abs(final[: len(truth)] - truth), axis=1))
    benchmark.extra_info |= {"median_end_error": error, "trajectories_per_s": count / benchmark.stats.stats.median}
