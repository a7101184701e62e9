"""Annotations of the fields of a case: the unit, the bounds, and how a value comes in."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from frahm.errors import ParameterError, check_count, check_number, nearest, printable
from frahm.units import si_value, with_unit

_HIGHEST_POWER = 15
_SMALLEST, _LARGEST = 1e-30, 1e30  # in SI units: products of a few such numbers neither overflow nor vanish
_NOT_IN_A_LINE = ("Cc", "Cs", "Zl", "Zp")  # control characters, halves of a pair, line and paragraph separators
_TURNING = ("LRE", "RLE", "LRO", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI")  # what changes the direction of the text


def refusal(
    allowed: str, *, hint: str | None = None, path: str | None = None, value: Any = None, also: Sequence[str] = ()
) -> PydanticCustomError:
    """Return the error a validator raises; `path` and `value` name another field than the one validated."""
    # Half a character of a file that is quoted would stop the library that carries the error.
    hint = hint and printable(hint)
    context = {"allowed": printable(allowed), "hint": hint, "path": path, "given": value, "also": also}
    return PydanticCustomError("parameter", "{allowed}", context)


@dataclass(frozen=True)
class FieldType:
    """How a field comes in; its subclasses say what is let in."""

    @property
    def unit(self) -> str:
        """SI unit, empty where there is none."""
        return ""

    @property
    def allowed(self) -> str:
        """What is let in, as the end of the sentence "allowed: ..."."""
        raise NotImplementedError

    def read(self, value: Any) -> Any:
        """Value as the case keeps it, or the refusal."""
        raise NotImplementedError

    def json_schema(self) -> dict[str, Any]:
        """JSON schema of what is let in."""
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return self.json_schema()


@dataclass(frozen=True)
class Quantity(FieldType):
    """A physical quantity: a finite number in the SI unit, or text with a unit.

    Parameters
    ----------
    si : str
        SI unit the case keeps; empty for a plain number [-].
    symbol : str
        Symbol in the formulas.
    above, at_least, below, at_most : float
        Bounds in the SI unit.
    """

    si: str
    symbol: str = ""
    above: float = -math.inf
    at_least: float = -math.inf
    below: float = math.inf
    at_most: float = math.inf

    @property
    def unit(self) -> str:
        """SI unit."""
        return self.si

    @property
    def allowed(self) -> str:
        """What is let in."""
        return with_unit(self.si).replace("a number", "a finite number").replace("],", f"]{self._bounds},", 1)

    @property
    def _bounds(self) -> str:
        pairs = ((">", self.above), (">=", self.at_least), ("<", self.below), ("<=", self.at_most))
        named = [f"{sign} {bound:g}" for sign, bound in pairs if math.isfinite(bound)]
        return " " + " and ".join(named) if named else ""

    def read(self, value: Any) -> float:
        """Value in the SI unit."""
        try:
            number = si_value(value, self.si) if isinstance(value, str) else value
            checked = check_number(
                "value", number, above=self.above, at_least=self.at_least, below=self.below, at_most=self.at_most
            )
        except ParameterError as error:
            raise refusal(self.allowed, hint=error.hint) from None
        if checked and not _SMALLEST <= abs(checked) <= _LARGEST:
            raise refusal(self.allowed, hint=f"A size beyond {_SMALLEST:g} ... {_LARGEST:g} can only be a mistake.")
        return checked + 0.0  # so that -0 and 0 are one case

    def json_schema(self) -> dict[str, Any]:
        """JSON schema: the number with its bounds, or text with a unit."""
        keys = {"exclusiveMinimum": self.above, "minimum": self.at_least}
        keys |= {"exclusiveMaximum": self.below, "maximum": self.at_most}
        number = {"type": "number"} | {key: bound for key, bound in keys.items() if math.isfinite(bound)}
        text = {"type": "string", "pattern": r"^\s*[-+]?[0-9.]+([eE][-+]?[0-9]+)?\s*[^\s0-9.eE+-].*$"}
        more = {"symbol": self.symbol} if self.symbol else {}
        return {"anyOf": [number, text], "unit": self.si or "-", **more}


@dataclass(frozen=True)
class QuantityOrNothing(Quantity):
    """A quantity that may be left unsaid: null is let in too."""

    @property
    def allowed(self) -> str:
        """What is let in."""
        return super().allowed + "; or nothing"

    def read(self, value: Any) -> Any:
        """Value in the SI unit, or None."""
        return None if value is None else super().read(value)

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        schema = super().json_schema()
        return schema | {"anyOf": [*schema["anyOf"], {"type": "null"}]}


@dataclass(frozen=True)
class Range(Quantity):
    """Two quantities of one kind, the lower first; or nothing."""

    @property
    def allowed(self) -> str:
        """What is let in."""
        return f"two numbers (lo, hi) with lo < hi, each {super().allowed}; or nothing"

    def read(self, value: Any) -> Any:
        """Both ends in the SI unit, or None."""
        if value is None:
            return None
        if isinstance(value, str) or not hasattr(value, "__len__") or len(value) != 2:
            raise refusal(self.allowed)
        lo, hi = (super(Range, self).read(end) for end in value)
        if not lo < hi:
            raise refusal(self.allowed)
        return lo, hi

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        ends = {"type": "array", "minItems": 2, "maxItems": 2, "items": super().json_schema()}
        return {"anyOf": [ends, {"type": "null"}]}


@dataclass(frozen=True)
class QuantityList(Quantity):
    """A list of quantities of one kind."""

    shortest: int = 1
    longest: int = 10_000

    @property
    def allowed(self) -> str:
        """What is let in."""
        return f"a list of {self.shortest} to {self.longest} numbers, each " + super().allowed

    def read(self, value: Any) -> Any:
        """Values in the SI unit."""
        if not isinstance(value, list | tuple) or not self.shortest <= len(value) <= self.longest:
            raise refusal(self.allowed)
        return tuple(super(QuantityList, self).read(0.0 if _vanishes(item) else item) for item in value)

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        return {"type": "array", "minItems": self.shortest, "maxItems": self.longest, "items": super().json_schema()}


def _vanishes(value: Any) -> bool:
    """Whether an entry of a list is what another program writes for zero."""
    return isinstance(value, float) and abs(value) < _SMALLEST


@dataclass(frozen=True)
class Count(FieldType):
    """A whole number, or one of a few words."""

    at_least: int = 1
    at_most: int = 2**31 - 1
    words: tuple[str, ...] = ()

    @property
    def allowed(self) -> str:
        """What is let in."""
        words = "".join(f", or {word!r}" for word in self.words)
        return f"a whole number >= {self.at_least} and <= {self.at_most}{words}"

    def read(self, value: Any) -> int | str:
        """Value as an integer, or the word."""
        if isinstance(value, str) and value in self.words:
            return value
        try:
            return check_count("value", value, at_least=self.at_least, at_most=self.at_most)
        except ParameterError:
            raise refusal(self.allowed) from None

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        number = {"type": "integer", "minimum": self.at_least, "maximum": self.at_most}
        return {"anyOf": [number, {"enum": list(self.words)}]} if self.words else number


@dataclass(frozen=True)
class Label(FieldType):
    """One line of text."""

    shortest: int = 0
    longest: int = 200

    @property
    def allowed(self) -> str:
        """What is let in."""
        return f"one line of text, {self.shortest} to {self.longest} characters"

    def read(self, value: Any) -> str:
        """Text without blanks around it."""
        text = value.strip() if isinstance(value, str) else ""
        broken = any(
            unicodedata.category(letter) in _NOT_IN_A_LINE or unicodedata.bidirectional(letter) in _TURNING
            for letter in text
        )
        if not isinstance(value, str) or broken or not self.shortest <= len(text) <= self.longest:
            number = isinstance(value, int | float) and not isinstance(value, bool)
            raise refusal(self.allowed, hint=f'Put it in quotes: "{value}".' if number else None)
        return text

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        return {"type": "string", "minLength": self.shortest, "maxLength": self.longest}


@dataclass(frozen=True)
class Choice(FieldType):
    """One of a few words."""

    words: tuple[str, ...]

    @property
    def allowed(self) -> str:
        """What is let in."""
        return "one of " + ", ".join(self.words)

    def read(self, value: Any) -> str:
        """Return the word."""
        if isinstance(value, str) and value in self.words:
            return value
        near = nearest(value, self.words) if isinstance(value, str) else None
        raise refusal(self.allowed, hint=f"Did you mean {near!r}?" if near else None)

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        return {"enum": list(self.words)}


@dataclass(frozen=True)
class Coefficients(FieldType):
    """Coefficients of a spring polynomial: c_1 [N/m], c_2 [N/m^2], ... ."""

    @property
    def unit(self) -> str:
        """SI units."""
        return "N/m, N/m^2, ..."

    @property
    def allowed(self) -> str:
        """What is let in."""
        return f"a list of 1 to {_HIGHEST_POWER} finite numbers [N/m, N/m^2, ...], or texts with a unit"

    def read(self, value: Any) -> tuple[float, ...]:
        """Coefficients in SI units, from the linear one upwards."""
        if not isinstance(value, list | tuple) or not 1 <= len(value) <= _HIGHEST_POWER:
            raise refusal(self.allowed)
        return tuple(_power(k).read(item) for k, item in enumerate(value, start=1))

    def json_schema(self) -> dict[str, Any]:
        """JSON schema."""
        item = {"anyOf": [{"type": "number"}, {"type": "string"}]}
        return {"type": "array", "minItems": 1, "maxItems": _HIGHEST_POWER, "items": item, "unit": self.unit}


def _power(k: int) -> Quantity:
    return Quantity("N/m" if k == 1 else f"N/m^{k}", symbol=f"c_{k}")
