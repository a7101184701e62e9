import math

import pytest
from pydantic import ValidationError

import frahm
from frahm.case import Absorber, Case, CubicLaw, LinearLaw, Pipe, PolynomialLaw, Wind

PLAIN = {
    "pipe": {"mass": 100.0, "frequency": 2.0, "damping_ratio": 0.01, "diameter": 0.5},
    "wind": {"speed": 3.0, "lift_coefficient": 0.3},
}


@pytest.fixture
def jacket():
    return frahm.load_case("jacket-pipe")


@pytest.fixture
def bare():
    return frahm.load_case(PLAIN)


def test_the_built_in_case_holds_the_published_values(jacket):
    # Table 1 and section 4.2 of doi 10.3390/app12147272, times the mass of the pipe
    assert jacket.pipe.mass == 247
    assert jacket.pipe.frequency == pytest.approx(2 * math.pi * 0.78, rel=1e-15)
    assert (jacket.pipe.damping_ratio, jacket.pipe.diameter, jacket.pipe.length) == (0.0015, 0.762, 1.0)
    assert (jacket.wind.speed, jacket.wind.air_density) == (2.7, 1.225)
    assert (jacket.wind.strouhal, jacket.wind.lift_coefficient) == (0.225, 0.4535)
    (sink,) = jacket.absorbers
    assert sink.mass == pytest.approx(4.94, rel=1e-15)
    assert sink.law.stiffness == pytest.approx(367.38 * 247, rel=1e-15)
    assert sink.law.damping == pytest.approx(0.0117 * 247, rel=1e-15)
    assert sink.normalised(247) == pytest.approx({"rho2": 0.02, "xi2": 0.0117, "kappa": 367.38}, rel=1e-14)


def test_with_absorber_changes_only_what_is_named(jacket):
    stiff = jacket.with_absorber(kappa=97.97)
    assert stiff.absorbers[0].law.stiffness == pytest.approx(24198.59)
    assert stiff.absorbers[0].law.damping == jacket.absorbers[0].law.damping
    assert stiff.absorbers[0].mass == jacket.absorbers[0].mass
    assert stiff.pipe == jacket.pipe
    assert jacket.absorbers[0].law.stiffness == pytest.approx(90742.86)
    assert jacket.with_absorber(xi2=0.0085).absorbers[0].law.damping == pytest.approx(2.0995)
    assert jacket.with_absorber(rho2=0.05).absorbers[0].mass == pytest.approx(12.35)


def test_with_absorber_adds_a_sink_to_a_bare_pipe(bare):
    case = bare.with_absorber(kappa=2.0, xi2=0.03, rho2=0.04, name="first")
    (sink,) = case.absorbers
    assert (sink.name, sink.mass) == ("first", pytest.approx(4.0))
    assert sink.law == CubicLaw(stiffness=200.0, damping=3.0)
    assert case.without_absorbers() == bare


@pytest.mark.parametrize("missing", ["kappa", "xi2", "rho2"])
def test_a_new_sink_needs_all_three_values(bare, missing):
    values = {"kappa": 2.0, "xi2": 0.03, "rho2": 0.04}
    del values[missing]
    with pytest.raises(frahm.ParameterError, match=f"^{missing}: given None.*no absorber yet"):
        bare.with_absorber(**values)


