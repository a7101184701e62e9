"""How slow an excitation may be for a search: the work of a period grows with its length, and there is no end to it."""

from __future__ import annotations

from frahm.systems import System

_SLOWEST = 1e-3  # of the lowest natural frequency: below it a structure follows its force without inertia
_LEAST = 0.5  # of the upper edge: something is searched whatever was asked


def searched_window(system: System, lo: float, hi: float) -> tuple[float, float, tuple[str, ...]]:
    """The part of a window of Omega [rad/s] that is searched, and a sentence on the rest."""
    positive = system.natural_frequencies[system.natural_frequencies > 0]
    floor = min(_SLOWEST * float(positive[0]), _LEAST * hi) if positive.size else 0.0
    if lo >= floor:
        return lo, hi, ()
    return floor, hi, (
        f"Between {lo:.4g} and {floor:.4g} rad/s nothing was searched: the structure follows so slow a force without"
        " inertia, and the work grows with the length of a period.",
    )  # fmt: skip
