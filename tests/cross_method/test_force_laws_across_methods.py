"""Every force law by harmonic balance, by our integrator, and by codes that know nothing of either."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import frahm

OMEGA, MASS = 2 * np.pi * 0.78, 247.0
SINK = 0.02 * MASS
K3, DAMPING, LENGTH = 247 * 367.38, 247 * 0.0085, 0.3
LAWS = {
    "transverse springs": frahm.TransverseSprings(K3 * LENGTH**2, LENGTH, DAMPING, pretension=2.0),
    "pushed springs": frahm.TransverseSprings(K3 * LENGTH**2, LENGTH, DAMPING, pretension=-15.0),
    "bistable": frahm.Bistable(K3, 60.0, DAMPING),
    "stops": frahm.Cubic(K3, DAMPING, stops=frahm.Stops(0.03, 3000.0, 0.02)),
    "friction": frahm.Cubic(K3, DAMPING, friction=frahm.Friction(0.1, 0.02)),
    "weight": frahm.Cubic(K3, DAMPING, weight=9.81 * SINK),
    "heavy tuned damper": frahm.Linear(SINK * OMEGA**2, DAMPING, weight=9.81 * SINK),
    "everything": frahm.TransverseSprings(
        K3 * LENGTH**2, LENGTH, DAMPING, pretension=2.0, stops=frahm.Stops(0.05, 3000.0, 0.02),
        friction=frahm.Friction(0.1, 0.02), weight=5.0,
    ),
}  # fmt: skip
W = OMEGA + 0.05


def system_with(law):
    return frahm.System(
        np.diag([MASS, SINK]), np.diag([2 * 0.0015 * OMEGA * MASS, 0.0]), np.diag([MASS * OMEGA**2, 0.0]),
        (MASS * 0.00624696, 0.0), [frahm.Element((-1, 1), law)], reference_frequency=OMEGA,
    )  # fmt: skip


def one_period(system, state):
    """State after one period and the monodromy matrix by DOP853, states (x_0, v_0, x_1, v_1)."""
    law, n = system.elements[0].law, system.elements[0].direction
    inverse = np.linalg.inv(system.mass)

    def rate(t, y):
        x, v, Phi = y[0:4:2], y[1:4:2], y[4:].reshape(4, 4)
        K = system.stiffness + float(law.stiffness(n @ x)) * np.outer(n, n)
        C = system.damping + float(law.damping_at(n @ v)) * np.outer(n, n)
        D = np.empty((4, 4))
        D[0::2] = Phi[1::2]
        D[1::2] = -inverse @ (K @ Phi[0::2] + C @ Phi[1::2])
        out = np.empty(4)
        out[0::2], out[1::2] = v, system.acceleration(x, v, W * t)
        return np.concatenate([out, D.ravel()])

    start = np.concatenate([state, np.eye(4).ravel()])
    end = solve_ivp(rate, (0, 2 * np.pi / W), start, method="DOP853", rtol=1e-10, atol=1e-13).y[:, -1]
    return end[:4], end[4:].reshape(4, 4)


@pytest.fixture(scope="module")
def found():
    return {name: frahm.periodic_responses(system_with(law), frequency=W) for name, law in LAWS.items()}


@pytest.mark.parametrize("name", LAWS)
def test_periodic_responses_return_to_themselves_with_the_multipliers_found(found, name):
    system = system_with(LAWS[name])
    assert found[name]
    for response in found[name]:
        end, Phi = one_period(system, response.state)
        size = np.max(np.abs(response.state))
        assert np.max(np.abs(end - response.state)) < max(2e-7, 30 * response.residual) * size
        values = np.linalg.eigvals(Phi)
        values = values[np.argsort(-np.abs(values))]
        tolerance = 1e-6 if LAWS[name].is_smooth else max(1e-5, 300 * response.residual)
        assert np.abs(response.multipliers) == pytest.approx(np.abs(values), abs=tolerance)


@pytest.mark.parametrize("name", LAWS)
def test_trajectories_against_another_code(name):
    system, periods = system_with(LAWS[name]), 6
    start = np.array([0.03, 0.1, -0.02, 0.2])

    def rate(t, y):
        out = np.empty(4)
        out[0::2], out[1::2] = y[1::2], system.acceleration(y[0::2], y[1::2], W * t)
        return out

    ours = frahm.integrate(system, frequency=W, periods=periods, initial_state=start, tolerance=1e-11)
    end = solve_ivp(rate, (0, periods * 2 * np.pi / W), start, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
    assert np.column_stack([ours.x[-1], ours.v[-1]]).ravel() == pytest.approx(end, abs=2e-7)


def test_pushed_springs_with_friction_against_adaptive_taylor():
    heyoka = pytest.importorskip("heyoka")
    k, T0, force, speed = K3 * LENGTH**2, -15.0, 0.1, 0.02
    law = frahm.TransverseSprings(k, LENGTH, DAMPING, pretension=T0, friction=frahm.Friction(force, speed), weight=2.0)
    x, v, x2, v2 = heyoka.make_vars("x", "v", "x2", "v2")
    z, w = x2 - x, v2 - v
    q = heyoka.sqrt(LENGTH**2 + z * z)
    push = 2 * (T0 + k * (q - LENGTH)) * z / q + DAMPING * w + force * heyoka.tanh(w / speed) - 2.0
    drive = MASS * 0.00624696 * heyoka.cos(W * heyoka.time)
    host = (drive - 2 * 0.0015 * OMEGA * MASS * v - MASS * OMEGA**2 * x + push) / MASS
    taylor = heyoka.taylor_adaptive([(x, v), (v, host), (x2, v2), (v2, -push / SINK)], [0.0] * 4, tol=1e-15)
    taylor.propagate_until(20 * 2 * np.pi / W)
    ours = frahm.integrate(system_with(law), frequency=W, periods=20, tolerance=1e-12)
    assert np.column_stack([ours.x[-1], ours.v[-1]]).ravel() == pytest.approx(taylor.state, abs=1e-8)


@pytest.mark.parametrize(
    ("law", "limit", "tolerance"),
    [
        (frahm.TransverseSprings(K3 * 1e10, 1e5, DAMPING), frahm.Cubic(K3, DAMPING), 1e-8),
        (frahm.Cubic(K3, DAMPING, stops=frahm.Stops(1.0, 1e6)), frahm.Cubic(K3, DAMPING), 1e-9),
        (frahm.Cubic(K3, DAMPING, friction=frahm.Friction(1e-9, 0.02)), frahm.Cubic(K3, DAMPING), 1e-6),
        (frahm.Cubic(K3, DAMPING, weight=1e-9), frahm.Cubic(K3, DAMPING), 1e-6),
    ],
    ids=["long springs", "stops out of reach", "hardly any friction", "hardly any weight"],
)
def test_limits(law, limit, tolerance):
    ours = frahm.periodic_responses(system_with(law), frequency=W)
    plain = frahm.periodic_responses(system_with(limit), frequency=W)
    assert [r.stable for r in ours] == [r.stable for r in plain]
    assert [r.pipe_peak for r in ours] == pytest.approx([r.pipe_peak for r in plain], rel=tolerance)
    assert [r.relative_peak for r in ours] == pytest.approx([r.relative_peak for r in plain], rel=tolerance)


def test_a_heavy_tuned_damper_only_sags():
    # a constant force shifts a linear system and changes nothing else
    plain, heavy = (frahm.Linear(SINK * OMEGA**2, DAMPING, weight=weight) for weight in (0.0, 9.81 * SINK))
    (light,) = frahm.periodic_responses(system_with(plain), frequency=W)
    (response,) = frahm.periodic_responses(system_with(heavy), frequency=W)
    assert response.harmonics[0] == pytest.approx([0.0, 9.81 / OMEGA**2], rel=1e-9, abs=1e-12)
    assert response.pipe_peak == pytest.approx(light.pipe_peak, rel=1e-8)
    assert response.relative_peak == pytest.approx(light.relative_peak + 9.81 / OMEGA**2, rel=1e-8)


def test_all_verbs_take_them():
    law = frahm.TransverseSprings(
        K3 * LENGTH**2, LENGTH, DAMPING, stops=frahm.Stops(0.08, 2000.0, 0.05), friction=frahm.Friction(0.02, 0.05)
    )
    system = system_with(law)
    found = frahm.find_attractors(system, frequency=W, samples=40, seed=1)
    stable = [r for r in frahm.periodic_responses(system, frequency=W) if r.stable]
    periodic = [a for a in found if a.kind == "periodic"]
    assert {round(a.pipe_peak, 6) for a in periodic} <= {round(r.pipe_peak, 6) for r in stable}
    assert sum(a.basin_fraction for a in found) == pytest.approx(1.0)
    labels = frahm.basin_map(system, frequency=W, resolution=6).label
    assert labels.shape == (6, 6)
    assert int(labels.min()) >= 0
