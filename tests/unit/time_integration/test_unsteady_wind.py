import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import frahm
from frahm.loads import WakeOscillator, wind_excitation
from frahm.time_integration.driven import Flow, mechanics_of, rate_of_change, table_of
from frahm.time_integration.wake import wake_flow

CASE = frahm.load_case("jacket-pipe")
GUSTS = frahm.WindRecord([0.0, 7.0, 11.5, 30.0, 31.0, 80.0], [2.6, 2.75, 2.4, 2.9, 2.6, 2.7])


def test_rates_of_a_general_system_are_its_equations(random_system):
    system = random_system(3)
    n, random = system.size, np.random.default_rng(4)
    flow = Flow(False, 1.7, 0.8, table_of([0.0, 1.0], [0.2, 0.25]), table_of([0.0], [0.9]), 0.0, 0.0, 0.0)
    mechanics = mechanics_of(system, system.forcing)
    for speed in (0.7, 1.8, 4.0):
        y, k = random.normal(size=2 * n + 2), np.empty(2 * n + 2)
        rate_of_change(mechanics, flow, speed, y, k)
        force = 0.8 * speed**2 * 0.9
        np.testing.assert_allclose(k[:n], y[n : 2 * n])
        expected = system.acceleration(y[:n], y[n : 2 * n], y[2 * n], scale=force)
        np.testing.assert_allclose(k[n : 2 * n], expected, rtol=1e-11)
        strouhal = np.interp(np.log(speed), [0.0, 1.0], [0.2, 0.25])
        assert k[2 * n] == pytest.approx(1.7 * speed * strouhal, rel=1e-14)
        assert k[2 * n + 1] == 0.0


def wake_by_hand(case, wake, speed):
    """The printed equations of pipe and wake, and one cubic sink on it."""
    D, rho = case.pipe.diameter, case.wind.air_density
    m, omega, zeta = case.pipe.mass, case.pipe.frequency, case.pipe.damping_ratio
    law, mass = case.absorbers[0].law, case.absorbers[0].mass
    shedding = 2 * np.pi * wake.strouhal * speed / D

    def rates(_, y):
        x1, x2, v1, v2, q, p = y
        sink = law.stiffness * (x2 - x1) ** 3 + law.damping * (v2 - v1)
        damping = 2 * m * zeta * omega + wake.stall * shedding * rho * D**2
        lift = 0.25 * rho * speed**2 * D * wake.lift_coefficient * q
        a1 = (lift - damping * v1 - m * omega**2 * x1 + sink) / m
        a2 = -sink / mass
        bend = wake.coupling / D * a1 - wake.nonlinearity * shedding * (q**2 - 1) * p - shedding**2 * q
        return np.array([v1, v2, a1, a2, p, bend])

    return rates


def test_rates_of_the_wake_are_the_printed_equations():
    wake, speed = WakeOscillator(), 2.9
    mechanics, flow = mechanics_of(frahm.build_system(CASE), np.array([1.0, 0.0])), wake_flow(CASE, wake)
    y, k = np.array([0.03, -0.02, 0.11, 0.2, 1.7, -3.0]), np.empty(6)
    rate_of_change(mechanics, flow, speed, y, k)
    np.testing.assert_allclose(k, wake_by_hand(CASE, wake, speed)(0.0, y), rtol=1e-12)


def test_steady_record_is_the_harmonic_force():
    # the same motion by `integrate`, sampled at the period of the force
    speed, tolerance = 2.66, 1e-12
    omega = float(wind_excitation(CASE).frequency(speed))
    other = frahm.integrate(CASE.with_wind(speed=speed), frequency=omega, periods=150, tolerance=1e-13)
    record = ([0.0, other.time[-1] + 1e-9], [speed, speed])
    found = frahm.unsteady_response(CASE, record=record, samples_per_period=256, tolerance=tolerance)
    x, v, t = found.history.x[:, 0], found.history.v[:, 0], found.history.time
    spline = np.clip(np.searchsorted(t, other.time, side="right") - 1, 0, t.size - 2)
    s, h = (other.time - t[spline]) / t[1], t[1]
    a, b, va, vb = x[spline], x[spline + 1], h * v[spline], h * v[spline + 1]
    here = a + s * (va + s * (3 * (b - a) - 2 * va - vb + s * (2 * (a - b) + va + vb)))
    inside = other.time <= t[-1]
    assert np.max(np.abs(here - other.x1)[inside]) < 2e-9 * np.max(np.abs(x)) + 1e-11
    assert found.history.phase[-1] == pytest.approx(omega * t[-1], rel=1e-12)
    assert found.history.outcome.ok
    np.testing.assert_array_equal(found.history.x, found.steady.x)


