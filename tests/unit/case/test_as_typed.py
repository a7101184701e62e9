"""A case remembers what was typed, and is the same case with or without it."""

import copy
import json
import pickle

import pytest

import frahm
from frahm.case import field_values

TYPED = {
    "name": "brace",
    "pipe": {
        "kind": "tube", "diameter": "24  inch", "wall": "0.5 inch", "length": 28, "damping_ratio": "0.15 %",
        "supports": [{"at": "0 m", "kind": "clamped"}, {"at": 28.0, "kind": "pinned"}],
    },
    "wind": {"speed": "12 m/s", "lift_coefficient": "en1991", "strouhal": [[1e3, "20 %"], [1e7, 0.25]]},
    "absorbers": [{"mass": "50 kg", "law": {"kind": "polynomial", "coefficients": ["2 N/mm", 0, 1e5], "damping": 3.0}}],
    "climate": {
        "duration": "30 day", "table": [{"speed": "1 m/s", "probability": 0.5}, {"speed": 9, "probability": 0.5}],
    },
    "design": {"scatter": "5 %", "spring_length": "100 mm"},
    "analysis": {"detuning": ["-0.1 Hz", 1.0]},
}  # fmt: skip
TEXTS = {
    "pipe.diameter": "24 inch", "pipe.wall": "0.5 inch", "pipe.damping_ratio": "0.15 %", "pipe.supports[0].at": "0 m",
    "wind.speed": "12 m/s", "wind.strouhal": "[[1000.0, 20 %], [10000000.0, 0.25]]", "absorbers[0].mass": "50 kg",
    "absorbers[0].law.coefficients": "[2 N/mm, 0, 100000.0]", "climate.duration": "30 day",
    "climate.table[0].speed": "1 m/s", "design.scatter.pipe_frequency": "5 %", "design.spring_length": "100 mm",
    "analysis.detuning": "[-0.1 Hz, 1.0]",
}  # fmt: skip


@pytest.fixture(scope="module")
def case():
    return frahm.load_case(TYPED)


def test_every_text_with_a_unit_is_remembered_by_its_path(case):
    assert dict(case.typed) == TEXTS
    assert {field.path: field.typed for field in field_values(case) if field.typed} == TEXTS


def test_what_was_typed_is_no_part_of_the_case(case):
    plain = frahm.load_case(json.loads(json.dumps(case.to_dict())))
    assert not plain.typed
    assert plain == case
    assert (plain.digest, hash(plain), plain.to_dict(), repr(plain)) == (
        case.digest, hash(case), case.to_dict(), repr(case),
    )  # fmt: skip
    assert "_typed" not in json.dumps(case.to_dict())
    for again in (pickle.loads(pickle.dumps(case)), copy.deepcopy(case), plain.with_typed(case.typed)):
        assert again == case
        assert again.typed == case.typed
    assert not plain.typed


def test_a_changed_field_loses_its_text_and_the_others_keep_theirs(case):
    louder = case.with_wind(speed=13.0)
    assert dict(louder.typed) == {path: text for path, text in TEXTS.items() if path != "wind.speed"}
    assert louder.with_wind(speed="26 knot").typed["wind.speed"] == "26 knot"
    assert "wind.speed" in case.typed
    heavier = case.with_absorber(rho2=0.03)
    assert "absorbers[0].mass" not in heavier.typed
    assert heavier.typed["absorbers[0].law.coefficients"] == "[2 N/mm, 0, 100000.0]"
    assert not [path for path in case.without_absorbers().typed if path.startswith("absorbers")]
    other = case.with_pipe(kind="mode", mass=1.0, frequency="9 Hz", damping_ratio=0.1, diameter=0.3)
    assert [path for path in other.typed if path.startswith("pipe")] == ["pipe.frequency"]


def test_a_file_of_a_table_is_remembered_by_its_name(tmp_path):
    (tmp_path / "wind.csv").write_text("speed [m/s],probability\n1,0.5\n9,0.5\n")
    data = frahm.load_case("jacket-pipe-elastic").to_dict()
    data["climate"] = {"duration": "1 year", "table": "wind.csv"}
    (tmp_path / "a.yaml").write_text(json.dumps(data))
    case = frahm.load_case(tmp_path / "a.yaml")
    assert case.typed["climate.table"] == "wind.csv"


def test_the_names_in_a_case_are_no_typed_values():
    assert dict(frahm.load_case("two-sinks").with_name("x", " Some title ").typed).keys() == {
        "pipe.mass", "pipe.length", "pipe.frequency", "pipe.diameter", "wind.speed", "wind.air_density",
        *(f"absorbers[{i}].{field}" for i in (0, 1) for field in ("mass", "law.stiffness", "law.damping")),
    }  # fmt: skip
