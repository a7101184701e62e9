"""Periodic responses by harmonic balance against trajectories: what is called stable must stay, with the same peaks."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import frahm

KINDS = ("sink", "two sinks", "grounded spring", "two modes", "three modes")
CASES = [(kind, seed) for kind in KINDS for seed in range(3)]


def random_case(kind, seed):
    """A moderately strong system near its first resonance, and a frequency there."""
    random = np.random.default_rng([KINDS.index(kind), seed])
    zeta, W = 10 ** random.uniform(-2.3, -1.5), random.uniform(0.9, 1.12)
    X = 0.3 / (2 * zeta)  # a third of the amplitude without absorber

    def sink():
        mass = 10 ** random.uniform(-1.7, -1)
        return mass, frahm.Cubic(mass * 10 ** random.uniform(-1, 1) / X**2, random.uniform(0.1, 0.4) * mass)

    modes = {"two modes": 2, "three modes": 3}.get(kind, 1)
    sinks = [sink() for _ in range(2 if kind == "two sinks" else 1)]
    omega = np.concatenate([[1.0], 1 + np.cumsum(random.uniform(0.5, 2, modes - 1))])
    shape = np.concatenate([[1.0], random.uniform(-1, 1, modes - 1)])
    none = np.zeros(len(sinks))
    elements = []
    for place, (_, law) in enumerate(sinks):
        elements.append(frahm.Element(np.concatenate([-shape, np.eye(len(sinks))[place]]), law))
    if kind == "grounded spring":
        hardening = random.choice([-0.03, 0.1]) / X**2
        elements.append(frahm.Element(np.concatenate([shape, none]), frahm.Polynomial([0, 0, hardening])))
    system = frahm.System(
        np.diag([*np.ones(modes), *(mass for mass, _ in sinks)]),
        np.diag([*(2 * zeta * omega), *none]), np.diag([*omega**2, *none]), [*shape, *none], elements,
        output=[*shape, *none],
    )  # fmt: skip
    return system, W


@pytest.fixture(scope="module")
def found():
    """System, frequency and responses of every case."""
    made = {}
    for case in CASES:
        system, W = random_case(*case)
        made[case] = system, W, frahm.periodic_responses(system, frequency=W)
    return made


@pytest.mark.parametrize("case", CASES)
def test_a_periodic_response_returns_to_itself(found, case):
    # one period, stable or not: nothing but the equations of motion decides
    system, W, responses = found[case]
    assert responses
    for response in responses:
        history = frahm.integrate(system, frequency=W, periods=1, initial_state=response.state, tolerance=1e-12)
        end = np.column_stack([history.x[-1], history.v[-1]]).ravel()
        assert np.max(np.abs(end - response.state)) < 2e-7 * np.max(np.abs(response.state))


@pytest.mark.parametrize("case", CASES)
def test_a_stable_response_stays_for_fifty_periods_with_its_peaks(found, case):
    system, W, responses = found[case]
    for response in responses:
        if not response.stable:
            continue
        run = frahm.integrate(
            system, frequency=W, periods=50, initial_state=response.state, tolerance=1e-12, samples_per_period=400
        )
        last = slice(-401, None)
        state = np.column_stack([run.x[-1], run.v[-1]]).ravel()
        assert np.max(np.abs(state - response.state)) < 1e-6 * np.max(np.abs(response.state))
        assert np.max(np.abs(run.x[last] @ system.output)) == pytest.approx(response.pipe_peak, rel=5e-4)
        assert np.max(np.abs(run.z[last])) == pytest.approx(response.relative_peak, rel=5e-4)


@pytest.mark.parametrize("case", CASES)
def test_motion_from_rest_that_settles_is_one_of_the_stable_responses(found, case):
    system, W, responses = found[case]
    run = frahm.integrate(system, frequency=W, periods=1500, samples_per_period=1)
    states = np.stack([run.x[-4:], run.v[-4:]], axis=2).reshape(4, -1)
    if np.max(np.abs(states - states[-1])) > 1e-6 * np.max(np.abs(states)):
        pytest.skip("the motion from rest is not periodic")
    misses = [np.max(np.abs(states[-1] - r.state)) / np.max(np.abs(r.state)) for r in responses if r.stable]
    assert min(misses, default=np.inf) < 1e-5


@pytest.mark.parametrize("case", CASES)
def test_multipliers_against_the_variational_equation_by_scipy(found, case):
    system, W, responses = found[case]
    n, inverse = system.size, np.linalg.inv(system.mass)

    def rate(t, y):
        x, v, dx, dv = y[:n], y[n : 2 * n], *y[2 * n :].reshape(2, n, -1)
        C, K = system.damping.copy(), system.stiffness.copy()
        for element in system.elements:
            outer = np.outer(element.direction, element.direction)
            C, K = C + element.law.damping * outer, K + float(element.law.stiffness(element.direction @ x)) * outer
        return np.concatenate([v, system.acceleration(x, v, W * t), *dv, *(-inverse @ (C @ dv + K @ dx))], axis=None)

    for response in responses[:3]:
        x, v = response.state.reshape(n, 2).T
        start = np.concatenate([x, v, np.eye(2 * n).ravel()])
        done = solve_ivp(rate, (0, 2 * np.pi / W), start, method="DOP853", rtol=1e-11, atol=1e-13)
        exact = np.linalg.eigvals(done.y[2 * n :, -1].reshape(2 * n, 2 * n))
        scale = max(1.0, np.max(np.abs(exact)))
        for multiplier in exact:
            assert np.min(np.abs(response.multipliers - multiplier)) < 1e-6 * scale
        assert response.stable == bool(np.max(np.abs(exact)) < 1)


def test_multipliers_against_heyoka():
    heyoka = pytest.importorskip("heyoka")
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
    system = frahm.build_system(case)
    W = system.reference_frequency - 0.144
    names = heyoka.make_vars("x", "v", "y", "w")
    x, v, y, w = names
    push = 0.0085 * (w - v) + 367.38 * (y - x) * (y - x) * (y - x)
    omega, xi1, F = system.reference_frequency, system.damping[0, 0] / 247, system.forcing[0] / 247
    rates = [v, F * heyoka.cos(W * heyoka.time) - xi1 * v - omega**2 * x + push, w, -push / 0.02]
    equations = heyoka.var_ode_sys(list(zip(names, rates, strict=True)), heyoka.var_args.vars, order=1)
    for response in frahm.periodic_responses(system, frequency=W):
        taylor = heyoka.taylor_adaptive(equations, list(response.state), tol=1e-15, compact_mode=True)
        taylor.propagate_until(2 * np.pi / W)
        exact = np.linalg.eigvals(taylor.state[4:].reshape(4, 4))
        np.testing.assert_allclose(np.sort(np.abs(response.multipliers)), np.sort(np.abs(exact)), atol=1e-6)


@pytest.mark.parametrize("kappa", [5.0, 24.425])
def test_slow_flow_is_the_limit_of_a_small_third_harmonic(kappa):
    # its error is of the order of the third harmonic over the first, which stands in the exact response
    case = frahm.load_case("jacket-pipe").with_absorber(kappa=kappa, xi2=0.0085, rho2=0.02)
    slow = frahm.frequency_response(case, detuning=(-0.3, 0.3), method="slow-flow")
    for detuning in (-0.2, -0.1, -0.03, 0.01, 0.1):
        (exact,) = frahm.periodic_responses(case, detuning=detuning)
        third = np.max(np.abs(exact.harmonics[3])) / np.max(np.abs(exact.harmonics[1]))
        near = np.interp(detuning, slow.detuning, slow.relative_amplitude)
        assert near == pytest.approx(exact.relative_amplitude, rel=1.5 * third + 1e-6)
        assert third < 0.05
