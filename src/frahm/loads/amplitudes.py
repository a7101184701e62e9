"""Amplitude at resonance by published estimates: an interval to hold the computed response against."""

from __future__ import annotations

import math
from dataclasses import dataclass

from frahm.case import Case
from frahm.case.reynolds import LIFT_CURVES
from frahm.errors import check_number
from frahm.loads.correlation import correlation_length
from frahm.loads.eurocode import METHOD_1, METHOD_2, eurocode_amplitude, spectral_amplitude
from frahm.loads.mode_factors import ModeFactors, mode_factors
from frahm.loads.reynolds import reynolds_curve, strouhal_curve
from frahm.loads.similarity import lock_in_band, resonant_shedding, scruton_number, skop_griffin_number
from frahm.loads.vortex import reynolds_number
from frahm.loads.wake_oscillator import WakeOscillator

_NAMES = (
    "EN 1991-1-4, method 1", "EN 1991-1-4, method 2", "Griffin and Skop", "Sarpkaya", "Facchinetti et al., Eq. 35"
)  # fmt: skip


@dataclass(frozen=True)
class AmplitudeEstimate:
    """One estimate of the largest amplitude at resonance.

    Attributes
    ----------
    name : str
        Whose estimate it is.
    ratio : float
        Amplitude over diameter [-]; infinite where it has no bound, NaN where the estimate is not given.
    detail : str
        The numbers that went in, as a sentence.
    standing : str
        "verified": read in the source; "secondary": quoted from elsewhere; "partly secondary": read in part.
    source : str
        Where it was read.
    """

    name: str
    ratio: float
    detail: str
    standing: str
    source: str


@dataclass(frozen=True)
class AmplitudeEstimates:
    """Every estimate for a pipe without absorbers.

    Attributes
    ----------
    estimates : tuple of AmplitudeEstimate
    diameter : float
        [m].
    """

    estimates: tuple[AmplitudeEstimate, ...]
    diameter: float

    @property
    def interval(self) -> tuple[float, float]:
        """Smallest and largest amplitude [m] of the estimates that have a value."""
        ratios = [estimate.ratio for estimate in self.estimates if not math.isnan(estimate.ratio)]
        return self.diameter * min(ratios), self.diameter * max(ratios)


def forced_amplitude(
    lift: float, mass: float, damping_ratio: float, frequency: float, load_factor: float = 1.0
) -> float:
    """A = g F_L / (2 m zeta omega^2) [m], the harmonic force in resonance; infinite without damping.

    Parameters
    ----------
    lift : float
        Amplitude of the lift [N] on the same length as the mass.
    mass : float
        [kg].
    damping_ratio : float
        zeta [-].
    frequency : float
        Natural frequency omega [rad/s].
    load_factor : float
        g = int |phi| / int phi^2 [-].
    """
    F = check_number("lift", lift, at_least=0, unit="N")
    resistance = 2 * check_number("mass", mass, above=0, unit="kg") * check_number("damping_ratio", damping_ratio,
        at_least=0) * check_number("frequency", frequency, above=0, unit="rad/s") ** 2  # fmt: skip
    return check_number("load_factor", load_factor, above=0) * F / resistance if resistance else math.inf


def griffin_skop_amplitude(skop_griffin: float, amplitude_factor: float = 1.0) -> float:
    """A/D = 1.29 gamma / (1 + 0.43 S_G)^3.35 [-]; secondary."""
    S = check_number("skop_griffin", skop_griffin, at_least=0)
    return 1.29 * amplitude_factor / (1 + 0.43 * S) ** 3.35


def sarpkaya_amplitude(skop_griffin: float, amplitude_factor: float = 1.0) -> float:
    """A/D = 0.32 gamma / sqrt(0.06 + S_G^2) [-]; secondary."""
    S = check_number("skop_griffin", skop_griffin, at_least=0)
    return 0.32 * amplitude_factor / math.sqrt(0.06 + S**2)


def amplitude_estimates(case: Case, factors: ModeFactors | None = None) -> AmplitudeEstimates:
    """Largest amplitude of the pipe of a case without absorbers, by every estimate.

    Parameters
    ----------
    case : Case
    factors : ModeFactors, optional
        Of the mode; those of the case by default.

    Returns
    -------
    AmplitudeEstimates
        Forced by the lift of the case, EN 1991-1-4 methods 1 and 2, Griffin and Skop, Sarpkaya, and Facchinetti et al.;
        the first one knows the mode of the case anyway, and the last one is for a rigid pipe, whatever the factors.

    Raises
    ------
    ParameterError
        If the Strouhal number is not given at the wind speed of the case.
    """
    given = factors or mode_factors(case)
    pipe = case.pipe
    critical = lock_in_band(case).resonance
    if math.isnan(critical):  # the tables do not reach the resonance: what they say at the wind of the case
        critical = case.wind.speed
    mass = given.mass_per_length or pipe.mass_per_length
    if mass is None:
        return AmplitudeEstimates((_forced(case), *map(_unknown, _NAMES)), pipe.diameter)
    Ks = scruton_number(mass, pipe.damping_ratio, pipe.diameter, case.wind.air_density)
    Re = reynolds_number(critical, pipe.diameter, case.wind.viscosity)
    St = float(strouhal_curve(case.wind).value(Re))
    SG = skop_griffin_number(Ks, St)
    mass_ratio = mass / (case.wind.air_density * pipe.diameter**2)
    estimates = (_forced(case), _method_1(given, Ks, St, Re), _method_2(given, Ks, St, Re, mass_ratio),
                 *_empirical(given, SG), _facchinetti(Ks))  # fmt: skip
    return AmplitudeEstimates(estimates, pipe.diameter)


