"""Amplitude at resonance by published estimates: an interval to hold the computed response against."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from frahm.case import Case, ModeTable, Tube
from frahm.case.reynolds import LIFT_CURVES
from frahm.errors import check_choice, check_number
from frahm.loads.reynolds import published_curve, strouhal_curve
from frahm.loads.similarity import lock_in_band, scruton_number, skop_griffin_number
from frahm.loads.vortex import reynolds_number, vortex_shedding
from frahm.loads.wake_oscillator import WakeOscillator

_NAMES = ("EN 1991-1-4, method 1", "Griffin and Skop", "Sarpkaya", "Facchinetti et al., Eq. 35")
SPANS = ("rigid", "cantilever", "simple span")
_ITERATIONS = 200
_GAUSS, _PANELS = 8, 64  # nodes a panel, panels: exact to rounding for the shapes of beams
_CANTILEVER = 1.305  # gamma of the first mode of a cantilever


@dataclass(frozen=True)
class ModeFactors:
    """What the shape of a mode does to the estimates; the defaults are those of a rigid pipe, see `mode_factors`.

    Parameters
    ----------
    load : float
        g = int |phi| / int phi^2 [-].
    amplitude : float
        gamma = max |phi| sqrt(int phi^2 / int phi^4) [-], of the estimates of Griffin and Skop and of Sarpkaya.
    span : {"rigid", "cantilever", "simple span"}
        Which correlation factor EN 1991-1-4 gives.
    slenderness : float, optional
        Length of the span over its diameter [-]; without it the lift is in phase all along, which is the safe side.
    mass_per_length : float, optional
        m_e = int m phi^2 / int phi^2 [kg/m]; that of the case by default.
    """

    load: float = 1.0
    amplitude: float = 1.0
    span: str = "rigid"
    slenderness: float | None = None
    mass_per_length: float | None = None

    def __post_init__(self) -> None:
        check_number("load", self.load, above=0)
        check_number("amplitude", self.amplitude, above=0)
        check_choice("span", self.span, SPANS)
        for name in ("slenderness", "mass_per_length"):
            if getattr(self, name) is not None:
                check_number(name, getattr(self, name), above=0)


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


def mode_factors(case: Case) -> ModeFactors:
    """Factors of the governing mode of a case: exact for one mode and for tubes.

    A table of modes knows its shapes at a few sections only: gamma is then that of a cantilever, the largest of the
    usual shapes, and the lift is taken to be in phase all along, as it is for spans EN 1991-1-4 gives no factor for.
    """
    pipe = case.pipe
    if isinstance(pipe, Tube):
        modes, mode = pipe.beam_modes, pipe.governing_mode - 1
        nodes, weights = np.polynomial.legendre.leggauss(_GAUSS)
        edges = np.linspace(0.0, pipe.length, _PANELS + 1)
        half = 0.5 * pipe.length / _PANELS
        shape = modes.shape((edges[:-1, None] + half * (1 + nodes)).ravel())[:, mode]
        fourth = half * float(np.tile(weights, _PANELS) @ shape**4)
        span = _span(pipe)
        return ModeFactors(
            load=float(modes.participations[mode]),
            amplitude=math.sqrt(float(modes.squares[mode]) / fourth),
            span=span,
            slenderness=None if span == "rigid" else pipe.length / pipe.diameter,
        )
    if isinstance(pipe, ModeTable):
        modal, mass = pipe.modal, pipe.mass_per_length
        load = 1.0 if mass is None else float(modal.lift_lengths[0] * mass / modal.masses[0])
        return ModeFactors(load=load, amplitude=_CANTILEVER)
    return ModeFactors()


def _span(tube: Tube) -> str:
    """The span EN 1991-1-4 gives a correlation factor for, "rigid" if it gives none."""
    held = [support for support in tube.supports if support.kind != "free"]
    if tube.governing_mode != 1 or tube.point_masses:
        return "rigid"
    if len(held) == 1 and held[0].kind == "clamped" and held[0].at in (0.0, tube.length):
        return "cantilever"
    ends = {support.at for support in held if support.kind == "pinned" and not support.rotation}
    return "simple span" if len(held) == 2 and ends == {0.0, tube.length} else "rigid"


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


def correlation_length(amplitude_ratio: float) -> float:
    """L_j/D of EN 1991-1-4: 6 below A/D = 0.1, 4.8 + 12 A/D to 0.6, then 12 [-]."""
    y = check_number("amplitude_ratio", amplitude_ratio, at_least=0)
    return min(max(6.0, 4.8 + 12 * y), 12.0)


def correlation_factor(span: str, length: float, slenderness: float | None) -> float:
    """Effective correlation length factor K_w of EN 1991-1-4 [-].

    Parameters
    ----------
    span : {"rigid", "cantilever", "simple span"}
        The expression for the cantilever was read in the source, that of the simple span is secondary; for the rigid
        pipe it is the share of its length that is in phase.
    length : float
        L_j/D [-].
    slenderness : float or None
        l/D [-]; None if the lift is in phase all along.
    """
    if slenderness is None:
        return 1.0
    r = min(1.0, check_number("length", length, above=0) / check_number("slenderness", slenderness, above=0))
    if check_choice("span", span, SPANS) == "cantilever":
        return min(0.6, 3 * r * (1 - r + r**2 / 3))
    return math.cos(math.pi / 2 * (1 - r)) if span == "simple span" else r


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
        K_w as a function of L_j/D; 1 by default.

    Returns
    -------
    (float, float)
        A/D [-] and L_j/D at it [-]. Where the iteration has more than one end, the largest; infinite without damping.
    """
    Sc = check_number("scruton", scruton, at_least=0)
    if Sc == 0:
        return math.inf, 12.0
    Kw = correlation or (lambda length: 1.0)
    scale = load_factor * lift_coefficient / (4 * math.pi * check_number("strouhal", strouhal, above=0) ** 2 * Sc)
    ratio = scale * Kw(12.0)  # from above: K_w grows with the amplitude, so the largest solution is met first
    for _ in range(_ITERATIONS):
        new = scale * Kw(correlation_length(ratio))
        if abs(new - ratio) <= 1e-14 * ratio:
            break
        ratio = new
    return ratio, correlation_length(ratio)


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
        Forced by the lift of the case, EN 1991-1-4 method 1, Griffin and Skop, Sarpkaya, and Facchinetti et al.; the
        first one knows the mode of the case anyway, and the last one is for a rigid pipe, whatever the factors.

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
    St = float(strouhal_curve(case.wind).value(reynolds_number(critical, pipe.diameter, case.wind.viscosity)))
    SG = skop_griffin_number(Ks, St)
    estimates = (_forced(case), _eurocode(case, given, Ks, St, critical), *_empirical(given, SG), _facchinetti(Ks))
    return AmplitudeEstimates(estimates, pipe.diameter)


