"""Cross-wind vibration after annex E of EN 1991-1-4.

What was read where is said in `METHOD_1`: the standard itself was not at hand.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from frahm.errors import check_number

METHOD_1 = (
    "partly secondary",
    "annex E.1.5.2; c_lat,0, L_j, K, and K_w of the cantilever with its limit 0.6 read in public code (E. Simon, RWTH "
    "Aachen, 2025), K_w of other shapes quoted from memory",
)
_ITERATIONS = 200


def eurocode_amplitude(
    scruton: float,
    strouhal: float,
    lift_coefficient: float,
    *,
    load_factor: float = 1.0,
    correlation: Callable[[float], float] | None = None,
) -> tuple[float, float]:
    """A/D = K K_w c_lat / (St^2 Sc) of method 1 of EN 1991-1-4, iterated over the correlation length.

    Parameters
    ----------
    scruton : float
        Sc = K_s [-].
    strouhal : float
        St [-].
    lift_coefficient : float
        c_lat [-].
    load_factor : float
        g = int |phi| / int phi^2; K = g / (4 pi).
    correlation : callable, optional
        K_w <= 1 as a function of A/D that does not fall, such as `Antinodes.correlation_factor`; 1 by default.

    Returns
    -------
    (float, float)
        A/D [-] and K_w [-] at it. Where the iteration has more than one end, the largest; infinite without damping.
    """
    Sc = check_number("scruton", scruton, at_least=0)
    Kw = correlation or (lambda ratio: 1.0)
    if Sc == 0:
        return math.inf, Kw(1.0)
    scale = load_factor * lift_coefficient / (4 * math.pi * check_number("strouhal", strouhal, above=0) ** 2 * Sc)
    ratio = scale  # from above: K_w grows with the amplitude, so the largest solution is met first
    for _ in range(_ITERATIONS):
        new = scale * Kw(ratio)
        if abs(new - ratio) <= 1e-14 * ratio:
            break
        ratio = new
    return ratio, Kw(ratio)
