import math
from collections import OrderedDict
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

import frahm
from frahm.case import builtin_names, template_text
from searching import at_most

YAML = """
name: 1e3 is text here
pipe: {mass: 1e2, frequency: 2 rad/s, damping_ratio: 1e-3, diameter: 50 cm}
wind: {speed: 3, lift_coefficient: 0.3}
"""
TOML = """
name = "1e3 is text here"
[pipe]
mass = 100
frequency = "2 rad/s"
damping_ratio = 1e-3
diameter = "50 cm"
[wind]
speed = 3
lift_coefficient = 0.3
"""


def test_yaml_and_toml_say_the_same(tmp_path):
    (tmp_path / "a.yml").write_text(YAML)
    (tmp_path / "a.toml").write_text(TOML)
    case = frahm.load_case(tmp_path / "a.yml")
    assert case == frahm.load_case(str(tmp_path / "a.toml"))
    assert (case.pipe.mass, case.pipe.frequency, case.pipe.damping_ratio, case.pipe.diameter) == (100, 2, 0.001, 0.5)


def test_other_doors():
    case = frahm.load_case("jacket-pipe")
    assert frahm.load_case(case) is case
    assert frahm.load_case(OrderedDict(case.to_dict())) == case
    assert "jacket-pipe" in builtin_names()


def test_byte_order_mark_windows_line_ends_and_harmless_aliases(tmp_path):
    text = YAML.replace("frequency: 2 rad/s", "frequency: &f 2 rad/s") + "analysis: {detuning: [-1 rad/s, *f]}\n"
    (tmp_path / "a.yaml").write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    assert frahm.load_case(tmp_path / "a.yaml").analysis.detuning == (-1.0, 2.0)


def test_to_yaml_writes_what_it_returns(tmp_path):
    case = frahm.load_case("jacket-pipe")
    text = case.to_yaml(tmp_path / "copy.yaml")
    assert (tmp_path / "copy.yaml").read_text() == text
    assert frahm.load_case(tmp_path / "copy.yaml") == case


def test_a_source_beside_a_built_in_name_does_not_hide_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("jacket-pipe").mkdir()
    assert frahm.load_case("jacket-pipe").name == "jacket-pipe"


@pytest.mark.parametrize("name", ["my-pipe", "yes", "1e3", "null", "a: b", "#1", "- x", "ø'\""])
def test_the_template_is_the_built_in_case_under_another_name(tmp_path, name):
    (tmp_path / "a.yaml").write_text(template_text(name), encoding="utf-8")
    case = frahm.load_case(tmp_path / "a.yaml")
    assert case.name == name
    assert case.with_name("x", "") == frahm.load_case("jacket-pipe").with_name("x", "")
    assert template_text(name).count("#") > 15


positive = st.floats(1e-6, 1e12)
label = st.text(st.characters(exclude_categories=["C", "Z"]), min_size=1, max_size=20)
cubic = st.fixed_dictionaries({"kind": st.just("cubic"), "stiffness": positive, "damping": positive})
finite = st.just(0.0) | st.floats(1e-30, 1e30) | st.floats(-1e30, -1e-30)
polynomial = st.fixed_dictionaries(
    {"kind": st.just("polynomial"), "coefficients": st.lists(finite, min_size=1, max_size=15), "damping": positive}
)
cases = st.fixed_dictionaries(
    {
        "name": label,
        "title": st.text(st.characters(exclude_categories=["C", "Z"]), max_size=40),
        "pipe": st.fixed_dictionaries(
            {
                "mass": positive,
                "frequency": st.floats(0.5, 1e6),
                "damping_ratio": st.just(0.0) | st.floats(1e-12, 0.99),
                "diameter": positive,
            }
        ),
        "wind": st.fixed_dictionaries({"speed": positive, "lift_coefficient": st.just(0.0) | st.floats(1e-12, 10)}),
        "absorbers": st.lists(
            st.fixed_dictionaries({"name": label, "mass": positive, "law": cubic | polynomial}),
            max_size=3,
            unique_by=lambda absorber: absorber["name"],
        ),
        "analysis": st.fixed_dictionaries({}, optional={"harmonics": st.just("auto") | st.integers(1, 199)}),
    }
)


@at_most(60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=cases)
def test_round_trip(tmp_path, data):
    case = frahm.load_case(data)
    assert case.pipe.mass == data["pipe"]["mass"]
    assert frahm.load_case(case.to_dict()) == case
    case.to_yaml(tmp_path / "a.yaml")
    again = frahm.load_case(tmp_path / "a.yaml")
    assert again == case
    assert again.digest == case.digest
    assert all(math.isfinite(value) for value in case.to_dict()["pipe"].values() if value != "mode")
