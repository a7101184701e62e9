"""Numbers as engineers read them: millimetres, megapascals, hertz, hours or years. SI stays everywhere else."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

HOUR, DAY, YEAR = 3600.0, 86_400.0, 365.25 * 86_400.0  # [s]
_MILLE = 1e3
_MOST_LINES, _WIDEST, _FEW = 12, 110, 4  # of an object at a prompt: lines, characters of one, numbers told one by one


def length(value: float) -> str:
    """A displacement [m] in millimetres."""
    return f"{in_mm(value)} mm"


def in_mm(value: float | None) -> str:
    """The number of a displacement [m] in a column of millimetres; a dash for what is not known."""
    return _in_column(value, _MILLE)


def stress(value: float) -> str:
    """A stress [Pa] in megapascals."""
    return f"{in_mpa(value)} MPa"


def in_mpa(value: float | None) -> str:
    """The number of a stress [Pa] in a column of megapascals; a dash for what is not known."""
    return _in_column(value, 1e-6)


def motion(kind: str, multiple: int = 0) -> str:
    """A kind of motion in the one word that people read, and after how many periods it repeats if that is not one.

    A quasi-periodic one is a modulated one.
    """
    word = {"quasi-periodic": "modulated"}.get(kind, kind)
    return f"{word}, {multiple} periods" if multiple > 1 else word


def frequency(value: float) -> str:
    """An angular frequency [rad/s] in hertz."""
    return f"{_digits(value / (2 * math.pi))} Hz"


def duration(value: float) -> str:
    """A time [s] in hours up to a year, then in years."""
    if not math.isfinite(value):
        return "without end"
    return f"{_digits(value / HOUR)} h" if value < YEAR else f"{_digits(value / YEAR)} years"


def speed(value: float) -> str:
    """A wind speed [m/s]."""
    return f"{value:.4g} m/s"


def share(value: float) -> str:
    """A ratio in per cent, or as a multiple where it is large."""
    return f"{value:.0%}" if value < 10 else f"{value:.0f} times"


def _in_column(value: float | None, factor: float) -> str:
    if value is None or math.isnan(value):
        return "-"
    return _digits(factor * value) if math.isfinite(value) else "without bound"


def _digits(value: float) -> str:
    """Three significant digits, without an exponent for sizes people write out."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    places = 2 - math.floor(math.log10(abs(value)))
    return f"{value:.{max(places, 0)}f}" if 1e-4 < abs(value) < 1e7 else f"{value:.3g}"


def summary(thing: Any) -> str:
    """An object made of fields as it is shown at a prompt: a line each, at most twelve; arrays by shape and range."""
    fields = [field.name for field in dataclasses.fields(thing)]
    told = fields if len(fields) < _MOST_LINES else fields[: _MOST_LINES - 2]
    lines = [type(thing).__name__, *(f"{name}: {_brief(getattr(thing, name))}" for name in told)]
    if len(told) < len(fields):
        lines.append(f"and {', '.join(fields[len(told) :])}")
    return "\n  ".join(_cut(line) for line in lines)


def listed(things: Sequence[Any], *sentences: str, name: str = "") -> str:
    """A list with what is said of it, as it is shown at a prompt: how many of what it holds, then a line a sentence."""
    what = f": {_brief(tuple(things))}" if things else "" if name else ": nothing"
    lines = [f"{name or type(things).__name__}{what}", *filter(None, sentences)]
    more = [f"and {len(lines) - _MOST_LINES + 1} more lines"] if len(lines) > _MOST_LINES else []
    return "\n  ".join(_cut(line) for line in [*lines[: _MOST_LINES - len(more)], *more])


def _brief(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if hasattr(value, "shape") and hasattr(value, "dtype") and value.ndim:
        numbers = value.size and value.dtype.kind in "fiu"
        ends = f", {value.min():.4g} ... {value.max():.4g}" if numbers else ""
        return f"array of shape {value.shape}{ends}"
    if isinstance(value, Mapping):
        return f"{len(value)} entries: {', '.join(map(str, value))}" if value else "none"
    if isinstance(value, Sequence) and not isinstance(value, str):
        plain = all(isinstance(item, str | int | float) for item in value)
        if plain and len(value) <= _FEW:
            return f"({', '.join(_brief(item) for item in value)})" if value else "none"
        return f"{len(value)} of {type(value[0]).__name__}"
    return type(value).__name__ if dataclasses.is_dataclass(value) else repr(value)


def _cut(line: str) -> str:
    flat = " ".join(line.split())
    return flat if len(flat) <= _WIDEST else f"{flat[: _WIDEST - 4]} ..."