def _unknown(name: str) -> AmplitudeEstimate:
    return AmplitudeEstimate(name, math.nan, "The case does not say the mass per length of the pipe.", "-", "-")


def _forced(case: Case) -> AmplitudeEstimate:
    shedding, pipe = vortex_shedding(case), case.pipe
    length = float(pipe.modal.lift_lengths[0])
    amplitude = forced_amplitude(shedding.lift / pipe.length * length, pipe.mass, pipe.damping_ratio, pipe.frequency)
    detail = f"C_L = {shedding.lift_coefficient:.4g} at {shedding.speed:g} m/s, generalised lift length {length:.4g} m."
    source = "closed form of the forced oscillator"
    return AmplitudeEstimate("Harmonic lift of the case, in resonance", amplitude / pipe.diameter, detail,
                             "verified", source)  # fmt: skip


def _eurocode(case: Case, factors: ModeFactors, Ks: float, St: float, critical: float) -> AmplitudeEstimate:
    curve = published_curve("en1991", LIFT_CURVES)
    Re = reynolds_number(critical, case.pipe.diameter, case.wind.viscosity)
    lift = float(curve.value(Re))
    name, source = _NAMES[0], "annex E.1.5.2; c_lat,0 and K_w of the cantilever read in public code"
    if math.isnan(lift):
        detail = f"c_lat,0 is not given at Re = {Re:.3g}."
        return AmplitudeEstimate(name, math.nan, detail, "partly secondary", source)
    ratio, length = eurocode_amplitude(
        Ks, St, lift, load_factor=factors.load,
        correlation=lambda length: correlation_factor(factors.span, length, factors.slenderness),
    )  # fmt: skip
    where = f"L_j/D = {length:.3g}" if factors.slenderness is not None else "in phase all along"
    detail = f"c_lat = {lift:.3g} at Re = {Re:.3g}, St = {St:.3g}, Sc = {Ks:.3g}, {where}."
    return AmplitudeEstimate(name, ratio, detail, "partly secondary", source)


def _empirical(factors: ModeFactors, SG: float) -> tuple[AmplitudeEstimate, AmplitudeEstimate]:
    detail = f"S_G = {SG:.3g}, gamma = {factors.amplitude:.4g}."
    return (
        AmplitudeEstimate(_NAMES[1], griffin_skop_amplitude(SG, factors.amplitude), detail,
                          "secondary", "quoted from memory"),
        AmplitudeEstimate(_NAMES[2], sarpkaya_amplitude(SG, factors.amplitude), detail,
                          "secondary", "quoted from memory"),
    )  # fmt: skip


def _facchinetti(Ks: float) -> AmplitudeEstimate:
    wake = WakeOscillator()
    SG = skop_griffin_number(Ks, wake.strouhal)
    return AmplitudeEstimate(
        _NAMES[3], wake.lock_in_amplitude(SG),
        f"S_G = {SG:.3g} with the published constants (St = {wake.strouhal:g}, C_L0 = {wake.lift_coefficient:g}).",
        "verified", "doi 10.1016/j.jfluidstructs.2003.12.004",
    )  # fmt: skip
