"""Trajectories against adaptive Taylor integration at the limit of double precision."""

import numpy as np
import pytest

import frahm
from frahm.time_integration import integrate_batch

heyoka = pytest.importorskip("heyoka")

OMEGA = 2 * np.pi * 0.78
XI1, FORCE, RHO2, KAPPA, XI2 = 2 * 0.0015 * OMEGA, 0.00624696, 0.02, 367.38, 0.0085


def pipe():
    return frahm.System(
        np.diag([247.0, 247.0 * RHO2]), np.diag([247.0 * XI1, 0.0]), np.diag([247.0 * OMEGA**2, 0.0]),
        (247.0 * FORCE, 0.0), [frahm.Element((-1, 1), frahm.Cubic(247.0 * KAPPA, 247.0 * XI2))],
    )  # fmt: skip


def oracle(detuning):
    x, v, x2, v2 = heyoka.make_vars("x", "v", "x2", "v2")
    z = x2 - x
    push = XI2 * (v2 - v) + KAPPA * z * z * z
    drive = FORCE * heyoka.cos((OMEGA + detuning) * heyoka.time)
    equations = [(x, v), (v, drive - XI1 * v - OMEGA**2 * x + push), (x2, v2), (v2, -push / RHO2)]
    return heyoka.taylor_adaptive(equations, [0.0] * 4, tol=1e-15)


def test_two_thousand_periods_of_the_jacket_pipe():
    ours = frahm.integrate(pipe(), detuning=-0.144, periods=2000, samples_per_period=1)
    taylor = oracle(-0.144)
    taylor.propagate_until(2000 * 2 * np.pi / (OMEGA - 0.144))
    np.testing.assert_allclose(ours.x[-1], taylor.state[[0, 2]], atol=1e-8)
    np.testing.assert_allclose(ours.v[-1], taylor.state[[1, 3]], atol=1e-8)


def test_random_starts_of_the_jacket_pipe():
    random = np.random.default_rng(0)
    x, v = random.uniform(-0.08, 0.08, 60), random.uniform(-0.08, 0.08, 60) * OMEGA
    states = np.stack([x, v, x, v], axis=1)
    ours = integrate_batch(pipe(), detuning=-0.144, initial_states=states, periods=200)
    errors, taylor = [], oracle(-0.144)
    for state, final in zip(states, ours.final_states, strict=True):
        taylor.time = 0.0
        taylor.state[:] = state
        taylor.propagate_until(200 * 2 * np.pi / (OMEGA - 0.144))
        errors.append(np.max(np.abs(final - taylor.state)))
    assert np.median(errors) < 1e-8
    assert np.quantile(errors, 0.9) < 2e-6


def test_a_large_start_follows_the_same_path():
    ours = frahm.integrate(pipe(), detuning=-0.144, periods=20, initial_state=(3, 3, 3, 3), tolerance=1e-12)
    taylor = oracle(-0.144)
    taylor.state[:] = 3.0
    samples = taylor.propagate_grid(np.array(ours.time))[-1]
    np.testing.assert_allclose(ours.x, samples[:, [0, 2]], atol=1e-7)
