import math

import pytest

import frahm

BASE = {
    "pipe": {"mass": 247, "frequency": "0.78 Hz", "damping_ratio": 0.0015, "diameter": "762 mm"},
    "wind": {"speed": 2.7, "lift_coefficient": 0.4535, "strouhal": 0.225},
}
ROWS = "# made up\nspeed [km/h]; probability [%]; direction [deg]\n\n3.6; 60; 0\n7.2; 30; 90\n10.8; 10; 180\n"


def test_a_table_beside_the_case_file_becomes_part_of_the_case(tmp_path, monkeypatch):
    (tmp_path / "wind.csv").write_text("\ufeff" + ROWS, encoding="utf-8")
    bare = frahm.load_case(BASE)
    text = bare.to_yaml().replace("climate: null", "climate: {duration: 25 year, table: wind.csv, sector: [0, 1.6]}")
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    case = frahm.load_case(tmp_path / "case.yaml")
    assert case.climate.duration == pytest.approx(25 * 365.25 * 86400)
    assert [row.speed for row in case.climate.table] == pytest.approx([1.0, 2.0, 3.0])
    assert [row.probability for row in case.climate.table] == pytest.approx([0.6, 0.3, 0.1])
    assert [row.direction for row in case.climate.table] == pytest.approx([0.0, math.pi / 2, math.pi])
    (tmp_path / "wind.csv").unlink()
    monkeypatch.chdir(tmp_path)
    again = frahm.load_case(case.to_dict())
    assert again == case
    assert again.digest == case.digest


def test_sections_that_are_left_out_or_empty_are_none():
    case = frahm.load_case({**BASE, "climate": None, "fatigue": None})
    assert case.climate is None
    assert case.fatigue is None
    assert frahm.load_case(case.to_dict()).digest == frahm.load_case(BASE).digest


def test_changing_the_sections_value_by_value():
    case = frahm.load_case(BASE).with_climate(duration="20 year", weibull={"scale": 8, "shape": 2})
    case = case.with_fatigue(curve="D", stress_per_displacement="283.5 MPa/m")
    other = case.with_fatigue(curve="T").with_climate(direction_factor=0.25)
    assert (other.fatigue.curve, other.fatigue.stress_per_displacement) == ("T", 283.5e6)
    assert (other.climate.direction_factor, other.climate.weibull.scale) == (0.25, 8.0)
    assert case.fatigue.curve == "D"
