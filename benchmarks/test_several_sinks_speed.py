"""Several cubic sinks on one mode: all responses at one frequency, the complete curve, attractors.

The work: the jacket pipe with 2, 3 and 8 sinks of its own kind. Goals, in CPU time of one core: all responses with
three sinks within 0.2 s; the complete curve with 2, 3 and 8 sinks within 0.1, 0.3 and 5 s; attractors from 200 states
with three sinks within 1.5 s. Those of the curve are not met yet: most of its time goes into branches of asymmetric
motions with some thirty harmonics.
"""

import numpy as np
import pytest

import frahm

PIPE = frahm.build_system("jacket-pipe")
HOST = PIPE.mass[0, 0]
SINKS = [(200, 0.004, 0.007), (367.38, 0.0039, 0.0067), (900, 0.006, 0.0063)]  # kappa, xi2, rho2
SINKS += [(100 * (j + 1) ** 1.3, 0.003 + 0.0005 * j, 0.004 + 0.0006 * j) for j in range(5)]
WINDOW = (-0.4, 0.4)


def pipe_with(count):
    """The pipe with the first so many sinks, each with a mass of its own."""
    sinks, n = SINKS[:count], count + 1
    M, C, K = np.diag([1.0, *(rho2 for *_, rho2 in sinks)]), np.zeros((n, n)), np.zeros((n, n))
    C[0, 0], K[0, 0] = PIPE.damping[0, 0], PIPE.stiffness[0, 0]
    elements = [
        frahm.Element(np.eye(n)[i + 1] - np.eye(n)[0], frahm.Cubic(kappa * HOST, xi2 * HOST))
        for i, (kappa, xi2, _) in enumerate(sinks)
    ]
    forcing = PIPE.forcing[0] * np.eye(n)[0]
    return frahm.System(HOST * M, C, K, forcing, elements, reference_frequency=PIPE.reference_frequency)


@pytest.mark.parametrize(("count", "detuning"), [(2, 0.05), (3, 0.05), (3, 0.1)])
def test_all_responses_at_one_frequency(benchmark, count, detuning):
    system = pipe_with(count)
    found = benchmark.pedantic(lambda: frahm.periodic_responses(system, detuning=detuning), rounds=9, warmup_rounds=2)
    benchmark.extra_info["responses"] = len(found)
    assert found.unverified == ()


@pytest.mark.parametrize("count", [2, 3, 8])
def test_complete_curve(benchmark, count):
    system = pipe_with(count)
    curve = benchmark.pedantic(
        lambda: frahm.frequency_response(system, detuning=WINDOW), rounds=3 if count < 8 else 1, warmup_rounds=1
    )
    benchmark.extra_info |= {"points": len(curve.frequency), "branches": len(curve.branches)}


def test_attractors_of_three_sinks_from_200_states(benchmark):
    system = pipe_with(3)
    found = benchmark.pedantic(
        lambda: frahm.find_attractors(system, detuning=0.05, samples=200, workers=1), rounds=3, warmup_rounds=1
    )
    benchmark.extra_info["kinds"] = [attractor.kind for attractor in found]
