import numpy as np
import pytest

import frahm
from frahm.attractors.orbits import (
    _adapted_root,
    monodromy_along,
    orbit_at,
    orbit_size,
    points_needed,
    refined,
    unstable_directions,
)
from frahm.attractors.stroboscope import stroboscope
from frahm.harmonic_balance import periodic_responses_of
from frahm.time_integration import integrate_batch

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
SYSTEM = frahm.build_system(CASE)
FREQUENCY = SYSTEM.reference_frequency - 0.144
RESPONSES = periodic_responses_of(SYSTEM, FREQUENCY, None)


@pytest.fixture(scope="module")
def strobe():
    return stroboscope(SYSTEM, FREQUENCY)


@pytest.mark.parametrize("response", RESPONSES, ids=lambda response: f"{response.pipe_peak:.4f}")
def test_the_monodromy_matrix_has_the_multipliers_of_harmonic_balance(response):
    count = points_needed(SYSTEM, response.period, np.full(2, response.relative_peak))
    Phi = monodromy_along(SYSTEM, response.period, response.x(np.linspace(0, response.period, count)))
    ours = np.sort_complex(np.linalg.eigvals(Phi))
    np.testing.assert_allclose(ours, np.sort_complex(np.array(response.multipliers)), atol=2e-6)


@pytest.mark.parametrize("which", [0, 2])
def test_every_state_of_a_ball_stays_in_it_and_converges(strobe, which):
    orbit = orbit_at(strobe, RESPONSES[which].state)
    (ball,) = orbit.balls
    assert ball.verified
    random = np.random.default_rng(3)
    steps = random.standard_normal((500, 4))
    steps *= (random.random((500, 1)) ** 0.25) / np.linalg.norm(steps, axis=1, keepdims=True)
    states = ball.centre + ball.radius * steps @ np.linalg.inv(ball.root).T
    assert np.all(ball.contains(states))
    later = integrate_batch(SYSTEM, frequency=FREQUENCY, initial_states=states, periods=100, window=0)
    assert np.all(ball.contains(later.final_states))
    end = integrate_batch(SYSTEM, frequency=FREQUENCY, initial_states=states, periods=1500, window=0)
    np.testing.assert_allclose(end.final_states, np.tile(RESPONSES[which].state, (500, 1)), atol=1e-6)


def test_an_unstable_response_has_no_ball_and_a_way_out(strobe):
    assert orbit_at(strobe, RESPONSES[1].state) is None
    assert len(unstable_directions(strobe, np.array(RESPONSES[1].state))) == 1


def test_newton_finds_the_orbit_from_beside_it(strobe):
    state = np.array(RESPONSES[2].state)
    found, Phi = refined(strobe, state * 1.01, 1)
    np.testing.assert_allclose(found, state, rtol=1e-7)
    ours = np.sort_complex(np.linalg.eigvals(Phi))
    np.testing.assert_allclose(ours, np.sort_complex(np.array(RESPONSES[2].multipliers)), atol=1e-5)


def test_the_adapted_norm_shrinks_however_dependent_the_eigenvectors_are():
    """P = M^T M was indefinite by rounding for one in a hundred of these nearly defective matrices."""
    random = np.random.default_rng(0)
    for _ in range(500):
        n, rho = random.choice([4, 6]), random.choice([1e-8, 0.1, 0.5, 0.9])
        jordan = np.diag(np.full(n, rho)) + np.diag(10.0 ** random.uniform(-3, 1, n - 1), 1)
        Q = np.linalg.qr(random.standard_normal((n, n)))[0]
        Phi = Q @ jordan @ Q.T
        rho = np.max(np.abs(np.linalg.eigvals(Phi)))
        R = _adapted_root(Phi, rho)
        shrinkage = np.linalg.norm(R @ Phi @ np.linalg.inv(R), 2)
        assert shrinkage <= 1 - 0.49 * (1 - rho)


def test_a_few_balls_are_enough_for_an_orbit_of_many_periods():
    """Motions near it come through one of them within a turn, from whatever state of the orbit they start."""
    case = frahm.load_case("jacket-pipe")
    system = frahm.build_system(case)
    found = frahm.find_attractors(case, detuning=0.047, samples=4)
    assert found[0].period_multiple == 45
    strobe = stroboscope(system, found.frequency)
    orbit = orbit_at(strobe, found[0].representative_state, 45)
    assert orbit.multiple == 45
    assert 2 <= len(orbit.balls) <= 4
    beside = np.array(orbit.states) * (1 + 1e-5)
    seen = strobe.run(beside, 450, strobes=45)
    assert np.all(orbit.attracts(seen.strobes))
    assert not np.all(orbit.contains(seen.states))
    away = strobe.run(beside * 1.5, 450, strobes=45)
    caught = orbit.attracts(away.strobes)  # the others are on the orbit's twin
    assert 0 < np.count_nonzero(caught) < 45
    size = orbit_size(strobe, orbit.states)
    later = strobe.run(away.states, 1800).states
    assert orbit.holds(later[caught], size)
    assert not any(orbit.holds(state[None], size) for state in later[~caught])
