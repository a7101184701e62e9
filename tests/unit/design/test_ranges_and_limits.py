"""Ranges are kept, rivals are not bound by them, limits hold for every attractor, and the verdict names who won."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import frahm
from frahm.attractors import WorstMotion
from frahm.case import Scatter
from frahm.design import DesignSettings, Objective, verified_designs, with_design
from frahm.design.absorber import DesignedAbsorber
from frahm.design.disturbance import Disturbance
from frahm.design.family_search import _why_not
from frahm.design.host import host_of
from frahm.design.problem import Problem
from frahm.design.settings import settings_for
from frahm.design.study import Rival, first_of, headline
from frahm.design.verdict import verdict
from frahm.report.decision import ranking_rows

CASE = frahm.load_case("jacket-pipe")
OMEGA = CASE.pipe.frequency


@pytest.mark.parametrize(("kappa", "xi2"), [((0.0, 0.001), (0.0, 1e-7)), ((1e-4, 2e-3), (0.01, 0.02)), (None, None)])
def test_no_design_lies_outside_the_ranges(kappa, xi2):
    problem = Problem.of(CASE, settings_for(CASE, changes={"kappa": kappa, "xi2": xi2}))
    space = problem.tier("sink").space
    designs = space.designs(np.random.default_rng(1).random((200, 2))) / 247
    for column, span in ((2, kappa), (3, xi2)):
        if span is not None:
            assert np.all(designs[:, column] >= span[0] * (1 - 1e-9))
            assert np.all(designs[:, column] <= span[1] * (1 + 1e-9))
    units = np.random.default_rng(2).random((20, 2))
    assert space.units(space.designs(units)) == pytest.approx(units, abs=1e-9)


def test_ranges_are_for_the_family_asked_for_alone():
    asked = settings_for(CASE, changes={"family": "sink", "xi2": (0.009, 0.013), "linear": (0.1, 0.2)})
    (tuned,) = verified_designs(CASE, asked, ("tuned",))
    assert tuned.worst_pipe_peak == pytest.approx(0.00255, rel=0.01)  # as if no range had been given
    of_tuned = asked.changed(family="tuned")
    (bound,) = verified_designs(CASE, of_tuned, ("tuned",))
    assert 0.1 <= bound.design.linear <= 0.2 + 1e-9
    assert bound.worst_pipe_peak > 2 * tuned.worst_pipe_peak


def test_a_limit_on_the_stroke_holds_for_modulated_motions_too():
    """The periodic stroke of these sinks is 0.032 m, the modulated one 0.053 m: none keeps a stroke of 0.045 m."""
    asked = {"force_margin": 1.0, "xi2": (0.009, 0.013), "kappa": (200, 600), "stroke": 0.045, "samples": 4}
    found = verified_designs(CASE, DesignSettings(**asked), ("sink",))
    assert all(rival.relative_peak <= 0.045 * 1.001 for rival in found)


def test_the_gap_of_end_stops_limits_the_stroke():
    absorber = CASE.to_dict()["absorbers"][0] | {"stops": {"gap": 0.02, "stiffness": 5000.0}}
    case = frahm.load_case(CASE.to_dict() | {"absorbers": [absorber]})
    assert Problem.of(case, settings_for(case)).limits.stroke == 0.02


def test_a_wind_without_lift_is_refused_and_a_pipe_without_damping_is_not():
    with pytest.raises(frahm.ParameterError, match="lift"):
        frahm.design_absorber(CASE.with_wind(lift_coefficient=0.0))
    (tuned,) = verified_designs(CASE.with_pipe(damping_ratio=0.0), DesignSettings(samples=4), ("tuned",))
    # the equal-peak optimum of an undamped host: 10.053 static deflections
    static = 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762 / 247 / OMEGA**2
    assert tuned.worst_pipe_peak == pytest.approx(10.053 * static, rel=2e-3)


def test_an_absorber_that_stays_is_not_moved_with_the_frequency_of_the_pipe():
    second = {"name": "other", "mass": 5.0, "law": {"kind": "linear", "stiffness": 110.0, "damping": 2.0}}
    case = frahm.load_case(CASE.to_dict() | {"absorbers": [CASE.to_dict()["absorbers"][0], second]})
    host = host_of(frahm.build_system(case))
    r, W = 0.85, np.linspace(3.9, 5.2, 14)
    _, _, _, x = host.receptances(W, Disturbance(pipe_frequency=r))
    omega = r * OMEGA
    dynamic = 247 * (omega**2 - W**2 + 2j * 0.0015 * omega * W)
    g = 110.0 + 2j * W
    carried = 5.0 * W**2 * g / (g - 5.0 * W**2)  # of a mass on a spring, felt at its foot
    force = r**2 * 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762
    assert np.abs(x) == pytest.approx(np.abs(force / (dynamic - carried)), rel=1e-6)


def rival(name, value, verified=True):
    worst = WorstMotion(
        pipe_peak=value, frequency=4.9, detuning=0.0, wind_speed=math.nan, kind="periodic", basin_fraction=1.0,
        basin_interval=(1.0, 1.0), relative_peak=0.0, relative_frequency=4.9, pipe_rms=0.0, rms_frequency=4.9,
        state=np.zeros(4), range="", tier="test", samples=0, searched=1, unverified=() if verified else ("a doubt",),
    )  # fmt: skip
    return Rival(name, None, value, worst, worst, Disturbance(), math.inf)


def test_the_verdict_names_the_best_that_is_verified():
    words = verdict(
        [rival("case", 0.0016), rival("tuned mass damper", 0.0036), rival("mixed", 0.0036), rival("sink", 0.009)],
        (), {}, Scatter(), Objective(),
    )  # fmt: skip
    assert words.startswith("With the pipe as given, the case's own absorber has the smallest worst pipe peak")
    words = verdict(
        [rival("mixed", 0.002, verified=False), rival("tuned mass damper", 0.0036)], (), {}, Scatter(), Objective()
    )
    assert "the tuned mass damper has the smallest" in words
    assert "Unverified: the mixture." in words


def test_of_devices_as_good_as_each_other_the_simpler_is_named():
    objective, sink = Objective(), rival("sink", 0.0067)
    tuned, mixed = rival("tuned mass damper", 0.00209), rival("mixed", 0.002089)
    assert first_of([sink, mixed, tuned]).name == "tuned mass damper"
    assert first_of([sink, replace(mixed, value=0.0015), tuned]).name == "mixed"
    assert first_of([sink, mixed, rival("tuned mass damper", 0.00209, verified=False)]).name == "mixed"
    said = headline(sink, first_of([sink, mixed, tuned]), objective)
    assert "the tuned mass damper does better, 2.09 mm" in said
    same = replace(mixed, design=DesignedAbsorber(rho2=0.02, linear=8.0, kappa=0.0, xi2=0.07))
    assert headline(same, tuned, objective).startswith(
        "Best mixed, which is a tuned mass damper without a cubic spring"
    )
    both = replace(mixed, design=DesignedAbsorber(rho2=0.02, linear=8.0, kappa=1.0, xi2=0.07))
    assert headline(both, both, objective).startswith("Best mixed: ")
    errors = {
        "error": [0.0, 0.1],
        "pipe_peak": {"mixed": [0.0020899, 0.003], "tuned mass damper": [0.00209, 0.004]},
        "verified": {"mixed": [True, True], "tuned mass damper": [True, True]},
    }
    ranked = [row[1].split(",")[0] for row in ranking_rows(errors)]
    assert ranked == ["tuned mass damper 2.09", "linear and cubic 3.00"]


def test_a_mixture_in_its_ranges_is_never_a_corner_outside_of_them():
    asked = DesignSettings(family="mixed", kappa=(500.0, 5000.0), samples=4)
    found = verified_designs(CASE, asked, ("tuned", "mixed"))
    mixed = [one for one in found if one.name == "mixed"]
    assert all(500 * (1 - 1e-6) <= one.design.kappa <= 5000 * (1 + 1e-6) for one in mixed)
    assert with_design(CASE, mixed[0].design).absorbers[0].law.kind == "polynomial"


def test_a_smaller_value_that_is_not_verified_is_not_called_no_better():
    chosen = SimpleNamespace(verified=True, value=2.0, unverified=())
    doubtful = SimpleNamespace(verified=False, value=1.0, unverified=("A motion beyond the range is larger.",))
    assert _why_not(doubtful, chosen) == "unverified: A motion beyond the range is larger"
    assert _why_not(SimpleNamespace(verified=False, value=3.0, unverified=("Large.",)), chosen) == "it is not better"
