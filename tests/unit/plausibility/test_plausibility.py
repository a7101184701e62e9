"""Each warning fires on the mistake it is for, says by which number, and leaves sound cases alone."""

import math
import re
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import frahm
from frahm.case import builtin_names
from frahm.plausibility.implausible import Inputs
from frahm.plausibility.ranges import USUAL

MODE = frahm.load_case("jacket-pipe")
TUBE = frahm.load_case("jacket-pipe-elastic")
SLOW = TUBE.with_analysis(detuning=(-1e-7, 0.4))
WATER = {"air_density": 1025.0, "viscosity": 1e-6, "speed": 0.3}


def found(case):
    return {one.name: one for one in frahm.plausibility(case)}


def with_law(case, mass=None, **law):
    (absorber,) = case.to_dict()["absorbers"]
    changed = absorber | {"law": law or absorber["law"]} | ({} if mass is None else {"mass": mass})
    return frahm.load_case(case.to_dict() | {"absorbers": [changed]})


def table(**mode):
    first = {"mass": 1000.0, "frequency": "0.8 Hz", "damping_ratio": 0.002, "lift_length": 12.0} | mode
    return frahm.load_case({
        "pipe": {"kind": "modes", "diameter": 0.762, "length": 30.0, "mass_per_length": 247.0, "sections": [15.0],
                 "modes": [first | {"displacements": [1.0]}]},
        "wind": {"speed": 2.7, "strouhal": 0.225, "lift_coefficient": 0.45},
    })  # fmt: skip


@pytest.mark.parametrize("name", builtin_names())
def test_the_built_in_cases_are_plausible(name):
    assert frahm.plausibility(name) == ()


def test_a_table_of_modes_is_plausible():
    assert frahm.plausibility(table()) == ()


def limited(case, **limits):
    return frahm.load_case(case.to_dict() | {"limits": limits})


UNSTRESSED = MODE.without_absorbers()

