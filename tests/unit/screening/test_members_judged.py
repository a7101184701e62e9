"""Members judged: against hand formulas, and every way to a verdict."""

import math

import numpy as np
import pytest

import frahm
from frahm.screening import FAIL, LOOK_CLOSER, NOT_JUDGED, PASS

E, RHO = 2.06e11, 7850.0
SECTION = {"diameter": 0.508, "wall": 0.0127}


def member(**changes):
    row = {"name": "B1", **SECTION, "length": 25.0, "ends": "fixed-pinned", "damping ratio": 0.0015, "modes": 1}
    return row | changes


def screened(**changes):
    (found,) = frahm.screen_members([member(**changes)])
    return found


def by_hand(D=0.508, t=0.0127, added=0.0):
    """E I [N m^2] and mass per length [kg/m] of a tube."""
    inner = D - 2 * t
    return E * math.pi / 64 * (D**4 - inner**4), RHO * math.pi / 4 * (D**2 - inner**2) + added


@pytest.mark.parametrize(
    ("ends", "beta_squared", "participation", "curvature"),
    [("pinned", math.pi**2, 4 / math.pi, math.pi**2), ("fixed-pinned", 15.4182, 1.298, 20.432),
     ("fixed", 22.3733, 1.320, 28.175), ("cantilever", 3.5160, 1.566, 3.516)],
)  # fmt: skip
def test_frequency_wind_damping_amplitude_and_stress_of_hand_formulas(ends, beta_squared, participation, curvature):
    """In resonance A = g F_L/(2 m zeta omega^2), with the lift of a table that has one value, whatever the wind."""
    L, zeta, St, C = 25.0, 0.0015, 0.2, 0.3
    found = screened(ends=ends, length=L, **{"added mass": 12.0, "strouhal": St, "lift coefficient": C}).findings
    stiffness, m = by_hand(added=12.0)
    f = beta_squared / (2 * math.pi) * math.sqrt(stiffness / m) / L**2
    assert found.case.pipe.frequency == pytest.approx(2 * math.pi * f, rel=1e-5)
    critical = f * 0.508 / St
    assert found.band.resonance == pytest.approx(critical, rel=1e-5)
    assert (found.band.low, found.band.high) == pytest.approx((critical / 1.2, critical / 0.8), rel=1e-5)
    K = 2 * m * 2 * math.pi * zeta / (1.225 * 0.508**2)
    assert found.numbers.scruton_number == pytest.approx(K, rel=1e-5)
    lift = 0.5 * 1.225 * critical**2 * 0.508 * C
    amplitude = participation * lift / (2 * m * zeta * (2 * math.pi * f) ** 2)
    assert found.motion.pipe_peak == pytest.approx(amplitude, rel=1e-3)  # the worst wind is a trifle above resonance
    assert found.motion.stress_range == pytest.approx(E * 0.508 * amplitude * curvature / L**2, rel=2e-3)


def test_fixity_goes_from_pinned_to_fixed():
    f = [screened(ends=r).case.pipe.frequency for r in (0.0, 0.3, 0.7, 0.9999, 1.0)]
    pinned, fixed = (screened(ends=words).case.pipe.frequency for words in ("pinned", "fixed"))
    assert f[0] == pytest.approx(pinned)
    assert f[-1] == pytest.approx(fixed)
    assert np.all(np.diff(f) > 0)
    assert f[3] == pytest.approx(fixed, rel=1e-3)


def test_ends_in_other_words():
    for words in ("Fixed / Pinned", "fixed_pinned", "clamped pinned", "FIXED-PINNED"):
        assert screened(ends=words).case.digest == screened().case.digest


def test_tables_that_end_inside_the_band_leave_a_question():
    found = screened(**{"strouhal": "facchinetti2004", "lift coefficient": "facchinetti2004", "highest wind": 25.0})
    assert found.verdict.word == LOOK_CLOSER
    assert "nan" not in " ".join(found.verdict.reasons)
    assert found.row()["critical_wind"] is None


