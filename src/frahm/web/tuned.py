"""The competitor: a tuned mass damper of the same mass, tuned for equal peaks, and the pipe without any."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.case import Case
from frahm.systems import build_system
from frahm.web.scope import detuning_window

_POINTS = 401


def tuned_case(case: Case) -> Case:
    """Case with its first absorber alone, as a tuned mass damper of the same mass in the same place.

    It is tuned for equal peaks of the governing mode, whose mass is felt where the damper hangs.
    """
    from frahm.design.tuned import equal_peak  # half a second that the page can do without until it is asked for

    old, pipe = case.absorbers[0], case.pipe
    moves = float(pipe.modal.displacement(old.position)[0])
    ratio, damping_ratio, _ = equal_peak(old.mass * moves**2 / pipe.mass)
    omega = ratio * pipe.frequency
    law = {"kind": "linear", "stiffness": old.mass * omega**2, "damping": 2 * damping_ratio * old.mass * omega}
    damper = {"name": "tuned mass damper", "mass": old.mass, "law": law, "position": old.position}
    return case.model_validate({**case.to_dict(), "absorbers": [damper]})


@dataclass(frozen=True)
class LinearResponse:
    """Amplitudes over the window [m]; `relative` is empty without an absorber."""

    detuning: Floats
    pipe: Floats
    relative: Floats


def tuned_mass_damper_response(case: Case) -> LinearResponse:
    """Response of the pipe with a tuned mass damper of the same mass, in closed form."""
    from frahm.harmonic_balance.condensation import linear_part

    system = build_system(tuned_case(case))
    damping, stiffness = linear_part(system)
    detuning = np.linspace(*detuning_window(case), _POINTS)
    W = (case.pipe.frequency + detuning)[:, None, None]
    dynamic = stiffness - W**2 * system.mass + 1j * W * damping
    force = np.broadcast_to(system.forcing[:, None], (_POINTS, system.size, 1))
    X = np.linalg.solve(dynamic, force)[..., 0]
    return LinearResponse(detuning, np.abs(X @ system.output), np.abs(X @ system.elements[0].direction))


def bare_response(case: Case) -> LinearResponse:
    """Response of the pipe without any absorber, mode by mode; NaN where it is infinite."""
    system = build_system(case.without_absorbers())
    detuning = np.linspace(*detuning_window(case), _POINTS)
    mass, damping, stiffness = (np.diag(matrix) for matrix in (system.mass, system.damping, system.stiffness))
    W = (case.pipe.frequency + detuning)[:, None]
    dynamic = stiffness - W**2 * mass + 1j * W * damping
    finite = np.abs(dynamic) > 0
    X = np.where(finite, system.forcing / np.where(finite, dynamic, 1.0), np.nan)
    return LinearResponse(detuning, np.abs(X @ system.output), np.empty(0))
