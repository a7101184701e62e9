import math
import subprocess
import sys

import pytest

from frahm import ParameterError, units
from frahm.units import si_value


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("0.78 Hz", "rad/s", 4.900884539600077),
        ("0.78Hz", "rad/s", 4.900884539600077),
        ("1 kHz", "rad/s", 2000 * math.pi),
        ("60 rpm", "rad/s", 2 * math.pi),
        ("60 rev/min", "rad/s", 2 * math.pi),
        ("1 cycle/s", "rad/s", 2 * math.pi),
        ("180 deg/s", "rad/s", math.pi),
        ("4.9 rad/s", "rad/s", 4.9),
        ("\N{MINUS SIGN}0.1 Hz", "rad/s", -0.2 * math.pi),
        ("762 mm", "m", 0.762),
        ("30 inch", "m", 0.762),
        ("36 km/h", "m/s", 10.0),
        ("0.15 %", "", 0.0015),
        ("1.5 kN/m^3", "N/m^3", 1500.0),
        ("1.5 kN / m**3", "N/m^3", 1500.0),
        ("2.5 N·s/m", "N s/m", 2.5),
        ("2.5 kg/s", "N s/m", 2.5),
        ("1 g/cm³", "kg/m^3", 1000.0),
        ("1.5 kN m-3", "N/m^3", 1500.0),
        ("2 N m-3", "N/m^3", 2.0),
        ("7 m s-1", "m/s", 7.0),
        ("7 m.s-1", "m/s", 7.0),
        ("7 m s**-1", "m/s", 7.0),
        ("36 km h-1", "m/s", 10.0),
        ("2 kg m-3", "kg/m^3", 2.0),
        ("3 m2 s-1", "m^2/s", 3.0),
        ("180 degree s-1", "rad/s", math.pi),
        ("3 rad s-1", "rad/s", 3.0),
        ("5 percent", "", 0.05),
    ],
)
def test_text_becomes_si(text, unit, expected):
    assert si_value(text, unit) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "unit", "says"),
    [
        ("0.78", "rad/s", "add the unit"),
        ("0.78 hz", "rad/s", "Did you mean 'Hz'"),
        ("0.78 1/s", "rad/s", "turns or radians"),
        ("0.78 Bq", "rad/s", "does not measure"),
        ("1 rad", "", "does not measure"),
        ("3 dB", "", "does not measure"),
        ("1 kg", "m", "does not measure [m]"),
        ("247 kg/m", "kg", "does not measure [kg]"),
        ("2,7 m/s", "m/s", "Write a point as decimal sign: '2.7 m/s'"),
        ("0,78 Hz", "rad/s", "Write a point as decimal sign: '0.78 Hz'"),
        (",0015", "", "Write a point as decimal sign: '.0015'"),
        ("-0,5", "m", "Write a point as decimal sign: '-0.5'"),
        ("3 s-1", "rad/s", "turns or radians"),
        ("1,5,3 m", "m", "a number [m]"),
        ("1 m-", "m", "Unknown unit"),
        ("1 m-12", "m", "Unknown unit"),
        ("1 zorks per hour", "m/s", "Unknown unit"),
        ("nan m", "m", "a number [m]"),
        ("inf m", "m", "a number [m]"),
        ("1e999 m", "m", "a number [m]"),
        ("", "m", "a number [m]"),
        ("m", "m", "a number [m]"),
        ("1 " + "(" * 70, "m", "Unknown unit"),
        ("1 m" + " " * 200, "m", "a number [m]"),
    ],
)
def test_bad_text_is_refused_with_a_way_out(text, unit, says):
    with pytest.raises(ParameterError) as caught:
        si_value(text, unit, name="pipe.field")
    assert str(caught.value).startswith("pipe.field: given ")
    assert says in str(caught.value)


@pytest.mark.parametrize("text", ["1 9**9**9**9", "1 m^9^9^9^9^9^9", "9**9**9**9 m", "1 m**m", "1 __import__('os')"])
def test_units_are_never_computed_with(text):
    with pytest.raises(ParameterError, match=r"Unknown unit|a number \[m\]"):
        si_value(text, "m")


def test_the_unit_library_is_imported_only_for_text():
    code = (
        "import sys; from frahm.case import load_case;"
        "load_case({'pipe': {'mass': 1, 'frequency': 1, 'damping_ratio': 0, 'diameter': 1},"
        " 'wind': {'speed': 1, 'lift_coefficient': 1}}); sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_the_commonest_units_are_read_without_the_unit_library_and_to_the_same_last_bit():
    code = "import sys; from frahm.case import load_case; load_case('jacket-pipe'); sys.exit('pint' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
    pairs = [*units._COMMON, *((unit, unit) for unit in units._FAMILIAR if unit)]
    for given, wanted in pairs:
        for number in (0.78, 762.0, 13.4, 1 / 3, 2.7e-7):
            quick = si_value(f"{number!r} {given}", wanted)
            assert quick == units._by_registry(number, given, wanted, "value", ""), (given, wanted, number)
