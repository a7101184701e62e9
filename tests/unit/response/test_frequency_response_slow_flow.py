"""The public verbs of the response room on the slow flow."""

import math

import numpy as np
import pytest

import frahm

OMEGA = 2 * math.pi * 0.78


@pytest.fixture(scope="module")
def case():
    return frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)


def test_curve_reports_all_special_points_in_order(case):
    curve = frahm.frequency_response(case, detuning=(-0.4, 0.4), method="slow-flow")
    found = [(p.kind, round(p.detuning, 5), p.branch) for p in curve.special_points]
    assert found == [
        ("saddle-node", -0.16809, 1),
        ("saddle-node", -0.09737, 1),
        ("hopf", -0.01307, 0),
        ("saddle-node", 0.05099, 0),
        ("hopf", 0.05901, 0),
        ("saddle-node", 0.12949, 0),
    ]
    assert [branch.detached for branch in curve.branches] == [False, True]
    assert curve.unverified == ()


def test_every_variable_has_unit_and_name(case):
    curve = frahm.frequency_response(case, detuning=(-0.1, 0.1), method="slow-flow", points=50)
    boundaries = frahm.stability_boundaries(case, resolution=60)
    for dataset in (curve.to_dataset(), frahm.slow_flow_map(case, detuning=[0.0, 0.1]), boundaries):
        assert dataset.data_vars
        for variable in dataset.data_vars.values():
            assert variable.attrs["units"]
            assert variable.attrs["long_name"]


def test_frequency_and_detuning_windows_are_the_same(case):
    by_detuning = frahm.frequency_response(case, detuning=(-0.1, 0.2), method="slow-flow", points=30)
    by_frequency = frahm.frequency_response(case, frequency=(OMEGA - 0.1, OMEGA + 0.2), method="slow-flow", points=30)
    assert by_detuning.frequency == pytest.approx(by_frequency.frequency, abs=1e-12)


def test_map_agrees_with_the_curve_at_every_root(case):
    detuning = np.linspace(-0.3, 0.3, 61)
    curve = frahm.frequency_response(case, detuning=(-0.3, 0.3), method="slow-flow", points=61)
    grid = frahm.slow_flow_map(case, detuning=detuning, kappa=[[367.38], [97.97]])
    assert grid["pipe_amplitude"].dims == ("kappa", "detuning", "root")
    for i, sigma in enumerate(detuning):
        here = np.abs(curve.detuning - sigma) < 1e-12
        order = np.argsort(curve.relative_amplitude[here])
        count = int(here.sum())
        row = grid.isel(kappa=0, detuning=i)
        assert row["pipe_amplitude"].values[:count] == pytest.approx(curve.pipe_amplitude[here][order], rel=1e-9)
        assert list(row["stability"].values[:count] == 0) == list(curve.stable[here][order])
        assert np.all(row["stability"].values[count:] == -1)
        assert np.all(np.isnan(row["relative_amplitude"].values[count:]))


def test_map_without_a_sink_spring_is_the_linear_response(case):
    W = OMEGA + 0.05
    one = frahm.slow_flow_map(case.with_absorber(kappa=1e-12), detuning=0.05)
    H = np.array(
        [[OMEGA**2 - W**2 + 2j * 0.0015 * OMEGA * W, -1j * W * 0.0085], [-0.02 * W**2, -0.02 * W**2 + 1j * W * 0.0085]]
    )
    force = 0.5 * 0.4535 * 1.225 * 2.7**2 * 0.762 / 247
    X, Z = np.linalg.solve(H, [force, 0])
    assert one["pipe_amplitude"].values[0] == pytest.approx(abs(X), rel=1e-9)
    assert one["relative_amplitude"].values[0] == pytest.approx(abs(Z), rel=1e-9)


def test_host_in_modal_coordinates_gives_the_same_response(case):
    """A sink at a section with modal ordinate 0.5 on a mode of quarter mass is the same machine."""
    plain = frahm.build_system(case)
    phi = 0.5
    scaled = frahm.System(
        mass=np.diag([plain.mass[0, 0] * phi**2, plain.mass[1, 1]]),
        damping=plain.damping * phi**2,
        stiffness=plain.stiffness * phi**2,
        forcing=plain.forcing * phi,
        elements=[frahm.Element((-phi, 1.0), plain.elements[0].law)],
        output=(phi, 0.0),
    )
    a = frahm.frequency_response(plain, detuning=(-0.2, 0.2), method="slow-flow", points=40)
    b = frahm.frequency_response(scaled, detuning=(-0.2, 0.2), method="slow-flow", points=40)
    assert a.pipe_amplitude == pytest.approx(b.pipe_amplitude, rel=1e-9)
    assert a.growth_rate == pytest.approx(b.growth_rate, abs=1e-9)


def linear_absorber():
    return frahm.System(
        np.eye(2), np.zeros((2, 2)), np.diag([1, 0]), [1, 0], [frahm.Element((-1, 1), frahm.Linear(1.0))]
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"detuning": (-0.1, 0.1), "frequency": (1, 2)}, "exactly one of the two"),
        ({"detuning": (-5.0, 0.1)}, "detuning[0]"),
        ({"detuning": (0.1, -0.1)}, "lo < hi"),
        ({"detuning": (0.1, math.nan)}, "detuning[1]"),
        ({"detuning": 0.1}, "two numbers"),
        ({"detuning": (-0.1, 0.1), "points": 1}, "points"),
        ({"detuning": (-0.1, 0.1), "method": "slowflow"}, "'slow-flow'"),
        ({"detuning": (-0.1, 0.1), "method": "slow-flow", "form": "papers"}, "'paper'"),
    ],
)
def test_bad_arguments_are_named(case, arguments, message):
    with pytest.raises(frahm.ParameterError) as caught:
        frahm.frequency_response(case, **arguments)
    assert message in str(caught.value)


def test_a_system_has_no_range_of_its_own_and_a_case_has():
    with pytest.raises(frahm.ParameterError, match="exactly one of the two"):
        frahm.frequency_response(linear_absorber())
    asked = frahm.load_case("jacket-pipe").without_absorbers()
    curve = frahm.frequency_response(asked)
    assert (curve.detuning.min(), curve.detuning.max()) == pytest.approx(asked.analysis.detuning)


def test_slow_flow_refuses_other_systems():
    with pytest.raises(frahm.ParameterError, match="harmonic-balance"):
        frahm.frequency_response(linear_absorber(), frequency=(0.5, 1.5), method="slow-flow")


@pytest.mark.parametrize("name", ["detuning", "kappa", "xi2"])
def test_map_refuses_what_is_not_a_number(case, name):
    with pytest.raises(frahm.ParameterError, match=name):
        frahm.slow_flow_map(case, **{name: [0.0, math.nan]})


@pytest.mark.parametrize("plane", [("detuning", "detuning"), ("detuning", "kapa"), "detuning"])
def test_boundaries_refuse_unknown_planes(case, plane):
    with pytest.raises(frahm.ParameterError, match="plane"):
        frahm.stability_boundaries(case, plane=plane)
