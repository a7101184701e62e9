"""Every number of a sweep is the one a single call of the method gives at that point."""

import numpy as np
import pytest

import frahm
from frahm.attractors.attractor import KINDS

CASE = frahm.load_case("jacket-pipe")


def swept(tmp_path, axes, quantities, case="jacket-pipe", **more):
    study = frahm.load_study({"case": case, "axes": axes, "quantities": quantities, **more})
    return study, frahm.sweep(study, store=tmp_path / "s").load()


def test_a_slow_flow_sweep_is_the_slow_flow_map(tmp_path):
    kappa, xi2, sigma = np.geomspace(20, 900, 5).round(6), np.array([0.004, 0.01, 0.03]), np.linspace(-0.2, 0.2, 9)
    axes = {"rho2": [0.02, 0.035], "kappa": kappa.tolist(), "xi2": xi2.tolist(), "detuning": sigma.tolist()}
    _, data = swept(tmp_path, axes, {"slow_flow": {}})
    for i, rho2 in enumerate(data.rho2.values):
        case = CASE.with_absorber(rho2=float(rho2))
        whole = frahm.slow_flow_map(case, detuning=sigma, kappa=kappa[:, None, None], xi2=xi2[:, None])
        for name in ("pipe_amplitude", "relative_amplitude", "stability"):
            np.testing.assert_array_equal(data[f"slow_flow_{name}"][i].values, whole[name].values)
        stable = np.where(whole.stability == 0, whole.pipe_amplitude, -1).max(axis=-1)
        np.testing.assert_array_equal(np.nan_to_num(data.slow_flow_stable_pipe_peak[i], nan=-1), stable)
        np.testing.assert_array_equal(data.slow_flow_equilibria[i], (whole.stability >= 0).sum("root"))
    assert set(np.unique(data.slow_flow_equilibria)) == {1, 3}  # both sorts of points were there


@pytest.mark.parametrize(("name", "method"), [("response", "harmonic-balance"), ("slow_flow", "slow-flow")])
def test_a_response_sweep_is_the_frequency_response_of_every_point(tmp_path, name, method):
    window = (-0.25, 0.25)
    axes = {"force": [0.5, 1.0], "kappa": [97.97, 367.38], "xi2": [0.0085, 0.0117]}
    _, data = swept(tmp_path, axes, {name: {"detuning": list(window)}})
    detached = 0
    for index in np.ndindex(2, 2, 2):
        at = {axis: float(data[axis][i]) for axis, i in zip(axes, index, strict=True)}
        case = CASE.with_absorber(kappa=at["kappa"], xi2=at["xi2"])
        system = frahm.build_system(case)
        loud = frahm.System(system.mass, system.damping, system.stiffness, at["force"] * system.forcing,
                            system.elements, reference_frequency=system.reference_frequency)  # fmt: skip
        curve = frahm.frequency_response(loud, detuning=window, method=method)
        found = {key.removeprefix(f"{name}_"): data[key].values[index] for key in data.data_vars}
        assert (found["pipe_peak"], found["branches"]) == (curve.pipe_peak.max(), len(curve.branches))
        assert found["peak_detuning"] == pytest.approx(curve.detuning[np.argmax(curve.pipe_peak)], abs=1e-12)
        limit = curve.pipe_peak[curve.growth_rate < 1e-6].max()
        assert found["stable_pipe_peak"] == limit >= curve.pipe_peak[curve.stable].max()
        assert found["detached_branches"] == sum(branch.detached for branch in curve.branches)
        islands = [branch.pipe_peak.max() for branch in curve.branches if branch.detached]
        np.testing.assert_equal(found["detached_pipe_peak"], max(islands, default=np.nan))
        assert found["saddle_nodes"] == sum(point.kind == "saddle-node" for point in curve.special_points)
        assert found["verified"] == (not curve.unverified)
        detached += len(islands)
    assert detached > 0


