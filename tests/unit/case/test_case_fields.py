import json
import re

import pytest

import frahm
from frahm.case import Case, case_schema, field_table


def test_every_field_says_what_it_is():
    table = field_table(Case)
    assert "absorbers[].law(cubic).stiffness" in table
    for path, facts in table.items():
        assert facts.title, path
        assert facts.description.endswith("."), path
        assert facts.allowed, path


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("pipe.mass", "kg"),
        ("pipe.frequency", "rad/s"),
        ("pipe.damping_ratio", ""),
        ("wind.air_density", "kg/m^3"),
        ("absorbers[].law(cubic).stiffness", "N/m^3"),
        ("absorbers[].law(linear).stiffness", "N/m"),
        ("absorbers[].law(linear).damping", "N s/m"),
        ("analysis.detuning", "rad/s"),
    ],
)
def test_units_of_fields(path, unit):
    assert field_table(Case)[path].unit == unit


def test_schema_knows_units_bounds_and_text():
    schema = case_schema()
    json.dumps(schema, allow_nan=False)
    assert schema["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert set(schema["required"]) == {"pipe", "wind"}
    mass = schema["$defs"]["Pipe"]["properties"]["mass"]
    number, text = mass["anyOf"]
    assert (mass["unit"], number["exclusiveMinimum"], text["type"]) == ("kg", 0, "string")
    assert schema["$defs"]["Pipe"]["additionalProperties"] is False
    assert schema["$defs"]["CubicLaw"]["properties"]["kind"]["const"] == "cubic"


@pytest.mark.parametrize(
    ("text", "fits"),
    [("0.78 Hz", True), (" -1.5e3 kN/m^3", True), ("0.78", False), ("1e5", False), ("Hz", False)],
)
def test_the_pattern_of_the_schema_asks_for_a_unit(text, fits):
    pattern = case_schema()["$defs"]["Pipe"]["properties"]["mass"]["anyOf"][1]["pattern"]
    assert bool(re.search(pattern, text)) is fits


def test_references_of_the_schema_resolve():
    schema = case_schema()
    names = set(re.findall(r"#/\$defs/(\w+)", json.dumps(schema)))
    assert names <= set(schema["$defs"])
    assert {"Pipe", "Wind", "Absorber", "Analysis"} <= names
    assert frahm.load_case("jacket-pipe").to_dict().keys() == schema["properties"].keys()
