"""Fields that are judged by themselves: the sizes that occur in practice."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

from frahm.plausibility.implausible import Implausible, Inputs
from frahm.readable import DAY, YEAR
from frahm.units import si_value


@dataclass(frozen=True)
class Usual:
    """The sizes a field has in practice.

    Attributes
    ----------
    path : str
        Of the field, ``[]`` for any entry of a list.
    low, high : float
        In the SI unit of the field.
    basis : str
        The sentence that says so, and where it comes from.
    units : tuple of str
        Units the number is often written in: asked about if it was given plain and would then be usual.
    """

    path: str
    low: float
    high: float
    basis: str
    units: tuple[str, ...] = ()


_THUMB = "a rule of thumb"
USUAL = (
    Usual("pipe.diameter", 0.01, 10, f"pipes and tubular members are 10 mm to 10 m across, {_THUMB}.",
          ("mm", "inch")),
    Usual("pipe.wall", 5e-4, 0.2, f"walls of pipes are 0.5 to 200 mm thick, {_THUMB}.", ("mm", "inch")),
    Usual("pipe.youngs_modulus", 5e8, 1e12, "structural steel has 2.06e11 Pa, the softest plastic pipes about 1e9 Pa.",
          ("GPa", "MPa")),
    Usual("pipe.density", 500, 2e4, "structural steel has 7850 kg/m^3, lead 11300 kg/m^3.", ("g/cm^3",)),
    Usual("climate.duration", DAY, 200 * YEAR, f"structures are designed for at most 200 years, {_THUMB}."),
    Usual("climate.weibull.scale", 2, 20, f"wind climates have scales of 3 to 15 m/s, {_THUMB}.", ("km/h", "knot")),
    Usual("climate.weibull.shape", 1, 4, f"measured winds have shapes of 1.5 to 3, {_THUMB}."),
    Usual("climate.table[].speed", 0, 70, "a hurricane of category 5 (Saffir and Simpson) begins at 70 m/s.",
          ("km/h", "knot")),
    Usual("fatigue.thickness", 5e-4, 0.2, f"welded walls are 0.5 to 200 mm thick, {_THUMB}.", ("mm", "inch")),
    Usual("fatigue.reference_thickness", 0.01, 0.04,
          "DNV-RP-C203 has 25 mm, and 16 mm for tubular joints (quoted from memory).", ("mm",)),
    Usual("fatigue.stress_concentration", 1, 10,
          "DNV-RP-C203 asks for other exponents beyond a factor of 10 (quoted from memory)."),
    Usual("wind.turbulence.intensity", 0.01, 0.5,
          f"0.05 to 0.2 at sea and over open land, 0.5 only in the wake of something, {_THUMB}."),
    Usual("wind.turbulence.length_scale", 5, 1000, f"gusts are some 20 to 300 m long, {_THUMB}."),
    Usual("absorbers[].gravity", -9.9, 9.9, "gravity has 9.81 m/s^2, along a vertical motion."),
    Usual("design.stroke", 1e-4, 5, f"devices move by 0.1 mm to 5 m, {_THUMB}.", ("mm",)),
    Usual("design.spring_length", 1e-3, 20, f"springs are 1 mm to 20 m long, {_THUMB}.", ("mm",)),
    Usual("limits.displacement", 1e-5, math.inf, f"pipes are let move by 0.01 mm or more, {_THUMB}."),
    Usual("limits.amplitude_ratio", 1e-5, 2, f"nothing moves by more than two diameters, {_THUMB}.", ("%",)),
    Usual("limits.stress_range", 1e5, 1.5e9, f"details are let swing by 0.1 to 1500 MPa, {_THUMB}.", ("MPa",)),
    Usual("limits.yield_strength", 5e7, 2e9, "structural steel yields at 235 to 700 MPa.", ("MPa",)),
    Usual("limits.static_stress", 0, 1.5e9, f"no more than steel bears, {_THUMB}.", ("MPa",)),
    Usual("limits.stroke", 1e-4, math.inf, f"devices move by 0.1 mm or more, {_THUMB}."),
    Usual("design.spring_stress", 5e7, 2e9,
          f"spring steel is stressed to 200 to 1000 MPa in shear, {_THUMB}.", ("MPa",)),
)  # fmt: skip


def judged_by_size(inputs: Inputs) -> Iterator[Implausible]:
    """Every field whose size is not usual."""
    for path, field in inputs.values.items():
        usual = _BY_PATH.get(re.sub(r"\[\d+\]", "[]", path))
        if usual is None or not isinstance(field.value, float) or usual.low <= field.value <= usual.high:
            continue
        meant = [u for u in usual.units
                 if usual.low <= si_value(f"{field.value!r} {u}", field.facts.unit) <= usual.high]  # fmt: skip
        yield inputs.implausible(path, usual.basis[0].upper() + usual.basis[1:], meant)


_BY_PATH = {usual.path: usual for usual in USUAL}
