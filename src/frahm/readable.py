"""Numbers as engineers read them: millimetres, megapascals, hertz, hours or years. SI stays everywhere else."""

from __future__ import annotations

import math

HOUR, YEAR = 3600.0, 365.25 * 86_400.0  # [s]
_MILLE = 1e3


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
