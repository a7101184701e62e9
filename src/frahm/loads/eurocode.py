"""Cross-wind vibration after annex E of EN 1991-1-4: both methods for the amplitude, and the number of load cycles.

What was read where is said in `METHOD_1`, `METHOD_2` and `CYCLES`: the standard itself was not at hand.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from frahm.case import Case, Weibull
from frahm.errors import check_number
from frahm.loads.similarity import lock_in_band

METHOD_1 = (
    "partly secondary",
    "annex E.1.5.2; c_lat,0, L_j, K, and K_w of the cantilever with its limit 0.6 read in public code (E. Simon, RWTH "
    "Aachen, 2025), K_w of other shapes quoted from memory",
)
METHOD_2 = (
    "secondary",
    "annex E.1.5.3; closed form, K_a,max, a_L and k_p read in two public codes (E. Simon, RWTH Aachen, 2025; "
    "O. M. Ellingsen, 2022), C_c quoted from memory",
)
CYCLES = ("secondary", "annex E.1.5.2.6, quoted from memory; for k = 2 it follows from the Rayleigh distribution")

BAND_WIDTH = 0.3  # eps_0, of the wind speeds that drive the vibration
LEAST_CYCLES = 1e4
LIMITING_DEVIATION = 0.4  # a_L: sigma/b at which the wind no longer takes damping away
_LOG_REYNOLDS = np.log([1e5, 5e5, 1e6])
_STRENGTH = (0.02, 0.005, 0.01)  # C_c
_LARGEST_DAMPING = (2.0, 0.5, 1.0)  # K_a,max
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

    Raises
    ------
    ParameterError
        If a number is out of bounds.
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


@dataclass(frozen=True)
class SpectralAmplitude:
    """Result of method 2 of EN 1991-1-4.

    Attributes
    ----------
    deviation : float
        Standard deviation of the displacement over the diameter, sigma/b, where the pipe moves most [-].
    peak_factor : float
        k_p [-].
    damping : float
        Aerodynamic damping parameter K_a [-]; the pipe locks in where it exceeds Sc/(4 pi).
    """

    deviation: float
    peak_factor: float
    damping: float

    @property
    def ratio(self) -> float:
        """Largest amplitude over diameter, k_p sigma/b [-]."""
        return self.peak_factor * self.deviation


def spectral_amplitude(
    scruton: float, strouhal: float, reynolds: float, mass_ratio: float, slenderness: float
) -> SpectralAmplitude:
    """Method 2 of EN 1991-1-4 (E.1.5.3), the spectral model of Vickery and Basu: a cantilever in its first mode.

    Parameters
    ----------
    scruton : float
        Sc [-].
    strouhal : float
        St [-].
    reynolds : float
        Re at the critical wind speed [-].
    mass_ratio : float
        m_e / (rho b^2) [-].
    slenderness : float
        h/b [-].

    Returns
    -------
    SpectralAmplitude
        (sigma/b)^2 = c_1 + sqrt(c_1^2 + c_2), c_1 = (a_L^2/2) [1 - Sc/(4 pi K_a)],
        c_2 = (a_L^2/K_a) (C_c^2/St^4) (rho b^2/m_e) (b/h); k_p = sqrt(2) {1 + 1.2 arctan[0.75 (Sc/(4 pi K_a))^4]}.

    Raises
    ------
    ParameterError
        If a number is out of bounds.

    Notes
    -----
    K_a is K_a,max, that of a wind without turbulence, which is the safe side. C_c (0.02, 0.005, 0.01) and K_a,max (2,
    0.5, 1) are linear in ln Re between Re = 1e5, 5e5 and 1e6 and constant beyond; a_L = 0.4. Where the pipe locks in,
    sigma/b hangs on a_L and K_a,max and hardly on C_c.
    """
    Sc = check_number("scruton", scruton, at_least=0)
    St = check_number("strouhal", strouhal, above=0)
    log_Re = math.log(check_number("reynolds", reynolds, above=0))
    strength = float(np.interp(log_Re, _LOG_REYNOLDS, _STRENGTH))
    Ka = float(np.interp(log_Re, _LOG_REYNOLDS, _LARGEST_DAMPING))
    slender = check_number("mass_ratio", mass_ratio, above=0) * check_number("slenderness", slenderness, above=0)
    share = Sc / (4 * math.pi * Ka)
    c1 = 0.5 * LIMITING_DEVIATION**2 * (1 - share)
    c2 = LIMITING_DEVIATION**2 / Ka * strength**2 / St**4 / slender
    # c1 + root loses every digit where c1 is large and negative: then c2/(root - c1), the same number
    root = math.hypot(c1, math.sqrt(c2))
    square = c1 + root if c1 >= 0 else c2 / (root - c1)
    kp = math.sqrt(2) * (1 + 1.2 * math.atan(0.75 * share**4))
    return SpectralAmplitude(math.sqrt(square), kp, Ka)


@dataclass(frozen=True)
class LoadCycles:
    """Number of load cycles of the vibration at resonance.

    Attributes
    ----------
    number : float
        N [-]; NaN if it cannot be said.
    detail : str
        The numbers that went in, as a sentence, or why there is none.
    standing, source : str
        As of an `AmplitudeEstimate`.
    """

    number: float
    detail: str
    standing: str
    source: str


def load_cycles(case: Case) -> LoadCycles:
    """N = 2 T n eps_0 (v_crit/v_0)^2 exp[-(v_crit/v_0)^2] of EN 1991-1-4 (E.1.5.2.6), at least 10^4.

    v_0 is sqrt(2) times the most frequent wind speed of the Weibull distribution of the case; a table counts as the
    Rayleigh distribution of the same mean square speed, for which v_0 is the root of that. Winds from all directions
    count. For k = 2 the formula is the time in a band of speeds of the width eps_0 v_crit, times the frequency n.

    Parameters
    ----------
    case : Case
    """
    climate, critical = case.climate, lock_in_band(case).resonance
    if climate is None:
        return _no_cycles("The case has no section climate.")
    if math.isnan(critical):
        return _no_cycles("The tables over the Reynolds number do not reach the resonance.")
    if climate.weibull is not None:
        speed, how = math.sqrt(2) * _most_frequent(climate.weibull), "of the Weibull distribution"
        if speed == 0:
            return _no_cycles("The most frequent wind of a Weibull distribution with k <= 1 is a calm.")
    else:
        total = math.fsum(row.probability for row in climate.table)
        speed = math.sqrt(math.fsum(row.probability * row.speed**2 for row in climate.table) / total)
        how = "of the Rayleigh distribution with the mean square speed of the table"
    n = case.pipe.frequency / (2 * math.pi)
    square = (critical / speed) ** 2
    number = 2 * climate.duration * n * BAND_WIDTH * square * math.exp(-square)
    least = f"; the formula gives {number:.3g}, the least to count is {LEAST_CYCLES:g}" if number < LEAST_CYCLES else ""
    detail = (
        f"T = {climate.duration:.3g} s, n = {n:.4g} Hz, eps_0 = {BAND_WIDTH:g}, v_crit = {critical:.4g} m/s, "
        f"v_0 = {speed:.4g} m/s {how}{least}."
    )
    return LoadCycles(max(number, LEAST_CYCLES), detail, *CYCLES)


def _no_cycles(why: str) -> LoadCycles:
    return LoadCycles(math.nan, why, *CYCLES)


def _most_frequent(weibull: Weibull) -> float:
    """Wind speed where the density of a Weibull distribution is largest [m/s]."""
    c, k = weibull.scale, weibull.shape
    return c * ((k - 1) / k) ** (1 / k) if k > 1 else 0.0
