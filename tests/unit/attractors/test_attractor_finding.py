import numpy as np
import pytest

import frahm
from frahm.attractors.settling import Settling, known_orbits
from frahm.attractors.stroboscope import stroboscope
from frahm.systems import with_parameters
from frahm.time_integration import integrate_batch

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
OMEGA = CASE.pipe.frequency
REGION = {"x1": (-0.08, 0.08), "v1": (-0.08 * OMEGA, 0.08 * OMEGA)}


def columns(found):
    return [(a.kind, a.pipe_peak, a.relative_peak, a.basin_fraction, a.lyapunov) for a in found]


def test_the_answer_does_not_depend_on_the_number_of_threads():
    one, three = (frahm.find_attractors(CASE, detuning=-0.04, samples=150, workers=n) for n in (1, 3))
    np.testing.assert_equal(columns(one), columns(three))
    np.testing.assert_array_equal(one[0].representative_state, three[0].representative_state)


def test_fractions_and_intervals_belong_together():
    found = frahm.find_attractors(CASE, detuning=-0.144, region=REGION, samples=100)
    assert sum(a.basin_fraction for a in found) == pytest.approx(1.0)
    assert all(a.basin_interval[0] <= a.basin_fraction <= a.basin_interval[1] for a in found)
    assert found.missed_below == pytest.approx(1 - 0.05**0.01)
    assert "100 initial states" in found.statement
    assert [a.pipe_peak for a in found] == sorted((a.pipe_peak for a in found), reverse=True)


def test_a_coexisting_response_is_found_from_100_samples():
    """Duffing's oscillator: both branches, and the unstable one between them is none."""
    system = frahm.System([[1.0]], [[0.1]], [[1.0]], [0.3], [frahm.Element([1.0], frahm.Cubic(1.0))])
    responses = frahm.periodic_responses(system, frequency=1.5)
    found = frahm.find_attractors(system, frequency=1.5, samples=100)
    assert [r.stable for r in responses] == [True, False, True]
    np.testing.assert_allclose(
        sorted(a.pipe_peak for a in found), [responses[0].pipe_peak, responses[2].pipe_peak], rtol=1e-6
    )
    assert all(a.basin_fraction > 0.05 for a in found)


def test_a_periodic_response_that_is_not_given_is_found_by_following_motions():
    """Without any periodic response told, Newton's method finds the orbits the motions go to."""
    system = frahm.System([[1.0]], [[0.1]], [[1.0]], [0.3], [frahm.Element([1.0], frahm.Cubic(1.0))])
    settling = Settling(stroboscope(system, 1.5), periods=2000)
    states = np.random.default_rng(0).uniform(-2, 2, (40, 2))
    settled = settling.settle(states)
    assert np.all(settled.labels >= 0)
    exact = [r for r in frahm.periodic_responses(system, frequency=1.5) if r.stable]
    found = np.sort([orbit.states[0, 0] for orbit in settling.orbits])
    np.testing.assert_allclose(found, np.sort([r.state[0] for r in exact]), rtol=1e-6)


def test_a_subharmonic_is_periodic_with_its_multiple():
    """The pipe at sigma -0.144 has a motion of three periods with a basin below one per cent."""
    strobe = stroboscope(frahm.build_system(CASE), OMEGA - 0.144)
    state = np.array([[0.00420025, 0.00231525, -0.00432281, -0.0170471]])
    responses = [r.state for r in frahm.periodic_responses(CASE, detuning=-0.144) if r.stable]
    settling = Settling(strobe, 3000, known_orbits(strobe, responses))
    assert settling.settle(state).labels[0] == 2
    assert settling.known[2].multiple == 3
    later = integrate_batch(CASE, detuning=-0.144, initial_states=state, periods=3000, strobes=4).strobes[0]
    assert np.max(np.abs(later[3] - later[0])) < 1e-7
    assert np.max(np.abs(later[2] - later[0])) > 1e-3


def test_the_dataset_says_what_everything_is():
    data = frahm.find_attractors(CASE, detuning=0.0, samples=20).to_dataset()
    assert all(data[name].attrs["units"] and data[name].attrs["long_name"] for name in data.variables)
    assert data.kind.attrs["kinds"].split(", ")[int(data.kind[0])] == "quasi-periodic"
    assert data.sizes["attractor"] == 1


