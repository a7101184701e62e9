"""What CONTRIBUTING lists for an addition is there for everything that was added so far."""

import inspect
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

import frahm
from frahm import absorbers
from frahm.absorbers.packed import law_force, law_force_and_slopes, pack_laws
from frahm.case import OBJECTIVES, Design
from frahm.case.absorber import Law as LawSection
from frahm.design.objective import _MEASURES, Objective
from frahm.sweep.batch import _COSTS
from frahm.sweep.quantities import _ONE_BY_ONE
from frahm.sweep.study import Quantities
from frahm.sweep.variables import variables_of_quantity
from frahm.systems.pipe import _LAWS

DOCS = Path(__file__).parents[2] / "docs"
EXAMPLES = {
    "Cubic": frahm.Cubic(300.0, 0.4),
    "Linear": frahm.Linear(20.0, damping=0.3),
    "Polynomial": frahm.Polynomial([2.0, -3.0, 40.0, 0.0, 9.0], 0.2),
    "Bistable": frahm.Bistable(300.0, 4.0, 0.1),
    "TransverseSprings": frahm.TransverseSprings(40.0, 0.7, damping=0.3, pretension=2.0),
}


def concrete(law=absorbers.Law):
    for child in law.__subclasses__():
        if not inspect.isabstract(child):
            yield child
        yield from concrete(child)


def test_every_force_law_has_its_place_in_a_case_in_the_documentation_and_at_the_top():
    names = {law.__name__ for law in concrete() if law.__module__.startswith("frahm")}
    assert names == {law.__name__ for law in _LAWS.values()} == set(EXAMPLES)
    assert all(getattr(frahm, name) in _LAWS.values() for name in names)
    sections = get_args(get_args(LawSection)[0])
    assert {section.model_fields["kind"].default for section in sections} == set(_LAWS)
    described = (DOCS / "force_laws.md").read_text(encoding="utf-8")
    assert [name for name in names if f"`{name}" not in described] == []


@pytest.mark.parametrize("law", EXAMPLES.values(), ids=list(EXAMPLES))
def test_what_compiled_code_makes_of_a_law_is_the_law(law):
    codes, table = pack_laws([law])
    for z in np.linspace(-0.6, 0.6, 7):
        for w in (-0.5, 0.0, 0.8):
            assert law_force(*codes[0], table, z, w) == pytest.approx(float(law.force(z, w)), rel=1e-12, abs=1e-13)
            force, *slopes = law_force_and_slopes(*codes[0], table, z, w)
            step = 1e-6
            by_z = float(law.force(z + step, w) - law.force(z - step, w)) / (2 * step)
            by_w = float(law.force(z, w + step) - law.force(z, w - step)) / (2 * step)
            assert force == pytest.approx(float(law.force(z, w)), rel=1e-12, abs=1e-13)
            assert slopes == pytest.approx([by_z, by_w], rel=1e-6, abs=1e-6)


def test_every_objective_is_measured_and_described():
    assert set(OBJECTIVES) == set(_MEASURES) == set(get_args(Design.model_fields["objective"].annotation))
    described = (DOCS / "design.md").read_text(encoding="utf-8")
    assert [name for name in OBJECTIVES if f"`{name}`" not in described] == []
    assert len({Objective(name).title for name in OBJECTIVES}) == len(OBJECTIVES)


@pytest.mark.parametrize("name", Quantities.model_fields)
def test_every_quantity_of_a_sweep_is_computed_costed_and_described(name):
    over = {window for known, window in _COSTS if known == name}
    assert over
    computed = {window for known, window in _ONE_BY_ONE if known == name} | ({False} if name == "slow_flow" else set())
    assert computed == over
    assert f"`{name}`" in (DOCS / "sweep.md").read_text(encoding="utf-8")
    case = "jacket-pipe-elastic" if name == "fatigue" else "jacket-pipe"  # one counts fatigue, one has a slow flow
    study = frahm.Study(case=case, axes={"kappa": [300.0, 400.0]}, quantities={name: {}})
    assert variables_of_quantity(study, name)
