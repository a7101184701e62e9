import math
import re
from pathlib import Path

import numpy as np
import pytest

import frahm
from frahm.cli.summary import case_summary
from frahm.loads import (
    ModeFactors,
    amplitude_estimates,
    antinodes,
    forced_amplitude,
    griffin_skop_amplitude,
    lock_in_band,
    mode_factors,
    onset_criteria,
    onset_sentence,
    operating_range,
    resonant_shedding,
    sarpkaya_amplitude,
    similarity,
    skop_griffin_number,
)

CASE = frahm.load_case("jacket-pipe")


def by_name(case, **more):
    return {criterion.name.split(" (")[0]: criterion for criterion in onset_criteria(case, **more)}


def test_similarity_numbers_of_the_seed_pipe():
    numbers = similarity(CASE)
    assert numbers.reduced_velocity == pytest.approx(4.54, abs=5e-3)
    assert numbers.scruton_number == pytest.approx(6.55, abs=5e-3)
    assert numbers.reynolds_number == pytest.approx(1.37e5, rel=2e-3)
    assert numbers.skop_griffin_number == pytest.approx(8 * np.pi**2 * 0.225**2 * 0.0015 * numbers.mass_ratio)


def test_the_resonance_of_the_seed_pipe_lies_below_brown_and_root():
    found = by_name(CASE)
    assert found["Brown & Root 1985"].expects_vibration is False
    assert found["DNV 1977"].expects_vibration is True
    assert found["Moe & Arild 1979"].expects_vibration is True
    assert found["Lock-in band around 1/St"].expects_vibration is True
    assert found["Statfjord A 1978"].expects_vibration is True
    assert found["EN 1991-1-4 E.1.2"].expects_vibration is None  # slenderness unknown
    assert "Brown" not in onset_sentence(onset_criteria(CASE))
    assert found["EN 1991-1-4 E.1.2"].standing == "secondary"
    assert found["DNV 1977"].standing == "verified"


@pytest.mark.parametrize(
    ("damping", "expected"),
    [  # K_s = 6.5456 at 0.0015
        (16.5 / 6.5456 * 0.0015, {"DNV 1977": False, "Moe & Arild 1979": True, "Statfjord A 1978": True}),
        (27.9 / 6.5456 * 0.0015, {"DNV 1977": False, "Moe & Arild 1979": False, "Statfjord A 1978": True}),
        (28.1 / 6.5456 * 0.0015, {"DNV 1977": False, "Moe & Arild 1979": False, "Statfjord A 1978": False}),
    ],
)
def test_limits_of_the_mass_damping(damping, expected):
    found = by_name(CASE.with_pipe(damping_ratio=damping))
    assert {name: found[name].expects_vibration for name in expected} == expected
    assert found["DNV 1977"].speeds is None


def test_criteria_over_the_wind_speed():
    scale = 0.78 * 0.762
    assert by_name(CASE)["Moe & Arild 1979"].speeds == pytest.approx((3.5 * scale, 8 * scale))
    assert by_name(CASE.with_wind(speed=4.6 * scale))["Brown & Root 1985"].expects_vibration is False
    assert by_name(CASE.with_wind(speed=4.8 * scale))["Brown & Root 1985"].expects_vibration is True
    assert by_name(CASE.with_wind(speed=8.1 * scale))["Moe & Arild 1979"].expects_vibration is False
    assert by_name(CASE.with_wind(speed=8.1 * scale))["DNV 1977"].expects_vibration is True


def test_the_eurocode_check_is_never_waived_by_the_wind_of_one_case():
    assert by_name(CASE, slenderness=40.0)["EN 1991-1-4 E.1.2"].expects_vibration is True
    weak = CASE.with_wind(speed=1.0)  # v_crit 2.64 > 1.25, but the wind of the site is not known
    assert by_name(weak, slenderness=40.0)["EN 1991-1-4 E.1.2"].expects_vibration is None
    assert by_name(CASE, slenderness=5.0)["EN 1991-1-4 E.1.2"].expects_vibration is False