FIRES = [
    (MODE.with_pipe(frequency=4.9), "pipe.frequency", r"0\.7799 Hz\. A unit says which: 4\.9 rad/s\. Was 4\.9 Hz"),
    (table(frequency=5.0), "pipe.modes[0].frequency", r"rad/s, so this is 0\.7958 Hz.* Was 5 Hz meant\?"),
    (limited(MODE, stroke=5), "limits.stroke", r"6\.56 times the diameter of the pipe, 0\.762 m.* Was 5 mm meant\?"),
    (limited(MODE, displacement="5 m"), "limits.displacement", r"6\.56 times the diameter .*ever be reached\.$"),
    (limited(MODE, stress_range="60 MPa"), "limits.stress_range", r"stress is not known: .*stress_per_displacement"),
    (limited(table(), yield_strength="355 MPa"), "limits.yield_strength", r"the modes .* need their stresses"),
    (limited(MODE, damage=0.5), "limits.damage", r"Without the section fatigue no damage is counted"),
    (limited(UNSTRESSED, stroke="30 mm"), "limits.stroke", r"no absorber.*frahm design judges"),
    (MODE.with_absorber(rho2=0.2), "absorbers[0].mass", r"0\.2 of the mass of the pipe.*a load of its own"),
    (MODE.with_absorber(rho2=0.002), "absorbers[0].mass", r"0\.002 of the mass.*a lighter one takes little"),
    (MODE.with_pipe(frequency=0.78), "pipe.frequency", r"0\.1241 Hz.*sheds at 0\.7972 Hz.* Was 0\.78 Hz meant\?"),
    (table(frequency=0.8), "pipe.modes[0].frequency", r"Was 0\.8 Hz meant\?"),
    (MODE.with_pipe(frequency="0.1241 Hz"), "wind.speed", r"sheds at 0\.7972 Hz, 6\.42 times .* 0\.1241 Hz"),
    (MODE.with_pipe(diameter=762), "pipe.diameter", r"10 mm to 10 m across.* Was 762 mm meant\?"),
    (MODE.with_pipe(diameter="762 m"), "pipe.diameter", r"10 m across, a rule of thumb\.$"),
    (TUBE.with_pipe(diameter=0.3, wall=0.0004), "pipe.wall", r"D/t = 750"),
    (MODE.with_pipe(damping_ratio="15 %"), "pipe.damping_ratio", r"0\.0015 \(NPD.*more than 0\.05 takes a damper\.$"),
    (MODE.with_pipe(damping_ratio=0.15), "pipe.damping_ratio", r"Was 0\.15 % meant\?"),
    (MODE.with_pipe(damping_ratio=0), "pipe.damping_ratio", r"a rule of thumb knows none with less than 0\.0001"),
    (table(damping_ratio=0.2), "pipe.modes[0].damping_ratio", r"Was 0\.2 % meant\?"),
    (TUBE.with_pipe(damping_ratio=0.5, damping_ratios=(0.5, 0.01, 0.01)), "pipe.damping_ratios", r"takes a damper"),
    (MODE.with_pipe(mass=7706), "pipe.mass", r"1\.38e\+04 times.*3580 kg/m.*Does the mass belong to the 1 m"),
    (MODE.with_pipe(mass=2.47), "pipe.mass", r"4\.42 times the mass of the fluid"),
    (SLOW.with_pipe(contained_mass=2e4), "pipe.contained_mass", r"as a solid steel bar"),
    (TUBE.with_pipe(density=10), "pipe.wall", r"times the mass of the fluid displaced"),
    (SLOW.with_pipe(youngs_modulus=206), "pipe.youngs_modulus", r"2\.06e11 Pa.*Was 206 GPa meant\?"),
    (TUBE.with_pipe(density=7.85), "pipe.density", r"7850 kg/m\^3.*Was 7\.85 g/cm\^3 meant\?"),
    (TUBE.without_absorbers().with_pipe(length=3.0), "pipe.length", r"L/D = 3\.94.*beyond 6"),
    (SLOW.with_pipe(length=31200.0), "pipe.length", r"Was 31200 mm meant\?"),
    (table(mass=9000.0), "pipe.modes[0].mass", r"at most .* 7410 kg"),
    (table(lift_length=31.0), "pipe.modes[0].lift_length", r"no longer than the pipe, 30 m"),
    (TUBE.with_wind(**WATER), "pipe.added_mass", r"467\.4 kg/m"),
    (MODE.with_wind(**WATER), "pipe.mass", r"less than the added mass alone: .*467\.4 kg/m"),
    (MODE.with_wind(**(WATER | {"viscosity": 1.5e-5})), "wind.viscosity", r"Water has 1\.0e-6.*1\.5e-5 is that of air"),
    (MODE.with_wind(viscosity=1e-6), "wind.viscosity", r"Air .* has 1\.5e-5 m\^2/s"),
    (MODE.with_wind(air_density=12.25), "wind.air_density", r"1\.2 to 1\.4 kg/m\^3"),
    (MODE.with_wind(speed=97.2), "wind.speed", r"category 5"),
    (MODE.with_wind(**(WATER | {"speed": 6.0})), "wind.speed", r"Currents stay below 5 m/s"),
    (MODE.with_wind(speed=1.5), "wind.speed", r"0\.568 times.*DNV-RP-C205.*Resonance is at 2\.64 m/s"),
    (TUBE.with_wind(speed=60.0), "wind.speed", r"above all 3 modes"),
    (MODE.with_wind(range=(3.0, 20.0)), "wind.speed", r"The site has winds of 3 to 20 m/s"),
    (MODE.with_wind(range=(0.1, 1.5)), "wind.range", r"\[0\.1, 1\.5\] m/s: No mode .* 0\.0295 to 0\.443 Hz.* 0\.78 Hz"),
    (MODE.with_analysis(detuning=None, wind=(5.0, 9.0)), "analysis.wind", r"No mode is excited: .* 1\.48 to 2\.66 Hz"),
    (MODE.with_design(wind=(5.0, 9.0)), "design.wind", r"No mode is excited"),
    (TUBE.with_wind(range=(0.1, 70.0)), "wind.range", r"Higher modes may be missing: .*20\.7 Hz, above all 3 modes"),
    (TUBE.with_climate(weibull={"scale": 0.5, "shape": 2}), "climate.weibull.scale", r"excited from 2\.2 m/s on"),
    (MODE.with_wind(strouhal=0.02), "wind.strouhal", r"circular cylinders have 0\.18 to 0\.2"),
    (MODE.with_wind(lift_coefficient=4.5), "wind.lift_coefficient", r"EN 1991-1-4 has 0\.7 at most"),
    (MODE.with_wind(lift_coefficient=0), "wind.lift_coefficient", r"0\.2 at least"),
    (MODE.with_pipe(frequency="2.6 Hz").with_wind(speed=9.0), "wind.lift_coefficient", r"Re = 4\.47e\+05.*a third"),
    (MODE.with_pipe(diameter="2 mm", mass=0.02).with_wind(speed=0.007), "wind.lift_coefficient", r"from 300 on"),
    (MODE.with_wind(lift_coefficient="facchinetti2004"), "wind.lift_coefficient", r"It ends at Re = 1\.5e\+05, 2\.95"),
    (MODE.with_wind(strouhal=[[1.2e5, 0.22], [4e5, 0.23]]), "wind.strouhal", r"It begins at Re = 1\.2e\+05"),
    (MODE.with_pipe(mass=20.0), "wind.lift_coefficient", r"moves the bare pipe by 1\.34 diameters"),
    (MODE.with_absorber(rho2=0.6), "absorbers[0].mass", r"0\.6 of the mass of the pipe, 247 kg"),
    (MODE.with_absorber(rho2=1e-4), "absorbers[0].mass", r"less than 0\.001 does next to nothing"),
    (with_law(MODE, mass=4940.0), "absorbers[0].mass", r"20 of the mass.* Was 4940 g meant\?"),
    (TUBE.with_absorber(position=3.0), "absorbers[0].mass", r"where the governing mode moves by 0\.0\d+"),
    (with_law(MODE, kind="linear", stiffness=0.1, damping=0.5), "absorbers[0].law.stiffness", r"Was 0\.1 N/mm meant"),
    (with_law(MODE, kind="linear", stiffness=1e5, damping=0.5), "absorbers[0].law.stiffness", r"already at a stroke"),
    (with_law(MODE, kind="cubic", stiffness=9e-5, damping=2.9), "absorbers[0].law.stiffness", r"9e-05 N/mm\^3 meant"),
    (with_law(MODE, kind="cubic", stiffness=9e13, damping=2.9), "absorbers[0].law.stiffness", r"rides along"),
    (with_law(MODE, kind="polynomial", coefficients=[1e6], damping=1.0), "absorbers[0].law.coefficients", r"already"),
    (MODE.with_absorber(xi2=0), "absorbers[0].law.damping", r"takes no energy out"),
    (MODE.with_absorber(xi2=1.0), "absorbers[0].law.damping", r"c/\(m omega\) = 10\.2"),
]  # fmt: skip


