"""Limit cycles of the slow flow against scipy's integration of it, differences, and the exact equations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import frahm
from frahm.attractors.cycle_branches import followed_branch
from frahm.attractors.cycle_starts import start_from_motion, starts_at_hopf
from frahm.attractors.slow_arcs import frequency_slope
from frahm.attractors.slow_cycles import Scales
from frahm.slow_flow import locate_points, slow_flow_of
from frahm.slow_flow.motion import slow_jacobian, slow_velocity

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=97.97, xi2=0.0085, rho2=0.02)
SLOW = slow_flow_of(frahm.build_system(CASE))
SCALES = Scales(0.0314, 0.0931, 0.1)


@pytest.fixture(scope="module")
def curve():
    return frahm.modulated_branches(CASE, detuning=(-0.1, 0.1))


def scipy_path(slow, W, state, duration, **more):
    """The slow flow as a complex differential equation written out here, at relative error 1e-12."""
    o, x1, x2, k, r, F = slow.omega, slow.xi1, slow.xi2, 0.75 * slow.kappa, slow.rho2, slow.force

    def velocity(_, y):
        X, Z = complex(y[0], y[1]), complex(y[2], y[3])
        g = (1j * W * x2 + k * abs(Z) ** 2) * Z
        dX = (F + g - (o**2 - W**2 + 1j * W * x1) * X) / (2j * W)
        dZ = (r * W**2 * (X + Z) - g) / (2j * r * W) - dX
        return [dX.real, dX.imag, dZ.real, dZ.imag]

    return solve_ivp(velocity, (0, duration), state, method="DOP853", rtol=1e-12, atol=1e-15, **more)


def monodromy(slow, W, state, period, step=1e-7):
    """Multipliers by central differences of scipy's flow over a period."""
    size = SCALES.state
    columns = []
    for e in np.eye(4):
        ends = [scipy_path(slow, W, state + sign * step * e * size, period).y[:, -1] for sign in (1, -1)]
        columns.append((ends[0] - ends[1]) / (2 * step) / size)
    return np.linalg.eigvals(np.column_stack(columns))


@pytest.mark.parametrize("form", ["averaged", "paper"])
def test_derivative_by_the_frequency(form):
    slow, W, h = slow_flow_of(frahm.build_system(CASE), form), SLOW.omega + 0.02, 1e-5
    X, Z = 0.02 - 0.013j, -0.05 + 0.07j
    head = (slow.code, *slow.host, slow.force, slow.kappa)
    sides = [np.array(slow_velocity(*head, W + sign * h, X, Z)) for sign in (1, -1)]
    np.testing.assert_allclose(frequency_slope(*head, W, X, Z), (sides[0] - sides[1]) / (2 * h), rtol=1e-8)


def test_jacobian_of_the_shooting_equations():
    (start, _) = start_from_motion(SLOW, SCALES, np.zeros(4), SLOW.omega + 0.003)
    rng, h = np.random.default_rng(3), 2e-6
    y = start.y + 1e-3 * rng.standard_normal(start.y.size) * np.abs(start.y)
    y[-1] = start.y[-1] + 1e-3
    _, J = start.shooting.residual(y)
    for _ in range(12):
        e = rng.standard_normal(y.size)
        e /= np.linalg.norm(e)
        ahead, behind = (start.shooting.residual(y + sign * h * e)[0] for sign in (1, -1))
        np.testing.assert_allclose(J @ e, (ahead - behind) / (2 * h), atol=2e-5 * np.abs(J).max())


def test_period_envelope_and_multipliers_at_resonance():
    (start, strange) = start_from_motion(SLOW, SCALES, np.zeros(4), SLOW.omega)
    cycle = start.shooting.cycle(start.y)
    assert not strange
    assert cycle.stable
    path = scipy_path(SLOW, SLOW.omega, cycle.nodes[0], cycle.period, dense_output=True)
    np.testing.assert_allclose(path.y[:, -1], cycle.nodes[0], atol=1e-8)
    y = path.sol(np.linspace(0, cycle.period, 60_000))
    pipe, relative = np.hypot(y[0], y[1]), np.hypot(y[2], y[3])
    np.testing.assert_allclose(cycle.pipe, (pipe.min(), pipe.max()), rtol=2e-5)
    np.testing.assert_allclose(cycle.relative, (relative.min(), relative.max()), rtol=2e-5)
    other = monodromy(SLOW, SLOW.omega, cycle.nodes[0], cycle.period)
    assert np.min(np.abs(other - 1)) < 1e-5
    small = other[np.argsort(np.abs(other))[-2]]
    assert small.real == pytest.approx(cycle.multipliers[np.argmax(np.abs(cycle.multipliers))].real, abs=1e-5)


def test_a_cycle_is_born_with_the_frequency_of_the_hopf_point():
    for point in locate_points(SLOW, "hopf", SLOW.omega - 0.1, SLOW.omega + 0.1):
        start = starts_at_hopf(SLOW, SCALES, point)[-1]
        cycle = start.shooting.cycle(start.y)
        X, Z = np.mean(cycle.nodes, axis=0) @ np.array([[1, 0], [1j, 0], [0, 1], [0, 1j]])
        velocity = slow_velocity(SLOW.code, *SLOW.host, SLOW.force, SLOW.kappa, point.frequency, X, Z)
        np.testing.assert_allclose(velocity, 0, atol=1e-6)
        values = np.linalg.eigvals(slow_jacobian(SLOW.code, *SLOW.host, SLOW.kappa, point.frequency, Z))
        turning = values[np.argmin(np.abs(values.real) + (values.imag <= 0))]
        assert cycle.period == pytest.approx(2 * np.pi / turning.imag, rel=1e-3)
        assert cycle.trivial_error < 1e-8


