"""Rows of what goes into a case, and of what follows from it, as text ready to be read."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from pydantic import BaseModel

from frahm.case import Case, field_values
from frahm.case.fields import FieldValue
from frahm.loads import vortex_shedding
from frahm.report.numbers import number

_LISTED = 12  # pairs of a table that are still written out
_GREEK = {"omega": "ω", "zeta": "ζ", "rho": "ρ", "sigma": "σ", "nu": "ν"}


class InputRow(NamedTuple):
    """One field of the case; the symbol is its letter and its index, `typed` what was written, with its own unit."""

    path: str
    title: str
    symbol: tuple[str, str]
    value: str
    unit: str
    defaulted: bool
    typed: str = ""


def input_rows(case: Case, defaulted: list[str], typed: Mapping[str, str]) -> list[InputRow]:
    """Every field of the case in SI units, as typed where that is another unit, those left out in the file marked."""
    return [
        InputRow(
            field.path, field.facts.title, _symbol(field.facts.symbol), _value(field.value), _unit(field.facts.unit),
            field.path in defaulted, _typed(field, typed.get(field.path)),
        )
        for field in field_values(case)
        if field.path not in ("name", "title", "absorbers") and not field.path.startswith("document")
    ]  # fmt: skip


def _typed(field: FieldValue, text: str | None) -> str:
    """What was typed, if it is not the very value in the very unit."""
    same = text is None or text.replace(" ", "") == f"{_value(field.value)}{field.facts.unit}"
    return "" if same else str(text)


def _symbol(symbol: str) -> tuple[str, str]:
    letter, _, index = symbol.partition("_")
    return _GREEK.get(letter, letter), index


def _unit(unit: str) -> str:
    return unit.replace("^2", "²").replace("^3", "³")


def _value(value: Any) -> str:
    if value == ():
        return "none"
    if isinstance(value, tuple) and isinstance(value[0], BaseModel):
        return f"{len(value)} rows"
    if isinstance(value, tuple) and isinstance(value[0], tuple):
        pairs = "; ".join(" → ".join(number(entry) for entry in pair) for pair in value)
        return pairs if len(value) <= _LISTED else f"{len(value)} pairs"
    if isinstance(value, tuple):
        return " … ".join(number(float(entry), 6) for entry in value) if len(value) == 2 else str(list(value))
    return number(value, 6)


def mode_count(case: Case) -> int:
    """Number of modes of the pipe that take part."""
    modal = getattr(case.pipe, "modal", None)
    return 1 if modal is None else len(modal.frequencies)


def derived_rows(case: Case) -> list[tuple[str, str, str]]:
    """What follows from the inputs: name, value, unit."""
    shedding, pipe = vortex_shedding(case), case.pipe
    rows = [
        ("Natural frequency of the pipe", number(pipe.frequency / (2 * math.pi)), "Hz"),
        ("Vortex shedding frequency", number(shedding.frequency_hz), "Hz"),
        ("Detuning of the wind", number(shedding.detuning), "rad/s"),
        ("Amplitude of the lift", number(shedding.lift), "N"),
        ("Reduced velocity", number(shedding.reduced_velocity), ""),
        ("Reynolds number", number(shedding.reynolds_number, 3), ""),
    ]
    units = {"rho2": ("mass over mass of the pipe", ""), "xi2": ("damping over mass of the pipe", "1/s"),
             "kappa": ("cubic stiffness over mass of the pipe", "1/(m² s²)")}  # fmt: skip
    for absorber in case.absorbers:
        for name, value in absorber.normalised(pipe.mass).items():
            text, unit = units[name]
            rows.append((f"{absorber.name}: {text}", number(value, 5), unit))
    return rows