def _unknown(name: str) -> AmplitudeEstimate:
    return AmplitudeEstimate(name, math.nan, "The case does not say the mass per length of the pipe.", "-", "-")


def _forced(case: Case) -> AmplitudeEstimate:
    shedding, pipe = resonant_shedding(case), case.pipe
    length = float(pipe.modal.lift_lengths[0])
    amplitude = forced_amplitude(shedding.lift / pipe.length * length, pipe.mass, pipe.damping_ratio, pipe.frequency)
    lift = f"C_L = {shedding.lift_coefficient:.4g} at {shedding.speed:.4g} m/s"
    detail = f"{lift}, generalised lift length {length:.4g} m."
    source = "closed form of the forced oscillator"
    return AmplitudeEstimate("Harmonic lift of the case, in resonance", amplitude / pipe.diameter, detail,
                             "verified", source)  # fmt: skip


def _method_1(factors: ModeFactors, Ks: float, St: float, Re: float) -> AmplitudeEstimate:
    lift = float(reynolds_curve("en1991", LIFT_CURVES).value(Re))
    if math.isnan(lift):
        return AmplitudeEstimate(_NAMES[0], math.nan, f"c_lat,0 is not given at Re = {Re:.3g}.", *METHOD_1)
    known = factors.antinodes
    ratio, Kw = eurocode_amplitude(
        Ks, St, lift, load_factor=factors.load, correlation=None if known is None else known.correlation_factor
    )
    where = "in step all along, because the case does not know the shape of the mode well enough"
    if known is not None:
        at = "the antinode" if known.count == 1 else f"the largest of {known.count} antinodes"
        where = f"K_w = {Kw:.3g}, L_j/D = {correlation_length(min(ratio, 1.0)):.3g} at {at}"
    detail = f"c_lat = {lift:.3g} at Re = {Re:.3g}, St = {St:.3g}, Sc = {Ks:.3g}, {where}."
    return AmplitudeEstimate(_NAMES[0], ratio, detail, *METHOD_1)


def _method_2(factors: ModeFactors, Ks: float, St: float, Re: float, mass_ratio: float) -> AmplitudeEstimate:
    slenderness = factors.cantilever_slenderness
    if slenderness is None:
        detail = "It is for a cantilever in its first mode, which this pipe is not, or is not known to be."
        return AmplitudeEstimate(_NAMES[1], math.nan, detail, *METHOD_2)
    found = spectral_amplitude(Ks, St, Re, mass_ratio, slenderness)
    detail = (
        f"sigma/D = {found.deviation:.3g}, k_p = {found.peak_factor:.3g}, K_a = {found.damping:.3g} without turbulence "
        f"at Re = {Re:.3g}, Sc/(4 pi) = {Ks / (4 * math.pi):.3g}, m_e/(rho D^2) = {mass_ratio:.3g}."
    )
    return AmplitudeEstimate(_NAMES[1], found.ratio, detail, *METHOD_2)


def _empirical(factors: ModeFactors, SG: float) -> tuple[AmplitudeEstimate, AmplitudeEstimate]:
    detail = f"S_G = {SG:.3g}, gamma = {factors.amplitude:.4g}."
    return (
        AmplitudeEstimate(_NAMES[2], griffin_skop_amplitude(SG, factors.amplitude), detail,
                          "secondary", "quoted from memory"),
        AmplitudeEstimate(_NAMES[3], sarpkaya_amplitude(SG, factors.amplitude), detail,
                          "secondary", "quoted from memory"),
    )  # fmt: skip


def _facchinetti(Ks: float) -> AmplitudeEstimate:
    wake = WakeOscillator()
    SG = skop_griffin_number(Ks, wake.strouhal)
    return AmplitudeEstimate(
        _NAMES[4], wake.lock_in_amplitude(SG),
        f"S_G = {SG:.3g} with the published constants (St = {wake.strouhal:g}, C_L0 = {wake.lift_coefficient:g}).",
        "verified", "doi 10.1016/j.jfluidstructs.2003.12.004",
    )  # fmt: skip