def test_a_special_point_has_its_multiplier():
    (start, _) = start_from_motion(SLOW, SCALES, np.zeros(4), SLOW.omega - 0.003)
    points, _ = followed_branch(SCALES, start, (SLOW.omega - 0.01, SLOW.omega + 0.01), None)
    for kind, expected in (("period-doubling", -1), ("fold of cycles", 1)):
        (cycle,) = [p.cycle for p in points if p.special == kind and 110 < p.cycle.period < 120][:1]
        other = monodromy(SLOW, cycle.frequency, cycle.nodes[0], cycle.period)
        assert np.sum(np.abs(other - expected) < 0.02) == (2 if expected == 1 else 1)  # a fold beside the trivial one


def test_stable_branches_attract_and_unstable_ones_do_not(curve):
    good = np.flatnonzero(curve.stable & (curve.pipe_min < 0.002))
    bad = np.flatnonzero(~curve.stable & (curve.multiplier > 5))
    assert np.all(curve.multiplier[good] <= 1 + 1e-3)
    for index, expected in ((good[len(good) // 3], True), (bad[len(bad) // 2], False)):
        W = curve.frequency[index]
        path = scipy_path(SLOW, W, np.zeros(4), 1000, dense_output=True)
        late = path.sol(np.linspace(700, 1000, 20_000))
        near = np.hypot(late[0], late[1]).max() == pytest.approx(curve.pipe_max[index], rel=1e-4)
        least = np.hypot(late[0], late[1]).min() == pytest.approx(curve.pipe_min[index], rel=0.05, abs=2e-6)
        assert (near and least) == expected


def test_where_the_branches_end(curve):
    ends = {end.kind: end for pair in curve.ends for end in pair}
    assert {"hopf", "period without bound"} <= set(ends)
    hopfs = [p.frequency - SLOW.omega for p in locate_points(SLOW, "hopf", SLOW.omega - 0.1, SLOW.omega + 0.1)]
    assert all(any(f"{at:.5g}" in end.sentence for pair in curve.ends for end in pair) for at in hopfs)
    assert np.max(curve.period) > 4 * np.median(curve.period)
    assert all(end.sentence.endswith(".") for end in ends.values())


def test_exact_motion_stays_on_what_is_stable(curve):
    assert len(curve.checks) == 3
    assert not curve.unverified
    for check in curve.checks:
        history = frahm.integrate(CASE, detuning=check.detuning, periods=1500, samples_per_period=64)
        late = np.abs(history.x1[history.time > 0.6 * history.time[-1]])
        assert np.max(late) == pytest.approx(check.exact_pipe_max, rel=5e-3)
        assert check.pipe_max == pytest.approx(check.exact_pipe_max, rel=0.02)


def test_a_window_cuts_the_branch_at_its_edges(curve):
    narrow = frahm.modulated_branches(CASE, detuning=(-0.001, 0.004), looks=5, workers=1)
    assert {end.kind for pair in narrow.ends for end in pair} == {"edge of the window"}
    np.testing.assert_allclose([narrow.detuning.min(), narrow.detuning.max()], [-0.001, 0.004], atol=1e-9)
    np.testing.assert_allclose(narrow.ranges, [(-0.001, 0.004)], atol=1e-9)
    main = curve.stable & (curve.pipe_min < 0.002)
    order = np.argsort(curve.detuning[main])
    expected = np.interp(narrow.detuning, curve.detuning[main][order], curve.pipe_max[main][order])
    np.testing.assert_allclose(narrow.pipe_max, expected, rtol=1e-3)


def test_the_dataset_says_what_everything_is(curve, tmp_path):
    data = curve.to_dataset()
    assert all({"units", "long_name"} <= set(variable.attrs) for variable in data.variables.values())
    data.to_netcdf(tmp_path / "curve.nc", engine="h5netcdf")
    assert data.sizes["point"] == curve.frequency.size
    np.testing.assert_allclose(data.coexistence, curve.coexistence)


@pytest.mark.parametrize(
    "law",
    [frahm.Cubic(0.0, 0.0085), frahm.Cubic(-97.97, 0.0085), frahm.Cubic(24.4, 0.05)],
    ids=["none", "soft", "damped"],
)
def test_no_modulation_is_an_empty_curve(law):
    system = frahm.System(
        np.diag([1.0, 0.02]), np.diag([0.0147, 0]), np.diag([24.02, 0]), (0.00625, 0), [frahm.Element((-1, 1), law)]
    )
    curve = frahm.modulated_branches(system, detuning=(-0.1, 0.1), looks=5)
    assert curve.frequency.size == 0
    assert curve.ranges == curve.coexistence == ()
    assert curve.to_dataset().sizes["point"] == 0


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"detuning": (0.1, -0.1)}, "detuning"), ({}, "detuning"), ({"detuning": (0, 1), "looks": -1}, "looks"),
        ({"detuning": (0, 1), "checks": 1.5}, "checks"), ({"detuning": (0, 1), "form": "averged"}, "averaged"),
        ({"detuning": (0, 1), "workers": 0}, "workers"), ({"detuning": (0, float("nan"))}, "detuning"),
    ],
)  # fmt: skip
def test_bad_arguments(arguments, name):
    with pytest.raises(frahm.ParameterError, match=name):
        frahm.modulated_branches(CASE, **arguments)


def test_another_system_is_refused_with_what_stands_in_the_way():
    system = frahm.System(
        np.diag([1.0, 0.02]), np.diag([0.0147, 0]), np.diag([24.02, 0]), (0.00625, 0),
        [frahm.Element((-1, 1), frahm.Linear(1.0, 0.01))],
    )  # fmt: skip
    with pytest.raises(frahm.ParameterError, match="cubic"):
        frahm.modulated_branches(system, detuning=(-0.1, 0.1))
