"""When cross-wind vibration is expected: published criteria, each evaluated and none of them trusted alone."""

from __future__ import annotations

import math
from dataclasses import dataclass

from frahm.case import Case, Tube
from frahm.loads.similarity import LockInBand, Similarity, lock_in_band, similarity

_UNKNOWN = "K_s is not known: the case does not say the mass per length of the pipe."
_REVIEW = "read in A. Kvitrud's review of vortex-induced vibrations offshore"


@dataclass(frozen=True)
class Criterion:
    """One published statement on when cross-wind vibration is expected.

    Attributes
    ----------
    name : str
        Who says it.
    condition : str
        What is expected to vibrate.
    expects_vibration : bool or None
        Whether the pipe meets the condition; None where the case does not say enough.
    speeds : (float, float) or None
        Wind speeds [m/s] over which the pipe meets it; None if it does at none, or if that is not known.
    detail : str
        The numbers behind it, as a sentence.
    standing : str
        "verified": read in the source; "secondary": quoted from elsewhere.
    source : str
        Where it was read.
    """

    name: str
    condition: str
    expects_vibration: bool | None
    speeds: tuple[float, float] | None
    detail: str
    standing: str
    source: str


def onset_criteria(
    case: Case, numbers: Similarity | None = None, *, slenderness: float | None = None
) -> list[Criterion]:
    """Every criterion, evaluated for a case at its wind speed.

    Parameters
    ----------
    case : Case
    numbers : Similarity, optional
        Similarity numbers of the mode; those of a rigid pipe at the wind speed of the case by default.
    slenderness : float, optional
        Largest length over width, for EN 1991-1-4; that of a tube by default, otherwise unknown.

    Raises
    ------
    ParameterError
        If the Strouhal number is not given at the wind speed.
    """
    numbers = similarity(case) if numbers is None else numbers
    band = lock_in_band(case)
    if slenderness is None and isinstance(case.pipe, Tube):
        slenderness = case.pipe.length / case.pipe.diameter
    return [
        _limits(case, numbers, "Brown & Root 1985", (4.7, 8.0), 16.0),
        _limits(case, numbers, "DNV 1977", (3.5, math.inf), 16.0, strict=True),
        _limits(case, numbers, "Moe & Arild 1979", (3.5, 8.0), 18.0),
        _eurocode(case, band, slenderness),
        _resonance(case, band),
        _statfjord(numbers),
    ]


def _limits(
    case: Case, numbers: Similarity, name: str, velocities: tuple[float, float], scruton: float, *, strict: bool = False
) -> Criterion:
    low, high = velocities
    V, K, scale = numbers.reduced_velocity, numbers.scruton_number, _speed_scale(case)
    meets = (low < V if strict else low <= V) and high >= V and scruton > K
    window = f"V_R > {low:g}" if math.isinf(high) else f"{low:g} <= V_R <= {high:g}"
    reach = f"{low * scale:.3g} m/s and more" if math.isinf(high) else f"{low * scale:.3g} ... {high * scale:.3g} m/s"
    if math.isnan(K):
        detail = f"V_R = {V:.3g}; {_UNKNOWN}"
        return Criterion(name, f"{window} and K_s < {scruton:g}", None, None, detail, "verified", _REVIEW)
    where = f"the reduced velocities are those of {reach}" if scruton > K else "at no speed is K_s low enough"
    return Criterion(
        name=name,
        condition=f"{window} and K_s < {scruton:g}",
        expects_vibration=meets,
        speeds=(low * scale, high * scale) if scruton > K else None,
        detail=f"V_R = {V:.3g}, K_s = {K:.3g}; {where}.",
        standing="verified",
        source=_REVIEW,
    )


def _eurocode(case: Case, band: LockInBand, slenderness: float | None) -> Criterion:
    """The wind of the case is not the extreme mean wind of the site: it can show that a check is needed, not more."""
    wind, critical = case.wind.speed, band.resonance
    needed: bool | None = None
    if math.isnan(critical):
        detail = "The Strouhal number is not given at the speed that excites the pipe in resonance."
    else:
        detail = f"v_crit = {critical:.3g} m/s: to be checked wherever v_m >= {critical / 1.25:.3g} m/s"
        slender = slenderness is not None and slenderness > 6
        if slenderness is None:
            detail += "; the case does not say how slender the structure is."
        elif not slender:
            needed, detail = False, f"{detail}; l/b = {slenderness:.3g}."
        elif critical <= 1.25 * wind:
            needed, detail = True, f"{detail}; l/b = {slenderness:.3g}, and the wind of the case is {wind:g} m/s."
        else:
            detail += f"; l/b = {slenderness:.3g}; v_m of the site is not part of the case."
    return Criterion(
        name="EN 1991-1-4 E.1.2",
        condition="l/b > 6, unless v_crit > 1.25 v_m",
        expects_vibration=needed,
        speeds=None,
        detail=detail,
        standing="secondary",
        source="EN 1991-1-4, annex E, quoted from memory",
    )


def _resonance(case: Case, band: LockInBand) -> Criterion:
    condition = f"shedding frequency within {band.ratios[0]:.3g} ... {band.ratios[1]:.3g} of the natural one"
    name = "Lock-in band around 1/St"
    if math.isnan(band.low):
        detail = "The Strouhal number is not given at any speed of the band."
        return Criterion(name, condition, None, None, detail, band.standing, band.source)
    inside = band.low <= case.wind.speed <= band.high
    detail = f"The band is {band.low:.3g} ... {band.high:.3g} m/s"
    if band.clipped:
        detail += "; the Strouhal number or the lift coefficient is not given beyond, so that it may be wider"
    if not math.isnan(band.resonance):
        detail += f"; resonance at {band.resonance:.3g} m/s"
    known = True if inside else (None if band.clipped else False)
    return Criterion(name, condition, known, (band.low, band.high), detail + ".", band.standing, band.source)


def _statfjord(numbers: Similarity) -> Criterion:
    K = numbers.scruton_number
    detail = _UNKNOWN if math.isnan(K) else f"K_s = {K:.3g}."
    if K > 28:
        detail = f"K_s = {K:.3g}: beyond what was seen there, which proves nothing for this pipe."
    return Criterion(
        name="Statfjord A 1978 (counter-example)",
        condition="K_s <= 28: large oscillations were seen at K_s = 28, beyond every limit above",
        expects_vibration=None if math.isnan(K) else K <= 28,
        speeds=None,
        detail=detail,
        standing="verified",
        source=_REVIEW,
    )


def onset_sentence(criteria: list[Criterion]) -> str:
    """What the criteria come to, in one sentence."""
    expect = [criterion.name for criterion in criteria if criterion.expects_vibration]
    unknown = [criterion.name for criterion in criteria if criterion.expects_vibration is None]
    if expect:
        text = f"Cross-wind vibration is expected by {len(expect)} of {len(criteria)}: {', '.join(expect)}"
    else:
        text = "No criterion expects cross-wind vibration at the wind speed of the case"
    return text + (f"; not decided: {', '.join(unknown)}." if unknown else ".")


def _speed_scale(case: Case) -> float:
    """f D [m/s], the wind speed of reduced velocity 1."""
    return case.pipe.frequency / (2 * math.pi) * case.pipe.diameter
