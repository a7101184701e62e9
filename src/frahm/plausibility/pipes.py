"""The pipe: damping, mass, proportions, and the fluid around it."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from frahm.case import ModeTable, Pipe, Tube
from frahm.case.tube import STEEL_DENSITY, STEEL_MODULUS
from frahm.plausibility.implausible import Implausible, Inputs

DAMPING, WET_DAMPING = (1e-4, 0.05), 0.2  # in air; at most in a liquid, which damps by itself
MEAN_DENSITY = (30.0, 1.5 * STEEL_DENSITY)  # thin tubes of glass fibre ... more than solid steel [kg/m^3]
THINNEST, STOCKIEST, SLENDEREST = 300.0, 6.0, 1000.0  # D/t, L/D, L/D
WATER = 100.0  # a fluid denser than this is a liquid [kg/m^3]
AIR_DENSITY = (0.6, 2.0)  # 7 km above the sea ... dry air at -90 degrees Celsius [kg/m^3]
GAS_VISCOSITY, LIQUID_VISCOSITY = 5e-6, 1e-5  # [m^2/s]
_ROUNDING = 1e-3


def judged_pipe(inputs: Inputs) -> Iterator[Implausible]:
    """What is implausible about the pipe, and the fluid around it."""
    yield from _damping(inputs)
    yield from _mass(inputs)
    yield from _fluid(inputs)
    if isinstance(inputs.case.pipe, Tube):
        yield from _tube(inputs, inputs.case.pipe)
    elif isinstance(inputs.case.pipe, ModeTable):
        yield from _table(inputs, inputs.case.pipe)
    yield from _stress(inputs)


def _damping(inputs: Inputs) -> Iterator[Implausible]:
    low, high = DAMPING[0], WET_DAMPING if inputs.case.wind.air_density > WATER else DAMPING[1]
    for path, field in inputs.values.items():
        ratios = field.value if isinstance(field.value, tuple) else (field.value,)
        if not re.fullmatch(r"pipe\.(modes\[\d+\]\.)?damping_ratios?", path) or not ratios:
            continue
        if max(ratios) > high:
            reason = (
                "Welded members have 0.0015 (NPD, measured on flare booms) to 0.005 (DNV-RP-C205, quoted from memory)"
                f" of critical damping, and more than {high:g} takes a damper."
            )
            yield inputs.implausible(path, reason, ["%"] if low <= max(ratios) / 100 <= high else [])
        elif min(ratios) < low:
            reason = (
                "Welded members have 0.0015 (NPD, measured on flare booms), and a rule of thumb knows none with less"
                f" than {low:g}: in resonance a pipe moves as 1/damping."
            )
            yield inputs.implausible(path, reason)


def _mass(inputs: Inputs) -> Iterator[Implausible]:
    """Vibrating mass over the volume of the pipe: between thin plastic and solid steel, whatever the fluid."""
    pipe = inputs.case.pipe
    if pipe.mass_per_length is None:
        return
    area = math.pi / 4 * pipe.diameter**2
    density, per_air = pipe.mass_per_length / area, pipe.mass_per_length / (inputs.case.wind.air_density * area)
    if MEAN_DENSITY[0] <= density <= MEAN_DENSITY[1]:
        return
    solid = STEEL_DENSITY * area
    reason = (
        f"{pipe.mass_per_length:.4g} kg/m are {per_air:.3g} times the mass of the fluid displaced; as a solid steel"
        f" bar it would have {solid:.4g} kg/m, as a steel tube with D/t = {THINNEST:g} {4 * solid / THINNEST:.3g} kg/m."
    )
    if isinstance(pipe, Pipe) and density > MEAN_DENSITY[1]:
        reason += f" Does the mass belong to the {pipe.length:g} m of pipe.length?"
    yield inputs.implausible(_mass_field(inputs, light=density < MEAN_DENSITY[0]), reason)


def _mass_field(inputs: Inputs, *, light: bool) -> str:
    """Field that makes the pipe too light or too heavy."""
    pipe = inputs.case.pipe
    if not isinstance(pipe, Tube):
        return "pipe.mass" if isinstance(pipe, Pipe) else "pipe.mass_per_length"
    if light:
        return "pipe.wall"
    return "pipe.contained_mass" if pipe.contained_mass > pipe.added_mass else "pipe.added_mass"


def _fluid(inputs: Inputs) -> Iterator[Implausible]:
    case = inputs.case
    pipe, rho, nu = case.pipe, case.wind.air_density, case.wind.viscosity
    if rho <= WATER:
        if not AIR_DENSITY[0] <= rho <= AIR_DENSITY[1]:
            yield inputs.implausible("wind.air_density", "Air at the sea has 1.2 to 1.4 kg/m^3.")
        if nu < GAS_VISCOSITY:
            yield inputs.implausible("wind.viscosity", "Air near 20 degrees Celsius has 1.5e-5 m^2/s, water 1.0e-6.")
        return
    added = rho * math.pi / 4 * pipe.diameter**2
    if nu > LIQUID_VISCOSITY:
        reason = (
            f"Water has 1.0e-6 m^2/s at 20 degrees Celsius, and the fluid has {rho:g} kg/m^3; 1.5e-5 is that of air."
        )
        yield inputs.implausible("wind.viscosity", reason)
    carried = (
        f"the water that moves with a cylinder has {added:.4g} kg/m, the mass it displaces (added mass coefficient 1)."
    )
    if isinstance(pipe, Tube) and not pipe.added_mass:
        yield inputs.implausible("pipe.added_mass", f"In a fluid of {rho:g} kg/m^3 {carried}")
    elif pipe.mass_per_length is not None and not isinstance(pipe, Tube) and pipe.mass_per_length < added:
        yield inputs.implausible(_mass_field(inputs, light=True), f"That is less than the added mass alone: {carried}")


def _tube(inputs: Inputs, tube: Tube) -> Iterator[Implausible]:
    if (ratio := tube.diameter / tube.wall) > THINNEST:
        reason = (
            f"D/t = {ratio:.4g}: API RP 2A knows tubes up to {THINNEST:g} (quoted from memory); beyond, it is a shell."
        )
        yield inputs.implausible("pipe.wall", reason)
    yield from _slenderness(inputs, tube.length, tube.diameter)


def _table(inputs: Inputs, table: ModeTable) -> Iterator[Implausible]:
    yield from _slenderness(inputs, table.length, table.diameter)
    limit = None if table.mass_per_length is None else table.mass_per_length * table.length
    for k, mode in enumerate(table.modes):
        path = f"pipe.modes[{k}]"
        if f"{path}.mass" not in inputs.values:  # a table too long to be listed field by field
            return
        if limit is not None and k == table.governing_mode - 1 and mode.mass > limit * (1 + _ROUNDING):
            reason = (
                f"A modal mass is at most mass_per_length times length, {limit:.4g} kg, if the largest displacement of"
                " the shape is 1. Are the shapes scaled otherwise?"
            )
            yield inputs.implausible(f"{path}.mass", reason)
        if abs(mode.lift_length) > table.length * (1 + _ROUNDING):
            reason = f"The integral of a shape of at most 1 is no longer than the pipe, {table.length:g} m."
            yield inputs.implausible(f"{path}.lift_length", reason)


def _slenderness(inputs: Inputs, length: float, diameter: float) -> Iterator[Implausible]:
    ratio = length / diameter
    if ratio < STOCKIEST:
        reason = (
            f"L/D = {ratio:.3g}: EN 1991-1-4, E.1.2 counts on vortices beyond {STOCKIEST:g} (quoted from memory), and a"
            " shorter pipe bends as no slender beam."
        )
        yield inputs.implausible("pipe.length", reason)
    elif ratio > SLENDEREST:
        reason = f"L/D = {ratio:.4g}: beyond {SLENDEREST:g} it is a cable, held by tension and sag, a rule of thumb."
        yield inputs.implausible("pipe.length", reason, ["mm"] if STOCKIEST < 1e-3 * ratio < SLENDEREST else [])


def _stress(inputs: Inputs) -> Iterator[Implausible]:
    """Stress per displacement of a pipe given as one mode, against that of a thin steel tube of its frequency."""
    fatigue, pipe = inputs.case.fatigue, inputs.case.pipe
    if fatigue is None or fatigue.stress_per_displacement is None:
        return
    tube = pipe.frequency * math.sqrt(2 * STEEL_MODULUS * STEEL_DENSITY)
    ratio = fatigue.stress_per_displacement / tube
    if not 0.02 <= ratio <= 20:
        reason = (
            f"A thin steel tube of this frequency has omega sqrt(2 E rho) = {tube / 1e6:.3g} MPa/m at its support or in"
            " its middle, 1.3 times that if clamped there: this is"
            f" {ratio:.2g} times it."
        )
        meant = [unit for unit, factor in (("MPa/m", 1e6), ("GPa/m", 1e9)) if 0.02 <= factor * ratio <= 20]
        yield inputs.implausible("fatigue.stress_per_displacement", reason, meant)
