"""Force laws in a case: what is read, what is made of it, what is refused."""

import numpy as np
import pytest

import frahm
from frahm.case import case_schema, load_case
from frahm.systems import build_system

LAWS = {
    "transverse-springs": {"stiffness": "8 kN/m", "length": "300 mm", "pretension": "20 N", "damping": 2.0},
    "bistable": {"stiffness": 9e4, "negative_stiffness": 60.0, "damping": 2.0},
    "linear": {"stiffness": 100.0, "damping": 2.0},
}


def case_with(law, **more):
    pipe = {"mass": 247, "length": 1, "frequency": "0.78 Hz", "damping_ratio": 0.0015, "diameter": 0.762}
    wind = {"speed": 2.7, "air_density": 1.225, "viscosity": 1.5e-5, "strouhal": 0.225, "lift_coefficient": 0.4535}
    return {"name": "laws", "pipe": pipe, "wind": wind, "absorbers": [{"mass": 4.94, "law": law, **more}]}


def law_of(kind, **more):
    return build_system(load_case(case_with({"kind": kind, **LAWS[kind]}, **more))).elements[0].law


def test_laws_of_a_case_are_those_of_the_library():
    z = np.linspace(-0.2, 0.2, 7)
    assert law_of("transverse-springs").force(z, 0.1) == pytest.approx(
        frahm.TransverseSprings(8000.0, 0.3, 2.0, pretension=20.0).force(z, 0.1)
    )
    assert law_of("bistable").force(z, 0.1) == pytest.approx(frahm.Bistable(9e4, 60.0, 2.0).force(z, 0.1))


def test_stops_friction_and_gravity_of_a_case():
    law = law_of(
        "linear", stops={"gap": "60 mm", "stiffness": 5000}, friction={"force": 0.05, "speed": "10 mm/s"}, gravity=9.81
    )
    assert law.stops == frahm.Stops(0.06, 5000.0)
    assert law.stops.depth == pytest.approx(0.006)
    assert law.friction == frahm.Friction(0.05, 0.01)
    assert law.weight == pytest.approx(4.94 * 9.81)


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"stiffness": -1.0}, "absorbers[0].law.stiffness"),
        ({"length": 0.0}, "absorbers[0].law.length"),
        ({"pretension": 2400.0}, "absorbers[0].law.pretension"),
        ({"lenght": 0.3}, "absorbers[0].law.lenght"),
        ({"kind": "transverse"}, "absorbers[0].law.kind"),
    ],
)
def test_bad_laws_are_named(change, path):
    with pytest.raises(frahm.ParameterError) as caught:
        load_case(case_with({"kind": "transverse-springs", **LAWS["transverse-springs"], **change}))
    assert caught.value.name == path


@pytest.mark.parametrize(
    ("more", "path"),
    [
        ({"stops": {"gap": 0.0, "stiffness": 1.0}}, "absorbers[0].stops.gap"),
        ({"stops": {"gap": 0.1}}, "absorbers[0].stops.stiffness"),
        ({"stops": {"gap": 0.1, "stiffness": 1.0, "depth": -1.0}}, "absorbers[0].stops.depth"),
        ({"friction": {"force": -0.1, "speed": 0.1}}, "absorbers[0].friction.force"),
        ({"friction": {"force": 0.1, "speed": 0.0}}, "absorbers[0].friction.speed"),
        ({"gravity": 1e3}, "absorbers[0].gravity"),
    ],
)
def test_bad_parts_are_named(more, path):
    with pytest.raises(frahm.ParameterError) as caught:
        load_case(case_with({"kind": "linear", **LAWS["linear"]}, **more))
    assert caught.value.name == path


def test_the_schema_knows_all_kinds():
    kinds = case_schema()["$defs"]["Absorber"]["properties"]["law"]["discriminator"]["mapping"]
    assert set(kinds) == {"cubic", "linear", "polynomial", "bistable", "transverse-springs"}
