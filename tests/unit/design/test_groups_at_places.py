"""Several absorbers at different places of an elastic pipe: no order of theirs and no node spoils the closed form."""

import numpy as np
import pytest

import frahm
from frahm.design.disturbance import Disturbance
from frahm.design.host import host_of
from frahm.design.problem import governed
from frahm.design.screening import Screening, fold_ceilings
from frahm.systems import build_system

ELASTIC = frahm.load_case("jacket-pipe-elastic")
NEAR_NODE, TIP = 24.43, 31.2  # of the second mode
DAMPER = {"kind": "linear", "stiffness": 450.0, "damping": 11.0}
SINK = {"kind": "cubic", "stiffness": 7e5, "damping": 12.0}


def _hung(case: frahm.Case, law: dict, *places: float, mode: int = 2) -> frahm.Case:
    """The pipe with alike absorbers, where a mode governs."""
    absorbers = [{"name": f"at {place}", "mass": 19.0, "law": law, "position": place} for place in places]
    return governed(frahm.load_case(case.to_dict() | {"absorbers": absorbers}), mode)


def _screening(case: frahm.Case) -> tuple[Screening, np.ndarray]:
    """The closed form of all absorbers of a case around the governing mode, and their row."""
    host, omega = host_of(build_system(case), len(case.absorbers)), case.pipe.frequency
    conditions = host.conditions([Disturbance()], (0.95 * omega, 1.05 * omega), 41)
    rows = []
    for absorber in case.absorbers:
        law = absorber.law
        cubic = law.kind == "cubic"
        rows += [absorber.mass, 0.0 if cubic else law.stiffness, law.stiffness if cubic else 0.0, law.damping, 0.0]
    return Screening(host, conditions, conditions), np.array([rows])


def _largest(case: frahm.Case) -> tuple[float, float]:
    """Largest pipe amplitude and stroke by the closed form [m]."""
    screening, row = _screening(case)
    peaks, others = screening.responses(row)
    return float(peaks[0, 0]), float(others[0, 0])


@pytest.mark.parametrize("places", [(NEAR_NODE, TIP), (TIP, NEAR_NODE)])
def test_dampers_of_which_one_hangs_near_a_node_answer_as_the_matrices_say(places):
    case = _hung(ELASTIC, DAMPER, *places)
    screening, _ = _screening(case)
    system, pipe, stroke = build_system(case), 0.0, 0.0
    K, C = system.stiffness.astype(complex), system.damping.astype(complex)
    for element in system.elements:
        K = K + element.law.coefficients[0] * np.outer(element.direction, element.direction)
        C = C + element.law.damping * np.outer(element.direction, element.direction)
    for W in screening.conditions.frequency[0]:
        x = np.linalg.solve(K - W * W * system.mass + 1j * W * C, system.forcing)
        pipe = max(pipe, abs(system.output @ x))
        stroke = max(stroke, *(abs(element.direction @ x) for element in system.elements))
    assert _largest(case) == pytest.approx((pipe, stroke), rel=1e-3)


def test_a_sink_at_a_node_takes_nothing_out():
    pipe = ELASTIC.to_dict()["pipe"] | {"supports": [{"at": 0.0, "kind": "pinned"}, {"at": 31.2, "kind": "pinned"}]}
    beam = frahm.load_case(ELASTIC.to_dict() | {"pipe": pipe, "absorbers": []})
    middle, quarter = 15.6, 7.8
    alone = _largest(_hung(beam, SINK, quarter))
    assert _largest(_hung(beam, SINK, middle, quarter)) == pytest.approx(alone, rel=2e-3)
    assert _largest(_hung(beam, SINK, quarter, middle)) == pytest.approx(alone, rel=2e-3)


def test_the_ceiling_of_a_sink_is_that_of_the_place_it_hangs_at():
    alone = [fold_ceilings(*_screening(_hung(ELASTIC, SINK, place, mode=1)))[0] for place in (NEAR_NODE, TIP)]
    assert alone[0] > 1.3 * alone[1]
    for places in ((NEAR_NODE, TIP), (TIP, NEAR_NODE)):
        assert fold_ceilings(*_screening(_hung(ELASTIC, SINK, *places, mode=1)))[0] == pytest.approx(alone[0], rel=1e-6)