def test_lock_in_band_stands_around_resonance():
    band = lock_in_band(CASE)
    critical = 0.78 * 0.762 / 0.225
    assert (band.low, band.resonance, band.high) == pytest.approx((critical / 1.2, critical, critical / 0.8))
    assert band.standing == "secondary"
    assert lock_in_band(CASE, (0.9, 1.1)).high == pytest.approx(1.1 * critical)


def test_a_table_that_ends_inside_the_band_is_told():
    short = CASE.with_wind(lift_coefficient=[[1.3e5, 0.5], [1.5e5, 0.4]])
    band = lock_in_band(short)
    assert band.clipped
    assert by_name(short)["Lock-in band around 1/St"].expects_vibration is True
    assert "may be wider" in by_name(short)["Lock-in band around 1/St"].detail
    far = CASE.with_wind(speed=8.0, lift_coefficient=[[3e5, 0.5], [6e5, 0.4]])
    assert math.isnan(lock_in_band(far).low)
    assert by_name(far)["Lock-in band around 1/St"].expects_vibration is None


def test_all_speeds_that_shed_at_one_frequency():
    folded = CASE.with_wind(strouhal=[[5e4, 0.2], [1.2e5, 0.2], [1.5e5, 0.1], [5e5, 0.1]])
    law = frahm.loads.wind_excitation(folded)
    speeds = law.speeds_of(3.0)
    assert speeds.size == 3
    np.testing.assert_allclose(law.frequency(speeds), 3.0, rtol=1e-12)


def test_forced_estimate_is_the_computed_resonance():
    assert amplitude_estimates(CASE).estimates[0].ratio * 0.762 == pytest.approx(0.0867, abs=5e-5)
    assert forced_amplitude(0.00624696, 1.0, 0.0015, 4.900885) == pytest.approx(0.08670, abs=5e-6)
    assert forced_amplitude(1.0, 1.0, 0.0, 1.0) == math.inf


@pytest.mark.parametrize("name", ["tube", "table", "chimney", "stiff", "calm"])
def test_the_forced_estimate_has_the_lift_of_the_resonant_wind_as_the_worst_motion_has(name):
    case = frahm.load_case(Path(__file__).parents[2] / "cases" / f"{name}.yaml")
    estimate = amplitude_estimates(case).estimates[0]
    worst = frahm.worst_case(case, wind=operating_range(case).wind)
    assert estimate.ratio * case.pipe.diameter == pytest.approx(worst.pipe_peak, rel=5e-3)
    shed = resonant_shedding(case)
    assert shed.frequency == pytest.approx(case.pipe.frequency)
    assert f"at {shed.speed:.4g} m/s" in estimate.detail
    amplitude = float(re.search(r"absorbers (\S+) m, by the lift of", case_summary(case))[1])
    assert amplitude == pytest.approx(worst.pipe_peak, rel=5e-3)


def test_a_fixed_lift_is_that_of_the_wind_of_the_case():
    assert resonant_shedding(CASE).speed == 2.7  # analysis.detuning
    assert resonant_shedding(CASE.with_analysis(detuning=None)).speed == pytest.approx(2.6416, abs=1e-4)


def test_the_estimates_of_the_seed_pipe_span_the_known_interval():
    # known: between 0.05 and 0.21 diameters
    estimates = amplitude_estimates(CASE)
    assert len(estimates.estimates) == 6
    low, high = estimates.interval
    assert 0.05 < low / 0.762 < 0.075
    assert 0.15 < high / 0.762 < 0.21
    assert {row.standing for row in estimates.estimates} == {"verified", "partly secondary", "secondary"}


def test_empirical_formulas_without_damping_and_by_hand():
    assert griffin_skop_amplitude(0.0) == pytest.approx(1.29)
    assert sarpkaya_amplitude(0.0, 1.155) == pytest.approx(1.155 * 0.32 / math.sqrt(0.06))
    assert griffin_skop_amplitude(2.0, 1.305) == pytest.approx(1.305 * 1.29 / 1.86**3.35)