def test_the_map_agrees_with_single_runs(tmp_path):
    data = frahm.basin_map(CASE, detuning=-0.144, extent=tuple(REGION.values()), resolution=(9, 8))
    assert data.label.dims == ("x1", "v1")
    assert data.label.shape == (9, 8)
    assert all(data[name].attrs["units"] and data[name].attrs["long_name"] for name in data.variables)
    x1, v1 = np.meshgrid(data.x1, data.v1, indexing="ij")
    states = np.stack([x1.ravel(), v1.ravel()] * 2, axis=1)
    batch = integrate_batch(CASE, detuning=-0.144, initial_states=states, periods=3000)
    reached = data.pipe_peak.values[data.label.values.ravel()]
    np.testing.assert_allclose(reached, batch.pipe_peak, rtol=1e-3)
    data.to_netcdf(tmp_path / "map.nc", engine="h5netcdf")


def test_another_plane_of_the_map():
    data = frahm.basin_map(CASE, detuning=-0.144, plane=("z", "w"), resolution=5)
    assert data.label.dims == ("z", "w")
    assert data.label.values[2, 2] == 1  # rest leads to the lower response


def test_the_worst_case_is_no_smaller_than_any_attractor_nearby():
    worst = frahm.worst_case(CASE, detuning=(-0.05, 0.05), samples=16)
    assert worst.verified
    surveyed = [survey.frequency for survey in worst.surveys]
    assert worst.frequency in surveyed
    assert worst.relative_frequency in surveyed
    for sigma in (worst.detuning - 0.004, worst.detuning + 0.004, -0.006, 0.037):  # the last in gaps between surveys
        found = [a for a in frahm.find_attractors(CASE, detuning=sigma, samples=16) if a.basin_fraction > 0]
        assert max(a.pipe_peak for a in found) <= worst.pipe_peak * 1.001
        assert max(a.relative_peak for a in found) <= worst.relative_peak * 1.002
    assert worst.attractor.pipe_peak == worst.pipe_peak
    assert worst.detuning == pytest.approx(worst.frequency - OMEGA)
    assert worst.relative_peak >= worst.attractor.relative_peak


def test_a_beat_of_nearly_fifteen_periods_is_modulated_and_not_unsettled():
    """Strobes that nearly repeat after 15 and 16 periods once looked like orbits that could not be found."""
    sink = CASE.with_absorber(kappa=2938.763886908479, xi2=0.05740993019274083)
    for error, W, repeats in ((1.05, 5.17606, 15), (1.1, 5.35969, 16)):
        system = with_parameters(frahm.build_system(sink), pipe_frequency=error * OMEGA, force=error**2)
        found = frahm.find_attractors(system, frequency=W, samples=24)
        assert [a.kind for a in found] == ["quasi-periodic"]
        late = frahm.integrate(system, frequency=W, periods=8000, samples_per_period=8)
        strobes = late.x1[-400 * 8 :: 8]
        moved = [np.max(np.abs(strobes[m:] - strobes[:-m])) for m in range(1, 20)]
        assert 1 + np.argmin(moved) == repeats
        last = late.x1[-3000 * 8 :]
        assert found[0].pipe_peak == pytest.approx(np.max(np.abs(last)), rel=0.08)  # 8 samples a period cut the peak
        assert found[0].pipe_rms == pytest.approx(np.sqrt(np.mean(last**2)), rel=2e-3)


def test_no_state_is_settled_twice(monkeypatch):
    """The first of the sample and rest are settled among the seeds, and counted from there."""
    asked, settle = [], Settling.settle

    def recorded(self, states, resume=True):
        asked.extend(map(tuple, states))
        return settle(self, states, resume)

    monkeypatch.setattr(Settling, "settle", recorded)
    found = frahm.find_attractors("jacket-pipe", detuning=0.2, samples=24)
    assert found.samples == 24
    assert found[0].basin_fraction == 1.0
    assert found[0].from_rest
    assert len(asked) == len(set(asked)) > 24
