import math
import re
from collections import OrderedDict
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given
from hypothesis import strategies as st

import frahm
from frahm.case import TEMPLATE_KINDS, builtin_names, template_text
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
    case, built_in = frahm.load_case(tmp_path / "a.yaml"), frahm.load_case("jacket-pipe")
    assert case.name == name
    assert (case.pipe, case.wind, case.absorbers) == (built_in.pipe, built_in.wind, built_in.absorbers)


@pytest.mark.parametrize("kind", TEMPLATE_KINDS)
def test_a_template_explains_every_field_and_is_plausible(tmp_path, kind):
    """No window of the paper; what is commented out can be put in as it stands."""
    text = template_text("mine", kind)
    (tmp_path / "a.yaml").write_text(text, encoding="utf-8")
    case = frahm.load_case(tmp_path / "a.yaml")
    assert case.pipe.kind == {"table": "modes"}.get(kind, kind)
    assert frahm.plausibility(case) == ()
    assert "detuning" not in case.analysis.model_fields_set
    sections = "document|pipe|wind|absorbers|climate|fatigue|limits|design|analysis"
    for line in text.splitlines():
        field = re.match(rf"( *)(# *)?(- )?(?!{sections}|name:|title:|sections:|modes:)([a-z_]+):", line)
        assert field is None or "  # " in line[field.end() :], line
        assert len(line) <= 120, line
    everything = re.sub(r"^( *)# (?=(?:  )*(?:- )?(?:[a-z_]+:|\{))", r"\1", text, flags=re.MULTILINE)
    (tmp_path / "b.yaml").write_text(everything, encoding="utf-8")
    full = frahm.load_case(tmp_path / "b.yaml")
    assert full.document.date == "2026-03-31"
    assert full.design.stroke == 0.02
    assert full.absorbers[0].stops.gap == 0.06
    assert full.analysis.wind[0] in (2.2, 5.0)
    assert full.analysis.detuning is None
    assert (full.wind.range, full.limits.stress_range) == ((0.0, 25.0), 60e6)
    assert {one.name for one in frahm.plausibility(full)} <= {"wind.range"}
    assert kind != "tube" or (full.pipe.point_masses[0].mass, len(full.pipe.supports)) == (50.0, 3)


def test_tube_and_table_of_the_templates_are_the_same_brace(tmp_path):
    """The table as another program would round the modes of the tube."""
    cases = []
    for kind in ("tube", "table"):
        (tmp_path / f"{kind}.yaml").write_text(template_text("brace", kind), encoding="utf-8")
        cases.append(frahm.load_case(tmp_path / f"{kind}.yaml"))
    tube, table = (case.pipe.modal for case in cases)
    for name in ("frequencies", "masses", "lift_lengths"):
        assert getattr(table, name) == pytest.approx(getattr(tube, name), rel=1e-3)
    for section in cases[1].pipe.sections:
        assert table.displacement(section) == pytest.approx(tube.displacement(section), abs=1e-3)
        assert table.stress(section) == pytest.approx(tube.stress(section), abs=2e-4 * 7e9)
    damped = [frahm.plausibility(case.with_absorber(xi2=0)) for case in cases]
    assert [[one.name for one in found] for found in damped] == [["absorbers[0].law.damping"]] * 2


def test_there_is_no_template_of_another_kind():
    with pytest.raises(frahm.ParameterError, match=r"kind: given 'tub'; allowed: one of mode, tube, table"):
        template_text("mine", "tub")


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