def test_a_spring_at_pinned_ends_is_the_fixity_it_amounts_to():
    stiffness, _ = by_hand()
    k = 3 * 0.4 / 0.6 * stiffness / 25.0
    spring = screened(ends="pinned", **{"rotational stiffness": k})
    assert spring.case.pipe.frequency == pytest.approx(screened(ends=0.4).case.pipe.frequency, rel=1e-9)


CLIMATE = {"weibull scale": 8.0, "weibull shape": 2.0, "design life": "20 year", "s-n curve": "F1", "modes": 3}


def test_a_member_beyond_a_limit_fails_and_says_by_how_much():
    found = screened(**CLIMATE)
    assert found.verdict.word == FAIL
    used = found.findings.damage["utilisation_with"]
    assert found.utilisation == used > 1
    assert f"{used:.3g} of 1" in found.verdict.why
    assert screened(**{"displacement limit": 0.01, "highest wind": 25.0}).verdict.word == FAIL


def test_a_member_that_no_wind_of_the_site_excites_passes():
    found = screened(length=8.0, ends="fixed", **CLIMATE)
    assert found.verdict.word == PASS
    assert found.findings.site[1] < found.findings.onset
    assert "No wind of the site excites it" in found.verdict.why


def test_a_member_that_is_excited_and_keeps_its_limits_passes():
    found = screened(**{"displacement limit": 0.4, "amplitude limit": 0.5, "highest wind": 12.0})
    assert found.verdict.word == PASS
    assert found.verdict.why.startswith("Excited from ")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "winds of the site are not known"),
        ({"highest wind": 15.0}, "nothing says what it may"),
        ({"highest wind": 15.0, "s-n curve": "F1"}, "nothing says what it may"),
        ({"highest wind": 30.0, "displacement limit": 0.4}, "excite modes above the 1 that were looked at"),
        ({"highest wind": 7.6}, "comes within 10% of"),
        ({"highest wind": 7.0}, "DNV 1977 expects vibration from"),
        ({"highest wind": 12.0, "displacement limit": 0.4, "damping ratio": 0.08}, "more than 0.05 takes a damper"),
        ({"weibull scale": 2.8, **{k: v for k, v in CLIMATE.items() if k != "weibull scale"}}, "locked in"),
    ],
)
def test_a_member_to_look_closer_at_says_why(changes, words):
    found = screened(**changes)
    assert found.verdict.word == LOOK_CLOSER
    assert any(words in reason for reason in found.verdict.reasons), found.verdict.reasons


def test_a_limit_that_a_lift_one_tenth_larger_would_break_is_near():
    free = screened(**{"displacement limit": 0.4, "highest wind": 12.0})
    peak = free.findings.motion.pipe_peak
    words = {share: screened(**{"displacement limit": peak / share, "highest wind": 12.0}).verdict for share in
             (0.90, 0.92, 1.01)}  # fmt: skip
    assert [verdict.word for verdict in words.values()] == [PASS, LOOK_CLOSER, FAIL]
    assert "a lift 10% larger would break it" in words[0.92].why


def test_lock_in_to_a_resonance_the_site_has_no_wind_for_is_counted():
    """The site ends inside the band: the vortices of its strongest wind may be shed at the natural frequency."""
    resonance = screened().findings.band.resonance
    found = screened(**CLIMATE | {"highest wind": 0.9 * resonance})
    assert found.findings.excited
    damage = found.findings.damage
    fatigue, case = found.case.fatigue, found.case
    S = found.findings.motion.stress_range / 1e6
    assert fatigue.thickness == case.pipe.wall
    N = 10**11.699 * S**-3 if S > 36.84 else 10**14.832 * S**-5
    low = found.findings.band.low
    chance = math.exp(-((low / 8) ** 2)) - math.exp(-((0.9 * resonance / 8) ** 2))
    cycles = case.climate.duration * chance * found.findings.motion.frequency / (2 * math.pi)
    assert damage["held"] == pytest.approx(cycles / N, rel=1e-6)


