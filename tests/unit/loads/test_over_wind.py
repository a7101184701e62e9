import numpy as np
import pytest
from scipy.optimize import brentq

import frahm
from frahm.loads import excitation_over_wind, vortex_shedding, wind_excitation

CASE = frahm.load_case("jacket-pipe")
BENT = CASE.with_wind(strouhal=[[5e4, 0.25], [1.3e5, 0.21], [2e5, 0.225]], lift_coefficient="en1991")
SPEEDS = np.linspace(1.1, 3.7, 53)


def test_constants_give_a_straight_frequency_and_a_square_lift():
    found = excitation_over_wind(CASE, SPEEDS)
    np.testing.assert_allclose(found.frequency, 2 * np.pi * 0.225 * SPEEDS / 0.762, rtol=1e-14)
    np.testing.assert_allclose(found.lift, 0.5 * 0.4535 * 1.225 * SPEEDS**2 * 0.762, rtol=1e-14)
    assert found.monotone
    assert float(found.speed_at(4.900885)[0]) == pytest.approx(0.78 * 0.762 / 0.225, rel=1e-6)


def test_values_of_the_published_lift_curve():
    # 0.70 up to Re 3e5, 0.20 from 5e5 to 5e6, 0.30 at 1e7, linear in log Re between
    law = wind_excitation(CASE.with_wind(lift_coefficient="en1991"))
    reynolds = [1e3, 3e5, np.sqrt(3e5 * 5e5), 5e5, 2e6, 5e6, np.sqrt(5e6 * 1e7), 1e7]
    np.testing.assert_allclose(
        law.lift_coefficient.value(reynolds), [0.7, 0.7, 0.45, 0.2, 0.2, 0.2, 0.25, 0.3], rtol=1e-12
    )
    assert np.isnan(law.lift_coefficient.value(1.01e7))
    assert law.speed_range == (0.0, pytest.approx(1e7 * 1.5e-5 / 0.762))


def test_a_table_is_met_at_its_pairs_and_is_linear_in_the_logarithm():
    law = wind_excitation(BENT)
    np.testing.assert_allclose(law.strouhal.value([5e4, 1.3e5, 2e5]), [0.25, 0.21, 0.225], rtol=1e-14)
    assert law.strouhal.value(np.sqrt(5e4 * 1.3e5)) == pytest.approx(0.23, rel=1e-13)
    assert np.all(np.isnan(law.frequency(np.array([0.9, 4.0]))))


def test_slopes_against_differences():
    law, h = wind_excitation(BENT), 1e-5
    smooth = SPEEDS[np.all(np.abs(SPEEDS[:, None] - law.kinks(0.1, 9.0)) > 2 * h, axis=1)]
    for value, slope in ((law.frequency, law.frequency_slope), (law.lift, law.lift_slope)):
        np.testing.assert_allclose((value(smooth + h) - value(smooth - h)) / (2 * h), slope(smooth), rtol=1e-8)


def test_the_way_back_from_the_frequency():
    found = excitation_over_wind(BENT, SPEEDS)
    assert found.monotone
    for target in (2.4, 3.1, 5.0):
        exact = brentq(lambda U: float(found.law.frequency(U)) - target, SPEEDS[0], SPEEDS[-1], xtol=1e-14)  # noqa: B023
        speed, rate = found.speed_at(target)
        assert float(speed) == pytest.approx(exact, rel=1e-13)
        assert float(rate) == pytest.approx(1 / float(found.law.frequency_slope(exact)), rel=1e-10)
    lift, slope = found.lift_at(np.array([3.0, 4.0]))
    above, below = found.lift_at(np.array([3.0, 4.0]) + 1e-6)[0], found.lift_at(np.array([3.0, 4.0]) - 1e-6)[0]
    np.testing.assert_allclose((above - below) / 2e-6, slope, rtol=1e-8)
    assert np.all(lift > 0)
    assert np.all(np.isnan(found.lift_at(np.array([0.1, 50.0]))[0]))


def test_a_frequency_that_falls_with_the_wind_is_seen():
    # St falls from 0.2 to 0.1 while Re rises by a quarter: U St falls, too
    folded = CASE.with_wind(strouhal=[[5e4, 0.2], [1.2e5, 0.2], [1.5e5, 0.1], [5e5, 0.1]])
    found = excitation_over_wind(folded, SPEEDS)
    assert not found.monotone
    assert np.any(np.diff(found.frequency) < 0)
    with pytest.raises(frahm.ParameterError, match="ascends with the speed"):
        found.speed_at(4.0)
    assert excitation_over_wind(folded, [1.1, 2.3]).monotone


def test_a_point_of_the_curve_is_the_case_at_that_speed():
    found = excitation_over_wind(BENT, [2.2, 3.3])
    for i, speed in enumerate((2.2, 3.3)):
        shedding = vortex_shedding(BENT, speed)
        assert (shedding.frequency, shedding.lift) == (found.frequency[i], pytest.approx(found.lift[i], rel=1e-14))
        assert vortex_shedding(BENT.with_wind(speed=speed)) == shedding


def test_dataset_says_what_it_holds():
    data = excitation_over_wind(BENT, SPEEDS).to_dataset()
    assert all({"units", "long_name"} <= set(data[name].attrs) for name in data.variables)
    assert data.attrs["monotone"] == 1