@pytest.mark.parametrize(("case", "name", "says"), FIRES, ids=[f"{name}-{i}" for i, (_, name, _) in enumerate(FIRES)])
def test_a_mistake_is_asked_about(case, name, says):
    sentences = [str(one) for one in frahm.plausibility(case) if one.name == name]
    assert any(re.search(says, sentence) for sentence in sentences), sentences


def test_a_site_with_all_winds_is_plausible():
    assert frahm.plausibility(MODE.with_wind(range=(0, 40))) == ()
    assert frahm.plausibility(TUBE.with_wind(range=(0, 40))) == ()
    assert (
        frahm.plausibility(TUBE.with_wind(range=(0, 40), speed=3.3, lift_coefficient="en1991", strouhal="en1991")) == ()
    )


def test_limits_that_can_be_judged_are_plausible():
    assert frahm.plausibility(limited(MODE, stroke="100 mm", displacement="50 mm")) == ()
    assert frahm.plausibility(limited(TUBE, stress_range="60 MPa", yield_strength="355 MPa")) == ()


def test_a_frequency_that_was_hertz_before_it_was_written_is_not_asked_about():
    """Results are written in SI units: 0.78 Hz as 4.900884539600077."""
    assert frahm.plausibility(MODE.with_pipe(frequency=2 * math.pi * 0.78)) == ()
    assert frahm.plausibility(MODE.with_pipe(frequency="4.9 rad/s")) == ()


