"""Loci and events of detached curves against the response curves on either side, and against scaling laws."""

import itertools
import math

import numpy as np
import pytest

import frahm

OMEGA = 2 * math.pi * 0.78
WINDOW = (-0.4, 0.4)


@pytest.fixture(scope="module")
def case():
    return frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)


@pytest.fixture(scope="module")
def saddle_nodes(case):
    return frahm.bifurcation_curve(
        case, kind="saddle-node", plane=("detuning", "kappa"), bounds=(WINDOW, (20, 1000)), slices=3
    )


def special(case, kind, **parameters):
    curve = frahm.frequency_response(case.with_absorber(**parameters), detuning=WINDOW)
    return curve, [p.detuning for p in curve.special_points if p.kind == kind]


def crossings(dataset, axis, other, value):
    found = []
    for number in np.unique(dataset["curve"]):
        on = dataset["curve"].values == number
        x, y = dataset[axis].values[on], dataset[other].values[on]
        for i, j in itertools.pairwise(range(x.size)):
            if (y[i] - value) * (y[j] - value) < 0:
                found.append(x[i] + (value - y[i]) / (y[j] - y[i]) * (x[j] - x[i]))
    return sorted(found)


@pytest.mark.parametrize("kappa", [60.0, 200.0, 500.0, 800.0])
def test_saddle_node_curves_cross_where_response_curves_turn(case, saddle_nodes, kappa):
    _, expected = special(case, "saddle-node", kappa=kappa)
    inside = [sigma for sigma in crossings(saddle_nodes, "detuning", "kappa", kappa) if abs(sigma) < 0.4]
    main = [sigma for sigma in expected if abs(sigma) < 0.4]
    assert inside == pytest.approx(sorted(main), abs=2e-3)


def test_every_point_of_a_locus_is_a_special_point(case, saddle_nodes):
    for i in range(5, saddle_nodes.sizes["point"], 29):
        kappa, sigma = float(saddle_nodes["kappa"][i]), float(saddle_nodes["detuning"][i])
        if abs(sigma) > 0.38:
            continue
        near = frahm.frequency_response(case.with_absorber(kappa=kappa), detuning=(sigma - 0.02, sigma + 0.02))
        distance = min(abs(p.detuning - sigma) for p in near.special_points if p.kind == "saddle-node")
        assert distance < 1e-7


def test_neimark_sacker_curve_crosses_where_stability_is_lost(case):
    curve = frahm.bifurcation_curve(
        case, kind="neimark-sacker", plane=("detuning", "xi2"), bounds=((-0.2, 0.2), (0.004, 0.02)), slices=2
    )
    for xi2 in (0.006, 0.012):
        _, expected = special(case, "neimark-sacker", xi2=xi2)
        assert crossings(curve, "detuning", "xi2", xi2) == pytest.approx(sorted(expected), abs=2e-3)


def test_birth_depends_on_kappa_and_force_only_through_kappa_force_squared(case):
    (by_force,) = frahm.detached_curve_events(case, "force", (0.6, 1.4), detuning=WINDOW, slices=3)
    (by_kappa,) = frahm.detached_curve_events(case, "kappa", (150, 700), detuning=WINDOW, slices=3)
    assert by_force.kind == by_kappa.kind == "birth"
    assert 367.38 * by_force.value**2 == pytest.approx(by_kappa.value, rel=1e-8)
    assert by_force.frequency == pytest.approx(by_kappa.frequency, rel=1e-8)


@pytest.mark.parametrize(("parameter", "bounds"), [("kappa", (150, 700)), ("xi2", (0.006, 0.014))])
def test_a_detached_curve_exists_on_one_side_of_its_birth_only(case, parameter, bounds):
    (event,) = frahm.detached_curve_events(case, parameter, bounds, detuning=WINDOW, slices=3)
    assert event.kind == "birth"
    for side in (-1, 1):
        curve, _ = special(case, "saddle-node", **{parameter: event.value * (1 + 0.01 * side)})
        assert any(curve.detached) == (side == event.direction)
    near, points = special(case, "saddle-node", **{parameter: event.value * (1 + 1e-3 * event.direction)})
    around = [p for p in points if abs(p - (event.frequency - OMEGA)) < 0.02]
    assert len(around) == 2
    assert near.branches[1].pipe_peak.mean() == pytest.approx(event.pipe_peak, rel=0.1)


def test_merge_joins_the_detached_curve_with_the_main_one(case):
    events = frahm.detached_curve_events(case, "rho2", (0.005, 0.04), detuning=(-0.3, 0.3), slices=5)
    assert [event.kind for event in events] == ["merge", "birth"]
    merge = events[0]
    joined, apart = (
        frahm.frequency_response(case.with_absorber(rho2=merge.value * factor), detuning=(-0.3, 0.3))
        for factor in (0.99, 1.01)
    )
    assert not any(joined.detached)
    assert any(apart.detached)


def test_no_detached_curve_where_the_response_has_no_saddle_node(case):
    soft = case.with_absorber(kappa=24.425)
    assert frahm.detached_curve_events(soft, "force", (0.8, 1.2), detuning=WINDOW, slices=2) == []


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda c: frahm.detached_curve_events(c, "forse"), "'force'"),
        (lambda c: frahm.detached_curve_events(c, "kappa"), "bounds"),
        (lambda c: frahm.detached_curve_events(c, "force", (2, 1)), "bounds of force"),
        (lambda c: frahm.detached_curve_events(c, "force", (0, math.nan)), "bounds of force"),
        (lambda c: frahm.detached_curve_events(c.without_absorbers(), "force"), "nonlinear element"),
        (lambda c: frahm.bifurcation_curve(c, plane=("detuning", "detuning"), bounds=((0, 1), (0, 1))), "plane"),
        (lambda c: frahm.bifurcation_curve(c, plane=("detuning", "kapa"), bounds=((0, 1), (0, 1))), "'kappa'"),
        (lambda c: frahm.bifurcation_curve(c, kind="hopf", bounds=((0, 1), (0, 1))), "kind"),
        (lambda c: frahm.bifurcation_curve(c, bounds=(0, 1)), "bounds"),
    ],
)
def test_bad_arguments_are_named(case, call, message):
    with pytest.raises(frahm.ParameterError) as caught:
        call(case)
    assert message in str(caught.value)
