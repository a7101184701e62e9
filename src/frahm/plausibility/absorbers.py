"""The absorbers: whether mass, spring and damper can do anything at the frequency of the pipe."""

from __future__ import annotations

import math
from collections.abc import Iterator

from frahm.absorbers import Law
from frahm.case import Absorber
from frahm.plausibility.implausible import Implausible, Inputs
from frahm.systems import build_system

MASS_RATIO = (0.005, 0.1)
_IDLE = 1e-3  # mass ratio
_ROUNDING = 1e-9
FREQUENCY_RATIO = (0.2, 5.0)
STROKE = (1e-3, 1.0)  # over the diameter
MOST_DAMPING = 2.0  # c/(m omega): critical
_THOUSAND = {"N/m": "N/mm", "N/m^3": "N/mm^3", "N s/m": "N s/mm"}


def judged_absorbers(inputs: Inputs) -> Iterator[Implausible]:
    """What is implausible about the absorbers."""
    case = inputs.case
    elements = build_system(case).elements if case.absorbers else ()
    for k, (absorber, element) in enumerate(zip(case.absorbers, elements, strict=True)):
        path = f"absorbers[{k}]"
        if f"{path}.mass" not in inputs.values:  # too many to be listed field by field
            return
        yield from _mass(inputs, path, absorber)
        yield from _spring(inputs, path, absorber, element.law)
        yield from _damper(inputs, path, absorber)


def _mass(inputs: Inputs, path: str, absorber: Absorber) -> Iterator[Implausible]:
    pipe = inputs.case.pipe
    motion = abs(float(pipe.modal.displacement(absorber.position)[0]))
    ratio = absorber.mass * motion**2 / pipe.mass
    if MASS_RATIO[0] * (1 - _ROUNDING) <= ratio <= MASS_RATIO[1] * (1 + _ROUNDING):
        return
    where = f" where the governing mode moves by {motion:.3g}" if motion < 1 - 1e-9 else ""
    light = f"less than {_IDLE:g} does next to nothing" if ratio < _IDLE else "a lighter one takes little out"
    reason = (
        f"{ratio:.3g} of the {'modal ' if pipe.modal.shapes else ''}mass of the pipe, {pipe.mass:.4g} kg{where};"
        f" dampers have {MASS_RATIO[0]:g} to {MASS_RATIO[1]:g} of it, a rule of thumb, and"
        f" {light if ratio < MASS_RATIO[0] else 'the weight of a heavier one is a load of its own'}."
    )
    low = absorber.mass * motion**2 * 1e-3 <= MASS_RATIO[1] * pipe.mass
    yield inputs.implausible(f"{path}.mass", reason, ["g"] if ratio > MASS_RATIO[1] and low else [])


def _spring(inputs: Inputs, path: str, absorber: Absorber, law: Law) -> Iterator[Implausible]:
    """Frequency of the absorber on the pipe held fast, at strokes of a thousandth and of one diameter."""
    pipe = inputs.case.pipe
    small, large = (
        math.sqrt(max(float(law.describing_stiffness(share * pipe.diameter)), 0.0) / absorber.mass) / pipe.frequency
        for share in STROKE
    )
    if max(small, large) >= FREQUENCY_RATIO[0] and min(small, large) <= FREQUENCY_RATIO[1]:
        return
    soft = max(small, large) < FREQUENCY_RATIO[0]
    field = next(f"{path}.law.{n}" for n in ("stiffness", "coefficients") if hasattr(absorber.law, n))
    ratio, share = (max(small, large), "one diameter") if soft else (min(small, large), "a thousandth of a diameter")
    reason = (
        f"On this spring the mass swings at {ratio:.3g} times the frequency of the pipe"
        f"{' still' if soft else ' already'} at a stroke of {share}: it"
        f" {'stands still in space' if soft else 'rides along as if it were welded'} and takes nothing out."
    )
    unit = inputs.values[field].facts.unit
    factor = 1e9 if unit == "N/m^3" else 1e3
    yield inputs.implausible(field, reason, [_THOUSAND[unit]] if soft and unit in _THOUSAND
                             and ratio * math.sqrt(factor) >= FREQUENCY_RATIO[0] else [])  # fmt: skip


def _damper(inputs: Inputs, path: str, absorber: Absorber) -> Iterator[Implausible]:
    field, c = f"{path}.law.damping", absorber.law.damping
    ratio = c / (absorber.mass * inputs.case.pipe.frequency)
    if c == 0 and absorber.friction is None:
        yield inputs.implausible(
            field, "Without damping an absorber takes no energy out of the pipe, it only holds it."
        )
    elif ratio > MOST_DAMPING:
        reason = (
            f"c/(m omega) = {ratio:.3g}: beyond {MOST_DAMPING:g}, critical damping, the mass hangs on its damper and"
            " rides along; the jacket pipe's sink has 0.12, and beyond 0.58 no sink has a folded slow manifold."
        )
        yield inputs.implausible(field, reason)
