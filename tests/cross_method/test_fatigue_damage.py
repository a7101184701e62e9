"""Damage counted on attractors against closed forms, a plain long history, and itself on other threads."""

import numpy as np
import pytest
import rainflow

import frahm
from frahm.assessment.detail import detail_of
from frahm.assessment.linear_damage import linear_pipe
from frahm.assessment.motion_damage import motion_damage
from frahm.published.dnv_rp_c203 import sn_curve

SECTIONS = {
    "climate": {"duration": "20 year", "weibull": {"scale": 7, "shape": 2}},
    "fatigue": {"curve": "D", "stress_per_displacement": "283.5 MPa/m", "samples": 8},
}


@pytest.fixture(scope="module")
def case():
    return frahm.load_case({**frahm.load_case("jacket-pipe").to_dict(), **SECTIONS})


def test_an_almost_linear_absorber_through_the_attractors_is_the_linear_one(case):
    """A cubic term too small to matter sends the same pipe through attractors and rainflow counting."""
    stiffness, damping = 4.94 * 4.8**2, 4.0
    laws = (
        {"kind": "linear", "stiffness": stiffness, "damping": damping},
        {"kind": "polynomial", "coefficients": [stiffness, 0.0, 1e-3 * stiffness], "damping": damping},
    )
    linear, almost = (frahm.load_case({**case.to_dict(), "absorbers": [{"mass": 4.94, "law": law}]}) for law in laws)
    found = frahm.fatigue_damage(almost, bins=6)
    known = linear_pipe(linear)
    assert set(found.kinds) == {"periodic"}
    assert found.range_with == pytest.approx(known.stress_range(found.speeds, detail_of(linear)), rel=1e-5)
    seconds = 20 * 365.25 * 86400
    rates = found.bin_with / found.probabilities / seconds
    assert rates == pytest.approx(known.rate(found.speeds, detail_of(linear)), rel=1e-4)
    assert found.damage_with == found.damage_with_weighted == pytest.approx(np.sum(found.bin_with))


def test_a_modulated_motion_against_a_plain_long_history(case):
    """Dense samples without interpolation, a longer window from another start, and the library alone."""
    system = frahm.build_system(case.with_wind(speed=2.64))
    found = frahm.find_attractors(system, detuning=0.01, samples=8)  # beside it are beats locked to 43 periods
    attractor = next(attractor for attractor in found if attractor.kind == "quasi-periodic")
    found = motion_damage(system, attractor, detail_of(case))
    assert found.settled
    history = frahm.integrate(system, detuning=0.01, periods=5000, samples_per_period=128).last(4000)
    stress = 283.5e6 * history.x1
    cycles = np.array([(size, count) for size, _, count, _, _ in rainflow.extract_cycles(stress)])
    damage = np.sum(cycles[:, 1] / sn_curve("D").cycles(cycles[:, 0]))
    assert found.rate == pytest.approx(damage / (history.time[-1] - history.time[0]), rel=0.03)
    assert found.largest_range == pytest.approx(cycles[:, 0].max(), rel=0.02)


def test_two_attractors_at_one_wind_and_any_number_of_threads(case):
    """The worst of two motions counts in full, the other by its share; and nothing hangs on the threads."""
    narrow = (2.625, 2.629)
    found, again = (frahm.fatigue_damage(case, bins=4, wind=narrow, workers=workers) for workers in (1, 3))
    assert found.to_dataset().identical(again.to_dataset())
    both = found.attractors == 2
    assert both.any()
    assert np.all(found.bin_with[both] >= found.bin_weighted[both])
    assert found.damage_with > found.damage_with_weighted > 0
    assert found.locked_in_with >= found.damage_with
    for variable in found.to_dataset().variables.values():
        assert variable.attrs["units"]
        assert variable.attrs["long_name"]


def test_factors_on_the_stress(case):
    """Below the knee of the D curve the damage grows with the fifth power of the stress."""
    window = (2.75, 2.8)
    once = frahm.fatigue_damage(case, bins=4, wind=window)
    other = case.with_fatigue(stress_concentration=1.5, thickness="50 mm", design_fatigue_factor=3)
    twice = frahm.fatigue_damage(other, bins=4, wind=window)
    factor = (1.5 * 2**0.2) ** 5
    assert twice.damage_with / once.damage_with == pytest.approx(factor, rel=1e-9)
    assert twice.damage_without / once.damage_without == pytest.approx(factor, rel=1e-9)
    assert once.life_years / twice.life_years == pytest.approx(3 * factor, rel=1e-9)


def test_an_elastic_pipe_of_one_mode_is_the_rigid_one_with_its_stress():
    elastic = frahm.load_case("jacket-pipe-elastic").with_pipe(mode_count=1).with_fatigue(samples=8)
    modal, length = elastic.pipe.modal, elastic.pipe.length
    pipe = {
        "mass": modal.masses[0], "frequency": modal.frequencies[0], "damping_ratio": 0.0015,
        "diameter": elastic.pipe.diameter, "length": float(modal.lift_lengths[0]),
    }  # fmt: skip
    data = elastic.to_dict()
    absorbers = [{**absorber, "position": None} for absorber in data["absorbers"]]
    fatigue = {**data["fatigue"], "stress_per_displacement": float(abs(modal.stress()[0]))}
    rigid = frahm.load_case({**data, "pipe": pipe, "absorbers": absorbers, "fatigue": fatigue})
    assert length == pytest.approx(31.2)
    assert abs(modal.stress()[0]) == pytest.approx(283.5e6, rel=1e-3)
    one, other = (frahm.fatigue_damage(which, bins=4, wind=(2.7, 2.75)) for which in (elastic, rigid))
    assert one.damage_with == pytest.approx(other.damage_with, rel=1e-6)
    assert one.damage_without == pytest.approx(other.damage_without, rel=1e-9)
