"""DNV-RP-C203 (edition of April 2016), S-N curves in air, as data.

Standing: m, log a, the limit at 1e7 cycles and the thickness exponents are those of Table 2-1 as the notebook of the
open package fatpack reproduces it; the standard itself was not at hand. Reference thicknesses, the exponent .30 of the
T curve and the usual design fatigue factors are secondary: quoted from elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats
from frahm.errors import check_choice, check_number
from frahm.units import MPA

SOURCE = "DNV-RP-C203 (April 2016), Table 2-1, S-N curves in air, as reproduced in the notebook of fatpack"
KNEE_CYCLES = 1e7
REFERENCE_THICKNESS = 0.025  # [m], secondary; 0.016 for tubular joints, secondary
_HIGH_CONCENTRATION = 10.0  # above it the T curve takes the exponent .30, secondary


@dataclass(frozen=True)
class SNCurve:
    """log10 N = log a - m log10(S), S in MPa, with one slope above and one below the limit at 1e7 cycles.

    Attributes
    ----------
    name : str
    m1, log_a1 : float
        Above the limit, for fewer than 1e7 cycles; S in MPa.
    m2, log_a2 : float
        Below the limit.
    limit : float
        Stress range printed for 1e7 cycles [Pa]. The two lines do not meet there to the last digit, as printed: the
        step in N is .8 % for the T curve and below .2 % for the others.
    thickness_exponent : float
        k of the factor (t/t_ref)^k on the stress range.
    """

    name: str
    m1: float
    log_a1: float
    m2: float
    log_a2: float
    limit: float
    thickness_exponent: float

    def cycles(self, stress_range: ArrayLike) -> Floats:
        """Cycles to failure N [-] of stress ranges [Pa], any shape; infinite for a range of zero."""
        S = np.asarray(stress_range, dtype=float) / MPA
        with np.errstate(divide="ignore"):
            upper, lower = 10**self.log_a1 * S**-self.m1, 10**self.log_a2 * S**-self.m2
        return np.where(self.limit <= S * MPA, upper, lower)

    def thickness_factor(
        self, thickness: float, reference: float = REFERENCE_THICKNESS, concentration: float = 1.0
    ) -> float:
        """Factor (t/t_ref)^k >= 1 on the stress range.

        Parameters
        ----------
        thickness, reference : float
            t and t_ref [m]; a thinner wall than t_ref counts as t_ref.
        concentration : float
            Stress concentration factor: above 10 the T curve has k = .30 (secondary).
        """
        t = check_number("thickness", thickness, above=0, unit="m")
        t_ref = check_number("reference", reference, above=0, unit="m")
        k = 0.30 if self.name == "T" and concentration > _HIGH_CONCENTRATION else self.thickness_exponent
        return max(t / t_ref, 1.0) ** k


def _curve(name: str, m1: float, log_a1: float, log_a2: float, limit: float, k: float) -> SNCurve:
    return SNCurve(name, m1, log_a1, 5.0, log_a2, limit * MPA, k)


SN_CURVES = {
    curve.name: curve
    for curve in (
        _curve("B1", 4.0, 15.117, 17.146, 106.97, 0.0),
        _curve("B2", 4.0, 14.885, 16.856, 93.59, 0.0),
        _curve("C", 3.0, 12.592, 16.320, 73.10, 0.05),
        _curve("C1", 3.0, 12.449, 16.081, 65.50, 0.10),
        _curve("C2", 3.0, 12.301, 15.835, 58.48, 0.15),
        _curve("D", 3.0, 12.164, 15.606, 52.63, 0.20),
        _curve("E", 3.0, 12.010, 15.350, 46.78, 0.20),
        _curve("F", 3.0, 11.855, 15.091, 41.52, 0.25),
        _curve("F1", 3.0, 11.699, 14.832, 36.84, 0.25),
        _curve("F3", 3.0, 11.546, 14.576, 32.75, 0.25),
        _curve("G", 3.0, 11.398, 14.330, 29.24, 0.25),
        _curve("W1", 3.0, 11.261, 14.101, 26.32, 0.25),
        _curve("W2", 3.0, 11.107, 13.845, 23.39, 0.25),
        _curve("W3", 3.0, 10.970, 13.617, 21.05, 0.25),
        _curve("T", 3.0, 12.480, 16.130, 67.09, 0.25),
    )
}


def sn_curve(name: str) -> SNCurve:
    """S-N curve by its name; an unknown name is refused with the nearest one named."""
    return SN_CURVES[check_choice("curve", name, tuple(SN_CURVES))]