def test_with_absorber_of_another_law(bare):
    case = frahm.load_case(
        PLAIN
        | {
            "absorbers": [
                {"name": "tuned", "mass": 2, "law": {"kind": "linear", "stiffness": 5, "damping": 0.5}},
                {"name": "odd", "mass": 3, "law": {"kind": "polynomial", "coefficients": [1, 0, 2], "damping": 0.7}},
            ]
        }
    )
    assert case.with_absorber(xi2=0.01).absorbers[0].law == LinearLaw(stiffness=5, damping=1.0)
    assert case.with_absorber(kappa=3.0, name="odd").absorbers[1].law == CubicLaw(stiffness=300.0, damping=0.7)
    assert case.with_absorber(rho2=0.5, index=1).absorbers[1].mass == pytest.approx(50.0)
    assert case.with_absorber(rho2=0.5, index=1).absorbers[1].law == PolynomialLaw(coefficients=(1, 0, 2), damping=0.7)
    assert case.with_absorber(rho2=0.5, index=1).absorbers[0] == case.absorbers[0]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"kappa": -1.0}, "kappa: given -1.0"),
        ({"kappa": math.nan}, "kappa: given nan"),
        ({"xi2": "0.01"}, "xi2: given '0.01'"),
        ({"rho2": 0}, "rho2: given 0"),
        ({"rho2": True}, "rho2: given True"),
        ({"kappa": 1e308}, "absorbers[0].law.stiffness: given inf"),
        ({"rho2": 0.1, "name": "snik"}, "Did you mean 'sink'"),
        ({"rho2": 0.1, "index": 1}, "index: given 1"),
        ({"rho2": 0.1, "index": -1}, "index: given -1"),
        ({"rho2": 0.1, "index": 0, "name": "sink"}, "at most one of the two"),
    ],
)
def test_with_absorber_refuses(jacket, arguments, says):
    with pytest.raises(frahm.ParameterError) as caught:
        jacket.with_absorber(**arguments)
    assert says in str(caught.value)


def test_sections_change_value_by_value(jacket):
    assert jacket.with_wind(speed="36 km/h").wind == Wind(**(jacket.wind.model_dump() | {"speed": 10.0}))
    assert jacket.with_pipe(frequency="1 Hz").pipe.frequency == pytest.approx(2 * math.pi)
    assert jacket.with_analysis(seed=7).analysis.seed == 7
    assert jacket.with_name("other", "Another").title == "Another"
    with pytest.raises(frahm.ParameterError, match=r"wind.sped: given 3.*Did you mean 'speed'"):
        jacket.with_wind(sped=3)
    with pytest.raises(frahm.ParameterError, match=r"wind.speed: given 0;.*> 0"):
        jacket.with_wind(speed=0)
    with pytest.raises(frahm.ParameterError, match=r"analysis.detuning\[0\]: given -0.4.*more than -0.3"):
        jacket.with_pipe(frequency=0.3)


def test_a_case_is_frozen_and_hashable(jacket):
    with pytest.raises(ValidationError, match="frozen"):
        jacket.name = "other"
    assert len({jacket, jacket.with_wind(speed=2.7), jacket.with_wind(speed=2.8)}) == 2


def test_a_case_can_be_built_from_its_parts():
    case = Case(
        pipe=Pipe(mass=100, frequency=2, damping_ratio=0.01, diameter=0.5),
        wind=Wind(speed=3, lift_coefficient=0.3),
        absorbers=[Absorber(mass=1, law=CubicLaw(stiffness=2, damping=3))],
    )
    assert case.with_wind(speed=4).absorbers == case.absorbers
    assert case.without_absorbers() == frahm.load_case(PLAIN)
    with pytest.raises(frahm.ParameterError, match=r"^pipe: given nothing.*required"):
        Case(wind=Wind(speed=3, lift_coefficient=0.3))


def test_equal_cases_have_equal_digests(jacket):
    assert jacket.digest == frahm.load_case(jacket.to_dict()).digest
    assert jacket.digest == jacket.with_wind(speed="2.7 m/s").digest
    assert jacket.digest != jacket.with_wind(speed=2.7000001).digest
    assert jacket.with_analysis(detuning=(-0.0, 1)).digest == jacket.with_analysis(detuning=(0, 1)).digest
    assert len(jacket.digest) == 64


def test_the_empty_section_of_a_file_means_its_defaults():
    assert frahm.load_case(PLAIN | {"analysis": None, "absorbers": None}) == frahm.load_case(PLAIN)
