"""The slow flow: maps of a million points and one curve with all its special points, beside batched polynomial roots.

A map of a million points holds every root with its stability. Its peer is numpy on companion matrices, which finds the
roots only.
"""

import numpy as np

import frahm

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
KAPPA = np.geomspace(10, 3000, 1000)[:, None]
SIGMA = np.linspace(-0.4, 0.4, 1000)[None, :]


def test_map_of_a_million_points(benchmark):
    found = benchmark.pedantic(
        lambda: frahm.slow_flow_map(CASE, detuning=SIGMA, kappa=KAPPA, xi2=0.0085), rounds=3, warmup_rounds=1
    )
    assert found.sizes["root"] == 3


def test_roots_of_a_tenth_of_them_from_companion_matrices(benchmark):
    """100,000 cubics: multiply by ten to compare with the map."""
    system = frahm.build_system(CASE)
    m, w = system.mass[0, 0], system.reference_frequency
    W = w + SIGMA.ravel()[::10]
    H = 1 / (w**2 - W**2 + 1j * system.damping[0, 0] / m * W)
    S, F = -0.02 * W**2 / (1 + H * 0.02 * W**2) + 1j * 0.0085 * W, 0.02 * W**2 * H * system.forcing[0] / m
    k = 0.75 * KAPPA
    cubic = np.stack(np.broadcast_arrays(k**2, 2 * k * S.real, np.abs(S) ** 2, -(np.abs(F) ** 2)), axis=-1)
    monic = (cubic / cubic[..., :1]).reshape(-1, 4)

    def roots():
        companion = np.zeros((len(monic), 3, 3))
        companion[:, 0], companion[:, 1, 0], companion[:, 2, 1] = -monic[:, 1:], 1, 1
        return np.linalg.eigvals(companion)

    assert benchmark.pedantic(roots, rounds=2).shape == (100_000, 3)


def test_curve_of_2000_points(benchmark):
    curve = benchmark.pedantic(
        lambda: frahm.frequency_response(CASE, detuning=(-0.4, 0.4), method="slow-flow", points=2000),
        rounds=21, warmup_rounds=2,
    )  # fmt: skip
    assert len(curve.special_points) >= 4
