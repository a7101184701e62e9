"""A case in a few lines, for people."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from frahm.case import Case, field_values
from frahm.loads import vortex_shedding

_LISTED = 12  # pairs of a table that are still written out
_HEADING = ("name", "title")


def case_summary(case: Case) -> str:
    """Return the fields of a case in SI units, the defaulted ones marked, and what follows from them."""
    rows = list(_rows(case))
    width = max(len(path) for path, _, _ in rows)
    lines = [f"  {path:<{width}}  {text}{'   (default)' if default else ''}" for path, text, default in rows]
    heading = f"{case.name}: {case.title}" if case.title else case.name
    return "\n".join([heading, *lines, "", *_consequences(case), "", "The case is valid."])


def _rows(case: Case) -> Iterator[tuple[str, str, bool]]:
    for field in field_values(case):
        if field.path not in _HEADING:
            yield field.path, _text(field.value, field.facts.unit), not field.given


def _text(value: Any, unit: str) -> str:
    if value is None or value == ():
        return "none"
    if isinstance(value, tuple) and isinstance(value[0], BaseModel):
        return f"{len(value)} rows"
    if isinstance(value, tuple) and isinstance(value[0], tuple) and len(value) > _LISTED:
        return f"{len(value)} pairs"
    if isinstance(value, tuple) and isinstance(value[0], tuple):
        return "[" + ", ".join(_text(entry, unit) for entry in value) + "]"
    if isinstance(value, tuple):
        return "[" + ", ".join(f"{number:.6g}" for number in value) + "]" + (f" {unit}" if unit else "")
    if isinstance(value, float):
        in_hertz = f" = {value / (2 * math.pi):.6g} Hz" if unit == "rad/s" else ""
        return f"{value:.6g}" + (f" {unit}" if unit else "") + in_hertz
    return str(value)


def _consequences(case: Case) -> list[str]:
    shedding, pipe = vortex_shedding(case), case.pipe
    lines = [
        f"  vortices are shed at {shedding.frequency_hz:.4g} Hz, detuning {shedding.detuning:.4g} rad/s",
        f"  lift amplitude {shedding.lift:.4g} N on {pipe.length:.4g} m of pipe",
        *_about_modes(case),
        f"  reduced velocity {shedding.reduced_velocity:.3g}, Reynolds number {shedding.reynolds_number:.3g}",
    ]
    damping = 2 * pipe.damping_ratio * pipe.mass * pipe.frequency
    if damping:
        lift = shedding.lift * pipe.modal.lift_lengths[0] / pipe.length
        lines.append(f"  resonant amplitude without absorbers {lift / (damping * pipe.frequency):.4g} m")
    for absorber in case.absorbers:
        values = absorber.normalised(pipe.mass)
        named = ", ".join(f"{key} {values[key]:.6g}" for key in ("rho2", "kappa", "xi2") if key in values)
        lines.append(f"  {absorber.name}, normalised by the mass of the pipe: {named}")
    return lines


def _about_modes(case: Case) -> Iterator[str]:
    """Frequencies and masses of the modes of an elastic pipe."""
    modal = case.pipe.modal
    if modal.shapes is None:
        return
    yield f"  governing mode: modal mass {modal.masses[0]:.5g} kg, lift on {modal.lift_lengths[0]:.4g} m of its motion"
    named = ", ".join(f"{omega / (2 * math.pi):.4g}" for omega in sorted(modal.frequencies))
    yield f"  natural frequencies {named} Hz"