def test_gusts_and_tables_against_scipy():
    case = CASE.with_wind(
        strouhal=[[1e5, 0.24], [1.35e5, 0.22], [2e5, 0.23]], lift_coefficient=[[1e5, 0.6], [2e5, 0.3]]
    )
    found = frahm.unsteady_response(case, record=GUSTS, tolerance=1e-11)
    law, system = wind_excitation(case), frahm.build_system(case)
    unit = system.forcing / float(law.lift(case.wind.speed))

    def rates(t, y):
        U = np.interp(t, GUSTS.time, GUSTS.speed)
        pushed = system.acceleration(y[:2], y[2:4], 0.0, scale=0.0) + np.linalg.solve(
            system.mass, unit * float(law.lift(U)) * math.cos(y[4])
        )
        return np.concatenate([y[2:4], pushed, [float(law.frequency(U))]])

    # Neither method steps over a corner: of the record, or where the wind passes the middle pair of the table.
    y, end, corner = np.zeros(5), found.history.time[-1], 1.35e5 * 1.5e-5 / 0.762
    t, U = GUSTS.time, GUSTS.speed
    passed = [t[i] + (corner - U[i]) / (U[i + 1] - U[i]) * (t[i + 1] - t[i]) for i in range(5)
              if (U[i] - corner) * (U[i + 1] - corner) < 0]  # fmt: skip
    assert len(passed) == 5
    ends = sorted([*t[1:-1], *passed, end])
    for start, stop in zip([0.0, *ends[:-1]], ends, strict=True):
        y = solve_ivp(rates, (start, stop), y, method="DOP853", rtol=1e-11, atol=1e-14).y[:, -1]
    np.testing.assert_allclose(found.history.x[-1], y[:2], atol=1e-9 * np.max(np.abs(found.history.x)))
    assert found.history.phase[-1] == pytest.approx(y[4], abs=1e-9)


def test_the_step_of_the_method_does_not_show():
    coarse, fine = (frahm.unsteady_response(CASE, record=GUSTS, tolerance=tol) for tol in (1e-7, 1e-12))
    assert np.max(np.abs(coarse.history.x - fine.history.x)) < 1e-5 * np.max(np.abs(fine.history.x))
    dense = frahm.unsteady_response(CASE, record=GUSTS, tolerance=1e-12, samples_per_period=64)
    np.testing.assert_allclose(dense.history.x[::2][: fine.history.time.size], fine.history.x, atol=1e-12)


def test_build_up_of_the_seed_pipe_takes_136_seconds():
    found = frahm.unsteady_response(CASE, record=([0.0, 60.0], [2.7, 2.7]))
    assert found.time_constant == pytest.approx(136.0, abs=0.05)
    assert found.build_up_time == pytest.approx(found.time_constant, rel=1e-4)
    assert found.resonant_speed == pytest.approx(0.78 * 0.762 / 0.225)
    # 0.0867 m at the lift of 2.7 m/s, less by the square of the speed
    assert found.resonant_amplitude == pytest.approx(0.08670 * (found.resonant_speed / 2.7) ** 2, abs=5e-6)


def test_gusts_move_the_bare_pipe_less_than_steady_resonance_and_the_sink_helps():
    resonant = CASE.with_wind(speed=2.6416, turbulence={"intensity": 0.1, "length_scale": 60.0})
    found = frahm.unsteady_response(resonant, duration=1500.0, seed=3)
    with_them, without = found.reduction_by_gusts
    assert 0.3 < without < 1.0
    assert found.reduction_by_absorbers > 0.1
    assert found.bare_steady.pipe_peak == pytest.approx(found.resonant_amplitude, rel=0.01)
    assert math.isfinite(with_them)
    data = found.to_dataset()
    assert all({"units", "long_name"} <= set(data[name].attrs) for name in data.variables)
    assert data.attrs["outcome"] == "DONE"
    again = frahm.unsteady_response(resonant, duration=1500.0, seed=3)
    np.testing.assert_array_equal(again.history.x, found.history.x)
    assert not np.array_equal(frahm.unsteady_response(resonant, duration=1500.0, seed=4).speed, found.speed)


def test_the_lift_of_another_speed_is_used_where_the_case_has_none():
    case = CASE.with_wind(speed=2.7, lift_coefficient=[[1.3e5, 0.4], [1.36e5, 0.0], [2e5, 0.0]])
    assert frahm.build_system(case).forcing[0] == 0.0
    found = frahm.unsteady_response(case, record=([0.0, 50.0], [2.6, 2.6]))
    direct = frahm.unsteady_response(case.with_wind(speed=2.6), record=([0.0, 50.0], [2.6, 2.6]))
    assert found.history.pipe_peak == pytest.approx(direct.history.pipe_peak, rel=1e-9)
    assert found.history.pipe_peak > 0
    calm = frahm.unsteady_response(CASE.with_wind(lift_coefficient=0.0), record=([0.0, 20.0], [2.6, 2.6]))
    assert calm.history.pipe_peak == 0.0