def test_mode_factors_scale_the_estimates():
    shape = antinodes(np.linspace(0, 1, 401) ** 2, 41.0)
    factors = ModeFactors(load=1.566, amplitude=1.305, antinodes=shape, cantilever_slenderness=41.0)
    rigid, mode = amplitude_estimates(CASE).estimates, amplitude_estimates(CASE, factors).estimates
    assert mode[3].ratio == pytest.approx(1.305 * rigid[3].ratio)
    assert mode[1].ratio < rigid[1].ratio  # only a part of the span is in phase
    heavier = amplitude_estimates(CASE, ModeFactors(mass_per_length=2 * 247.0)).estimates
    assert heavier[1].ratio == pytest.approx(rigid[1].ratio / 2)


def test_the_elastic_cantilever_has_the_factors_of_its_mode():
    elastic = frahm.load_case("jacket-pipe-elastic").with_pipe(lift="uniform")
    factors = mode_factors(elastic)
    assert (factors.load, factors.amplitude) == pytest.approx((1.566, 1.305), abs=5e-4)
    assert (factors.antinodes.count, factors.cantilever_slenderness) == (1, pytest.approx(31.2 / 0.762))
    # 762 x 13.4 mm of steel weigh 247 kg/m: the same K_s as the seed pipe, and g times its forced amplitude
    assert similarity(elastic).scruton_number == pytest.approx(similarity(CASE).scruton_number, rel=2e-3)
    ratio = amplitude_estimates(elastic).estimates[0].ratio / amplitude_estimates(CASE).estimates[0].ratio
    assert ratio == pytest.approx(1.566, rel=5e-3)


def test_a_simple_span_has_the_factors_of_a_half_sine():
    elastic = frahm.load_case("jacket-pipe-elastic")
    pins = [{"at": 0.0, "kind": "pinned"}, {"at": 31.2, "kind": "pinned"}]
    factors = mode_factors(elastic.without_absorbers().with_pipe(supports=pins))
    assert (factors.load, factors.amplitude) == pytest.approx((4 / math.pi, math.sqrt(4 / 3)), rel=1e-8)
    assert (factors.antinodes.count, factors.cantilever_slenderness) == (1, None)


TABLE_PIPE = {
    "kind": "modes", "diameter": 0.762, "length": 31.2, "sections": [0, 31.2],
    "modes": [{"frequency": 4.900885, "mass": 1930.0, "damping_ratio": 0.0015, "lift_length": 12.2,
               "displacements": [0, 1]}],
}  # fmt: skip


def test_without_a_mass_per_length_nothing_that_needs_it_is_decided():
    case = frahm.load_case(CASE.to_dict() | {"pipe": TABLE_PIPE, "absorbers": []})
    found = by_name(case)
    undecided = {name for name, criterion in found.items() if criterion.expects_vibration is None}
    assert {"Brown & Root 1985", "DNV 1977", "Moe & Arild 1979", "Statfjord A 1978"} <= undecided
    assert "= nan" not in " ".join(criterion.detail for criterion in found.values())
    estimates = amplitude_estimates(case)
    assert [math.isnan(row.ratio) for row in estimates.estimates] == [False, True, True, True, True, True]
    lift = 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762 * 12.2
    assert estimates.interval == pytest.approx([lift / (2 * 1930.0 * 0.0015 * 4.900885**2)] * 2)
    known = frahm.load_case(CASE.to_dict() | {"pipe": TABLE_PIPE | {"mass_per_length": 247.0}, "absorbers": []})
    assert by_name(known)["DNV 1977"].expects_vibration is True
    assert similarity(known).scruton_number == pytest.approx(6.55, abs=5e-3)


@pytest.mark.parametrize(
    "make",
    [
        lambda: ModeFactors(load=0.0),
        lambda: ModeFactors(cantilever_slenderness=-1.0),
        lambda: skop_griffin_number(-1.0, 0.2),
        lambda: lock_in_band(CASE, (1.1, 1.2)),
        lambda: frahm.loads.WakeOscillator(coupling=0.0),
        lambda: frahm.loads.WakeOscillator(stall=math.nan),
        lambda: griffin_skop_amplitude(-0.1),
    ],
)
def test_bad_numbers_are_refused(make):
    with pytest.raises(frahm.ParameterError):
        make()