def test_the_stress_per_displacement_is_held_against_that_of_a_tube():
    """283.5 MPa/m for the jacket pipe as a cantilever; MPa/m forgotten is asked about."""
    climate, fatigue = TUBE.to_dict()["climate"], {"curve": "D", "stress_per_displacement": 283.5}
    case = frahm.load_case(MODE.to_dict() | {"climate": climate, "fatigue": fatigue})
    one = found(case)["fatigue.stress_per_displacement"]
    assert "279 MPa/m" in one.reason
    assert "Was 283.5 MPa/m meant?" in one.reason
    assert not found(case.with_fatigue(stress_per_displacement="283.5 MPa/m"))


@pytest.mark.parametrize("usual", USUAL, ids=lambda usual: usual.path)
def test_every_usual_size_belongs_to_a_field_and_its_units_can_be_read(usual):
    from frahm.case import field_table
    from frahm.units import si_value

    fields = {re.sub(r"\(\w+\)", "", path): facts for path, facts in field_table(frahm.Case).items()}
    assert usual.low < usual.high
    for unit in usual.units:
        assert si_value(f"1 {unit}", fields[usual.path].unit) != 1
    assert usual.path in fields


def test_values_are_shown_as_typed_and_frozen():
    (one,) = frahm.plausibility(MODE.with_pipe(damping_ratio="15 %"))
    assert (one.name, one.value, one.given) == ("pipe.damping_ratio", 0.15, "15 %")
    assert str(one).startswith("pipe.damping_ratio = 15 %: Welded members")
    with pytest.raises(AttributeError):
        one.value = 1.0
    assert [one.given for one in frahm.plausibility(MODE.with_pipe(damping_ratio=0.15))] == ["0.15"]


def test_warnings_come_in_the_order_of_the_case_and_quickly():
    case = MODE.with_wind(speed=97.2).with_pipe(damping_ratio=0.3, diameter=762)
    names = [one.name for one in frahm.plausibility(case)]
    places = list(Inputs(case).values)
    assert names == sorted(names, key=places.index)
    assert len(names) > 2
    times = []
    for speed in (2.71, 2.72, 2.73):
        start = time.perf_counter()
        frahm.plausibility(TUBE.with_wind(speed=speed))
        times.append(time.perf_counter() - start)
    assert min(times) < 0.05


sizes = st.floats(1e-6, 1e12)


@settings(max_examples=100, deadline=None)
@given(mass=sizes, frequency=st.floats(0.5, 1e6), damping=st.just(0.0) | st.floats(1e-12, 0.99), diameter=sizes,
       speed=sizes, lift=st.just(0.0) | st.floats(1e-12, 10), stiffness=sizes, device=sizes)  # fmt: skip
def test_no_valid_case_is_too_odd_to_be_judged(mass, frequency, damping, diameter, speed, lift, stiffness, device):
    pipe = {"mass": mass, "frequency": frequency, "damping_ratio": damping, "diameter": diameter}
    law = {"kind": "cubic", "stiffness": stiffness, "damping": damping}
    case = {
        "pipe": pipe,
        "wind": {"speed": speed, "lift_coefficient": lift},
        "absorbers": [{"mass": device, "law": law}],
    }
    for one in frahm.plausibility(case):
        assert one.reason.endswith((".", "?"))
        assert not re.search(r"\bnan\b", one.reason)
        assert math.isfinite(one.value)
