"""A published optimisation of a sink, why its optimum is unsafe, and the design found for the same problem.

The study that comes with NLvib-py (a harmonic balance code) looks for cubic stiffness alpha and damping d of a sink
of 5 % mass on an oscillator with m = k = 1, c = .002 and F = .11, excited between .8 and 1.4: it minimises the peak
rms of the periodic response and reports .663 at d = .001, alpha = .010.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass

import numpy as np

import frahm
from frahm.design import DesignedAbsorber, DesignSettings
from frahm.design.disturbance import Disturbance
from frahm.design.exact import ExcitedMode, Windows
from frahm.design.finalists import finalists
from frahm.design.host import host_of
from frahm.design.objective import Objective
from frahm.design.screening import Screening
from frahm.design.search import ClosedFormSearch, DesignLimits
from frahm.design.space import design_space
from frahm.design.verification import Verification, verification

REPORTED = DesignedAbsorber(rho2=0.05, linear=0.0, kappa=0.010, xi2=0.001)
WINDOW, WIDE = (0.8, 1.4), (0.7, 1.5)
MARGIN = 1.05


@dataclass(frozen=True)
class Study:
    """What is wrong with the reported optimum, and what is found instead.

    Attributes
    ----------
    reported_rms : float
        Largest rms on the branch that comes from low frequency, until it leaves the window: the number reported.
    reported_stable : bool
        Whether that response is stable.
    detached_peak : float
        Peak of the detached branch the report does not mention.
    peak_from_rest : float
        Where the motion from rest settles at Omega = .970.
    design : DesignedAbsorber
    verified : Verification
        Of the design, over all attractors.
    """

    reported_rms: float
    reported_stable: bool
    detached_peak: float
    peak_from_rest: float
    design: DesignedAbsorber
    verified: Verification


def system_of(design: DesignedAbsorber) -> frahm.System:
    """Oscillator and sink of the study."""
    law = frahm.Polynomial((design.linear, 0.0, design.kappa), design.xi2)
    element = frahm.Element((-1, 1), law)
    return frahm.System(
        np.diag([1, design.rho2]), np.diag([0.002, 0]), np.diag([1.0, 0]), (0.11, 0), [element], name="NLvib study"
    )


def study(samples: int = 200) -> Study:
    """Judge the reported optimum and design a sink for the same problem."""
    system = system_of(REPORTED)
    curve = frahm.frequency_response(system, frequency=WINDOW)
    branch = curve.branches[0]
    first = branch.piece == 0
    rms = branch.pipe_amplitude[first] / math.sqrt(2)
    at = int(np.argmax(rms))
    motion = frahm.integrate(system, frequency=0.970, periods=3000)
    best = designed()
    found = verification(_modes_of(best), [Disturbance()], Objective(), samples=samples, seed=1)
    return Study(
        reported_rms=float(rms[at]),
        reported_stable=bool(branch.stable[first][at]),
        detached_peak=max(float(np.max(b.pipe_peak)) for b in curve.branches if b.detached),
        peak_from_rest=float(motion.peaks().pipe),
        design=best,
        verified=found,
    )


def designed() -> DesignedAbsorber:
    """Best sink of the same mass, by the closed form corrected with the exact equations."""
    host = host_of(system_of(REPORTED))
    screening = Screening(
        host,
        host.conditions([Disturbance()], WINDOW, 161, moving=False, forces=(1.0, MARGIN)),
        host.conditions([Disturbance()], WIDE, 481, moving=False),
    )
    space = design_space(host, 1.0, "sink", DesignSettings(mass_ratio=REPORTED.rho2))
    limits = DesignLimits(MARGIN, math.inf, stable=False)
    kept, _ = finalists(ClosedFormSearch(screening, space, Objective(), limits), _modes_of, [Disturbance()], limits)
    return kept[0].design


def _modes_of(design: DesignedAbsorber) -> list[ExcitedMode]:
    """The one mode there is, and where it is judged."""
    return [ExcitedMode(system_of(design), Windows(WINDOW, WIDE, False))]


def main() -> None:
    """Print the study."""
    s = study()
    sys.stdout.write(
        f"Reported optimum: peak rms {s.reported_rms:.3f}, {'stable' if s.reported_stable else 'unstable'}; a detached"
        f" branch reaches {s.detached_peak:.1f}; from rest at Omega = .970 the motion ends at {s.peak_from_rest:.1f}.\n"
        f"Design: alpha {s.design.kappa:.5f}, d {s.design.xi2:.4f}: worst peak {s.verified.pipe_peak:.3f} of all"
        f" attractors, verified: {s.verified.verified}.\n"
    )


if __name__ == "__main__":
    main()
