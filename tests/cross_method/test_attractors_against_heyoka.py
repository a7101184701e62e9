"""Labels and attractors against adaptive Taylor integration over 3000 periods, no early classification."""

import numpy as np
import pytest

import frahm
from frahm.attractors.regions import sample_region
from frahm.attractors.settling import Settling, known_orbits
from frahm.attractors.stroboscope import stroboscope

heyoka = pytest.importorskip("heyoka")

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
SYSTEM = frahm.build_system(CASE)
OMEGA, FORCE = SYSTEM.reference_frequency, SYSTEM.forcing[0] / SYSTEM.mass[0, 0]
REGION = {"x1": (-0.08, 0.08), "v1": (-0.08 * OMEGA, 0.08 * OMEGA)}
WIDTH = 4


def equations(kappa, frequency):
    x, v, x2, v2 = heyoka.make_vars("x", "v", "x2", "v2")
    z = x2 - x
    push = 0.0085 * (v2 - v) + kappa * z * z * z
    drive = FORCE * heyoka.cos(frequency * heyoka.time)
    return [(x, v), (v, drive - 0.003 * OMEGA * v - OMEGA**2 * x + push), (x2, v2), (v2, -push / 0.02)]


def largest_pipe_displacement(kappa, frequency, states, periods, window):
    """Peak of |x1| at 64 samples a period over the last periods, one value per state."""
    integrator = heyoka.taylor_adaptive_batch(equations(kappa, frequency), np.zeros((4, WIDTH)), tol=1e-9)
    turn, peaks = 2 * np.pi / frequency, []
    grid = (periods - window + np.arange(64 * window + 1) / 64) * turn
    for first in range(0, len(states), WIDTH):
        integrator.set_time(0.0)
        integrator.state[:] = states[first : first + WIDTH].T
        integrator.propagate_until(grid[0])
        samples = integrator.propagate_grid(np.repeat(grid[:, None], WIDTH, axis=1))[-1]
        peaks.append(np.max(np.abs(samples[:, 0]), axis=0))
    return np.concatenate(peaks)


def test_labels_of_two_basins():
    frequency = OMEGA - 0.144
    responses = [r for r in frahm.periodic_responses(CASE, detuning=-0.144) if r.stable]
    strobe = stroboscope(SYSTEM, frequency)
    settling = Settling(strobe, 3000, known_orbits(strobe, [r.state for r in responses]))
    states = sample_region(SYSTEM, REGION, 200, seed=11)
    settled = settling.settle(states)
    assert np.mean(settled.periods) < 400
    truth = largest_pipe_displacement(367.38, frequency, states, 3000, 6)
    reached = np.array([r.pipe_peak for r in responses])[np.minimum(settled.labels, 1)]
    agree = np.abs(truth - reached) < 0.01 * reached
    agree[settled.labels > 1] = truth[settled.labels > 1] < 0.0044
    assert np.mean(agree) >= 0.995


def test_envelope_of_a_modulated_attractor():
    case = CASE.with_absorber(kappa=97.97)
    (modulated,) = [a for a in frahm.find_attractors(case, detuning=0.0, samples=32) if a.kind != "periodic"]
    peaks = largest_pipe_displacement(97.97, OMEGA, np.tile(modulated.representative_state, (4, 1)), 400, 300)
    np.testing.assert_allclose(peaks, modulated.pipe_peak, rtol=2e-3)
