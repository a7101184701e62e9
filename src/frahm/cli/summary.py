"""A case in a few lines, for people."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from frahm.case import Case, field_values
from frahm.loads import resonant_shedding, vortex_shedding
from frahm.plausibility import plausibility

_LISTED = 12  # pairs of a table that are still written out
_HEADING = ("name", "title")
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")


def case_summary(case: Case) -> str:
    """Return the fields of a case as typed and in SI units, the defaulted ones marked, and what follows from them."""
    rows = list(_rows(case))
    width = max(len(path) for path, _, _ in rows)
    lines = [f"  {path:<{width}}  {text}{'   (default)' if default else ''}" for path, text, default in rows]
    heading = f"{case.name}: {case.title}" if case.title else case.name
    notes = [f"  note: {one}" for one in plausibility(case)]
    odd = ["", *notes] if notes else []
    ending = "The case is valid" + ("; see the notes above." if notes else ", and nothing about it is implausible.")
    return "\n".join([heading, *lines, "", *_consequences(case), *odd, "", ending])


def _rows(case: Case) -> Iterator[tuple[str, str, bool]]:
    for field in field_values(case):
        if field.path not in _HEADING:
            yield field.path, _as_typed(field.typed, field.value, field.facts.unit), not field.given


def _as_typed(typed: str | None, value: Any, unit: str) -> str:
    """The text of a value as typed, with the value in SI units beside it; once, if it was typed in these."""
    if typed is None:
        return _text(value, unit)
    if unit != "rad/s":
        number = _NUMBER.match(typed)
        if number and isinstance(value, float) and float(number[0]) == value:
            return f"{number[0]} {unit}".rstrip()  # the unit in the one spelling of all lines
    elif isinstance(value, float) and typed.endswith("Hz"):
        return f"{typed} = {_number(value)} {unit}"
    return f"{typed} = {_text(value, unit)}"


def _number(value: float, digits: int = 6) -> str:
    """So many digits, and powers of ten as people write them: 1.5e-5."""
    return re.sub(r"e([+-])0*(\d+)", lambda power: f"e{power[1].strip('+')}{power[2]}", f"{value:.{digits}g}")


def _text(value: Any, unit: str) -> str:
    if value is None or value in ((), ""):
        return "none"
    if isinstance(value, tuple) and isinstance(value[0], BaseModel):
        return f"{len(value)} rows"
    if isinstance(value, tuple) and isinstance(value[0], tuple) and len(value) > _LISTED:
        return f"{len(value)} pairs"
    if isinstance(value, tuple) and isinstance(value[0], tuple):
        return "[" + ", ".join(_text(entry, unit) for entry in value) + "]"
    if isinstance(value, tuple):
        return "[" + ", ".join(map(_number, value)) + "]" + (f" {unit}" if unit else "")
    if isinstance(value, float):
        in_hertz = f" = {_number(value / (2 * math.pi))} Hz" if unit == "rad/s" else ""
        return _number(value) + (f" {unit}" if unit else "") + in_hertz
    return str(value)


def _consequences(case: Case) -> list[str]:
    shedding, pipe = vortex_shedding(case), case.pipe
    lines = [
        f"  vortices are shed at {_number(shedding.frequency_hz, 4)} Hz,"
        f" detuning {_number(shedding.detuning, 4)} rad/s",
        f"  lift amplitude {_number(shedding.lift, 4)} N on {_number(pipe.length, 4)} m of pipe",
        *_about_modes(case),
        f"  reduced velocity {_number(shedding.reduced_velocity, 3)},"
        f" Reynolds number {_number(shedding.reynolds_number, 3)}",
    ]
    damping = 2 * pipe.damping_ratio * pipe.mass * pipe.frequency
    if damping:
        resonant = resonant_shedding(case)
        lift = resonant.lift * pipe.modal.lift_lengths[0] / pipe.length
        amplitude = _number(lift / (damping * pipe.frequency), 4)
        lines.append(f"  resonant amplitude without absorbers {amplitude} m, by the lift of {resonant.speed:.4g} m/s")
    for absorber in case.absorbers:
        values = absorber.normalised(pipe.mass)
        named = ", ".join(f"{key} {_number(values[key])}" for key in ("rho2", "kappa", "xi2") if key in values)
        lines.append(f"  {absorber.name}, normalised by the mass of the pipe: {named}")
    return lines


def _about_modes(case: Case) -> Iterator[str]:
    """Frequencies and masses of the modes of an elastic pipe."""
    modal = case.pipe.modal
    if modal.shapes is None:
        return
    mass, length = _number(modal.masses[0], 5), _number(modal.lift_lengths[0], 4)
    yield f"  governing mode: modal mass {mass} kg, lift on {length} m of its motion"
    named = ", ".join(_number(omega / (2 * math.pi), 4) for omega in sorted(modal.frequencies))
    yield f"  natural frequencies {named} Hz"
