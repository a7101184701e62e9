"""Bad regions, motions that cannot be followed, interruptions: named and kept, never lost."""

import numpy as np
import pytest

import frahm
from frahm.attractors.stroboscope import Stroboscope

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)


@pytest.mark.parametrize(
    ("region", "message"),
    [
        ({}, "region"),
        ({"v": (0, 1)}, "Did you mean 'v1'"),
        ({"x1": 3}, "two numbers"),
        ({"x1": (1, 0)}, "lo <= hi"),
        ({"x1": (0, float("nan"))}, "finite"),
        ({"x1": (0, float("inf"))}, "finite"),
        ({"z": (-1e300, 1e300)}, "1e\\+30"),
        ([("x1", (0, 1))], "a region such as"),
        ({"x1": ("0", 1)}, "finite"),
    ],
)
def test_a_bad_region_is_refused_by_name(region, message):
    with pytest.raises(frahm.ParameterError, match=message):
        frahm.find_attractors(CASE, detuning=0.0, region=region)


@pytest.mark.parametrize(
    "arguments",
    [
        {"detuning": float("nan")}, {"detuning": 0.0, "frequency": 4.9}, {}, {"detuning": 0.0, "samples": -1},
        {"detuning": 0.0, "samples": 2.5}, {"detuning": 0.0, "seed": -1}, {"detuning": 0.0, "periods": 0},
        {"detuning": 0.0, "workers": 0},
    ],
)  # fmt: skip
def test_bad_arguments_of_find_attractors(arguments):
    with pytest.raises(frahm.ParameterError):
        frahm.find_attractors(CASE, **arguments)


@pytest.mark.parametrize(
    "arguments",
    [
        {"plane": ("x1", "x1")}, {"plane": "x1"}, {"plane": ("x1", "q")}, {"extent": (0, 1)}, {"extent": 1},
        {"extent": ((0, 1), (2, 1))}, {"resolution": 1}, {"resolution": (3, 4, 5)}, {"resolution": 10**5},
    ],
)  # fmt: skip
def test_bad_arguments_of_basin_map(arguments):
    with pytest.raises(frahm.ParameterError):
        frahm.basin_map(CASE, detuning=0.0, **arguments)


@pytest.mark.parametrize(
    "arguments", [{"detuning": 0.0}, {"detuning": (0.1, 0.0)}, {"detuning": (0, 0.1), "min_basin": 2}]
)
def test_bad_arguments_of_worst_case(arguments):
    with pytest.raises(frahm.ParameterError):
        frahm.worst_case(CASE, **arguments)


def test_states_too_stiff_to_follow_are_named_and_counted():
    found = frahm.find_attractors(CASE, detuning=-0.144, region={"z": (1e5, 1e6)}, samples=8)
    (stiff,) = [a for a in found if a.kind == "unsettled"]
    assert stiff.outcome is frahm.Outcome.STEP_LIMIT
    assert stiff.basin_fraction == 1.0
    assert np.isnan(stiff.pipe_peak)
    assert found[-1] is stiff
    assert [a.kind for a in found[:2]] == ["periodic", "periodic"]


def test_motion_that_escapes_is_named_and_comes_first():
    softening = frahm.System(
        np.diag([1.0, 0.02]), np.diag([0.01, 0.0]), np.diag([1.0, 0.0]), (0.001, 0.0),
        [frahm.Element((-1, 1), frahm.Polynomial((0.02, 0.0, -1.0), 0.001))],
    )  # fmt: skip
    found = frahm.find_attractors(softening, frequency=0.8, region={"x1": (-0.3, 0.3)}, samples=64)
    assert found[0].kind == "unsettled"
    assert found[0].outcome is frahm.Outcome.DIVERGED
    assert found[0].pipe_peak == np.inf
    assert 0 < found[0].basin_fraction < 1
    assert sum(a.basin_fraction for a in found) == pytest.approx(1.0)


def test_a_structure_that_only_escapes():
    system = frahm.System([[1.0]], [[0.1]], [[-1.0]], [0.1], reference_frequency=1.0)
    found = frahm.find_attractors(system, frequency=1.0, samples=16)
    assert [(a.kind, a.basin_fraction) for a in found] == [("unsettled", 1.0)]


def test_motion_that_neither_settles_nor_escapes_is_called_unsettled():
    undamped = frahm.System([[1.0]], [[0.0]], [[1.0]], [0.1], reference_frequency=1.0)
    found = frahm.find_attractors(undamped, frequency=1.3, samples=8, periods=1000)
    lost = [a for a in found if a.kind == "unsettled"]
    assert lost[0].outcome is frahm.Outcome.NOT_CONVERGED
    assert lost[0].basin_fraction == 1.0


