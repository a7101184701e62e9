"""Little or no damping: the slow flow's searches take no longer, warn of nothing, and find what is there."""

import math
import time

import numpy as np
import pytest

import frahm
from frahm.slow_flow import SlowFlow, locate_points, slow_flow_of
from frahm.slow_flow import branches as branches_module
from frahm.slow_flow.kernels import equilibria, linear_parts

OMEGA = 2 * math.pi * 0.78
BARE = frahm.load_case("jacket-pipe").to_dict()
UNDAMPED = frahm.load_case(BARE | {"pipe": BARE["pipe"] | {"damping_ratio": 0.0}})


def _slow(xi1, xi2, form):
    return SlowFlow(omega=OMEGA, xi1=xi1, xi2=xi2, kappa=367.38, rho2=0.02, force=5.2e-3, form=form)


@pytest.mark.parametrize("form", ["averaged", "paper"])
@pytest.mark.parametrize("xi2", [1e-3, 1e-6, 1e-12, 0.0])
@pytest.mark.parametrize("xi1", [0.0147, 1e-9, 0.0])
def test_every_saddle_node_up_to_far_beyond_resonance_within_a_second(xi1, xi2, form):
    slow = _slow(xi1, xi2, form)
    lo, hi = slow.limits
    locate_points(slow, "saddle-node", OMEGA, 1.1 * OMEGA)  # compiled
    began = time.perf_counter()
    folds = [point.frequency for point in locate_points(slow, "saddle-node", lo, hi)]
    assert time.perf_counter() - began < 1.0
    grid = np.geomspace(lo, hi, 40_000)
    counts = np.array([_count(slow, W) for W in grid])
    for index in np.flatnonzero(np.diff(counts)):
        if xi1 == 0.0 and _stiffness(slow, grid[index]) * _stiffness(slow, grid[index + 1]) < 0:
            continue  # the resonance with the sink locked: two equilibria come from infinity there, and meet nowhere
        assert any(grid[index] * (1 - 1e-9) <= W <= grid[index + 1] * (1 + 1e-9) for W in folds), grid[index]


def _count(slow, W):
    _, _, d0, _, s0, e, _ = linear_parts(slow.code, W, *slow.host)
    return equilibria(d0, s0, e, slow.force, slow.kappa)[0]


def _stiffness(slow, W):
    return linear_parts(slow.code, W, *slow.host)[4].real


@pytest.mark.parametrize("form", ["averaged", "paper"])
@pytest.mark.parametrize("case", [UNDAMPED.with_absorber(xi2=0.0), UNDAMPED, UNDAMPED.with_absorber(xi2=1e-6)])
def test_the_response_of_an_undamped_pipe_takes_no_longer(case, form):
    began = time.perf_counter()
    curve = frahm.frequency_response(case, detuning=(-0.4, 0.4), method="slow-flow", form=form)
    assert time.perf_counter() - began < 20  # with what is compiled; minutes if every box were looked at
    assert curve.unverified == ()
    assert np.all(np.isfinite(curve.pipe_amplitude))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("plane", [("detuning", "kappa"), ("detuning", "force"), ("xi2", "kappa"), ("rho2", "force")])
def test_boundaries_without_damping_are_finite_and_of_a_positive_load(plane):
    bounds = {"detuning": (-0.4, 0.4), "kappa": (0.0, 1000.0), "force": (0.0, 3.0), "xi2": (0, 0.1), "rho2": (0, 0.1)}
    found = frahm.stability_boundaries(
        UNDAMPED.with_absorber(xi2=0.0), plane=plane, bounds=tuple(bounds[axis] for axis in plane), detuning=-0.1
    )
    assert found.sizes["point"] > 0
    assert np.all(np.isfinite(found["relative_amplitude"]))
    assert np.all(found[plane[1]] > 0)


def test_a_search_that_meets_its_budget_says_so(monkeypatch):
    slow = slow_flow_of(frahm.build_system(frahm.load_case("jacket-pipe")), "averaged")
    monkeypatch.setattr(branches_module, "hopf_points", lambda *_: -1)
    found = branches_module.slow_branches(slow, OMEGA - 0.1, OMEGA + 0.1, 100)
    assert "hopf points could not all be separated within the work" in found.unverified[0]
