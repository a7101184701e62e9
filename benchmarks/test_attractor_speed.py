"""Attractors: what early classification saves, wall time on the cores there are.

The work: the jacket pipe with kappa 367.38, xi2 0.0085, rho2 0.02. 10,000 states labelled in at most 10 s on two cores,
200 samples of `find_attractors` within 1 s.
"""

import numpy as np
import pytest

import frahm
from frahm.attractors.regions import sample_region
from frahm.attractors.settling import Settling, known_orbits
from frahm.attractors.stroboscope import stroboscope
from frahm.time_integration import integrate_batch

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
SYSTEM = frahm.build_system(CASE)
OMEGA = SYSTEM.reference_frequency
REGION = {"x1": (-0.08, 0.08), "v1": (-0.08 * OMEGA, 0.08 * OMEGA)}


def settling():
    strobe = stroboscope(SYSTEM, OMEGA - 0.144)
    responses = frahm.periodic_responses(CASE, detuning=-0.144)
    return Settling(strobe, 3000, known_orbits(strobe, [r.state for r in responses if r.stable]))


def test_ten_thousand_labels(benchmark):
    states = sample_region(SYSTEM, REGION, 10_000, seed=1)
    settled = benchmark.pedantic(lambda: settling().settle(states), rounds=3, warmup_rounds=1)
    benchmark.extra_info["mean_periods"] = float(np.mean(settled.periods))
    assert np.all(settled.labels >= 0)


def test_agreement_with_3000_periods_of_500_states(benchmark):
    states = sample_region(SYSTEM, REGION, 500, seed=7)
    room = settling()
    settled = room.settle(states)

    def run():
        return integrate_batch(CASE, detuning=-0.144, initial_states=states, periods=3000, strobes=4, window=0)

    batch = benchmark.pedantic(run, rounds=1)
    same = [
        np.min(np.max(np.abs(room.known[label].states - final), axis=1)) < 1e-4
        for label, final in zip(settled.labels, batch.final_states, strict=True)
    ]
    benchmark.extra_info["agreement"] = float(np.mean(same))
    assert np.mean(same) >= 0.995


@pytest.mark.parametrize(("kappa", "detuning"), [(367.38, -0.144), (367.38, 0.0), (97.97, 0.0), (367.38, -0.04)])
def test_find_attractors_with_200_samples(benchmark, kappa, detuning):
    case = CASE.with_absorber(kappa=kappa)
    found = benchmark.pedantic(
        lambda: frahm.find_attractors(case, detuning=detuning, samples=200), rounds=3, warmup_rounds=1
    )
    benchmark.extra_info["kinds"] = [attractor.kind for attractor in found]


def test_worst_case_over_a_window(benchmark):
    worst = benchmark.pedantic(lambda: frahm.worst_case(CASE, detuning=(-0.4, 0.4)), rounds=1)
    benchmark.extra_info |= {"pipe_peak": worst.pipe_peak, "frequencies": len(worst.surveys)}


@pytest.mark.parametrize("kappa", [97.97, 367.38])
def test_modulated_branches_over_the_resonance(benchmark, kappa):
    """Both Hopf branches and the relaxation cycles, with their stability: a few seconds."""
    case = CASE.with_absorber(kappa=kappa)
    curve = benchmark.pedantic(
        lambda: frahm.modulated_branches(case, detuning=(-0.4, 0.4)),
        rounds=2,
        warmup_rounds=1,
    )
    benchmark.extra_info["points"] = int(curve.frequency.size)
    assert curve.ranges
