import numpy as np
import pytest
import scipy.integrate
import scipy.linalg

import frahm
from frahm.errors import Outcome


def exact_linear(system, omega, time, state):
    """Closed form of a linear system: harmonic response plus matrix exponential, rows (x_0 ... v_n-1)."""
    n = system.size
    stiffness, damping = np.array(system.stiffness), np.array(system.damping)
    for element in system.elements:
        stiffness += element.law.coefficients[0] * np.outer(element.direction, element.direction)
        damping += element.law.damping * np.outer(element.direction, element.direction)
    first_order = np.block(
        [
            [np.zeros((n, n)), np.eye(n)],
            [-np.linalg.solve(system.mass, stiffness), -np.linalg.solve(system.mass, damping)],
        ]
    )
    X = np.linalg.solve(stiffness - omega**2 * system.mass + 1j * omega * damping, system.forcing)
    phasor = np.concatenate([X, 1j * omega * X])
    start = np.concatenate([state[0::2], state[1::2]]) - phasor.real
    turning = np.exp(1j * omega * time)[:, None]
    return (phasor * turning).real + np.array([scipy.linalg.expm(first_order * t) @ start for t in time])


def linear_system(seed=0):
    random = np.random.default_rng(seed)
    root = random.normal(size=(5, 5))
    return frahm.System(
        root @ root.T + 5 * np.eye(5), 0.3 * np.diag(random.uniform(0.5, 1.5, 5)),
        np.diag(random.uniform(5, 50, 5)), random.normal(size=5),
        [frahm.Element(random.normal(size=5), frahm.Linear(2.0, 0.1))],
    )  # fmt: skip


def test_linear_motion_follows_the_closed_form():
    system, state = linear_system(), np.random.default_rng(1).normal(size=10)
    history = frahm.integrate(system, frequency=1.7, periods=12.5, initial_state=state, samples_per_period=10)
    exact = exact_linear(system, 1.7, history.time, state)
    assert history.time.size == 126
    assert history.time[-1] == pytest.approx(12.5 * 2 * np.pi / 1.7)
    np.testing.assert_allclose(history.x, exact[:, :5], atol=2e-6)
    np.testing.assert_allclose(history.v, exact[:, 5:], atol=6e-6)


def test_samples_between_steps_are_as_good_as_the_steps():
    system, state = linear_system(2), np.random.default_rng(3).normal(size=10)
    errors = {}
    for samples in (1, 97):
        history = frahm.integrate(
            system, frequency=1.1, periods=20, initial_state=state, samples_per_period=samples, tolerance=1e-10
        )
        errors[samples] = np.max(np.abs(history.x - exact_linear(system, 1.1, history.time, state)[:, :5]))
    assert errors[97] < 1e-7
    assert errors[97] < 40 * errors[1]


def test_error_falls_with_the_eighth_power_of_the_step(jacket_pipe):
    def final(tolerance):
        history = frahm.integrate(
            jacket_pipe(), detuning=-0.144, periods=300, samples_per_period=1, tolerance=tolerance
        )
        return history.x[-1], sum(history.steps)

    reference, _ = final(1e-14)
    (coarse, few), (fine, many) = final(1e-7), final(1e-10)
    order = np.log(np.max(abs(coarse - reference)) / np.max(abs(fine - reference))) / np.log(many / few)
    assert 7.5 < order < 9.5


def test_energy_stays_in_a_conservative_oscillator():
    system = frahm.System([[2.0]], [[0.0]], [[3.0]], [0.0], [frahm.Element([1.0], frahm.Cubic(5.0))])
    history = frahm.integrate(system, frequency=1.0, periods=200, initial_state=(1.0, 0.5))
    energy = history.v[:, 0] ** 2 + 1.5 * history.x[:, 0] ** 2 + 1.25 * history.x[:, 0] ** 4
    np.testing.assert_allclose(energy, energy[0], rtol=5e-5)
    tight = frahm.integrate(system, frequency=1.0, periods=200, initial_state=(1.0, 0.5), tolerance=1e-12)
    energy = tight.v[:, 0] ** 2 + 1.5 * tight.x[:, 0] ** 2 + 1.25 * tight.x[:, 0] ** 4
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)