def test_an_elastic_pipe_and_a_pipe_without_absorbers():
    elastic = frahm.load_case("jacket-pipe-elastic")
    record = ([0.0, 40.0, 60.0], [2.6, 2.7, 2.5])
    found = frahm.unsteady_response(elastic, record=record)
    assert found.outcome.ok
    assert found.build_up_time == pytest.approx(found.time_constant, rel=1e-3)
    bare = frahm.unsteady_response(CASE.without_absorbers(), record=record)
    np.testing.assert_array_equal(bare.history.x, bare.bare.x)
    assert math.isnan(bare.history.relative_peak)


def test_lock_in_curve_against_scipy_at_one_speed():
    wake, speed = WakeOscillator(), 3.0
    found = frahm.wake_response(CASE, wind=(speed, speed + 1e-6), speeds=2)
    y = np.array([0.0, 0.0, 0.0, 0.0, 0.1, 0.0])
    run = solve_ivp(wake_by_hand(CASE, wake, speed), (0, 1500), y, method="LSODA", rtol=1e-8, atol=1e-10,
                    t_eval=np.linspace(1300, 1500, 8001))  # fmt: skip
    assert np.max(np.abs(run.y[0])) == pytest.approx(found.curve.pipe_peak[0, 0], rel=5e-3)
    assert np.max(np.abs(run.y[4])) == pytest.approx(found.curve.wake_peak[0, 0], rel=5e-3)


def test_lock_in_curve_shows_both_directions_and_is_labelled():
    found = frahm.wake_response(CASE, wind=(2.7, 3.3), speeds=7)
    assert found.unverified == ()
    assert found.bare.hysteresis.size > 0
    assert np.all(found.curve.pipe_peak < 0.3 * np.nanmax(found.bare.pipe_peak))
    data = found.to_dataset()
    assert all({"units", "long_name"} <= set(data[name].attrs) for name in data.variables)
    assert data["pipe_peak"].dims == ("direction", "speed")
    assert any("fitted together" in note for note in found.notes)
    mine = frahm.wake_response(CASE, wind=(2.6, 2.7), speeds=2, wake=WakeOscillator.of_case(CASE))
    assert mine.wake.strouhal == 0.225
    assert not any("fitted together" in note for note in mine.notes)


def test_a_motion_that_has_no_time_to_settle_is_named():
    found = frahm.wake_response(CASE.without_absorbers(), wind=(3.0, 3.05), speeds=2, most_periods=160)
    assert "had not settled at 3" in found.unverified[0]
    assert not np.all(found.curve.settled)


def test_a_wake_in_steady_wind_builds_up_to_its_lock_in_curve():
    wake, speed = WakeOscillator(), 3.0
    found = frahm.unsteady_response(CASE, record=([0.0, 1200.0], [speed, speed]), wake=wake)
    lasting = frahm.wake_response(CASE, wind=(speed, speed + 1e-6), speeds=2, wake=wake)
    assert found.bare.pipe_peak == pytest.approx(lasting.bare.pipe_peak[0, 0], rel=3e-3)
    assert found.bare.pipe_rms(found.since) == pytest.approx(lasting.bare.pipe_rms[0, 0], rel=5e-3)
    assert found.resonant_amplitude == pytest.approx(0.0735 * 0.762, rel=1e-3)
    assert np.max(np.abs(found.bare.q)) > 2
    assert np.all(np.isnan(found.history.phase))
    assert found.lift[0] == pytest.approx(0.5 * 0.3 * 1.225 * 9.0 * 0.762)


def test_a_wake_in_gusts_against_scipy():
    wake = WakeOscillator()
    found = frahm.unsteady_response(CASE, record=GUSTS, wake=wake, tolerance=1e-11)
    assert any("steady flow" in note for note in found.notes)
    assert not any("no margin" in note for note in found.notes)

    def rates(t, y):
        return wake_by_hand(CASE, wake, float(np.interp(t, GUSTS.time, GUSTS.speed)))(t, y)

    y, ends = np.array([0.0, 0.0, 0.0, 0.0, 0.1, 0.0]), [*GUSTS.time[1:-1], found.history.time[-1]]
    for start, stop in zip([0.0, *ends[:-1]], ends, strict=True):
        y = solve_ivp(rates, (start, stop), y, method="DOP853", rtol=1e-10, atol=1e-13).y[:, -1]
    np.testing.assert_allclose(found.history.x[-1], y[:2], atol=1e-7 * np.max(np.abs(found.history.x)))
    assert found.history.q[-1] == pytest.approx(y[4], abs=1e-7)
    with pytest.raises(frahm.ParameterError, match=r"pipe\.kind"):
        frahm.unsteady_response("jacket-pipe-elastic", record=GUSTS, wake=wake)
    with pytest.raises(frahm.ParameterError, match="WakeOscillator"):
        frahm.unsteady_response(CASE, record=GUSTS, wake="facchinetti")
