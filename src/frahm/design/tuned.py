"""The tuned mass damper: closed form with equal peaks, and the best one for a damped host and its frequency errors."""

from __future__ import annotations

import math
from typing import Any

from frahm.case import Case
from frahm.errors import ParameterError, check_number


def equal_peak(mass_ratio: float) -> tuple[float, float, float]:
    """Tuned mass damper with exactly equal peaks on an undamped host: frequency ratio, damping ratio, peak.

    Parameters
    ----------
    mass_ratio : float
        mu = mass of the damper over mass of the host [-].

    Returns
    -------
    tuple of float
        Frequency of the damper over that of the host [-], its damping ratio c/(2 m omega) with its own mass and
        frequency [-], and the largest response over the static deflection [-].

    Notes
    -----
    Asami and Nishihara, J. Vib. Acoust. 125 (2003) 398-405, doi 10.1115/1.1569514 (secondary: formula quoted
    second-hand; checked here against a numerical minimum of the largest response).
    """
    mu = check_number("mass_ratio", mass_ratio, above=0)
    root = math.sqrt(4 + 3 * mu)
    inside = 2 * (16 + 23 * mu + 9 * mu**2 + 2 * (2 + mu) * root) / (3 * (64 + 80 * mu + 27 * mu**2))
    ratio = 2 / (1 + mu) * math.sqrt(inside)
    damping = 0.25 * math.sqrt((8 + 9 * mu - 4 * root) / (1 + mu))
    height = (8 + 9 * mu) ** 2 * (16 + 9 * mu) - 128 * (4 + 3 * mu) ** 1.5
    return ratio, damping, math.sqrt(height / (32 + 27 * mu) / 27) / mu


def den_hartog(mass_ratio: float) -> tuple[float, float, float]:
    """Den Hartog's tuned mass damper: frequency ratio, damping ratio, height of the fixed points over the static one.

    Parameters
    ----------
    mass_ratio : float
        mu [-].

    Notes
    -----
    f = 1/(1 + mu), zeta = sqrt(3 mu/(8 (1 + mu)^3)) referred to the frequency of the host, sqrt(1 + 2/mu): the
    textbook's fixed-point method (secondary).
    """
    mu = check_number("mass_ratio", mass_ratio, above=0)
    return 1 / (1 + mu), math.sqrt(3 * mu / (8 * (1 + mu) ** 3)), math.sqrt(1 + 2 / mu)


def textbook_damper(case: Case, mass_ratio: float = 0.02) -> Case:
    """The case with one tuned mass damper of equal peaks in place of all its absorbers, and with their mass.

    It hangs where the first of them does, or where the governing mode moves most; the mass of that mode is felt there.

    Parameters
    ----------
    case : Case
    mass_ratio : float
        Mass over that of the pipe of a case without absorbers [-].
    """
    pipe, old = case.pipe, case.absorbers
    mass = sum(absorber.mass for absorber in old) if old else mass_ratio * pipe.mass
    place = old[0].position if old else None
    moves = float(pipe.modal.displacement(place)[0])
    if moves == 0:
        raise ParameterError("absorbers[0].position", place, "a section that the governing mode moves")
    ratio, damping_ratio, _ = equal_peak(mass * moves**2 / pipe.mass)
    omega = ratio * pipe.frequency
    law = {"kind": "linear", "stiffness": mass * omega**2, "damping": 2 * damping_ratio * mass * omega}
    given: dict[str, Any] = {"name": "tuned mass damper", "mass": mass, "law": law}
    damper = given if place is None else given | {"position": place}  # the case says what is wrong with it
    return Case(**({key: getattr(case, key) for key in case.model_fields_set} | {"absorbers": (damper,)}))
