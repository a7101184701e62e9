"""Annex E of EN 1991-1-4 against the closed forms it tabulates, and against brute force on textbook shapes."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import frahm
from frahm.loads import (
    amplitude_estimates,
    antinodes,
    correlation_length,
    eurocode_amplitude,
    load_cycles,
    lock_in_band,
    mode_factors,
    spectral_amplitude,
    wind_climate,
)

CASE = frahm.load_case("jacket-pipe-elastic").without_absorbers()
N = 8192
S = (np.arange(N) + 0.5) / N  # middles of equal cells
ENDS = {
    "clamped": {"at": 0.0, "kind": "clamped"},
    "pinned": {"at": 31.2, "kind": "pinned"},
    "clamped at the other end": {"at": 31.2, "kind": "clamped"},
}


def tube(*supports, **more):
    return CASE.with_pipe(supports=list(supports), **more)


def by_sliding(shape, share):
    """Largest part of int |phi| in a window, of all places it can have."""
    total = np.concatenate([[0.0], np.cumsum(np.abs(shape))])
    width = round(share * shape.size)
    return float(np.max(total[width:] - total[:-width]) / total[-1])


@pytest.mark.parametrize("slenderness", [18.0, 40.0, 150.0])
@pytest.mark.parametrize(
    ("shape", "closed"),
    [
        (S**2, lambda r: 3 * r * (1 - r + r * r / 3)),
        (np.sin(np.pi * S), lambda r: math.cos(math.pi / 2 * (1 - r))),
        ((1 - np.cos(2 * np.pi * S)) / 2, lambda r: r + math.sin(math.pi * (1 - r)) / math.pi),
    ],
    ids=["cantilever", "simple span", "clamped span"],
)
def test_correlation_factor_is_that_of_the_table_for_the_shapes_of_the_table(shape, closed, slenderness):
    for ratio in (0.0, 0.3, 2.0):
        expected = min(0.6, closed(min(1.0, correlation_length(ratio) / slenderness)))
        for same in (shape, -3 * shape, shape[::-1]):
            assert antinodes(same, slenderness).correlation_factor(ratio) == pytest.approx(expected, rel=1e-5)


def test_every_antinode_has_its_own_correlation_length():
    for m in (2, 5, 60):
        found = antinodes(np.sin(m * np.pi * S), 400.0)
        assert found.count == m
        share = min(1.0, 6.0 * m / 400.0)
        assert found.correlation_factor(0.0) == pytest.approx(min(0.6, math.sin(math.pi / 2 * share)), rel=2e-4)
    # an antinode that moves half as much is correlated over the length of half the amplitude
    uneven = np.where(S < 0.5, 1.0, 0.5) * np.sin(2 * np.pi * S)
    parts = [height * math.sin(math.pi * length / 100.0) for height, length in ((1.0, 8.4), (0.5, 6.6))]
    assert antinodes(uneven, 100.0).correlation_factor(0.3) == pytest.approx(sum(parts) / 1.5, rel=1e-5)


def test_humps_without_a_node_between_are_antinodes_but_rounding_is_none():
    two = antinodes(0.6 - 0.4 * np.cos(4 * np.pi * S), 60.0)
    assert two.count == 2
    each = 0.6 * 0.1 + 0.4 / (4 * math.pi) * 2 * math.sin(4 * math.pi * 0.05)  # 6 of 60 diameters around a top
    assert two.correlation_factor(0.0) == pytest.approx(2 * each / 0.6, rel=1e-5)
    rigid = 1 - 1e-12 * np.random.default_rng(1).random(N)
    assert antinodes(rigid, 20.0).count == 1
    assert antinodes(rigid, 20.0).correlation_factor(0.0) == pytest.approx(0.3)
    assert antinodes(rigid, 4.0).correlation_factor(0.0) == 0.6


@pytest.mark.parametrize("shape", [[], [0.0, 0.0], [1.0, math.nan], [[1.0, 1.0]], ["a"]])
def test_a_shape_that_is_none_is_refused(shape):
    with pytest.raises(frahm.ParameterError, match="a mode shape"):
        antinodes(shape, 10.0)
    with pytest.raises(frahm.ParameterError, match="slenderness"):
        antinodes([1.0], 0.0)


@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("amplitude_ratio", lambda: antinodes([1.0], 10.0).correlation_factor(-0.1)),
        ("scruton", lambda: eurocode_amplitude(-1.0, 0.2, 0.7)),
        ("strouhal", lambda: spectral_amplitude(5.0, 0.0, 1e5, 300.0, 40.0)),
        ("reynolds", lambda: spectral_amplitude(5.0, 0.2, 0.0, 300.0, 40.0)),
        ("slenderness", lambda: spectral_amplitude(5.0, 0.2, 1e5, 300.0, math.inf)),
    ],
)
def test_numbers_out_of_bounds_are_refused_by_name(name, call):
    with pytest.raises(frahm.ParameterError, match=name):
        call()


def test_tubes_are_integrated_over_their_textbook_shapes():
    beta = 3.9266023
    sigma = (math.cosh(beta) - math.cos(beta)) / (math.sinh(beta) - math.sin(beta))
    propped = np.cosh(beta * S) - np.cos(beta * S) - sigma * (np.sinh(beta * S) - np.sin(beta * S))
    share = 6 / (31.2 / 0.762)
    found = mode_factors(tube(ENDS["clamped"], ENDS["pinned"])).antinodes
    assert found.correlation_factor(0.0) == pytest.approx(by_sliding(propped, share), rel=2e-3)
    clamped = mode_factors(tube(ENDS["clamped"], ENDS["clamped at the other end"])).antinodes
    tabulated = share + math.sin(math.pi * (1 - share)) / math.pi
    assert clamped.correlation_factor(0.0) == pytest.approx(tabulated, rel=0.05)  # the table takes 1 - cos
    cantilever = mode_factors(tube(ENDS["clamped"])).antinodes
    assert cantilever.correlation_factor(0.0) < 3 * share * (1 - share + share**2 / 3)  # the table takes a square


def test_elastic_supports_masses_and_higher_modes_have_their_factor_too():
    stiff = {"kind": "spring", "translation": 1e12, "rotation": 1e13}
    springs = mode_factors(tube({"at": 0.0} | stiff, {"at": 31.2} | stiff)).antinodes
    clamped = mode_factors(tube(ENDS["clamped"], ENDS["clamped at the other end"])).antinodes
    assert springs.correlation_factor(0.1) == pytest.approx(clamped.correlation_factor(0.1), rel=1e-3)
    pins = ({"at": 0.0, "kind": "pinned"}, ENDS["pinned"])
    second = mode_factors(tube(*pins, governing_mode=2)).antinodes
    assert second.count == 2
    assert second.correlation_factor(0.0) == pytest.approx(math.sin(math.pi * 6 * 0.762 / 31.2), rel=1e-5)
    heavy = mode_factors(tube(*pins, point_masses=[{"at": 15.6, "mass": 4000.0}])).antinodes
    light = mode_factors(tube(*pins)).antinodes
    # a heavy middle makes the shape pointed
    assert (
        heavy.correlation_factor(0.0)
        > light.correlation_factor(0.0)
        == pytest.approx(math.sin(math.pi / 2 * 6 * 0.762 / 31.2), rel=1e-5)
    )
    spans = mode_factors(tube(*pins, {"at": 15.6, "kind": "pinned"})).antinodes
    assert spans.count == 2


def table_of(case, sections):
    """The governing mode of a tube as a table at some sections."""
    pipe = case.pipe
    shape = pipe.beam_modes.shape(sections)[:, pipe.governing_mode - 1]
    mode = {
        "mass": pipe.mass, "frequency": pipe.frequency, "damping_ratio": pipe.damping_ratio,
        "lift_length": float(pipe.beam_modes.lift_lengths(pipe.governing_mode - 1)[pipe.governing_mode - 1]),
        "displacements": list(shape / np.max(np.abs(shape))),
    }  # fmt: skip
    table = {"kind": "modes", "diameter": pipe.diameter, "length": pipe.length, "sections": list(sections),
             "mass_per_length": pipe.mass_per_length, "modes": [mode]}  # fmt: skip
    return frahm.load_case(case.to_dict() | {"pipe": table, "fatigue": None})


def test_a_table_of_modes_is_integrated_where_it_resolves_the_shape():
    for case in (CASE, tube(ENDS["clamped"], ENDS["pinned"])):
        exact = mode_factors(case)
        sections = np.linspace(0, 31.2, 13)
        known = mode_factors(table_of(case, np.random.default_rng(3).permutation(sections)))
        assert known.antinodes.correlation_factor(0.0) == pytest.approx(
            exact.antinodes.correlation_factor(0.0), rel=0.01
        )
        assert (known.load, known.amplitude) == pytest.approx((exact.load, exact.amplitude), rel=2e-3)
        assert known.cantilever_slenderness is None  # a table does not say how the pipe is held
    coarse = table_of(CASE, [0.0, 20.0, 31.2])
    assert mode_factors(coarse).antinodes is None
    assert mode_factors(table_of(CASE, [31.2])).antinodes is None
    row = amplitude_estimates(coarse).estimates[1]
    assert "in step all along" in row.detail
    assert row.ratio > 2 * amplitude_estimates(table_of(CASE, sections)).estimates[1].ratio


def test_tables_that_are_integrated_are_true_to_two_per_cent():
    pins = ({"at": 0.0, "kind": "pinned"}, ENDS["pinned"])
    spans = [(ENDS["clamped"],), (ENDS["clamped"], ENDS["clamped at the other end"]), pins]
    draw, taken = np.random.default_rng(5), 0
    for supports in spans:
        for mode in (1, 3):
            case = tube(*supports, governing_mode=mode)
            exact = mode_factors(case).antinodes.correlation_factor(0.0)
            for count in range(4, 24, 2):
                for inner in (np.linspace(0, 31.2, count)[1:-1], draw.uniform(0.5, 30.7, count)):
                    known = mode_factors(table_of(case, np.sort([0.0, *inner, 31.2]))).antinodes
                    taken += known is not None
                    assert known is None or known.correlation_factor(0.0) == pytest.approx(exact, rel=0.02)
    assert 20 < taken < 100


def test_method_1_ends_at_its_own_fixed_point():
    # K = 0.1246 for the cantilever, 0.1013 for the simple span
    for factor, K in ((1.566, 0.1246), (1.273, 0.1013)):
        assert eurocode_amplitude(1.0, 1.0, 1.0, load_factor=factor)[0] == pytest.approx(K, abs=5e-5)
    assert [correlation_length(y) for y in (0.0, 0.1, 0.35, 0.6, 2.0)] == pytest.approx([6, 6, 9, 12, 12])
    shape = antinodes(S**2, 41.0)
    for scruton in (0.5, 2.0, 6.5, 20.0):
        ratio, Kw = eurocode_amplitude(
            scruton, 0.2, 0.7, load_factor=1.566, correlation=shape.correlation_factor
        )  # fmt: skip
        assert Kw == shape.correlation_factor(ratio)
        assert ratio == pytest.approx(1.566 / (4 * math.pi) * Kw * 0.7 / (0.04 * scruton), rel=1e-12)
    assert eurocode_amplitude(0.0, 0.2, 0.7)[0] == math.inf


@pytest.mark.parametrize("scruton", [0.0, 2.0, 12.0, 25.2, 80.0, 4000.0])
def test_method_2_solves_its_own_implicit_equation(scruton):
    found = spectral_amplitude(scruton, 0.18, 2e4, 300.0, 40.0)
    y = found.deviation
    left = scruton / (4 * math.pi) - found.damping * (1 - (y / 0.4) ** 2)
    assert left > 0
    assert y == pytest.approx(0.02 / 0.18**2 / math.sqrt(left) / math.sqrt(300.0 * 40.0), rel=1e-8)


def test_constants_and_limits_of_method_2():
    def of(reynolds, scruton=0.0):
        return spectral_amplitude(scruton, 0.18, reynolds, 300.0, 40.0)

    assert [of(Re).damping for Re in (1e4, 1e5, 5e5, 1e6, 1e8)] == pytest.approx([2, 2, 0.5, 1, 1])
    assert of(math.sqrt(1e5 * 5e5)).damping == pytest.approx(1.25)
    assert of(1e4).deviation == pytest.approx(0.4, rel=0.01)  # no damping: the limiting amplitude, a pure sine
    assert of(1e4).peak_factor == math.sqrt(2)
    assert of(1e4, 1e6).peak_factor == pytest.approx(math.sqrt(2) * (1 + 0.6 * math.pi))  # far from lock-in
    strengths = [of(Re, 1e6).deviation for Re in (1e5, 5e5, 1e6)]  # where the damping of the wind counts for nothing
    assert np.array(strengths) / strengths[0] == pytest.approx([1, 0.25, 0.5], rel=1e-4)


def test_method_2_is_for_cantilevers_in_their_first_mode_only():
    row = amplitude_estimates(CASE).estimates[2]
    assert row.name == "EN 1991-1-4, method 2"
    assert row.standing == "secondary"
    assert 0.2 < row.ratio < 0.4 * math.sqrt(2)
    others = (tube(ENDS["clamped"], ENDS["pinned"]), tube(ENDS["clamped"], governing_mode=2), "jacket-pipe")
    for other in others:
        case = frahm.load_case(other) if isinstance(other, str) else other
        row = amplitude_estimates(case).estimates[2]
        assert math.isnan(row.ratio)
        assert "cantilever in its first mode" in row.detail


def test_load_cycles_are_the_time_in_a_band_of_speeds():
    # for k = 2 the formula is T n eps_0 v p(v), p the density of the climate
    found, critical = load_cycles(CASE), lock_in_band(CASE).resonance
    climate = wind_climate(CASE)
    seconds = CASE.climate.duration * 0.3 * critical * float(climate.density(critical))
    assert found.number == pytest.approx(seconds * CASE.pipe.frequency / (2 * math.pi), rel=1e-12)
    assert found.standing == "secondary"


def climate_case(**climate):
    return frahm.load_case(CASE.to_dict() | {"climate": {"duration": 1e8} | climate})


def test_load_cycles_of_other_climates():
    case = climate_case(weibull={"scale": 6.0, "shape": 3.0})
    density = wind_climate(case).density
    often = minimize_scalar(
        lambda v: -float(density(v)), bounds=(0.1, 20.0), method="bounded", options={"xatol": 1e-9}
    ).x
    rayleigh = climate_case(weibull={"scale": math.sqrt(2) * often, "shape": 2.0})
    assert load_cycles(case).number == pytest.approx(load_cycles(rayleigh).number, rel=1e-5)
    rows = [{"speed": 3.0, "probability": 0.75}, {"speed": 9.0, "probability": 0.25}]
    same = climate_case(weibull={"scale": math.sqrt(27.0), "shape": 2.0})
    assert load_cycles(climate_case(table=rows)).number == pytest.approx(load_cycles(same).number, rel=1e-12)


def test_load_cycles_that_cannot_be_said_and_those_that_are_few():
    assert "no section climate" in load_cycles(frahm.load_case("jacket-pipe")).detail
    assert math.isnan(load_cycles(climate_case(weibull={"scale": 6.0, "shape": 1.0})).number)
    far = CASE.with_wind(speed=8.0, lift_coefficient=[[3e5, 0.5], [6e5, 0.4]])
    assert math.isnan(load_cycles(far).number)
    few = load_cycles(climate_case(weibull={"scale": 0.5, "shape": 2.0}))
    assert few.number == 1e4
    assert "the formula gives" in few.detail
    assert set(dataclasses.asdict(few)) == {"number", "detail", "standing", "source"}