def test_higher_modes_that_winds_of_the_site_excite_count():
    found = screened(length=40.0, ends="pinned", **{"highest wind": 30.0, "modes": ""})
    modes = {case.pipe.governing_mode for case, _ in found.findings.motions}
    assert {1, 2} <= modes
    assert found.case.pipe.mode_count > max(modes)
    peaks = [motion.pipe_peak for _, motion in found.findings.motions]
    assert found.findings.motion.pipe_peak == max(peaks)
    assert found.findings.mode == max(found.findings.motions, key=lambda one: one[1].pipe_peak)[0].pipe.governing_mode


def test_the_others_go_on_where_a_row_cannot_be_read():
    rows = [member(), member(name="B2", ends="pined"), member(name="B3", wall=0.4), member(name="B4", length="x"),
            member(name="B5", **{"damping ratio": 0.0})]  # fmt: skip
    screen = frahm.screen_members(rows)
    assert screen.counts[NOT_JUDGED] == 4
    assert "Did you mean 'pinned'" in screen["B2"].verdict.why
    assert screen["B3"].verdict.why.startswith("wall thickness: given 0.4")
    assert "length" in screen["B4"].verdict.why
    assert "damping ratio: given 0.0" in screen["B5"].verdict.why
    assert len(screen.unverified) == 5
    with pytest.raises(frahm.ParameterError, match=r"at least one row that can be read.*pined"):
        frahm.screen_members([member(ends="pined")])
    with pytest.raises(frahm.ParameterError, match="Did you mean 'B1'"):
        screen["B11"]
    with pytest.raises(RuntimeError, match="B2 is no case"):
        _ = screen["B2"].case


def test_the_worst_comes_first():
    rows = [member(name=f"L{L}", length=float(L), **CLIMATE) for L in (8, 14, 20, 25)] + [member(name="?", ends="x")]
    screen = frahm.screen_members(rows)
    order = [FAIL, LOOK_CLOSER, NOT_JUDGED, PASS]
    words = [one.verdict.word for one in screen]
    assert words == sorted(words, key=order.index)
    fails = [one.utilisation for one in screen if one.verdict.word == FAIL]
    assert fails == sorted(fails, reverse=True)
    assert len(fails) > 1


def test_what_was_assumed_is_said():
    found = screened(**CLIMATE)
    assert found.assumed["stress concentration"] == "1"
    assert found.assumed["density"].startswith("7850")
    assert "stress concentration" not in screened(**CLIMATE | {"stress concentration": 1.5}).assumed
    assert "density" not in screened(density=7850.0).assumed
    screen = frahm.screen_members([member(), member(name="B2", density=7800.0)])
    assert screen.assumptions["density"][1] == 1
    assert screen.assumptions["air density"][1] == 2


def test_a_tubular_joint_has_its_own_reference_thickness():
    thick = CLIMATE | {"wall": 0.02}
    assert screened(**thick | {"s-n curve": "T"}).case.fatigue.reference_thickness == 0.016
    assert screened(**thick).case.fatigue.reference_thickness == 0.025


def test_an_interruption_keeps_what_was_done():
    def stop(name, number, total):
        if number == 1:
            raise KeyboardInterrupt

    screen = frahm.screen_members([member(name=f"B{i}") for i in range(3)], progress=stop)
    assert screen.interrupted
    assert [one.verdict.word for one in screen].count(NOT_JUDGED) == 2


def test_the_repr_is_short():
    assert len(repr(frahm.screen_members("members-example")).splitlines()) <= 12


def test_a_data_frame_is_a_table():
    pandas = pytest.importorskip("pandas")
    rows = [member(), member(name="B2", **{"highest wind": 15.0})]
    screen = frahm.screen_members(pandas.DataFrame(rows))
    assert screen["B1"].findings.site[1] == math.inf
    assert screen["B2"].findings.site[1] == 15.0
