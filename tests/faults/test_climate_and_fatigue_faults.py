import re

import pytest
from typer.testing import CliRunner

import frahm
from frahm.cli import app

BASE = """pipe: {mass: 247, frequency: 0.78 Hz, damping_ratio: 0.0015, diameter: 762 mm}
wind: {speed: 2.7, lift_coefficient: 0.4535, strouhal: 0.225}
"""
CLIMATE = "climate: {duration: 20 year, weibull: {scale: 7, shape: 2}}\n"
FATIGUE = "fatigue: {curve: D, stress_per_displacement: 283.5 MPa/m}\n"


def refusal_of(folder, text, table=None):
    """The message of `frahm check`, which is the one `load_case` raises; exit code 2."""
    path = folder / "case.yaml"
    path.write_text(text, encoding="utf-8")
    if table is not None:
        (folder / "wind.csv").write_bytes(table if isinstance(table, bytes) else table.encode())
    with pytest.raises(frahm.ParameterError) as caught:
        frahm.load_case(path)
    result = CliRunner().invoke(app, ["check", str(path)])
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"frahm: {caught.value}\n"
    return str(caught.value)


@pytest.mark.parametrize(
    ("sections", "says"),
    [
        (FATIGUE, r"case.yaml:3: fatigue: given 'a case without climate'; allowed: a case with the section climate"),
        (CLIMATE + "fatigue: {stress_per_displacement: 1e8}\n", r"fatigue.curve: given nothing; .*\(required\)"),
        (CLIMATE + "fatigue: {curve: D}\n", r"fatigue.stress_per_displacement: given None; .*MPa/m"),
        (CLIMATE + FATIGUE.replace("curve: D", "curve: C3"), r"given 'C3'; allowed: one of B1, .*Did you mean 'C"),
        (CLIMATE + FATIGUE.replace("curve: D", "curve: W"), r"given 'W'; allowed: one of B1, .*Did you mean 'W"),
        (CLIMATE + FATIGUE.replace("283.5 MPa/m", "283.5 MPa"), r"'MPa' does not measure \[Pa/m\]"),
        (CLIMATE + FATIGUE.replace("}", ", stress_concentration: 0.5}"), r"stress_concentration: given 0.5; .*>= 1"),
        (CLIMATE + FATIGUE.replace("}", ", wind_speeds: [3, 2]}"), r"wind_speeds: given \[3, 2\]; .*lo < hi"),
        (CLIMATE + FATIGUE.replace("}", ", scf: 2}"), r"fatigue.scf: given 2; allowed: no such field here"),
        (CLIMATE.replace("20 year", "20"), r"climate.duration: given 20; .*year"),
        (CLIMATE.replace("20 year", "20 m"), r"climate.duration: .*'m' does not measure"),
        (CLIMATE.replace("shape: 2", "shape: 0"), r"climate.weibull.shape: given 0"),
        (CLIMATE.replace(", shape: 2", ""), r"climate.weibull.shape: given nothing"),
        ("climate: {duration: 20 year}\n", r"climate: given 'neither'; allowed: exactly one of weibull and table"),
        (
            "climate: {duration: 1 year, weibull: {scale: 7, shape: 2}, table: "
            "[{speed: 1, probability: 0.5}, {speed: 2, probability: 0.5}]}\n",
            r"climate: given 'weibull and table'",
        ),
        (
            "climate: {duration: 1 year, table: [{speed: 1, probability: 0.5}, {speed: 2, probability: 0.4}]}\n",
            r"climate.table: .*allowed: probabilities that sum to one. These sum to 0.9",
        ),
        (
            "climate: {duration: 1 year, table: [{speed: 1, probability: 1.5}, {speed: 2, probability: -0.5}]}\n",
            r"climate.table\[0\].probability: given 1.5",
        ),
        (
            "climate: {duration: 1 year, table: [{speed: 1, probability: 1.0}]}\n",
            r"allowed: a table of at least two different speeds",
        ),
        (
            "climate: {duration: 1 year, table: [{speed: 1, probability: .5}, {speed: 2, probability: .5}], "
            "sector: [0 deg, 90 deg]}\n",
            r"climate.sector: .*a table that has directions",
        ),
        (
            "climate: {duration: 1 year, table: [{speed: 1, probability: .5, direction: 90}, "
            "{speed: 2, probability: .5, direction: 90 deg}]}\n",
            r"climate.table\[0\].direction: given 90; .*deg",
        ),
        (
            "climate: {duration: 1 year, table: [{speed: 1, probability: .5}, {speed: 2, probability: .4}, "
            "{speed: 1, probability: .1}]}\n",
            r"every speed and direction once. 1 m/s is there twice",
        ),
    ],
)
def test_bad_section(tmp_path, sections, says):
    assert re.search(says, refusal_of(tmp_path, BASE + sections))


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (None, r"climate.table: given 'wind.csv'; allowed: rows, or the name of .* wind.csv: There is no such file"),
        ("", r"at least one row of numbers"),
        ("speed,probability\n", r"at least one row of numbers"),
        ("sped,probability\n1,1\n", r"wind.csv has a column 'sped'. Did you mean 'speed'"),
        ("speed,speed,probability\n1,1,1\n", r"wind.csv has a column 'speed' twice"),
        ("speed\n1\n2\n", r"wind.csv has no column probability"),
        ("speed [kg],probability\n1,1\n", r"column 'speed': 'kg' does not measure"),
        ("speed,probability,direction\n1,1,90\n", r"say the unit of direction, as in 'direction \[deg\]'"),
        ("speed,probability\n1,0.5\n2\n", r"2 cells in every row.* wind.csv:3: row: given '1 cells'"),
        ("speed,probability\n1,0.5\n2,half\n", r"wind.csv:3: probability: given 'half'"),
        ("speed,probability\n1,0.5\n2,nan\n", r"wind.csv:3: probability: given nan"),
        ('speed,probability\n1,"0,5"\n2,"0,5"\n', r"probability: given '0,5'. Write the full stop as decimal sign"),
        ("speed;probability\n1;0,5\n2;0.5\n", r"wind.csv:3: probability: given '0.5'. Lines above have the sign ','"),
        ("speed,probability\n1,0.5\n2,0.4\n", r"These sum to 0.9"),
        ("speed,probability\n-1,0.5\n2,0.5\n", r"climate.table\[0\].speed: given -1"),
        (b"speed,probability\n1,\xff\n", r"wind.csv:2: probability: given 'ÿ'"),
        (b"speed,probability\n1,\x000.5\n", r"It is not text"),
    ],
)
def test_bad_table(tmp_path, table, says):
    assert re.search(says, refusal_of(tmp_path, BASE + "climate: {duration: 1 year, table: wind.csv}\n", table))