def test_work_of_the_force_is_energy_plus_loss(jacket_pipe):
    system = jacket_pipe()
    history = frahm.integrate(system, detuning=-0.05, periods=30, samples_per_period=512, tolerance=1e-11)
    t, x, v, z, w = history.time, history.x, history.v, history.z, history.w
    law, mass = system.elements[0].law, np.diag(system.mass)
    energy = 0.5 * v**2 @ mass + 0.5 * system.stiffness[0, 0] * x[:, 0] ** 2 + law.coefficients[2] * z**4 / 4
    power = system.forcing[0] * np.cos(history.frequency * t) * v[:, 0]
    loss = system.damping[0, 0] * v[:, 0] ** 2 + law.damping * w**2
    work = scipy.integrate.simpson(power - loss, x=t)
    assert energy[-1] - energy[0] == pytest.approx(work, rel=1e-6)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_five_coupled_coordinates_as_scipy_integrates_them(random_system, seed):
    system = random_system(seed)
    state = 0.5 * np.random.default_rng(seed).normal(size=10)

    def slope(t, y):
        return np.concatenate([y[5:], system.acceleration(y[:5], y[5:], 1.3 * t)])

    history = frahm.integrate(
        system, frequency=1.3, periods=4, initial_state=state, samples_per_period=8, tolerance=1e-11
    )
    peer = scipy.integrate.solve_ivp(
        slope, (0, history.time[-1]), [*state[0::2], *state[1::2]], "DOP853", history.time, rtol=1e-11, atol=1e-12
    )
    np.testing.assert_allclose(history.x, peer.y[:5].T, atol=1e-8)
    np.testing.assert_allclose(history.v, peer.y[5:].T, atol=1e-8)


def test_scaling_the_unit_of_length_scales_the_motion(jacket_pipe):
    """The tolerance is relative to the motion: metres or micrometres make no difference."""
    small = 2.0**-20
    system = jacket_pipe()
    law = system.elements[0].law
    scaled = frahm.System(
        system.mass, system.damping, system.stiffness, small * system.forcing,
        [frahm.Element((-1, 1), frahm.Cubic(law.coefficients[2] / small**2, law.damping))],
    )  # fmt: skip
    one = frahm.integrate(system, detuning=0.0, periods=100)
    other = frahm.integrate(scaled, detuning=0.0, periods=100)
    np.testing.assert_allclose(other.x / small, one.x, atol=1e-6 * np.max(np.abs(one.x)))
    assert other.steps == one.steps


def test_a_system_at_rest_without_force_stays_there():
    system = frahm.System(np.eye(2), np.eye(2), np.eye(2), [0, 0], [frahm.Element([1, -1], frahm.Cubic(1.0))])
    history = frahm.integrate(system, frequency=1.0, periods=10)
    assert history.outcome is Outcome.DONE
    assert not np.any(history.x)


@pytest.mark.parametrize(
    ("stiffness", "law"),
    [
        (1.0, frahm.Cubic(-1.0)),
        (-1.0, frahm.Cubic(0.0)),
        (1.0, frahm.Polynomial([0.0] * 14 + [-1.0])),
        (1.0, frahm.Polynomial([0.0, 5.0])),
    ],
    ids=["softening", "negative stiffness", "fifteenth power", "quadratic"],
)
def test_escape_is_a_value(stiffness, law):
    system = frahm.System(np.eye(1), np.zeros((1, 1)), [[stiffness]], [2.0], [frahm.Element([1.0], law)])
    history = frahm.integrate(system, frequency=1.0, periods=200)
    assert history.outcome is Outcome.DIVERGED
    assert np.all(np.isfinite(history.x))
    assert history.time.size < 64 * 200
    with pytest.raises(frahm.ConvergenceError, match="left every bound"):
        frahm.integrate(system, frequency=1.0, periods=200, throw=True)


def test_a_hopeless_start_ends_at_the_step_limit(jacket_pipe, monkeypatch):
    monkeypatch.setattr("frahm.time_integration.batch.LEAST_STEPS", 1e5)
    history = frahm.integrate(jacket_pipe(), detuning=0.0, periods=50, initial_state=(0, 0, 1e6, 0))
    assert history.outcome is Outcome.STEP_LIMIT
    assert np.all(np.isfinite(history.x))


@pytest.mark.parametrize("size", [1e-9, 1e3])
def test_any_size_of_start_state_works_unaided(jacket_pipe, size):
    history = frahm.integrate(jacket_pipe(), detuning=-0.144, periods=50, initial_state=[size] * 4)
    assert history.outcome is Outcome.DONE


def test_an_absurd_force_law_ends_as_a_value():
    system = frahm.System(
        np.eye(1), [[0.0]], [[1.0]], [1.0], [frahm.Element([1.0], frahm.Polynomial([0] * 14 + [1e300]))]
    )
    history = frahm.integrate(system, frequency=1.0, periods=5, initial_state=(1e30, 0.0))
    assert not history.outcome.ok
