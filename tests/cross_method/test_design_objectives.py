"""What designs are judged by, against other ways to compute it; and designs for it against the one for the peak."""

import numpy as np
import pytest

import frahm
from frahm.assessment.climate_mean import climate_mean
from frahm.design import DesignSettings, Objective, verified_designs, with_design
from frahm.design.disturbance import Disturbance
from frahm.design.exact import ExcitedMode, Windows
from frahm.design.verification import verification
from frahm.loads import wind_climate
from frahm.systems import with_parameters

PEAK = frahm.DesignedAbsorber(0.02, 0.0, 2938.76, 0.05741)  # the best sink for the worst pipe peak
CLIMATE = {"duration": "20 year", "weibull": {"scale": "7 m/s", "shape": 2}}
FATIGUE = {"curve": "D", "stress_per_displacement": "283.5 MPa/m", "bins": 16, "samples": 8}
CASE = frahm.load_case(frahm.load_case("jacket-pipe").to_dict() | {"climate": CLIMATE, "fatigue": FATIGUE})
OMEGA = CASE.pipe.frequency


def test_damage_is_that_of_the_fatigue_assessment():
    for case in (with_design(CASE, PEAK), CASE.without_absorbers()):
        found = climate_mean(case, "damage", samples=8, seed=1)
        counted = frahm.fatigue_damage(case)
        expected = counted.damage_with if case.absorbers else counted.damage_without
        assert found.value == pytest.approx(expected, rel=1e-6)


def test_expected_peak_of_one_stable_branch_is_the_integral_of_its_curve():
    case = with_design(CASE, PEAK)
    found = climate_mean(case, "expected", samples=8, seed=1)
    W = OMEGA + np.array(CASE.analysis.detuning)
    low, high = W * CASE.pipe.diameter / (2 * np.pi * 0.225)
    curve = frahm.frequency_response(case, wind=(low, high))
    assert curve.stable.all()
    order = np.argsort(curve.wind_speed)
    U, peak = curve.wind_speed[order], curve.pipe_peak[order]
    weight = wind_climate(case).density(U)
    by_curve = np.trapezoid(weight * peak, U) / np.trapezoid(weight, U)
    assert found.value == pytest.approx(by_curve, rel=0.01)
    assert found.pipe_peak == pytest.approx(peak.max(), rel=0.01)


def test_a_mean_over_the_climate_with_something_off_is_that_of_the_changed_case():
    off = Disturbance(pipe_frequency=1.02, pipe_damping=1.3, lock_in=False)
    pipe = {"frequency": 1.02 * OMEGA, "damping_ratio": 1.3 * 0.0015}
    # the band of winds follows the window of detuning: it must be named to stay
    band = CASE.with_fatigue(wind_speeds=(2.5, 2.9))
    tuned = with_design(band, frahm.DesignedAbsorber(0.02, 0.46, 0.0, 0.0166))
    for measure in ("damage", "expected"):
        found = climate_mean(tuned, measure, samples=1, seed=1, changed=off.of)
        assert found.value == pytest.approx(
            climate_mean(tuned.with_pipe(**pipe), measure, samples=1, seed=1).value, rel=1e-3
        )


def test_the_worst_case_over_winds_has_the_lift_of_every_wind():
    case = with_design(CASE, PEAK)
    found = frahm.worst_case(case, wind=(2.5, 3.1), samples=16)
    curve = frahm.frequency_response(case, wind=(2.5, 3.1))
    assert found.verified
    assert found.pipe_peak == pytest.approx(curve.pipe_peak.max(), rel=2e-3)
    speed = found.frequency * CASE.pipe.diameter / (2 * np.pi * 0.225)
    there = frahm.find_attractors(case.with_wind(speed=speed), frequency=found.frequency, samples=16)
    assert there[0].pipe_peak == pytest.approx(found.pipe_peak, rel=1e-4)
    assert found.pipe_rms == pytest.approx(found.pipe_peak / np.sqrt(2), rel=0.01)
    with pytest.raises(frahm.ParameterError, match="wind"):
        frahm.worst_case(frahm.build_system(case), wind=(2.5, 3.1))
    with pytest.raises(frahm.ParameterError, match="wind"):
        frahm.worst_case(case, wind=(2.5, 3.1), detuning=(-0.4, 0.4))


def test_a_quantile_over_the_scatter_is_one_of_the_worst_cases():
    system = frahm.build_system(with_design(CASE, PEAK))
    window = (OMEGA - 0.2, OMEGA + 0.2)
    off = [Disturbance(force=f) for f in (0.7, 0.8, 0.9, 1.0)]
    found = verification(
        [ExcitedMode(system, Windows(window, window, False))], off, Objective("peak", 0.7), samples=8, seed=1
    )
    worst = [frahm.worst_case(with_parameters(system, force=d.force), frequency=window, samples=8) for d in off]
    assert found.value == pytest.approx(sorted(w.pipe_peak for w in worst)[3])
    assert found.pipe_peak == pytest.approx(max(w.pipe_peak for w in worst))


def test_a_sink_designed_for_damage_does_less_of_it_than_the_one_for_the_peak():
    (best,) = verified_designs(CASE, DesignSettings(objective="damage", samples=8), ("sink",))
    assert best.verified
    of_peak = frahm.fatigue_damage(with_design(CASE, PEAK)).damage_with
    assert best.value < 0.9 * of_peak
    assert frahm.fatigue_damage(with_design(CASE, best.design)).damage_with == pytest.approx(best.value, rel=1e-6)
    assert best.force_margin >= 1.05


def test_less_rms_than_the_sink_for_the_peak_is_had_by_one_that_beats():
    """The design for the least rms (`frahm design --objective rms`) beats where its response is largest."""
    of_rms = frahm.DesignedAbsorber(0.02, 0.0, 2726.455795842368, 0.05404623003266618)
    largest = []
    for design, window in ((PEAK, (4.870, 4.885)), (of_rms, (4.914, 4.924))):  # around the worst of each
        system = frahm.build_system(with_design(CASE, design))
        mode = ExcitedMode(system, Windows(window, window, False))
        largest.append(verification([mode], [Disturbance()], Objective("rms"), samples=4, seed=1))
    for_peak, for_rms = largest
    assert for_peak.value == pytest.approx(for_peak.pipe_peak / np.sqrt(2), rel=0.01)
    assert for_rms.value == for_rms.pipe_rms < for_peak.value
    assert for_rms.pipe_peak > 1.03 * for_peak.pipe_peak
    assert (for_peak.kind, for_rms.kind) == ("periodic", "quasi-periodic")


def test_more_mass_is_better_and_a_free_mass_is_found_at_its_bound():
    (best,) = verified_designs(CASE, DesignSettings(mass_ratio=(0.015, 0.025), samples=8), ("sink",))
    assert best.design.rho2 == pytest.approx(0.025, rel=1e-3)
    assert best.worst_pipe_peak < 0.0075  # 0.0081 with two per cent


def test_the_best_place_on_a_cantilever_is_its_tip():
    case = frahm.load_case("jacket-pipe-elastic")
    settings = DesignSettings(position=(20.0, 31.2), samples=8)
    (best,) = verified_designs(case, settings, ("tuned",))
    (there,) = verified_designs(case, DesignSettings(samples=8), ("tuned",))
    assert best.design.position == pytest.approx(31.2, abs=0.1)
    assert best.value == pytest.approx(there.value, rel=2e-3)
