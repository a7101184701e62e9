"""What a design report says of several absorbers."""

from types import SimpleNamespace

from frahm.design import DesignSettings
from frahm.design.absorber import DesignedAbsorber, together
from frahm.report.design_report import _device, asked_rows


def test_shares_of_the_mass_are_a_list_and_a_range_is_a_range():
    shown = {name: text for name, text, *_ in asked_rows(SimpleNamespace(settings=DesignSettings(
        mass_ratio=(0.01, 0.03), count=2, mass_shares=(0.6, 0.4))))}  # fmt: skip
    assert shown["Masses of several absorbers"] == "0.6, 0.4"
    assert shown["Mass ratio"] == "0.01 ... 0.03"


def test_parts_of_the_fifth_power_are_shown_for_every_absorber():
    pair = together([DesignedAbsorber(0.01, 0.0, 20.0, 0.01), DesignedAbsorber(0.01, 0.0, 20.0, 0.01, 3.0e5)])
    assert "fifth power 0 · 300000 1/(m⁴ s²)" in _device(SimpleNamespace(name="sink", design=pair))
