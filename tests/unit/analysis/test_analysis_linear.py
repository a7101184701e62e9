import numpy as np
import pytest
import scipy.integrate

import frahm
from frahm.analysis.linear import bare_amplitude, bare_resonance, linear_amplitudes
from frahm.analysis.response import exact_response
from frahm.analysis.section import Work

CASE = frahm.load_case("jacket-pipe")
DAMPER = {"name": "tuned", "mass": 4.94, "law": {"kind": "linear", "stiffness": 114.0, "damping": 4.0}}


def with_absorbers(*absorbers):
    return frahm.load_case(CASE.to_dict() | {"absorbers": list(absorbers)})


def test_resonance_of_the_bare_pipe_as_in_the_paper():
    peak, frequency = bare_resonance(CASE)
    assert peak == pytest.approx(0.08670, abs=1e-5)
    assert frequency == pytest.approx(2 * np.pi * 0.78, rel=1e-5)
    assert bare_amplitude(CASE, frequency * np.array([0.999, 1.001])).max() < peak


def test_without_damping_the_bare_resonance_is_infinite():
    assert bare_resonance(CASE.with_pipe(damping_ratio=0))[0] == np.inf
    assert bare_resonance(CASE.with_pipe(damping_ratio=0).with_wind(lift_coefficient=0))[0] == 0


def test_amplitudes_with_two_linear_absorbers_solve_the_equations_of_motion():
    system = frahm.build_system(with_absorbers(DAMPER, DAMPER | {"name": "other", "mass": 2.0}))
    W = 4.7
    (X,) = linear_amplitudes(system, np.array([W]))
    for t in (0.0, 0.3, 1.1):
        turned = X * np.exp(1j * W * t)
        x, v, a = turned.real, (1j * W * turned).real, (-(W**2) * turned).real
        assert a == pytest.approx(system.acceleration(x, v, W * t), rel=1e-9, abs=1e-12)


def test_a_tuned_damper_by_an_independent_integration():
    case = with_absorbers(DAMPER)
    section = exact_response(Work(case))
    curve = section.data["response"]
    assert section.results["response"]["harmonic-balance"]["growth_rate"] < 0
    i = int(np.argmax(curve["pipe_peak"].values))
    system, W = frahm.build_system(case), float(curve["frequency"][i])

    def velocity(t, y):
        return np.concatenate([y[2:], system.acceleration(y[:2], y[2:], W * t)])

    end = 80 * 2 * np.pi / W  # a disturbance loses a fifth in each period
    run = scipy.integrate.solve_ivp(velocity, (0, end), np.zeros(4), rtol=1e-8, atol=1e-12, max_step=0.05)
    late = run.t > 0.9 * end
    assert np.max(np.abs(run.y[0, late])) == pytest.approx(float(curve["pipe_peak"][i]), rel=2e-3)
    assert np.max(np.abs(run.y[1, late] - run.y[0, late])) == pytest.approx(float(curve["relative_peak"][i]), rel=2e-3)


def test_a_linear_response_that_does_not_attract_is_unverified():
    free = with_absorbers(DAMPER | {"law": {"kind": "linear", "stiffness": 114.0, "damping": 0.0}})
    section = exact_response(Work(free.with_pipe(damping_ratio=0)))
    assert "does not attract" in section.unverified[0]
