"""The damage of every mode: winds that one of them counts are no doubt of another."""

import dataclasses

import numpy as np
import pytest

import frahm
from frahm.assessment import damage_of_modes, doubts_of_modes
from frahm.assessment.verdict import doubts_of_the_rest
from frahm.assessment.wind_bins import gaps

TABLE = {
    "pipe": {
        "kind": "modes", "diameter": "0.4 m", "length": "24 m", "sections": ["0 m", "8 m", "16 m", "24 m"],
        "modes": [
            {"mass": "600 kg", "frequency": "1.7 Hz", "damping_ratio": "0.25 %", "lift_length": "9 m",
             "displacements": [0, 0.18, 0.56, 1], "stresses": ["900 MPa/m", "420 MPa/m", "150 MPa/m", 0]},
            {"mass": "560 kg", "frequency": "9.8 Hz", "damping_ratio": "0.25 %", "lift_length": "4.9 m",
             "displacements": [0, -0.62, -0.35, 1], "stresses": ["4800 MPa/m", "-1700 MPa/m", "-2600 MPa/m", 0]},
        ],
    },
    "wind": {"speed": "3.6 m/s", "strouhal": 0.2, "lift_coefficient": 0.4, "range": ["1 m/s", "24 m/s"]},
    "climate": {"duration": "25 year", "weibull": {"scale": "7 m/s", "shape": 1.9}},
    "fatigue": {"curve": "E", "stress_concentration": 1.2, "thickness": "12 mm"},
}  # fmt: skip


@pytest.fixture(scope="module")
def case():
    return frahm.load_case(TABLE)


def outside(doubts):
    return [doubt for doubt in doubts if doubt.startswith("Winds outside")]


def test_winds_that_another_mode_counts_are_no_doubt(case):
    alone, parts = frahm.fatigue_damage(case), damage_of_modes(case)
    assert len(parts) == 2
    assert len(outside(alone.unverified)) == 1
    assert outside(doubts_of_modes(parts)) == []
    assert parts[0].damage_with == alone.damage_with
    assert all(part.outside_without < 0.01 * alone.outside_without for part in parts)


def test_winds_that_no_mode_counts_are_said_once(case):
    least, most = (
        dataclasses.replace(part, outside_without=size, outside_wind=wind)
        for part, size, wind in zip(damage_of_modes(case), (1e3, 2e3), (7.0, 24.0), strict=True)
    )
    (doubt,) = doubts_of_the_rest((least, most))
    assert "Winds outside all bands do a damage of 2e+03" in doubt
    assert "near 24 m/s" in doubt


def test_what_bands_leave():
    assert gaps(0.0, 10.0, [(4.0, 2.0), (3.0, 5.0), (8.0, 12.0)]) == [(0.0, 2.0), (5.0, 8.0)]
    assert gaps(3.0, 4.0, [(1.0, 2.0)]) == [(3.0, 4.0)]
    assert gaps(3.0, 4.0, [(1.0, 9.0)]) == []
    assert np.sum(np.diff(gaps(0.0, 10.0, [(-1.0, 1.0), (20.0, 30.0)]))) == 9.0
