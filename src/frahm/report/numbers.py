"""Numbers as text ready to be read."""

from __future__ import annotations

import math
from typing import Any

_PLAIN = 6  # a number below ten to this power is written out


def number(value: Any, digits: int = 4) -> str:
    """A number for people; what is not known is a dash."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "-"
    if not isinstance(value, float):
        return str(value)
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return text
    mantissa, exponent = text.split("e")
    return f"{float(text):.0f}" if 0 <= int(exponent) < _PLAIN else f"{mantissa}e{int(exponent)}"
