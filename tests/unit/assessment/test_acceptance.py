"""Limits against numbers worked out by hand, and what makes a verdict."""

import math

import pytest

import frahm
from frahm.assessment import accepted, headline, nothing_to_judge, utilisations
from frahm.assessment.acceptance import NO_LIMITS, ONLY_STROKE

WORST = {"pipe_peak": 0.0381, "stress_range": 80e6, "relative_peak": 0.06}
FATIGUE = {"utilisation_with": 0.4}


def found(limits, worst=WORST, fatigue=None, **changes):
    case = frahm.load_case(frahm.load_case("jacket-pipe").to_dict() | {"limits": limits})
    return {row.name: row for row in utilisations(case, None if worst is None else worst | changes, fatigue)}


def test_every_limit_is_a_share_of_what_is_allowed():
    limits = {"displacement": "50 mm", "amplitude_ratio": 0.1, "stress_range": "100 MPa", "stroke": "0.08 m",
              "yield_strength": "355 MPa", "static_stress": "120 MPa", "damage": 0.5}  # fmt: skip
    rows = found(limits, fatigue=FATIGUE)
    assert {name: row.ratio for name, row in rows.items()} == pytest.approx({
        "displacement": 0.0381 / 0.05, "amplitude_ratio": 0.0381 / 0.762 / 0.1, "stress_range": 0.8,
        "yield": (120 + 40) / 355, "stroke": 0.75, "damage": 0.8,
    })  # fmt: skip
    assert rows["displacement"].text == "Displacement 38.1 mm of 50.0 mm"
    verdict = accepted(list(rows.values()), True)
    assert verdict["verdict"] == "pass"
    assert verdict["sentence"] == "PASS: the limit used most is stress range, 80%."
    assert verdict["utilisation"]["yield"] == pytest.approx(160 / 355)


def test_one_limit_exceeded_fails_even_if_nothing_is_verified():
    rows = list(found({"displacement": "30 mm", "stroke": "0.1 m"}).values())
    for verified in (True, False):
        verdict = accepted(rows, verified)
        assert verdict["verdict"] == "fail"
        assert verdict["sentence"] == "FAIL: Displacement 38.1 mm of 30.0 mm, 127%."


def test_exactly_at_the_limit_passes():
    assert accepted(list(found({"stroke": 0.06}).values()), True)["verdict"] == "pass"


def test_damage_above_one_fails_without_a_section_limits():
    case = frahm.load_case("jacket-pipe")
    (row,) = utilisations(case, WORST, {"utilisation_with": 14.2})
    assert (row.name, row.limit, row.ratio) == ("damage", 1.0, 14.2)
    assert "14 times" in accepted([row], True)["sentence"]


@pytest.mark.parametrize("limit", ["stress_range", "yield_strength"])
def test_a_limit_that_lacks_data_is_never_passed(limit):
    rows = list(found({limit: "100 MPa", "displacement": "50 mm"}, stress_range=math.nan).values())
    assert accepted(rows, True)["verdict"] == "not verified"
    assert accepted(list(found({limit: "1 MPa"}, stress_range=math.nan).values()), True)["sentence"].startswith(
        "NOT VERIFIED: nothing is known that the limits"
    )


def test_a_doubt_leaves_no_pass_and_a_case_without_limits_says_so():
    assert accepted(list(found({"stroke": 0.1}).values()), False)["verdict"] == "not verified"
    nothing = accepted([], True)
    assert nothing["verdict"] == "not verified"  # nothing was judged, so nothing passes
    assert headline(nothing) == "NOT JUDGED"
    assert nothing["sentence"].startswith("NOT JUDGED: the case gives no limit")
    (unknown,) = found({"stroke": 0.1}, worst=None).values()
    assert math.isnan(unknown.ratio)
    assert unknown.text == "Stroke not known of 100 mm"
    assert headline(accepted([unknown], True)) == "NOT VERIFIED"


def test_a_bare_pipe_has_no_stroke():
    bare = frahm.load_case("jacket-pipe").without_absorbers()
    case = frahm.load_case(bare.to_dict() | {"limits": {"stroke": 0.1, "displacement": 0.1}})
    assert [row.name for row in utilisations(case, WORST, None)] == ["displacement"]


def test_a_bare_pipe_with_a_limit_of_the_stroke_alone_is_told_so():
    bare = frahm.load_case("jacket-pipe").without_absorbers()
    case = frahm.load_case(bare.to_dict() | {"limits": {"stroke": 0.1}})
    sentence = accepted(utilisations(case, WORST, None), True, nothing_to_judge(case))["sentence"]
    assert sentence == f"NOT JUDGED: {ONLY_STROKE}"
    assert nothing_to_judge(bare) == NO_LIMITS


@pytest.mark.parametrize(("limit", "value"), [("stroke", -1), ("stress_range", 0), ("yield_strength", "20 mm")])
def test_impossible_limits_are_refused(limit, value):
    with pytest.raises(frahm.ParameterError, match=f"limits.{limit}"):
        found({limit: value})
