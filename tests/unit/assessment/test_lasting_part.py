"""Motions that decay for longer than a search watches them count by what they end on."""

import numpy as np
import pytest

import frahm
from frahm.assessment.detail import detail_of
from frahm.assessment.lasting_part import lasting
from frahm.assessment.wind_survey import WindSurvey

MAST = {
    "pipe": {"kind": "tube", "diameter": "8.625 inch", "wall": "8.2 mm", "length": "18 m",
             "supports": [{"at": "0 m", "kind": "clamped"}], "damping_ratio": "0.2 %", "mode_count": 3,
             "governing_mode": 3},
    "wind": {"speed": "13.5 m/s", "strouhal": 0.2, "lift_coefficient": 0.3},
    "absorbers": [{"mass": "4 kg", "position": "18 m", "law": {
        "kind": "polynomial", "coefficients": ["90 N/m", "0 N/m^2", "30000 N/m^3"], "damping": "3 N s/m"}}],
    "fatigue": {"curve": "F1"},
    "climate": {"duration": "20 year", "weibull": {"scale": "8 m/s", "shape": 2}},
}  # fmt: skip


@pytest.fixture(scope="module")
def survey():
    case = frahm.load_case(MAST)
    survey = WindSurvey(case, detail_of(case), 12, 1, 1)
    survey.look([13.5])
    return survey.at[13.5]


def test_free_motions_of_the_first_mode_die_out_in_the_winds_of_the_third(survey):
    """The only lasting motion is the small one at the shedding frequency, as from rest after a long time."""
    assert [one.kind for one in survey.found] == ["periodic"]
    assert survey.found[0].basin_fraction == 1.0
    assert survey.found[0].basin_interval[1] == 1.0
    history = frahm.integrate(survey.system, frequency=survey.frequency, periods=9000, samples_per_period=32).last(4)
    place = detail_of(frahm.load_case(MAST))
    assert survey.damage[0].largest_range == pytest.approx(place.factor * np.ptp(history.x @ place.row), rel=5e-3)


def test_a_modulated_motion_that_lasts_is_kept():
    from frahm.attractors.finding import attractors_from, settling_periods
    from frahm.attractors.regions import default_region
    from frahm.attractors.stroboscope import stroboscope
    from frahm.harmonic_balance import periodic_responses_of

    system = frahm.build_system(frahm.load_case("jacket-pipe").with_wind(speed=2.64))
    W = system.reference_frequency + 0.01
    responses, strobe = periodic_responses_of(system, W, None), stroboscope(system, W, 1)
    region = default_region(system, W, responses)
    found = attractors_from(strobe, responses, region, 8, 1, settling_periods(system, W))
    assert "quasi-periodic" in [one.kind for one in found]
    assert lasting(strobe, responses, found).attractors == found.attractors
