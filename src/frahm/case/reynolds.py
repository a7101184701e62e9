"""Coefficients of the flow in a case: a number, a table over the Reynolds number, or a published curve by its name."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from frahm.case.quantities import FieldType, Quantity, refusal
from frahm.errors import ParameterError, check_number, nearest

Coefficient = float | tuple[tuple[float, float], ...] | str
_MOST_PAIRS = 200


@dataclass(frozen=True)
class PublishedCurve:
    """A curve over the Reynolds number that somebody published.

    Attributes
    ----------
    pairs : tuple of (float, float)
        Reynolds number and value [-]; the value is linear in log Re between pairs, constant left of the first one.
    range : (float, float)
        Reynolds numbers the source gives it for; beyond them it is not used.
    standing : str
        "verified": read in the source named; "secondary": quoted from elsewhere.
    source : str
        Where it comes from.
    """

    pairs: tuple[tuple[float, float], ...]
    range: tuple[float, float]
    standing: str
    source: str


_FACCHINETTI = "Facchinetti, de Langre and Biolley, J. Fluids Struct. 19 (2004) 123-140"

STROUHAL_CURVES = {
    "facchinetti2004": PublishedCurve(((300.0, 0.20),), (300.0, 1.5e5), "verified", _FACCHINETTI),
    "en1991": PublishedCurve(((1.0, 0.18),), (0.0, math.inf), "secondary", "EN 1991-1-4, circular cylinders"),
}
LIFT_CURVES = {
    "facchinetti2004": PublishedCurve(((300.0, 0.3),), (300.0, 1.5e5), "verified", _FACCHINETTI),
    "en1991": PublishedCurve(
        ((3e5, 0.70), (5e5, 0.20), (5e6, 0.20), (1e7, 0.30)), (0.0, 1e7), "verified",
        "EN 1991-1-4, basic lateral force coefficient c_lat,0, read in public code that implements it",
    ),
}  # fmt: skip


@dataclass(frozen=True)
class FlowCoefficient(FieldType):
    """A number, pairs of Reynolds number and number, or the name of a published curve.

    Parameters
    ----------
    number : Quantity
        What the numbers may be.
    curves : tuple of str
        Names of the published curves.
    """

    number: Quantity
    curves: tuple[str, ...]

    @property
    def symbol(self) -> str:
        """Symbol in the formulas."""
        return self.number.symbol

    @property
    def allowed(self) -> str:
        """What is let in."""
        return (
            f"{self.number.allowed}; or a list of pairs [Reynolds number, value] in ascending order; "
            f"or one of {', '.join(self.curves)}"
        )

    def read(self, value: Any) -> Coefficient:
        """Number, pairs or name."""
        if isinstance(value, str) and value in self.curves:
            return value
        if isinstance(value, Mapping):
            value = [[_number(key), entry] for key, entry in value.items()]
        if isinstance(value, list | tuple):
            return self._pairs(value)
        try:
            return self.number.read(value)
        except ValueError:
            near = nearest(value, self.curves) if isinstance(value, str) else None
            raise refusal(self.allowed, hint=f"Did you mean {near!r}?" if near else None) from None

    def _pairs(self, given: Any) -> tuple[tuple[float, float], ...]:
        if not 2 <= len(given) <= _MOST_PAIRS:
            raise refusal(self.allowed, hint=f"A table has 2 to {_MOST_PAIRS} pairs.")
        pairs: list[tuple[float, float]] = []
        for place, entry in enumerate(given):
            if not isinstance(entry, list | tuple) or len(entry) != 2:
                raise refusal(self.allowed, hint=f"Entry {place} is {entry!r}, not a pair.")
            try:
                reynolds = check_number("Reynolds number", entry[0], above=0, at_most=1e12)
                pairs.append((reynolds, self.number.read(entry[1])))
            except ParameterError as error:
                raise refusal(self.allowed, hint=f"Entry {place}: {error}.") from None
            except ValueError:
                raise refusal(self.allowed, hint=f"Entry {place}: {entry[1]!r} is not such a number.") from None
            if place and not pairs[-1][0] > pairs[-2][0]:
                raise refusal(self.allowed, hint=f"Entry {place}: {reynolds:g} does not ascend.")
        return tuple(pairs)

    def json_schema(self) -> dict[str, Any]:
        """JSON schema: the number, the table, or a name."""
        number = self.number.json_schema()
        reynolds = {"type": "number", "exclusiveMinimum": 0}
        pair = {"type": "array", "prefixItems": [reynolds, {"anyOf": number["anyOf"]}], "minItems": 2, "maxItems": 2}
        table = {"type": "array", "items": pair, "minItems": 2, "maxItems": _MOST_PAIRS}
        mapping = {"type": "object", "additionalProperties": {"anyOf": number["anyOf"]}, "minProperties": 2}
        return number | {"anyOf": [*number["anyOf"], {"enum": list(self.curves)}, table, mapping]}


STROUHAL = FlowCoefficient(Quantity("", "St", above=0), tuple(STROUHAL_CURVES))
LIFT = FlowCoefficient(Quantity("", "C_L", at_least=0), tuple(LIFT_CURVES))


def reynolds_range(value: Coefficient, curves: Mapping[str, PublishedCurve]) -> tuple[float, float]:
    """Lowest and highest Reynolds number a coefficient is given for; (0, inf) for a number."""
    if isinstance(value, str):
        return curves[value].range
    return (value[0][0], value[-1][0]) if isinstance(value, tuple) else (0.0, math.inf)


def _number(key: Any) -> Any:
    """The key of a mapping is text in every file format."""
    try:
        return float(key)
    except (TypeError, ValueError):
        return key
