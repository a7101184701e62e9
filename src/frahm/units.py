"""Units at the door: a plain number is SI, text is a number with its unit.

Inside the package everything is SI, and frequencies are angular [rad/s]. One registry reads the text, with
1 Hz = 2 pi rad/s; it takes half a second to create, and is created when a unit is met that is not among the commonest.
"""

from __future__ import annotations

import contextlib
import functools
import math
import re
from typing import Any

from frahm.errors import ParameterError, nearest

_NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_QUANTITY = re.compile(rf"({_NUMBER})(.*)", re.DOTALL)
_TERM = r"\(*(?:1|%|[^\W\d]+°?(?:(?:\^|\*\*)-?[1-9]|[²³⁴])?)\)*"
# Only names, products, quotients and one-digit powers reach the parser of the registry: it would evaluate 9**9**9.
_UNIT = re.compile(rf"{_TERM}(?:[*/· ]{_TERM})*")
_DECIMAL_COMMA = re.compile(r"[-+]?[0-9]*,[0-9]+(?:[eE][-+]?[0-9]+)?(?=[^0-9,.]|$)")
_POWER = re.compile(r"(?<=[^\W\d_])(-?[1-9])(?![0-9.])")  # of the conventions for netCDF: m s-1 is m*s^-1
_LONGEST = 80
MPA = 1e6  # [Pa]
_COMMON = {("mm", "m"): 1e-3, ("Hz", "rad/s"): 2 * math.pi}  # factors, to the last bit those of the registry

# Units that keep their name where others would become products of kg, m and s; the radian is kept apart from 1.
_DERIVED = ("", "s", "m", "m/s", "m/s^2", "N", "Pa", "rad/s", "kg", "rad", "N/m", "N m", "W", "V", "N/m^3", "N s/m")

_FAMILIAR = {
    "rad/s": ("Hz", "rad/s", "rpm", "rad/min", "deg/s", "cycle/s"),
    "m": ("m", "mm", "cm", "inch", "ft"),
    "kg": ("kg", "g", "t", "lb"),
    "m/s": ("m/s", "km/h", "knot", "mph", "ft/s"),
    "N/m": ("N/m", "kN/m", "N/mm"),
    "N/m^3": ("N/m^3", "kN/m^3", "N/mm^3"),
    "N s/m": ("N s/m", "kN s/m", "N s/mm"),
    "kg/m^3": ("kg/m^3", "g/cm^3"),
    "s": ("year", "day", "h", "s"),
    "rad": ("deg", "rad"),
    "Pa/m": ("MPa/m", "GPa/m", "Pa/m"),
    "": ("%",),
}


def si_value(value: str, unit: str, *, name: str = "value") -> float:
    """Return text with a unit as a number in the SI unit wanted.

    Parameters
    ----------
    value : str
        A number and its unit, such as ``"0.78 Hz"``.
    unit : str
        SI unit of the result, such as ``"rad/s"``; empty for a plain number [-].
    name : str
        What the value is called in an error message.

    Returns
    -------
    float
        The value in `unit`.

    Raises
    ------
    ParameterError
        If the text is not a number with a unit, the unit is unknown, or it measures something else. A frequency
        in ``1/s`` is refused, because it does not say whether turns or radians are counted.

    Notes
    -----
    Units are written as in ``kN/m^3``, or with powers as in ``N m-3`` (UDUNITS, which netCDF files use).
    """
    number, unit_text = _split(value, unit, name)
    if not unit_text:
        way_out = f"Write {number:g} without quotes" + (f" for {number:g} {unit}, or add the unit." if unit else ".")
        raise ParameterError(name, value, with_unit(unit), hint=way_out)
    converted = _convert(number, unit_text, unit, name, value)
    if not math.isfinite(converted):
        raise ParameterError(name, value, with_unit(unit))
    return converted


