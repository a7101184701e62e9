"""Windows down to zero frequency: the work is bounded, and what was not searched is said."""

import numpy as np
import pytest

import frahm
from frahm.harmonic_balance.quasi_static import searched_window

CASE = frahm.load_case("jacket-pipe").to_dict()
LAW = {"kind": "bistable", "negative_stiffness": 10.0, "stiffness": 9e4, "damping": 1.0}
BISTABLE = frahm.load_case(CASE | {"absorbers": [{"name": "sink", "mass": 4.94, "law": LAW}]})
SYSTEM = frahm.build_system(BISTABLE)
TOP = 1.3 * SYSTEM.reference_frequency


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("lowest", [1e-6, 1e-12])
def test_a_bistable_sink_over_a_window_down_to_zero(lowest):
    curve = frahm.frequency_response(BISTABLE, frequency=(lowest, TOP))
    assert curve.branches
    assert curve.unverified[0].startswith(f"Between {lowest:.4g} and 0.004901 rad/s nothing was searched")
    assert curve.frequency.min() >= 1e-3 * SYSTEM.reference_frequency * (1 - 1e-9)


@pytest.mark.filterwarnings("error")
def test_responses_to_a_force_too_slow_to_follow_have_no_stability():
    found = frahm.periodic_responses(BISTABLE, frequency=1e-5)
    assert len(found) >= 1
    for response in found:
        assert np.all(np.isnan(response.multipliers))
        assert not response.stable
        assert np.isfinite(response.pipe_peak)


@pytest.mark.parametrize(("factor", "raised"), [(1e-2, False), (1e-4, True)])
def test_the_lowest_frequency_searched_scales_with_the_structure(factor, raised):
    for stiffness in (1.0, 1e6):
        system = frahm.System([[1.0]], [[0.01]], [[stiffness]], [1.0], [frahm.Element([1.0], frahm.Cubic(1.0))])
        omega = np.sqrt(stiffness)
        lo, hi, words = searched_window(system, factor * omega, 2 * omega)
        assert lo == pytest.approx(1e-3 * omega if raised else factor * omega)
        assert hi == 2 * omega
        assert bool(words) == raised


def test_detached_curves_and_loci_say_what_they_left_out():
    cubic = frahm.load_case("jacket-pipe").with_absorber(kappa=24.0)
    found = frahm.detached_curve_events(cubic, "force", (0.9, 1.0), frequency=(1e-6, 5.0), slices=2)
    assert "nothing was searched" in found.unverified[0]
    data = frahm.bifurcation_curve(cubic, plane=("frequency", "force"), bounds=((1e-6, 5.0), (0.9, 1.0)), slices=1)
    assert "nothing was searched" in data.attrs["unverified"]


def test_slices_that_meet_their_limit_of_work_are_named(monkeypatch):
    cubic = frahm.load_case("jacket-pipe").with_absorber(kappa=24.0)
    search = {"frequency": (4.6, 5.0), "slices": 2}
    assert frahm.detached_curve_events(cubic, "force", (0.9, 1.0), **search).unverified == ()
    monkeypatch.setattr("frahm.harmonic_balance.found.Budget.reached", property(lambda self: True))
    found = frahm.detached_curve_events(cubic, "force", (0.9, 1.0), **search)
    assert [sentence.partition(":")[0] for sentence in found.unverified] == ["At force 0.9", "At force 1"]
    assert "met its limit of work" in found.unverified[0]
    data = frahm.bifurcation_curve(cubic, plane=("frequency", "force"), bounds=((4.6, 5.0), (0.9, 1.0)), slices=1)
    assert "met its limit of work" in data.attrs["unverified"]
