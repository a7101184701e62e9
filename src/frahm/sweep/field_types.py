"""How the values of a study come in: axes, the place on the frequency axis, and the case it starts from."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pydantic_core import PydanticCustomError

from frahm.case import Case, builtin_names, case_schema, load_case
from frahm.case.quantities import Count, FieldType, Quantity, refusal
from frahm.case.table_files import beside
from frahm.errors import ParameterError, nearest

_SPAN = ("from", "to", "count", "spacing")
_SPACINGS = ("linear", "log")
_DIGITS = 12  # of a value between the ends: the same study on every machine
WINDOW, WIND = "window", "wind"


@dataclass(frozen=True)
class AxisValues(Quantity):
    """The values of an axis: a list, or from where to where in how many steps."""

    name: str = ""
    longest: int = 100_000

    @property
    def allowed(self) -> str:
        """What is let in."""
        return (
            "a list of different values, or {from: ..., to: ..., count: ..., spacing: linear or log}; each value "
            + super().allowed
        )

    def read(self, value: Any) -> Any:
        """Values in the SI unit."""
        if isinstance(value, Mapping):
            return self._span(value)
        if not isinstance(value, list | tuple | np.ndarray) or not 1 <= len(value) <= self.longest:
            raise refusal(self.allowed)
        values: list[float] = []
        for index, item in enumerate(value):
            number = self._number(item, f"[{index}]")
            if number in values:
                raise refusal("a value the axis does not have yet", path=self._path(f"[{index}]"), value=item)
            values.append(number)
        return tuple(values)

    def json_schema(self) -> dict[str, Any]:
        """JSON schema: a list, or a span."""
        item = super().json_schema()
        span = {
            "type": "object",
            "properties": {
                "from": item, "to": item, "count": Count(at_least=2, at_most=self.longest).json_schema(),
                "spacing": {"enum": list(_SPACINGS)},
            },
            "required": ["from", "to", "count"],
            "additionalProperties": False,
        }  # fmt: skip
        listed = {"type": "array", "items": item, "minItems": 1, "maxItems": self.longest}
        return {"anyOf": [listed, span], "unit": self.si or "-"}

    def _span(self, span: Mapping[Any, Any]) -> tuple[float, ...]:
        for key in span:
            if key not in _SPAN:
                near = nearest(str(key), _SPAN)
                hint = f"Did you mean {near!r}?" if near else None
                allowed = "no such field here, only " + ", ".join(_SPAN)
                raise refusal(allowed, hint=hint, path=self._path(f".{key}"), value=span[key])
        for key in ("from", "to", "count"):
            if key not in span:
                raise refusal(f"a span that says {key}", path=self._path(""), value=dict(span))
        lo, hi = (self._number(span[key], f".{key}") for key in ("from", "to"))
        count = self._count(span["count"])
        spacing = span.get("spacing", "linear")
        if spacing not in _SPACINGS:
            raise refusal("one of " + ", ".join(_SPACINGS), path=self._path(".spacing"), value=spacing)
        if lo == hi:
            raise refusal("another value than that of from", path=self._path(".to"), value=span["to"])
        if spacing == "log" and not (lo > 0 and hi > 0):
            end = "from" if lo <= 0 else "to"
            raise refusal("above zero where the spacing is log", path=self._path(f".{end}"), value=span[end])
        between = np.geomspace(lo, hi, count) if spacing == "log" else np.linspace(lo, hi, count)
        values = (lo, *(float(f"{number:.{_DIGITS}g}") for number in between[1:-1]), hi)
        if len(set(values)) < count:
            raise refusal("ends further apart: the values in between are not different", path=self._path(""))
        return values

    def _number(self, item: Any, where: str) -> float:
        try:
            return super().read(item)
        except PydanticCustomError as error:
            context = error.context or {}
            raise refusal(super().allowed, hint=context.get("hint"), path=self._path(where), value=item) from None

    def _count(self, value: Any) -> int:
        door = Count(at_least=2, at_most=self.longest)
        try:
            return int(door.read(value))
        except PydanticCustomError:
            raise refusal(door.allowed, path=self._path(".count"), value=value) from None

    def _path(self, below: str) -> str:
        return f"axes.{self.name}{below}"


@dataclass(frozen=True)
class WholeAxisValues(AxisValues):
    """The values of an axis of whole numbers."""

    @property
    def allowed(self) -> str:
        """What is let in."""
        return super().allowed + ", whole"

    def read(self, value: Any) -> Any:
        """Whole values."""
        values = super().read(value)
        for index, number in enumerate(values):
            if number != int(number):
                raise refusal(self.allowed, path=self._path(f"[{index}]"), value=number)
        return values


@dataclass(frozen=True)
class Place(FieldType):
    """Where on the frequency axis: at a detuning, over a window of it, or as the wind has it."""

    @property
    def unit(self) -> str:
        """SI unit."""
        return "rad/s"

    @property
    def allowed(self) -> str:
        """What is let in."""
        return (
            f"a number [rad/s] or text with a unit, two of them [lo, hi] with lo < hi, {WINDOW!r} (that of the case), "
            f"or {WIND!r} (where the wind sheds)"
        )

    def read(self, value: Any) -> Any:
        """Detuning, window or word."""
        if value in (WINDOW, WIND):
            return value
        number = Quantity("rad/s", "sigma")
        try:
            if not isinstance(value, list | tuple):
                return number.read(value)
            lo, hi = (number.read(item) for item in value)
        except (ValueError, TypeError):
            near = nearest(value, (WINDOW, WIND)) if isinstance(value, str) else None
            raise refusal(self.allowed, hint=f"Did you mean {near!r}?" if near else None) from None
        if not lo < hi:
            raise refusal(self.allowed)
        return lo, hi

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        number = Quantity("rad/s").json_schema()
        pair = {"type": "array", "items": number, "minItems": 2, "maxItems": 2}
        return {"anyOf": [*number["anyOf"], pair, {"enum": [WINDOW, WIND]}], "unit": "rad/s"}


@dataclass(frozen=True)
class BaseCase(FieldType):
    """The case a study starts from: a name, a file beside that of the study, or the case itself."""

    @property
    def allowed(self) -> str:
        """What is let in."""
        return f"the name of a built-in case ({', '.join(builtin_names())}), a file of a case, or a case written here"

    def read(self, value: Any) -> Case:
        """Validated case."""
        if isinstance(value, Mapping):
            return _written_here(value)
        if isinstance(value, Case):
            return value
        if not isinstance(value, str | os.PathLike):
            raise refusal(self.allowed)
        try:
            return load_case(value if value in builtin_names() else beside(Path(value)))
        except ParameterError as error:
            if error.where is not None:
                first, *more = str(error).splitlines()
                allowed = "a case without mistakes"
                raise refusal(allowed, hint=first, value=str(value), path="case", also=more) from None
            raise refusal(self.allowed, hint=error.hint, value=str(value), path="case") from None

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        schema = {key: entry for key, entry in case_schema().items() if key not in ("$schema", "$defs")}
        return {"anyOf": [{"type": "string"}, {"type": "object", "required": schema.get("required", [])}]}


def _written_here(value: Mapping[Any, Any]) -> Case:
    try:
        return load_case(value)
    except ParameterError as error:
        path = "case" if error.name == "case" else f"case.{error.name}"
        raise refusal(error.allowed, hint=error.hint, path=path, value=error.value, also=error.also) from None


def is_window(place: Any) -> bool:
    """Whether a place is a range of detuning."""
    return place == WINDOW or isinstance(place, tuple)
