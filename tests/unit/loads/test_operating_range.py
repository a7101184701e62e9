"""The range of operation against hand computation: the band of a mode, the site, the tables, and what is refused."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh

import frahm
from frahm.loads import (
    excited_bands,
    operating_range,
    other_ranges,
    site_winds,
    split_resonances,
    wind_excitation,
)

FREQUENCY, DIAMETER, STROUHAL = 3.28, 0.61, 0.2
RESONANCE = FREQUENCY * DIAMETER / STROUHAL  # U_crit = f D / St = 10.004 m/s
LOW, HIGH = RESONANCE / 1.2, RESONANCE / 0.8  # vortices shed at 1/1.2 ... 1/0.8 of the natural frequency
SINK = {"mass": 50, "law": {"kind": "cubic", "stiffness": 1e6, "damping": 20}}


def case(wind=None, absorbers=(), frequency=FREQUENCY, **sections):
    """A brace that moves as one, in winds of a constant Strouhal number and lift coefficient."""
    pipe = {"kind": "mode", "mass": 2500, "length": 16, "frequency": f"{frequency} Hz", "damping_ratio": 0.0015,
            "diameter": DIAMETER}  # fmt: skip
    blown = {"speed": 10, "strouhal": STROUHAL, "lift_coefficient": 0.3} | (wind or {})
    return frahm.load_case({"name": "brace", "pipe": pipe, "wind": blown, "absorbers": list(absorbers)} | sections)


@pytest.mark.parametrize("ratio", [1e-6, 0.02, 0.1, 0.7])
def test_split_resonances_are_the_eigenvalues_of_host_and_tuned_absorber(ratio):
    squared = eigh([[1 + ratio, -ratio], [-ratio, ratio]], np.diag([1, ratio]), eigvals_only=True)
    assert split_resonances(ratio) == pytest.approx(np.sqrt(squared), rel=1e-9)


def test_without_an_absorber_nothing_is_split():
    assert split_resonances(0.0) == (1.0, 1.0)


@pytest.mark.parametrize("frequency", [0.3, FREQUENCY, 12.0])
def test_the_default_is_the_lock_in_band_in_proportion_to_the_frequency(frequency):
    scale = frequency / FREQUENCY
    within = operating_range(case({"speed": 10 * scale}, frequency=frequency))
    assert within.over_wind
    assert within.moves
    assert within.wind == pytest.approx((scale * LOW, scale * HIGH), rel=1e-12)
    assert within.frequency == pytest.approx(2 * math.pi * frequency * np.array([1 / 1.2, 1 / 0.8]), rel=1e-12)
    assert within.detuning == pytest.approx(2 * math.pi * frequency * np.array([-1 / 6, 1 / 4]), rel=1e-12)


def test_an_absorber_widens_the_band_by_the_resonances_it_splits():
    low, high = split_resonances(50 / 2500)
    own, asked = operating_range(case(absorbers=[SINK])), operating_range(case(), most_mass_ratio=0.02)
    assert own.wind == pytest.approx((LOW * low, HIGH * high), rel=1e-12)
    assert asked.wind == own.wind
    assert operating_range(case(absorbers=[SINK]), most_mass_ratio=0.01).wind == own.wind


def test_winds_of_the_site_clip_it_and_nothing_lies_beyond():
    within = operating_range(case({"range": [9, 11]}))
    assert within.wind == (9.0, 11.0)
    assert within.closed(0)
    assert within.closed(1)
    assert within.widened().wind == (9.0, 11.0)
    above = operating_range(case({"range": [9, 40]}))
    assert above.wind == pytest.approx((9.0, HIGH))
    assert above.closed(0)
    assert not above.closed(1)


def test_a_climate_bounds_the_winds():
    table = [{"speed": speed, "probability": 0.25} for speed in (3, 5, 7, 9)]  # classes of 2 m/s up to 10 m/s
    assert operating_range(case({"speed": 9}, climate={"duration": "30 day", "table": table})).wind[1] == 10.0
    climate = {"duration": "30 day", "correlation_time": "1 h", "weibull": {"scale": 4, "shape": 2}}
    site, sentence = site_winds(case(climate=climate))
    assert site == pytest.approx((0.0, 4 * math.sqrt(math.log(720))))  # exceeded once in 720 independent hours
    assert math.exp(-((site[1] / 4) ** 2)) == pytest.approx(1 / 720)
    assert "10.26 m/s" in sentence
    assert site_winds(case({"range": [1, 8]}, climate=climate))[0] == (1.0, 8.0)


@pytest.mark.parametrize("table", [(9, 11), (9, 99), (1, 11), (10.5, 99)])
def test_tables_clip_it_and_say_so(table):
    """Also where one end of the band, or both, lie beyond the tables: the resonance is never left out with them."""
    scale = DIAMETER / 1.5e-5
    asked = case({"speed": max(10, table[0]), "strouhal": [[U * scale, STROUHAL] for U in table]})
    within = operating_range(asked)
    assert within.wind == pytest.approx((max(LOW, table[0]), min(HIGH, table[1])), rel=1e-12)
    assert not within.closed(0)
    assert not within.closed(1)
    assert any("nothing is known beyond" in sentence for sentence in within.basis)


def largest_of_all_winds(asked, low, high):
    """Largest displacement [m] of a bare pipe with one mode over winds close together, by hand."""
    law, pipe = wind_excitation(asked), asked.pipe
    U = np.linspace(low, high, 1_000_001)
    W, omega = law.frequency(U), pipe.frequency
    bound = np.hypot(omega**2 - W**2, 2 * pipe.damping_ratio * omega * W) * pipe.mass
    return float(np.max(law.lift(U) / bound))


FALLING = [11.0, 11.2]  # winds between which the Strouhal number drops from .2 to .15


@pytest.mark.parametrize("speed", [10.0, 11.05, 14.0])
def test_where_the_shedding_frequency_falls_with_the_wind_every_stretch_is_looked_at(speed):
    scale = DIAMETER / 1.5e-5
    table = [[1 * scale, 0.2], [FALLING[0] * scale, 0.2], [FALLING[1] * scale, 0.15], [99 * scale, 0.15]]
    asked = case({"strouhal": table, "speed": speed})
    within, beside = operating_range(asked), other_ranges(asked)
    assert within.doubts == ()
    rising_ends = (LOW, 11.0), (11.2, HIGH * 0.2 / 0.15)
    assert [within.wind, *(part.wind for _, part in beside)] == [
        pytest.approx(ends, rel=1e-9)
        for ends in ([rising_ends[0], FALLING[::-1], rising_ends[1]] if speed < 11.1
                     else [rising_ends[1], rising_ends[0], FALLING[::-1]])
    ]  # fmt: skip
    for one in (within, *(part for _, part in beside)):
        assert one.frequency[0] < one.frequency[1]
        for W in np.linspace(*one.frequency, 7)[1:-1]:
            U = float(one.speed(W))
            assert min(one.wind) <= U <= max(one.wind)
            assert float(one.law.frequency(U)) == pytest.approx(W, rel=1e-12)
            assert one.lift * one.lift_factor(W) == pytest.approx(float(one.law.lift(U)), rel=1e-9)
    worst = frahm.worst_case(asked, samples=2)
    assert worst.verified
    assert worst.pipe_peak == pytest.approx(largest_of_all_winds(asked, LOW, HIGH * 0.2 / 0.15), rel=1e-4)
    assert worst.wind_speed == pytest.approx(RESONANCE * 0.2 / 0.15, rel=1e-3)
    with pytest.raises(frahm.ParameterError, match="ascends"):
        operating_range(case({"strouhal": table}), wind=(9, 12))


@pytest.mark.parametrize(("site", "nearest"), [((5.0, 9.5), 9.5), ((10.5, 22.0), 10.5)])
def test_a_wind_that_may_lock_in_meets_the_resonance_the_site_lacks(site, nearest):
    asked = case({"speed": nearest, "range": list(site)})
    ((locked, within),) = other_ranges(asked)
    assert within.held == locked.wind.speed == nearest
    worst = frahm.worst_case(asked, samples=2)
    assert worst.verified
    pipe = asked.pipe
    lift = float(wind_excitation(asked).lift(nearest))
    resonance = lift / (2 * pipe.damping_ratio * pipe.frequency**2 * pipe.mass)
    assert worst.pipe_peak == pytest.approx(resonance, rel=1e-4)
    assert worst.wind_speed == nearest
    assert other_ranges(case({"speed": 8.0, "range": [5.0, 8.2]})) == ()  # below the band of lock-in
    assert other_ranges(case({"speed": 9.0, "range": [5.0, 10.1]})) == ()  # the site has the resonance itself


def test_a_worst_motion_on_the_stretch_where_the_shedding_falls_is_found():
    """The site ends where the shedding has fallen: of its winds the strongest that excites sheds on the way down."""
    scale = DIAMETER / 1.5e-5
    table = [[1 * scale, 0.2], [9.9 * scale, 0.2], [11.2 * scale, 0.2], [12.2 * scale, 0.15], [99 * scale, 0.15]]
    asked = case({"strouhal": table, "speed": 9.0, "range": [5.0, 12.0]})
    worst = frahm.worst_case(asked, samples=2)
    assert worst.verified
    assert 11.2 < worst.wind_speed < 12.0
    assert worst.pipe_peak == pytest.approx(largest_of_all_winds(asked, 5.0, 12.0), rel=1e-4)
    held = frahm.worst_case(asked.with_analysis(wind=(5.0, 11.19)), samples=2)
    assert held.pipe_peak < 0.9 * worst.pipe_peak
    off = next(part for _, part in other_ranges(asked) if part.wind[0] > part.wind[1]).stretched(0.9, 1.1)
    assert off.winds == pytest.approx((11.2, 12.0), rel=1e-9)


@pytest.mark.parametrize(("speed", "ends"), [(30.0, (LOW, 30.0)), (2.0, (2.0, HIGH))])
def test_a_design_wind_far_off_is_part_of_it(speed, ends):
    assert operating_range(case({"speed": speed})).wind == pytest.approx(ends, rel=1e-12)


def test_of_a_site_too_calm_for_the_mode_the_strongest_winds_are_looked_at():
    within = operating_range(case({"speed": 5, "range": [0, 5]}))
    assert within.wind == pytest.approx((5 / 1.2, 5.0))
    assert any("No wind of the site excites the mode" in sentence for sentence in within.basis)
    assert operating_range(case({"speed": 4, "range": [0, 5]})).wind == (4.0, 5.0)


@pytest.mark.parametrize(("site", "speed"), [([15.0, 22.0], 10.0), ([1.0, 3.0], 10.0), ([20.0, 22.0], 14.0)])
def test_winds_that_the_site_does_not_have_are_looked_at_and_nothing_of_them_is_verified(site, speed):
    asked = case({"speed": speed, "range": site})
    within = operating_range(asked)
    assert within.wind == pytest.approx((min(LOW, speed), max(HIGH, speed)), rel=1e-12)  # the resonance among them
    (doubt,) = within.doubts
    assert f"The site has winds of {site[0]:g} ... {site[1]:g} m/s" in doubt
    assert "correct wind.range" in doubt
    worst = frahm.worst_case(asked.without_absorbers(), samples=2)
    assert not worst.verified
    assert [one.split(":")[0] for one in worst.unverified] == [doubt.split(":")[0]]
    assert worst.pipe_peak > 0


@pytest.mark.parametrize(("site", "speed"), [([5.0, 22.0], 4.0), ([0.0, 5.0], 5.0), ([11.0, 22.0], 30.0)])
def test_a_site_that_has_the_wind_of_the_case_or_one_that_excites_is_not_in_doubt(site, speed):
    assert operating_range(case({"speed": speed, "range": site})).doubts == ()


@pytest.mark.parametrize(("drop", "stretches"), [((0.94, 1.05), 3), ((0.94, 1.3), 2)])
def test_another_mode_where_the_shedding_falls_with_the_wind_is_looked_at_on_every_stretch(drop, stretches):
    mast = frahm.load_case(Path(__file__).parents[2] / "cases" / "table.yaml")
    ((_, full),) = other_ranges(mast)
    middle = math.sqrt(full.wind[0] * full.wind[1])
    Re = [share * middle * mast.pipe.diameter / mast.wind.viscosity for share in drop]
    ratio = drop[0] / drop[1] * 0.95  # falls faster than one over the wind
    folded = mast.with_wind(strouhal=[[1e2, 0.2], [Re[0], 0.2], [Re[1], 0.2 * ratio], [1e7, 0.2 * ratio]])
    if stretches == 2:  # the site has none of the winds beyond
        folded = folded.with_wind(range=(0.96 * middle, 1.28 * middle))
    beside = [part for other, part in other_ranges(folded) if other.pipe.governing_mode == 2 and part.over_wind]
    assert len(beside) == stretches
    assert any(part.wind[0] > part.wind[1] for part in beside)
    for within in beside:
        assert within.law.is_monotone(*within.wind)
        assert float(within.law.frequency(within.wind[0])) < within.law.frequency(within.wind[1])
    winds = np.sort(np.array([part.wind for part in beside]).ravel())
    assert np.all(np.diff(winds)[1::2] < 1e-3)  # one begins where the other ends, but for a turning point
    worst = frahm.worst_case(folded, samples=2)
    bare = max(part.pipe_peak for part in (worst, *worst.others))
    assert worst.pipe_peak == bare > 0


def test_lift_and_wind_follow_the_frequency():
    within = operating_range(case({"speed": 12}))
    for speed in np.linspace(LOW, HIGH, 7):
        W = 2 * math.pi * STROUHAL * speed / DIAMETER
        assert within.lift_factor(W) == pytest.approx((speed / 12) ** 2, rel=1e-9)
        assert float(within.speed(W)) == pytest.approx(speed, rel=1e-12)
    assert within.lift == pytest.approx(0.5 * 1.225 * 12**2 * DIAMETER * 16 * 0.3)


def test_parts_stretches_and_widenings():
    within = operating_range(case())
    lo, hi = within.frequency
    middle = 0.5 * (lo + hi)
    part = within.part(0.5 * lo, middle)
    assert part.frequency == (lo, middle)
    assert part.wind == pytest.approx((LOW, middle / lo * LOW), rel=1e-12)
    stretched = within.stretched(0.9, 1.1)
    assert stretched.wind == pytest.approx((0.9 * LOW, 1.1 * HIGH), rel=1e-9)
    widened = within.widened()
    assert widened.wind == pytest.approx((LOW - 0.25 * (HIGH - LOW), HIGH + 0.25 * (HIGH - LOW)), rel=1e-12)
    for wider in (part, stretched, widened):
        assert wider.lift_factor(middle) == pytest.approx(within.lift_factor(middle), rel=1e-9)
    site = operating_range(case({"range": [8, 13]}))
    assert site.stretched(0.5, 2).wind == (8.0, 13.0)
    assert site.widened().wind == pytest.approx((8.0, 13.0))


def test_a_window_at_one_lift():
    within = operating_range(case(analysis={"detuning": [-0.4, 0.5]}))
    omega = 2 * math.pi * FREQUENCY
    assert not within.over_wind
    assert not within.moves
    assert within.frequency == pytest.approx((omega - 0.4, omega + 0.5))
    assert within.lift_factor(omega) == 1.0
    assert math.isnan(within.speed(omega))
    assert within.widened().detuning == pytest.approx((-0.625, 0.725))
    assert within.stretched(0.9, 1.1).frequency == pytest.approx((0.9 * (omega - 0.4), 1.1 * (omega + 0.5)))
    assert not within.closed(0)


def test_winds_that_are_given_are_all_that_is_asked():
    given = operating_range(case(analysis={"wind": [9, 10]}))
    assert given.wind == (9.0, 10.0)
    assert not given.moves
    assert operating_range(case(analysis={"detuning": [-1, 1]}), wind=(9, 10)).wind == (9.0, 10.0)


def test_every_other_mode_has_its_own_band():
    pipe = {"kind": "tube", "diameter": "8 inch", "wall": "6 mm", "length": "30 m", "damping_ratio": 0.002,
            "supports": [{"at": 0, "kind": "pinned"}, {"at": "30 m", "kind": "pinned"}], "mode_count": 3}  # fmt: skip
    wind = {"speed": 0.7, "strouhal": STROUHAL, "lift_coefficient": 0.3, "range": [0, 6]}
    slender = frahm.load_case({"name": "slender", "pipe": pipe, "wind": wind, "absorbers": []})
    first = slender.pipe.frequency / 2 / math.pi * 8 * 0.0254 / STROUHAL
    found = other_ranges(slender)
    bands = [np.array([n**2 / 1.2, min(n**2 / 0.8, 6 / first)]) * first for n in (1, 2, 3)]  # pinned: f_n ~ n^2
    assert operating_range(slender).wind == pytest.approx(bands[0], rel=1e-6)
    expected = [(n, band) for n, band in zip((2, 3), bands[1:], strict=True) if band[0] < band[1]]
    assert [other.pipe.governing_mode for other, _ in found] == [n for n, _ in expected]
    for (_, within), (_, band) in zip(found, expected, strict=True):
        assert within.wind == pytest.approx(band, rel=1e-6)
    assert expected  # at least the second mode is excited
    assert other_ranges(slender.with_analysis(wind=(1, 2))) == ()
    assert len(excited_bands(slender)) == 3


@pytest.mark.parametrize(
    ("wind", "says"),
    [((12, 10), "lo < hi"), ((-1, 10), r"wind\[0\]"), ((1, math.nan), r"wind\[1\]"), (9, "two wind speeds")],
)
def test_bad_winds_are_refused(wind, says):
    with pytest.raises(frahm.ParameterError, match=says):
        operating_range(case(), wind=wind)


def test_winds_beyond_a_table_and_two_windows_at_once_are_refused():
    scale = DIAMETER / 1.5e-5
    with pytest.raises(frahm.ParameterError, match="wind"):
        operating_range(case({"strouhal": [[9 * scale, 0.2], [11 * scale, 0.2]]}), wind=(9, 12))
    with pytest.raises(frahm.ParameterError, match=r"analysis\.wind"):
        case(analysis={"wind": [9, 10], "detuning": [-1, 1]})


def test_a_pipe_off_its_frequency_meets_the_same_winds_of_the_site():
    """Where the winds of the site end below resonance, a softer pipe still has all of them."""
    within = operating_range(case({"speed": 9, "range": [5, 9.4]}))
    assert within.wind[1] == 9.4 < RESONANCE
    assert within.asked[1] > within.frequency[1]
    softer = within.stretched(0.9, 1.0).part(0.9 * within.asked[0], 0.9 * within.asked[1])
    assert softer.wind == pytest.approx((0.9 * within.wind[0], 9.4))


def test_a_knot_of_a_table_at_the_end_of_the_range_is_no_piece_of_its_own():
    viscosity = 1.5e-5
    table = [[1e5, 0.2], [9.4 * DIAMETER / viscosity, 0.2], [1e6, 0.21]]
    within = operating_range(case({"strouhal": table, "viscosity": viscosity, "speed": 9, "range": [5, 9.4]}))
    assert np.all(np.diff(within.factor[:, 0]) > 0)
