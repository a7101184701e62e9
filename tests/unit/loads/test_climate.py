import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp
from scipy.stats import norm, weibull_min

import frahm
from frahm.loads import persistence, wind_climate

PIPE = {
    "pipe": {"mass": 247, "frequency": "0.78 Hz", "damping_ratio": 0.0015, "diameter": "762 mm"},
    "wind": {"speed": 2.7, "lift_coefficient": 0.4535, "strouhal": 0.225},
}


def climate(**section):
    return wind_climate(frahm.load_case({**PIPE, "climate": {"duration": "20 year", **section}}))


def test_weibull_band_against_scipy():
    found = climate(weibull={"scale": 7.5, "shape": 1.8}, direction_factor=0.4)
    known = weibull_min(1.8, scale=7.5)
    assert found.probability(2.5, 3.1) == pytest.approx(0.4 * (known.cdf(3.1) - known.cdf(2.5)), rel=1e-12)
    assert found.density(2.7) == pytest.approx(0.4 * known.pdf(2.7), rel=1e-12)
    assert found.cumulative([0, 4.0]) == pytest.approx([0, known.cdf(4.0)], rel=1e-12)
    assert found.density([-1.0, 0.0]) == pytest.approx([0, 0])


def test_table_by_hand():
    rows = [{"speed": 1, "probability": 0.2}, {"speed": 2, "probability": 0.5}, {"speed": 4, "probability": 0.3}]
    found = climate(table=rows)
    assert found.edges == pytest.approx([0.5, 1.5, 3.0, 5.0])
    assert found.probability(0.5, 5.0) == pytest.approx(1.0)
    assert found.probability(1.5, 3.0) == pytest.approx(0.5)
    assert found.probability(1.0, 2.25) == pytest.approx(0.1 + 0.25)
    assert found.density([1.0, 2.0, 4.0, 6.0, 0.1]) == pytest.approx([0.2, 0.5 / 1.5, 0.15, 0, 0])
    assert quad(found.density, 0.7, 4.2, points=[1.5, 3.0])[0] == pytest.approx(found.probability(0.7, 4.2))


def test_calm_does_not_reach_below_zero():
    rows = [{"speed": 0, "probability": 0.2}, {"speed": 2, "probability": 0.8}]
    assert climate(table=rows).edges == pytest.approx([0, 1, 3])


@pytest.mark.parametrize(("sector", "share"), [(("350 deg", "100 deg"), 0.7), (("80 deg", "300 deg"), 0.6)])
def test_sector_wraps_around_north(sector, share):
    rows = [
        {"speed": speed, "direction": f"{angle} deg", "probability": part}
        for speed in (2, 3)
        for angle, part in ((0, 0.2), (90, 0.15), (200, 0.15))
    ]
    found = climate(table=rows, sector=sector)
    assert found.probability(0, 10) == pytest.approx(share)
    assert found.cumulative(10.0) == pytest.approx(1.0)


def test_persistence_against_the_exit_time_of_the_process():
    """Mean exit time of the Ornstein-Uhlenbeck process from the band, T_c (m'' - g m') = -1 with m = 0 at both ends."""
    found = climate(weibull={"scale": 8, "shape": 2}, correlation_time="6 h")
    g1, g2 = norm.ppf(weibull_min(2, scale=8).cdf([2.43, 2.86]))
    hours = 6 * 3600.0
    solved = solve_bvp(
        lambda g, m: np.array([m[1], g * m[1] - hours]), lambda a, b: np.array([a[0], b[0]]),
        np.linspace(g1, g2, 50), np.zeros((2, 50)), tol=1e-8,
    )  # fmt: skip
    mean = quad(lambda g: solved.sol(g)[0] * norm.pdf(g), g1, g2)[0] / (norm.cdf(g2) - norm.cdf(g1))
    stay = persistence(found, 2.43, 2.86, 136.0)
    assert stay.mean_stay == pytest.approx(mean, rel=0.01)
    # The mean is the area below the share that stays longer than t.
    area = quad(lambda t: persistence(found, 2.43, 2.86, t).share_built_up, 1e-9, 40 * mean, limit=200)[0]
    assert area == pytest.approx(stay.mean_stay, rel=1e-3)
    assert persistence(found, 2.43, 2.86, np.inf).share_built_up == 0.0


def test_a_case_without_climate_is_refused():
    with pytest.raises(frahm.ParameterError, match="climate: given None"):
        wind_climate(frahm.load_case(PIPE))