def test_a_table_in_a_folder_is_no_table(tmp_path):
    (tmp_path / "wind.csv").mkdir()
    message = refusal_of(tmp_path, BASE + "climate: {duration: 1 year, table: wind.csv}\n")
    assert "It is a folder" in message


FULL = BASE + CLIMATE + FATIGUE


@pytest.mark.parametrize(
    ("text", "arguments", "says"),
    [
        (BASE, {}, r"fatigue: given None; allowed: a case with the section fatigue"),
        (FULL, {"bins": 3}, r"bins: given 3; allowed: a whole number >= 4"),
        (FULL, {"bins": 4.5}, r"bins: given 4.5"),
        (FULL, {"samples": 0}, r"samples: given 0"),
        (FULL, {"workers": 0}, r"workers: given 0"),
        (FULL, {"wind": (3, 2)}, r"wind: given \(3.0, 2.0\); allowed: two wind speeds \(lo, hi\) with lo < hi"),
        (FULL, {"wind": 2.7}, r"wind: given 2.7; allowed: two wind speeds"),
        (FULL, {"wind": (0, 2)}, r"wind\[0\]: given 0"),
        (FULL.replace("strouhal: 0.225", "strouhal: [[1e5, 0.225], [1.5e5, 0.225]]"), {"wind": (2, 9)},
         r"speeds within 1.9685 \.\.\. 2.95276 m/s. Beyond them wind.strouhal is not given"),
    ],
)  # fmt: skip
def test_bad_calls(tmp_path, text, arguments, says):
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    case = frahm.load_case(tmp_path / "case.yaml")
    with pytest.raises(frahm.ParameterError, match=says):
        frahm.fatigue_damage(case, **arguments)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"position": "40 m"}, r"fatigue.position: given 40.0; allowed: sections of the pipe, 0 to 31.2 m"),
        ({"stress_per_displacement": "1 MPa/m"}, r"stress_per_displacement: given 1000000.0; allowed: nothing"),
        ({"position": -1}, r"fatigue.position: given -1"),
    ],
)
def test_bad_detail_of_an_elastic_pipe(changes, says):
    with pytest.raises(frahm.ParameterError, match=says):
        frahm.load_case("jacket-pipe-elastic").with_fatigue(**changes)


def test_a_position_on_a_pipe_that_has_none():
    case = frahm.load_case("jacket-pipe").with_climate(duration="20 year", weibull={"scale": 7, "shape": 2})
    with pytest.raises(frahm.ParameterError, match=r"fatigue.position: given 3.0; allowed: nothing"):
        case.with_fatigue(curve="D", stress_per_displacement=1e8, position=3)


def test_winds_left_out_by_the_band_are_said(tmp_path):
    """The band misses the resonance: what lies outside is more than what is counted."""
    (tmp_path / "case.yaml").write_text(FULL, encoding="utf-8")
    found = frahm.fatigue_damage(frahm.load_case(tmp_path / "case.yaml"), bins=4, wind=(2.8, 2.9))
    assert not found.verified
    assert re.search(r"Winds outside the band .* most of it near 2.6\d m/s", found.unverified[0])  # the resonance
