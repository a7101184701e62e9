"""Fatigue damage over forty winds, every attractor counted. Goal: below 30 s on two cores, compiled and warm."""

import pytest

import frahm

SECTIONS = {
    "climate": {"duration": "20 year", "weibull": {"scale": 7, "shape": 2}},
    "fatigue": {"curve": "D", "stress_per_displacement": "283.5 MPa/m"},
}
CASES = {
    "one mode": frahm.load_case({**frahm.load_case("jacket-pipe").to_dict(), **SECTIONS}),
    "elastic": frahm.load_case("jacket-pipe-elastic"),
}


@pytest.mark.parametrize("name", CASES)
def test_forty_wind_bins(benchmark, name):
    case = CASES[name]
    frahm.fatigue_damage(case, bins=4)
    found = benchmark.pedantic(frahm.fatigue_damage, args=(case,), kwargs={"bins": 40}, rounds=1)
    assert found.speeds.size == 40
    assert benchmark.stats.stats.max < 2 * 30  # CPU seconds, of two cores
