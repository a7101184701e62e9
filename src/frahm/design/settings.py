"""What a design is asked for: frozen, checked settings."""

from __future__ import annotations

import math
from dataclasses import dataclass

from frahm.design.absorber import FAMILIES
from frahm.errors import ParameterError, check_choice, check_count, check_number

_RANGE_UNITS = {"linear": "1/s^2", "kappa": "1/(m^2 s^2)", "xi2": "1/s"}
Range = tuple[float, float]


@dataclass(frozen=True)
class DesignSettings:
    """Settings of `design_absorber`.

    Parameters
    ----------
    mass_ratio : float
        Mass of the absorber over that of the pipe [-].
    family : str
        "sink" (cubic spring alone), "tuned" (linear spring alone) or "mixed" (both).
    scatter : float
        The frequency of the pipe may be off by this fraction either way [-].
    force_margin : float
        Factor on the force up to which no detached response curve may exist [-].
    stroke : float, optional
        Largest displacement allowed between absorber and pipe [m].
    linear, kappa, xi2 : tuple of float, optional
        Ranges (lo, hi) of the parameters, per mass of the pipe; by default wide ones that scale with the pipe.
    samples : int
        Initial states per frequency in the verification.
    seed : int
        Of the samples.
    errors : tuple of float
        Frequencies of the pipe over the nominal one [-] at which all devices are compared, not retuned.
    margins : tuple of float
        Force margins [-] of the trade-off between margin and worst peak.

    Raises
    ------
    ParameterError
        For bad input.
    """

    mass_ratio: float = 0.02
    family: str = "sink"
    scatter: float = 0.0
    force_margin: float = 1.05
    stroke: float | None = None
    linear: Range | None = None
    kappa: Range | None = None
    xi2: Range | None = None
    samples: int = 200
    seed: int = 1
    errors: tuple[float, ...] = (0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15)
    margins: tuple[float, ...] = (1.0, 1.05, 1.1, 1.15, 1.2)

    def __post_init__(self) -> None:
        check_number("mass_ratio", self.mass_ratio, above=0, at_most=1)
        check_choice("family", self.family, FAMILIES)
        check_number("scatter", self.scatter, at_least=0, at_most=0.5)
        check_number("force_margin", self.force_margin, at_least=1, at_most=3)
        if self.stroke is not None:
            check_number("stroke", self.stroke, above=0, unit="m")
        for name, unit in _RANGE_UNITS.items():
            given = getattr(self, name)
            if given is not None:
                object.__setattr__(self, name, _checked_range(name, given, unit))
        check_count("samples", self.samples, at_most=1_000_000)
        check_count("seed", self.seed, at_least=0)
        for index, error in enumerate(self.errors):
            check_number(f"errors[{index}]", error, at_least=0.5, at_most=1.5)
        for index, margin in enumerate(self.margins):
            check_number(f"margins[{index}]", margin, at_least=1, at_most=3)


def _checked_range(name: str, given: Range, unit: str) -> Range:
    allowed = f"two numbers (lo, hi) with 0 <= lo < hi [{unit}]"
    try:
        lo, hi = given
    except (TypeError, ValueError):
        raise ParameterError(name, given, allowed) from None
    lo, hi = (
        check_number(f"{name}[0]", lo, at_least=0, unit=unit),
        check_number(f"{name}[1]", hi, at_least=0, unit=unit),
    )
    if not lo < hi or not math.isfinite(hi):
        raise ParameterError(name, (lo, hi), allowed)
    return lo, hi
