"""All responses of parallel elements, of several absorbers, and of equal ones."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import frahm
from frahm.harmonic_balance.alike import moving_alike
from frahm.harmonic_balance.condensation import condense, stiffness_at
from frahm.harmonic_balance.newton import solve_at
from frahm.harmonic_balance.seeds import seeder_for
from frahm.harmonic_balance.shared_drive import cubic_stiffnesses, solutions_at

PIPE = frahm.build_system("jacket-pipe")
HOST, OMEGA = PIPE.mass[0, 0], PIPE.reference_frequency


def star(sinks, force=1.0, law=None):
    """The built-in pipe with cubic sinks (kappa, xi2, rho2) on it, each with a mass of its own."""
    n = len(sinks) + 1
    M, C, K = np.diag([1.0, *(rho2 for *_, rho2 in sinks)]), np.zeros((n, n)), np.zeros((n, n))
    C[0, 0], K[0, 0] = PIPE.damping[0, 0], PIPE.stiffness[0, 0]
    law = law or (lambda kappa, xi2: frahm.Cubic(kappa * HOST, xi2 * HOST))
    elements = [
        frahm.Element(-np.eye(n)[0] + np.eye(n)[i + 1], law(kappa, xi2)) for i, (kappa, xi2, _) in enumerate(sinks)
    ]
    forcing = force * PIPE.forcing[0] * np.eye(n)[0]
    return frahm.System(HOST * M, C, K, forcing, elements, reference_frequency=OMEGA)


def parallel(system, laws):
    """A system with its one element replaced by parallel ones: factors of the direction, and laws."""
    n = system.elements[0].direction
    elements = [frahm.Element(factor * n, law) for factor, law in laws]
    return frahm.System(
        system.mass, system.damping, system.stiffness, system.forcing, elements, reference_frequency=OMEGA
    )


THREE = [(200, 0.004, 0.007), (367.38, 0.0039, 0.0067), (900, 0.006, 0.0063)]


@pytest.mark.parametrize(
    ("factors", "sink", "force", "detuning"),
    [
        ((1, 1), (128.394, 0.0037074, 0.02411), 4.2553, 0.929),
        ((1, -2), (28.711, 0.0013480, 0.026278), 6.0769, 0.954),
        ((1, 1, 0.5), (414.747, 0.0026615, 0.031534), 0.56263, -0.249),
    ],
)
def test_parallel_elements_start_from_every_root_of_the_one_they_are(factors, sink, force, detuning):
    one = star([sink], force)
    law, share = one.elements[0].law, 1 / len(factors)
    many = parallel(one, [(f, law.scaled(share / f**4, share / f**2)) for f in factors])
    window, W = OMEGA * np.array([0.9, 1.0, 1.3]), OMEGA + detuning
    roots = [
        sorted(abs(seed.harmonics[1][0]) for seed in seeder_for(condense(s), window).at(W, 1.0)) for s in (one, many)
    ]
    assert len(roots[0]) >= 3
    np.testing.assert_allclose(roots[1], roots[0], rtol=1e-9)


def test_stops_beside_a_parallel_spring_are_one_law():
    sink, stops = (367.38, 0.0085, 0.02), frahm.Stops(gap=0.01, stiffness=2e4, depth=0.005)
    law = frahm.Cubic(367.38 * HOST, 0.0085 * HOST)
    one = star([sink], law=lambda kappa, xi2: frahm.Cubic(kappa * HOST, xi2 * HOST, stops=stops))
    two = parallel(one, [(1, law), (1, frahm.Cubic(0.0, stops=stops))])
    found = [frahm.periodic_responses(s, detuning=0.05, harmonics=9) for s in (one, two)]
    peaks = [[response.relative_peak for response in responses] for responses in found]
    np.testing.assert_allclose(peaks[1], peaks[0], rtol=1e-8)
    assert found[1].unverified == ()


@pytest.mark.parametrize(("detuning", "count"), [(0.05, 13), (0.1, 7)])
def test_all_first_harmonic_responses_of_three_sinks(detuning, count):
    system = star(THREE)
    found = frahm.periodic_responses(system, detuning=detuning, harmonics=1)
    assert len(found) == count
    assert found.unverified == ()
    for response in found:  # each satisfies the equations as they stand
        X, W = response.harmonics[1], response.frequency
        D = -W * W * system.mass + 1j * W * system.damping + system.stiffness
        force = D @ X - system.forcing
        for element in system.elements:
            z = element.direction @ X
            stiffness = 0.75 * element.law.cubic_stiffness * abs(z) ** 2 + 1j * W * element.law.damping
            force = force + element.direction * stiffness * z
        assert np.max(np.abs(force)) < 1e-9 * np.max(np.abs(system.forcing))


sinks = st.tuples(st.floats(1, 4), st.floats(-3, -1.5), st.floats(-3, -1.5))


@given(st.lists(sinks, min_size=2, max_size=3), st.floats(-0.7, 0.7), st.floats(-0.3, 0.5))
@settings(max_examples=25, deadline=None, derandomize=True)
def test_newtons_method_from_anywhere_finds_no_further_solution(logs, force, detuning):
    problem = condense(star([tuple(10.0**v for v in sink) for sink in logs], 10.0**force))
    k, W = cubic_stiffnesses(problem), OMEGA + detuning
    solutions = solutions_at(problem, W, k)
    S, F = stiffness_at(problem, 1, W)
    assert solutions.complete
    for u in solutions.harmonics:
        assert np.max(np.abs(S @ u + k * np.abs(u) ** 2 * u - F)) < 1e-9 * np.max(np.abs(F))
    random = np.random.default_rng(1)
    scale, size = np.max(np.abs(solutions.harmonics), axis=0), 2 * k.size
    for _ in range(150):
        start = scale * 10 ** random.uniform(-2, 0.3, k.size) * np.exp(2j * np.pi * random.uniform(size=k.size))
        X = np.zeros(size + 1)
        X[:size] = np.column_stack([start.real, start.imag]).ravel()
        ok, _, _ = solve_at(problem, True, W, X, 1, 1, np.inf, 30)
        u = X[:size:2] + 1j * X[1:size:2]
        if ok:
            assert np.min(np.max(np.abs(solutions.harmonics - u), axis=1)) < 1e-5 * np.max(np.abs(u))


def test_equal_absorbers_have_the_responses_of_the_one_they_are_together():
    kappa, xi2, rho2, force, detuning = 414.75, 0.00266, 0.03153, 0.56263, -0.24898
    one, two = (
        frahm.periodic_responses(star([(kappa / n, xi2 / n, rho2 / n)] * n, force), detuning=detuning) for n in (1, 2)
    )
    assert len(one) == 3
    for response in one:
        near = min(two, key=lambda other: abs(other.relative_peak - response.relative_peak))
        assert near.pipe_peak == pytest.approx(response.pipe_peak, rel=1e-7)
        assert near.relative_peak == pytest.approx(response.relative_peak, rel=1e-7)


@pytest.mark.parametrize("detuning", [-0.1, 0.05])
def test_motions_in_which_equal_absorbers_part_are_found_with_all_their_exchanges(detuning):
    kappa, xi2, rho2 = 367.38, 0.0039, 0.0067
    system = star([(kappa / 3, xi2, rho2)] * 3)
    found = frahm.periodic_responses(system, detuning=detuning)
    assert found.unverified == ()
    strokes = np.array([response.element_amplitudes for response in found])
    np.testing.assert_allclose(strokes[:, 0], [response.relative_amplitude for response in found])
    alike = [r for r, z in zip(found, strokes, strict=True) if np.ptp(z) < 1e-6 * np.max(z)]
    together = frahm.periodic_responses(star([(kappa, 3 * xi2, 3 * rho2)]), detuning=detuning)
    np.testing.assert_allclose([r.pipe_peak for r in alike], [r.pipe_peak for r in together], rtol=1e-7)
    for z in strokes:  # every exchange of the three strokes is there
        rows = {tuple(np.round(z[list(order)], 9)) for order in itertools.permutations(range(3))}
        assert rows <= {tuple(row) for row in np.round(strokes, 9)}
    once = {tuple(sorted(np.round(z, 9))) for z in strokes}
    assert len(alike) < len(once) < len(found) == len({tuple(row) for row in np.round(strokes, 9)})
    assert f"{len(found)} responses are listed, {len(once)} if" in found.searched


def test_a_curve_of_equal_absorbers_says_that_exchanges_are_listed():
    system = star([(200, 0.004, 0.007)] * 2)
    inventory = frahm.frequency_response(system, detuning=(0.3, 0.32)).settings["inventory"]
    assert "which of them carries the motion are all listed" in inventory
    unequal = star([(200, 0.004, 0.007), (210, 0.004, 0.007)])
    assert "equal:" not in frahm.frequency_response(unequal, detuning=(0.3, 0.32)).settings["inventory"]


def test_only_equal_absorbers_move_alike():
    equal = (300, 0.005, 0.01)
    assert moving_alike(star([equal])) is None
    assert moving_alike(star([equal, (300, 0.006, 0.01)])) is None
    assert moving_alike(star([equal, (300, 0.005, 0.011)])) is None
    together = moving_alike(star([equal, (100, 0.005, 0.01), equal]))
    assert together.size == 3
    np.testing.assert_allclose(np.diag(together.mass) / HOST, [1, 0.02, 0.01])
    beside = frahm.System(np.eye(3), np.zeros((3, 3)), np.diag([1, 0, 0.1]), (1, 0, 0), star([equal, equal]).elements)
    assert moving_alike(beside) is None  # one of them hangs on a spring of its own


def test_an_absorber_without_a_linear_spring_is_not_taken_for_one_with_two_wells():
    assert not seeder_for(condense(frahm.build_system("two-sinks")), OMEGA * np.array([0.9, 1.1])).buckled


def test_what_is_only_searched_is_unverified_in_every_result():
    def law(kappa, xi2):
        return frahm.Polynomial([0, 0, kappa * HOST, 0, 1e3 * kappa * HOST], xi2 * HOST)

    system = star([(300, 0.02, 0.01), (500, 0.03, 0.01)], 0.2, law=law)
    doubt = "not proven complete"
    found = frahm.periodic_responses(system, detuning=0.2)
    curve = frahm.frequency_response(system, detuning=(0.15, 0.25))
    attractors = frahm.find_attractors(system, detuning=0.2, samples=1)
    worst = frahm.worst_case(system, detuning=(0.2, 0.21), samples=1)
    for result in (found, curve, attractors, worst):
        assert any(doubt in sentence for sentence in result.unverified)
    assert doubt in attractors.to_dataset().attrs["unverified"]
    assert not worst.verified