def test_unstable_ranges_are_what_a_fine_grid_of_growth_rates_shows(tmp_path):
    axes = {"kappa": [97.97, 367.38], "xi2": [0.0085]}
    _, data = swept(tmp_path, axes, {"slow_flow": {"detuning": [-0.3, 0.3]}})
    for i, kappa in enumerate(axes["kappa"]):
        whole = frahm.slow_flow_map(CASE, detuning=np.linspace(-0.3, 0.3, 20_001), kappa=kappa, xi2=0.0085)
        unstable = np.any(whole.stability.values > 0, axis=-1)
        none = ~np.any(whole.stability.values == 0, axis=-1)
        for name, flags in (("unstable_ranges", unstable), ("ranges_without_stable", none)):
            ranges = np.count_nonzero(np.diff(flags.astype(int)) == 1) + int(flags[0])
            assert data[f"slow_flow_{name}"].values[i, 0] == ranges


def test_responses_at_a_detuning_are_the_periodic_responses(tmp_path):
    axes = {"kappa": [97.97, 367.38], "xi2": [0.0085], "detuning": [-0.12, 0.02]}
    _, data = swept(tmp_path, axes, {"response": {}})
    counts = set()
    for i, kappa in enumerate(axes["kappa"]):
        for j, sigma in enumerate(axes["detuning"]):
            found = frahm.periodic_responses(CASE.with_absorber(kappa=kappa, xi2=0.0085), detuning=sigma)
            point = data.isel(kappa=i, xi2=0, detuning=j)
            assert point.response_responses == len(found)
            assert point.response_stable_responses == sum(response.stable for response in found)
            assert point.response_pipe_peak == max(response.pipe_peak for response in found)
            stable = [response.pipe_peak for response in found if response.stable]
            np.testing.assert_equal(float(point.response_stable_pipe_peak), max(stable, default=np.nan))
            counts.add(len(found))
    assert counts == {1, 3}


def test_the_worst_over_a_window_is_the_worst_case(tmp_path):
    quantities = {"attractors": {"detuning": [0.0, 0.01], "samples": 4, "min_basin": 0.1}}
    study, data = swept(tmp_path, {"kappa": [97.97], "xi2": [0.05]}, quantities, seed=11)
    assert data.seed.values.item() == study.seed_at(0)
    case = CASE.with_absorber(kappa=97.97, xi2=0.05)
    worst = frahm.worst_case(case, detuning=(0.0, 0.01), samples=4, min_basin=0.1, seed=study.seed_at(0))
    assert data.attractors_pipe_peak.item() == worst.pipe_peak
    assert data.attractors_relative_peak.item() == worst.relative_peak
    assert data.attractors_peak_detuning.item() == worst.detuning
    assert KINDS[data.attractors_kind.item()] == worst.attractor.kind
    assert data.attractors_verified.item() == worst.verified


def test_motions_at_the_wind_are_the_attractors_there(tmp_path):
    quantities = {"attractors": {"detuning": "wind", "samples": 16}}
    study, data = swept(tmp_path, {"wind_speed": [2.6, 2.65]}, quantities)
    for i, speed in enumerate((2.6, 2.65)):
        case = CASE.with_wind(speed=speed)
        sigma = 2 * np.pi * 0.225 * speed / 0.762 - case.pipe.frequency
        found = frahm.find_attractors(case, detuning=sigma, samples=16, seed=study.seed_at(i))
        worst = max((motion for motion in found if motion.basin_fraction >= 0.01), key=lambda m: m.pipe_peak)
        assert data.attractors_pipe_peak[i].item() == pytest.approx(worst.pipe_peak, rel=1e-9)
        assert data.attractors_basin_fraction[i].item() == worst.basin_fraction
        assert KINDS[data.attractors_kind[i].item()] == worst.kind
        assert data.attractors_motions[i].item() == sum(motion.kind != "unsettled" for motion in found)


def test_the_damage_is_that_of_every_case(tmp_path):
    case = frahm.load_case("jacket-pipe-elastic").without_absorbers()
    study, data = swept(tmp_path, {"pipe_damping": [0.002, 0.004]}, {"fatigue": {}}, case=case)
    for i, ratio in enumerate((0.002, 0.004)):
        damage = frahm.fatigue_damage(case.with_pipe(damping_ratio=ratio), seed=study.seed_at(i))
        assert data.fatigue_damage_without[i].item() == damage.damage_without > 0
        assert data.fatigue_damage_with[i].item() == damage.damage_with
