"""Detached curves of springs that are not purely cubic: the narrow range of their birth must not be stepped over."""

import numpy as np
import pytest

import frahm
from frahm.harmonic_balance.condensation import condense
from frahm.harmonic_balance.root_counts import polynomial_counts
from frahm.harmonic_balance.seeds import amplitude_roots, seeder_for, spring_polynomial, stiffness_at
from frahm.systems import with_parameters

CASE = frahm.load_case("jacket-pipe")
OMEGA = CASE.pipe.frequency
WIDE = (0.7 * OMEGA, 1.3 * OMEGA)
MASS, KAPPA, XI2 = 247.0, 2871.84, 0.0572429  # a detached curve of the cubic spring is born at 1.062 times the force


def sink(law):
    absorber = {"name": "sink", "mass": 0.02 * MASS, "law": law | {"damping": MASS * XI2}}
    return frahm.build_system(frahm.load_case(CASE.to_dict() | {"absorbers": [absorber]}))


def quintic(q):
    return sink({"kind": "polynomial", "coefficients": [0.0, 0.0, MASS * KAPPA, 0.0, MASS * q]})


@pytest.mark.parametrize("force", [1.05, 1.08, 1.1, 1.15])
def test_a_vanishing_fifth_power_changes_nothing(force):
    cubic = with_parameters(sink({"kind": "cubic", "stiffness": MASS * KAPPA}), force=force)
    other = with_parameters(quintic(1e-3), force=force)
    one, two = (frahm.frequency_response(system, frequency=WIDE) for system in (cubic, other))
    assert one.detached == two.detached == ((False,) if force < 1.06 else (False, True))
    assert two.pipe_peak.max() == pytest.approx(one.pipe_peak.max(), rel=1e-4)  # of the points of either


@pytest.mark.parametrize("force", [1.15, 1.2])
def test_the_detached_curve_of_transverse_springs_is_found_and_moves_as_it_says(force):
    length = 4 * 0.0132
    springs = sink({"kind": "transverse-springs", "stiffness": MASS * KAPPA * length**2, "length": length})
    system = with_parameters(springs, force=force)
    curve = frahm.frequency_response(system, frequency=WIDE)
    assert curve.detached == (False, True)
    on = (curve.branch == 1) & curve.stable
    W = float(curve.frequency[on][np.argmax(curve.pipe_peak[on])])
    upper = max(frahm.periodic_responses(system, frequency=W), key=lambda response: response.pipe_peak)
    assert upper.stable
    motion = frahm.integrate(system, frequency=W, periods=400, initial_state=upper.state, samples_per_period=64)
    last = motion.x1[-64 * 20 :]
    assert np.max(np.abs(last)) == pytest.approx(upper.pipe_peak, rel=2e-3)
    assert upper.pipe_peak > 3 * curve.pipe_peak[curve.branch == 0].max()


def test_roots_are_counted_as_the_polynomial_has_them():
    system = with_parameters(quintic(3e6), force=1.2)
    problem = condense(system)
    e = spring_polynomial(problem)
    grid = np.linspace(*WIDE, 301)
    parts = [stiffness_at(problem, 1, float(W)) for W in grid]
    S, F = (np.array([part[k].flat[0] for part in parts]) for k in (0, 1))
    counts, turns = polynomial_counts(e, S, F)
    exact = [len(amplitude_roots(s, f, e)) for s, f in zip(S, F, strict=True)]
    assert set(exact) == {1, 3}
    # two roots nearer than the grid of amplitudes are one turn of the force very near to that which there is
    assert np.mean(counts == exact) > 0.98
    for w in np.flatnonzero(counts != exact):
        assert np.min(np.abs(turns[turns[:, 0] == w, 2])) < 0.05


@pytest.mark.parametrize("place", [27.0, 28.7, 30.8625, 31.2])
def test_a_sink_anywhere_on_an_elastic_pipe_does_not_look_as_if_it_had_two_wells(place):
    """The static stiffness that holds a sink is zero; its rounding, negative at some places, hid detached curves."""
    case = frahm.load_case("jacket-pipe-elastic").with_absorber(kappa=2847.87, xi2=0.057257, position=place)
    system, omega = frahm.build_system(case), case.pipe.frequency
    window = (0.7 * omega, 1.3 * omega)
    assert not seeder_for(condense(system), np.linspace(*window, 5)).buckled
    births = [e.value for e in frahm.detached_curve_events(system, "force", (0.4, 1.6)) if e.kind == "birth"]
    assert births
    for factor, there in ((0.99, False), (1.02, True)):
        curve = frahm.frequency_response(with_parameters(system, force=factor * births[0]), frequency=window)
        assert any(curve.detached) == there


def test_a_branch_cut_off_by_the_window_is_not_called_detached():
    """With little damping the low response on the right hangs together with the rest far beyond the window."""
    case = CASE.with_absorber(xi2=0.0005)
    narrow, wide = (frahm.frequency_response(case, detuning=window) for window in ((-0.4, 0.4), (-2.0, 4.0)))
    assert wide.detached[0] is False
    low = [b for b in narrow.branches if b.detuning.min() > 0.05 and b.detuning.max() > 0.399]
    assert len(low) == 1
    assert not low[0].detached
    assert sum(narrow.detached) == sum(wide.detached) == 2  # the others are apart in both


def crossings(branch, sigma):
    """Pipe peaks of a branch where it passes a detuning."""
    d, peak = branch.detuning - sigma, branch.pipe_peak
    return [peak[i] - d[i] * (peak[i + 1] - peak[i]) / (d[i + 1] - d[i]) for i in np.flatnonzero(d[:-1] * d[1:] < 0)]


def test_the_part_cut_off_is_the_first_branch_of_the_wide_window():
    case = CASE.with_absorber(xi2=0.0005)
    narrow, wide = (frahm.frequency_response(case, detuning=window) for window in ((-0.4, 0.4), (-2.0, 4.0)))
    (low,) = (b for b in narrow.branches if b.detuning.min() > 0.05 and b.detuning.max() > 0.399)
    (peak,) = crossings(low, 0.2)[:1]
    assert any(other == pytest.approx(peak, rel=0.02) for other in crossings(wide.branches[0], 0.2))


@pytest.mark.parametrize(("law", "bounds"), [("transverse springs", (1.1, 1.14)), ("stops", (1.05, 1.08))])
def test_a_detached_curve_of_any_law_is_found_however_near_its_birth(law, bounds):
    length, cubic = 4 * 0.0132, {"kind": "cubic", "stiffness": MASS * KAPPA}
    if law == "stops":
        system = sink(cubic)
        stopped = frahm.Cubic(
            MASS * KAPPA, system.elements[0].law.damping, stops=frahm.Stops(gap=0.03, stiffness=2e3, depth=0.01)
        )
        parts = (system.mass, system.damping, system.stiffness, system.forcing)
        element = frahm.Element(system.elements[0].direction, stopped)
        system = frahm.System(*parts, [element], reference_frequency=system.reference_frequency)
    else:
        system = sink({"kind": "transverse-springs", "stiffness": MASS * KAPPA * length**2, "length": length})
    (birth,) = frahm.detached_curve_events(system, "force", bounds, frequency=WIDE, slices=2)
    assert birth.kind == "birth"
    for beside, there in ((-1e-5, False), (1e-5, True), (5e-4, True)):
        curve = frahm.frequency_response(with_parameters(system, force=birth.value * (1 + beside)), frequency=WIDE)
        assert any(curve.detached) == there
