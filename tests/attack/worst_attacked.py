"""Verified worst motions, of random systems and of designed absorbers, against random motions of the same range."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import frahm
from brute_force import ends, random_states
from frahm.attractors.attractor import clopper_pearson
from frahm.attractors.finding import settling_periods
from frahm.attractors.regions import region_for
from frahm.case import Scatter
from frahm.design.disturbance import Disturbance
from frahm.design.problem import Problem
from frahm.loads import frequency_range, operating_range
from frahm.systems import build_system
from oracle import Oracle

CASES = Path(__file__).parents[1] / "cases"
MEMBERS = ("stiff", "jacket-pipe", "calm", "chimney", "brace", "table", "tube", "jacket-pipe-elastic")
SMALL = ("stiff", "jacket-pipe", "calm", "chimney", "brace")  # of one mode, where further scatter is asked
RATIOS = (0.01, 0.02, 0.05)
SCATTER = Scatter(pipe_frequency=0.05)
WIDE = Scatter(pipe_frequency=0.05, kappa=0.1, xi2=0.1)
NO_SCATTER = Scatter()
LARGER = 1.01  # what is larger by less is as large
STATES, AGAIN = 400, 200  # random motions of a range; at a frequency where one of them is larger
_DISTURBED, _SAMPLES = 8, 16


@dataclass(frozen=True)
class Promise:
    """Peak of the pipe and stroke [m] that no motion of a range passes, unless its basin is below `least`."""

    name: str
    pipe_peak: float
    stroke: float
    least: float


def attack_random(drawn, samples=100, states=STATES):
    """The worst of a drawn system over its range, as plain data."""
    worst = frahm.worst_case(drawn.system, frequency=(drawn.low, drawn.high), samples=samples)
    within = frequency_range(drawn.low, drawn.high)
    promise = Promise(drawn.system.name, worst.pipe_peak, worst.relative_peak, _least(samples, worst.min_basin))
    row = {"name": promise.name, "verified": worst.verified, "unverified": list(worst.unverified)}
    region = max((survey.region for survey in worst.surveys), key=len)
    return row | challenge(promise, drawn.system, within, region, states, drawn.number)


def attack_design(name, ratio, scatter=SCATTER, count=1, samples=_SAMPLES, states=STATES):
    """Every device of so many absorbers that a design compares, nominal and with everything off that scatters."""
    case = frahm.load_case(CASES / f"{name}.yaml" if (CASES / f"{name}.yaml").exists() else name)
    study = frahm.design_absorber(
        case, mass_ratio=ratio, family="mixed", scatter=scatter, count=count, samples=samples, errors=(), margins=()
    )
    problem = Problem.of(study.case, study.settings)
    rows = []
    for rival in study.comparison:
        if rival.design is None:
            continue
        device = study.case if rival.name == "case" else problem.case_with(rival.design)
        many = "" if count == 1 else f" x {rival.count}"
        rows += _device(f"{name} {100 * ratio:g} % {rival.name}{many}", rival, device, problem, samples, states)
        if rival.design == study.best.design and math.isfinite(study.with_margin):
            rows.append(_with_margin(f"{name} {100 * ratio:g} % margin", study, device, samples, states))
    return rows


def challenge(promise, system, within, region, states=STATES, seed=0, force=1.0):
    """What random motions of a range say against a promise."""
    random = np.random.default_rng([11, seed])
    periods = settling_periods(system, within.frequency[0])
    oracle = Oracle(system)
    W = random.uniform(*within.frequency, states)
    factor = force * np.array([within.lift_factor(one) for one in W])
    motions = ends(oracle, random_states(system, region, states, random), W, periods, factor)
    larger = _larger(motions, promise)
    found = []
    for at in np.flatnonzero(larger)[:8]:
        again = ends(oracle, random_states(system, region, AGAIN, random), W[at], periods, factor[at])
        hits = int(np.count_nonzero(_larger(again, promise)))
        low = clopper_pearson(hits, AGAIN)[0]
        found.append({
            "frequency": float(W[at]), "looks": motions.looks[at].tolist(), "share": hits / AGAIN,
            "multiple": int(motions.multiple[at]), "breaks": low > promise.least,
        })  # fmt: skip
    return {
        "promised": [promise.pipe_peak, promise.stroke], "least": promise.least, "states": states,
        "larger": int(np.count_nonzero(larger)), "lost": int(np.count_nonzero(motions.lost)), "found": found,
        "largest": np.nanmax(motions.looks[:, [0, 2]], axis=0).tolist(),
    }  # fmt: skip


def _device(name, rival, device, problem, samples, states):
    """Rows of one device in every mode that winds excite: as designed, and with pipe and absorber off."""
    promise = Promise(name, rival.worst.pipe_peak, rival.worst.relative_peak, _least(samples))
    nominal = {"name": name, "verified": rival.worst.verified, "unverified": list(rival.worst.unverified)}
    scattered = Promise(f"{name}, off", rival.scattered.pipe_peak, rival.relative_peak, _least(samples))
    rows = []
    for mode in problem.modes(device):
        within = mode.windows.range(Disturbance(), mode.system.reference_frequency)
        region = region_for(mode.system, within.frequency[1], promise.pipe_peak, promise.stroke)
        rows.append(nominal | challenge(promise, mode.system, within, region, states))
        random = np.random.default_rng(5)
        for index in range(_DISTURBED if problem.settings.scatter.names else 0):
            off = _disturbance(problem, random)
            if not mode.windows.includes(off):
                continue
            changed = off.of(mode.system)
            there = mode.windows.range(off, changed.reference_frequency)
            region = region_for(changed, there.frequency[1], scattered.pipe_peak, scattered.stroke)
            part = challenge(scattered, changed, there, region, states // _DISTURBED, index)
            facts = {"name": f"{scattered.name}: {off.text}", "verified": rival.scattered.verified}
            rows.append(facts | {"unverified": list(rival.scattered.unverified)} | part)
    return rows


def _with_margin(name, study, device, samples, states):
    """The best design under forces up to its margin."""
    system, within = build_system(device), operating_range(device)
    peak = max(study.with_margin, study.best.worst_pipe_peak)
    force = np.random.default_rng(9).uniform(1.0, study.settings.force_margin)
    region = region_for(system, within.frequency[1], peak, study.best.relative_peak)
    promise = Promise(name, peak, math.inf, _least(samples))
    facts = {"name": name, "verified": study.best.verified, "unverified": list(study.best.unverified)}
    return facts | challenge(promise, system, within, region, states, force=force)


def _disturbance(problem, random):
    scatter = problem.settings.scatter
    sizes = {name: getattr(scatter, name) for name in scatter.names}
    lock_in = not problem.within.over_wind
    return replace(
        Disturbance(lock_in=lock_in, others=problem.disturbances[0].others),
        **{name: 1 + s * random.uniform(-1, 1) for name, s in sizes.items()},
    )


def _larger(motions, promise):
    with np.errstate(invalid="ignore"):
        return (motions.looks[:, 0] > LARGER * promise.pipe_peak) | (motions.looks[:, 2] > LARGER * promise.stroke)


def _least(samples, min_basin=0.0):
    """Basin that `samples` states miss with a probability below 5 %, or the least that counts."""
    return max(min_basin, 1 - 0.05 ** (1 / samples))
