"""The response over the wind speed against the response at every single wind."""

import numpy as np
import pytest

import frahm
from frahm.errors import ParameterError
from frahm.harmonic_balance.condensation import condense
from frahm.harmonic_balance.kernels import forcing_factor, stiffness
from frahm.loads import operating_range, vortex_shedding, wind_excitation

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
BENT = CASE.with_wind(strouhal=[[5e4, 0.25], [1.3e5, 0.21], [2e5, 0.225]], lift_coefficient="en1991")
WINDOW = (2.4, 2.9)


@pytest.mark.parametrize("case", [CASE, BENT], ids=["constants", "tables"])
def test_every_point_is_a_response_at_its_own_wind(case):
    curve = frahm.frequency_response(case, wind=WINDOW)
    assert curve.wind_speed.min() == pytest.approx(WINDOW[0])
    assert curve.wind_speed.max() == pytest.approx(WINDOW[1])
    special = np.array([point.frequency for point in curve.special_points])
    away = np.flatnonzero(np.min(np.abs(curve.frequency[:, None] - special), axis=1) > 1e-3)
    rows = away[np.linspace(2, away.size - 3, 5).astype(int)]
    for speed, frequency, peak in zip(
        curve.wind_speed[rows], curve.frequency[rows], curve.pipe_peak[rows], strict=True
    ):
        here = case.with_wind(speed=float(speed))
        assert vortex_shedding(here).frequency == pytest.approx(frequency, rel=1e-12)
        peaks = [response.pipe_peak for response in frahm.periodic_responses(here, frequency=float(frequency))]
        assert np.min(np.abs(np.array(peaks) / peak - 1)) < 2e-8


def test_folds_lie_where_the_number_of_responses_at_a_fixed_wind_changes():
    curve = frahm.frequency_response(CASE, wind=WINDOW)
    folds = [p for p in curve.special_points if p.kind == "saddle-node"]
    assert len(folds) == 4
    for fold in folds:
        counts = []
        for side in (-1, 1):
            here = CASE.with_wind(speed=fold.wind_speed + side * 2e-5)
            counts.append(len(frahm.periodic_responses(here, frequency=vortex_shedding(here).frequency)))
        assert abs(counts[1] - counts[0]) == 2


def test_a_pipe_without_absorbers_has_its_closed_form():
    bare = CASE.without_absorbers()
    curve = frahm.frequency_response(bare, wind=WINDOW)
    lift, m, w = wind_excitation(bare).lift(curve.wind_speed), bare.pipe.mass, bare.pipe.frequency
    receptance = 1 / (m * (w**2 - curve.frequency**2 + 2j * bare.pipe.damping_ratio * w * curve.frequency))
    np.testing.assert_allclose(curve.pipe_peak, lift * np.abs(receptance), rtol=1e-9)


def test_factor_and_its_slope_against_the_lift_and_differences():
    axis = operating_range(BENT, wind=(1.2, 3.6))
    pb = condense(frahm.build_system(BENT), axis.factor)
    speeds = np.linspace(1.21, 3.59, 41)
    lift = vortex_shedding(BENT).lift
    for U in speeds:
        W, h = float(axis.law.frequency(U)), 1e-5
        value, slope = forcing_factor(pb, W)
        assert value == pytest.approx(float(axis.law.lift(U)) / lift, rel=1e-9)
        kinks = axis.law.frequency(axis.law.kinks(1.2, 3.6))
        if np.all(np.abs(kinks - W) > 2 * h):
            assert slope == pytest.approx(
                (forcing_factor(pb, W + h)[0] - forcing_factor(pb, W - h)[0]) / (2 * h), rel=1e-6
            )


def test_derivative_of_the_condensed_force_against_differences():
    pb = condense(frahm.build_system(CASE), operating_range(CASE, wind=WINDOW).factor)

    def at(W):
        S, dS, f, df = np.empty((1, 1), complex), np.empty((1, 1), complex), np.empty(1, complex), np.empty(1, complex)
        stiffness(pb, 1j * W, S, dS, f, df)
        return f[0], df[0]

    for W in (3.0, 4.6, 5.2, 9.0):  # inside the window and on both sides of it
        h = 1e-6
        assert 1j * at(W)[1] == pytest.approx((at(W + h)[0] - at(W - h)[0]) / (2 * h), rel=1e-6)


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"wind": (2.9, 2.4)}, "wind"),
        ({"wind": 2.7}, "wind"),
        ({"wind": (0, 2.7)}, "wind"),
        ({"wind": WINDOW, "detuning": (-0.1, 0.1)}, "detuning, frequency, wind"),
        ({"wind": WINDOW, "method": "slow-flow"}, "method"),
    ],
)
def test_bad_windows(arguments, name):
    with pytest.raises(ParameterError) as refused:
        frahm.frequency_response(CASE, **arguments)
    assert refused.value.name.startswith(name)


def test_a_system_knows_no_wind():
    with pytest.raises(ParameterError, match="wind"):
        frahm.frequency_response(frahm.build_system(CASE), wind=WINDOW)


def test_speeds_beyond_the_tables_are_refused():
    with pytest.raises(ParameterError):
        frahm.frequency_response(BENT, wind=(2.0, 30.0))
