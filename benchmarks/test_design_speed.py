"""Design: a million designs screened at 400 frequencies, and a design of (kappa, xi2) with its verification.

Goals on two cores: 60 s each; this measures CPU time, of which two cores have two seconds a second.
"""

import numpy as np

import frahm
from frahm.design import DesignSettings, verified_designs
from frahm.design.disturbance import Disturbance
from frahm.design.host import host_of
from frahm.design.screening import Screening

CASE = frahm.load_case("jacket-pipe")
HOST = host_of(frahm.build_system(CASE))
DESIGNS, FREQUENCIES = 1_000_000, 400


def test_screening_of_a_million_designs(benchmark):
    omega = HOST.frequency
    conditions = HOST.conditions([Disturbance()], (omega - 0.4, omega + 0.4), FREQUENCIES, moving=False)
    screening = Screening(HOST, conditions, conditions)
    rng = np.random.default_rng(1)
    designs = np.zeros((DESIGNS, 5))
    designs[:, 0] = 0.02 * 247
    designs[:, 2] = 247 * 10 ** rng.uniform(2, 4, DESIGNS)
    designs[:, 3] = 247 * 10 ** rng.uniform(-2.5, -0.7, DESIGNS)
    screening.largest_pipe_amplitudes(designs[:10])
    worst = benchmark.pedantic(lambda: screening.largest_pipe_amplitudes(designs), rounds=1)
    benchmark.extra_info["best"] = float(np.min(worst))


def test_design_of_a_sink_with_verification(benchmark):
    (best,) = benchmark.pedantic(lambda: verified_designs(CASE, DesignSettings(), ("sink",)), rounds=1)
    benchmark.extra_info |= {"worst_pipe_peak": best.worst_pipe_peak, "verified": best.verified}
