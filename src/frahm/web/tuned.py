"""The competitor: a tuned mass damper of the same mass, tuned for equal peaks, and the pipe without any."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.case import Case
from frahm.harmonic_balance.condensation import linear_part
from frahm.systems import build_system

_POINTS = 401


def tuned_case(case: Case) -> Case:
    """Case with its first absorber replaced by a tuned mass damper of the same mass, tuned for equal peaks."""
    from frahm.design.tuned import equal_peak  # half a second that the page can do without until it is asked for

    mass, pipe = case.absorbers[0].mass, case.pipe
    ratio, damping_ratio, _ = equal_peak(mass / pipe.mass)
    omega = ratio * pipe.frequency
    law = {"kind": "linear", "stiffness": mass * omega**2, "damping": 2 * damping_ratio * mass * omega}
    damper = {"name": "tuned mass damper", "mass": mass, "law": law}
    return case.model_validate({**case.to_dict(), "absorbers": [damper]})


@dataclass(frozen=True)
class LinearResponse:
    """Amplitudes over the window [m]; `relative` is empty without an absorber."""

    detuning: Floats
    pipe: Floats
    relative: Floats


def tuned_mass_damper_response(case: Case) -> LinearResponse:
    """Response of the pipe with a tuned mass damper of the same mass, in closed form."""
    system = build_system(tuned_case(case))
    damping, stiffness = linear_part(system)
    detuning = np.linspace(*case.analysis.detuning, _POINTS)
    W = (case.pipe.frequency + detuning)[:, None, None]
    dynamic = stiffness - W**2 * system.mass + 1j * W * damping
    X = np.linalg.solve(dynamic, np.broadcast_to(system.forcing[:, None], (_POINTS, 2, 1)))[..., 0]
    return LinearResponse(detuning, np.abs(X[:, 0]), np.abs(X[:, 1] - X[:, 0]))


def bare_response(case: Case) -> LinearResponse:
    """Response of the pipe without any absorber; NaN where it is infinite."""
    system = build_system(case.without_absorbers())
    detuning = np.linspace(*case.analysis.detuning, _POINTS)
    W = case.pipe.frequency + detuning
    dynamic = np.abs(system.stiffness[0, 0] - W**2 * system.mass[0, 0] + 1j * W * system.damping[0, 0])
    pipe = system.forcing[0] / np.where(dynamic > 0, dynamic, np.nan)
    return LinearResponse(detuning, pipe, np.empty(0))