def test_nothing_attracts_where_nothing_dissipates():
    conservative = frahm.System(
        np.diag([1.0, 0.05]), np.zeros((2, 2)), np.diag([1.0, 0.0]), (0.01, 0.0),
        [frahm.Element((-1, 1), frahm.Cubic(1.0))],
    )  # fmt: skip
    found = frahm.find_attractors(conservative, frequency=1.3, samples=8, periods=1200)
    assert {a.kind for a in found if a.basin_fraction > 0} == {"unsettled"}


def test_too_few_periods_leave_motions_unsettled():
    found = frahm.find_attractors(CASE, detuning=-0.144, samples=20, periods=30)
    assert sum(a.basin_fraction for a in found if a.kind == "unsettled") > 0.5


def test_no_sample_still_gives_the_stable_responses():
    found = frahm.find_attractors(CASE, detuning=-0.144, samples=0)
    assert [a.kind for a in found] == ["periodic", "periodic"]
    assert found.missed_below == 1.0
    assert found.to_dataset().sizes["attractor"] == 2


@pytest.fixture
def interrupted_after(monkeypatch):
    """Raise KeyboardInterrupt in the n-th run over a given number of periods."""
    original = Stroboscope.run

    def arrange(periods, count, least):
        left = [count]

        def run(self, states, stretch, **options):
            if stretch == periods and len(states) >= least:
                left[0] -= 1
                if left[0] < 0:
                    raise KeyboardInterrupt
            return original(self, states, stretch, **options)

        monkeypatch.setattr(Stroboscope, "run", run)

    return arrange


def test_an_interruption_keeps_what_is_labelled(interrupted_after):
    region = {"x1": (-0.08, 0.08), "v1": (-0.4, 0.4)}
    whole = frahm.find_attractors(CASE, detuning=-0.144, region=region, samples=200)
    interrupted_after(50, 1, least=100)
    found = frahm.find_attractors(CASE, detuning=-0.144, region=region, samples=200)
    assert found.outcome is frahm.Outcome.INTERRUPTED
    assert whole.outcome is frahm.Outcome.DONE
    assert 0 < found.samples < 200
    assert all(a.kind != "unsettled" for a in found)


def test_an_interrupted_map_says_where_it_is_empty(interrupted_after):
    interrupted_after(50, 1, least=50)
    data = frahm.basin_map(CASE, detuning=-0.144, resolution=10)
    assert np.any(data.label == -4)
    assert np.any(data.label >= 0)


def test_an_interrupted_worst_case_is_not_verified(monkeypatch):
    import frahm.attractors.worst as room

    original, calls = room.attractors_from, [0]

    def attractors_from(*arguments, **more):
        calls[0] += 1
        if calls[0] > 3:
            raise KeyboardInterrupt
        return original(*arguments, **more)

    monkeypatch.setattr(room, "attractors_from", attractors_from)
    worst = frahm.worst_case(CASE, detuning=(-0.2, -0.1), samples=8)
    assert not worst.verified
    assert len(worst.surveys) == 3
    assert worst.pipe_peak > 0


@pytest.mark.filterwarnings("error")
def test_the_worst_of_motions_none_of_which_has_a_peak_warns_of_nothing(monkeypatch):
    monkeypatch.setattr("frahm.attractors.stroboscope._LEAST_STEPS", 1.0)
    monkeypatch.setattr("frahm.attractors.stroboscope._STEPS_PER_PERIOD", 0.0)
    monkeypatch.setattr("frahm.attractors.worst.responses_on", lambda *_: [])
    found = frahm.worst_case(CASE, detuning=(-0.3, -0.299), samples=2, periods=100)
    assert np.isnan(found.not_excluded)
    assert not found.verified


def test_a_plane_from_which_every_motion_escapes_has_a_map_without_attractors():
    law = frahm.Polynomial((0.0, 0.0, -1.0), 0.0)
    soft = frahm.System(np.eye(1), [[0.1]], [[1.0]], [3.0], [frahm.Element((1.0,), law)], name="softening")
    data = frahm.basin_map(soft, frequency=0.9, resolution=4)
    assert data.sizes["attractor"] == 0
    assert np.all(data.label == -2)
    assert (
        frahm.find_attractors(soft, frequency=0.9, samples=8).to_dataset().sizes["attractor"] == 1
    )  # those that escape