def to_si(unit: str) -> tuple[float, str]:
    """Factor that brings values in a unit into SI, and the SI unit they are in then.

    Parameters
    ----------
    unit : str
        As in ``kN/m^3`` or ``kN m-3``; nothing, "1" and "-" are no unit.

    Returns
    -------
    factor : float
    si : str
        "1" without a unit. A unit that is not known, or whose zero is not zero (degrees Celsius), stays as it is.
    """
    if unit in ("", "-", "1"):
        return 1.0, "1"
    if unit in _DERIVED:
        return 1.0, unit
    for si in _DERIVED:
        with contextlib.suppress(ParameterError):
            return si_value(f"1 {unit}", si), si or "1"
    plain = _plain(unit)
    if not is_unit(unit):
        return 1.0, unit
    registry = _registry()
    given = registry.parse_units(plain)
    base = registry.get_base_units(given, system="mks")[1]
    if registry.convert(0.0, given, base) != 0:
        return 1.0, unit
    return float(registry.convert(1.0, given, base)), f"{base:~C}".replace("**", "^") or "1"


def is_unit(text: str) -> bool:
    """Whether a text is a unit of any kind."""
    plain = _plain(text) if len(text) <= _LONGEST else ""
    if not _UNIT.fullmatch(plain):
        return False
    try:
        _registry().parse_units(plain)
    except Exception:  # the registry raises a dozen unrelated types for text that is no unit
        return False
    return True


def with_unit(unit: str) -> str:
    """Say what a field of the SI unit accepts, as the end of the sentence "allowed: ..."."""
    known = _FAMILIAR.get(unit, (unit,))
    return f"a number [{unit or '-'}], or text with a unit such as {', '.join(known[:4])}"


def _split(value: Any, unit: str, name: str) -> tuple[float, str]:
    text = " ".join(str(value).replace("\N{MINUS SIGN}", "-").split()) if len(value) <= _LONGEST else ""
    found = _QUANTITY.fullmatch(text)
    comma = _DECIMAL_COMMA.match(text)
    if comma:
        hint = f"Write a point as decimal sign: {text.replace(',', '.', 1)!r}."
        raise ParameterError(name, value, with_unit(unit), hint=hint)
    if found is None:
        raise ParameterError(name, value, with_unit(unit))
    return float(found[1]), _plain(found[2])


def _plain(unit_text: str) -> str:
    """A unit without needless blanks and with signs for its powers and products."""
    text = re.sub(r" ?(\*\*|[*/·^()]) ?", r"\1", unit_text.strip())
    return re.sub(r"(?<=\w)\.(?=[^\W\d])", "*", _POWER.sub(r"^\1", text))


def _convert(number: float, unit_text: str, unit: str, name: str, value: str) -> float:
    if unit and unit_text == unit:
        return number
    if (unit_text, unit) in _COMMON:
        return number * _COMMON[unit_text, unit]
    return _by_registry(number, unit_text, unit, name, value)


def _by_registry(number: float, unit_text: str, unit: str, name: str, value: str) -> float:
    registry = _registry()
    try:
        if not _UNIT.fullmatch(unit_text):
            raise ValueError(unit_text)
        given = registry.parse_units(unit_text)
        wanted = registry.parse_units(unit.replace(" ", "*"))
        # Radians are dimensionless to the registry: comparing root units keeps 1/s apart from rad/s.
        same = registry.get_root_units(given)[1] == registry.get_root_units(wanted)[1]
        if same and registry.convert(0.0, given, wanted) == 0:
            return float(registry.convert(number, given, wanted))
    except Exception:  # the registry raises a dozen unrelated types for text that is no unit
        known = _FAMILIAR.get(unit, (unit,))
        near = {unit.lower(): unit for unit in known}.get(unit_text.lower()) or nearest(unit_text, known)
        hint = f"Unknown unit {unit_text!r}." + (f" Did you mean {near!r}?" if near else "")
        raise ParameterError(name, value, with_unit(unit), hint=hint) from None
    measure = "turns or radians per second" if unit_text in ("1/s", "s^-1") and unit == "rad/s" else f"[{unit or '-'}]"
    raise ParameterError(name, value, with_unit(unit), hint=f"{unit_text!r} does not measure {measure}.")


@functools.cache
def _registry() -> Any:
    from pathlib import Path

    import pint

    # Loaded by hand, because a registry fills its conversion tables when it is created: a later definition of
    # the hertz would reach only some of them.
    registry: Any = pint.UnitRegistry(None, on_redefinition="ignore")
    registry.load_definitions(Path(pint.__file__).with_name("default_en.txt"))
    registry.define("hertz = 2 * pi * radian / second = Hz")
    registry.define("@alias revolution = rev")
    return registry
