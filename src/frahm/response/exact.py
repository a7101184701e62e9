"""Response curve of the exact equations by harmonic balance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.harmonic_balance import (
    Search,
    SolutionBranch,
    check_rest,
    connected,
    find_branches,
    is_linear,
    linear_growth,
    linear_response,
    resonant_grid,
    search_over,
)
from frahm.harmonic_balance.inventory import NONE_FOUND, exchanges_text, inventory_text, not_proven, unfinished
from frahm.response.curve import ResponseCurve, SpecialPoint
from frahm.systems import System, detuning_of

_MOST_SENTENCES = 5  # on points of one kind on one branch
_ROUNDING = 2.0**-52
ROUGH = 1e-3  # truncation that is worth a word


def exact_curve(
    system: System, lo: float, hi: float, harmonics: int | None, forcing: Floats | None = None
) -> ResponseCurve:
    """All branches of periodic responses of the exact equations over Omega in [lo, hi] [rad/s].

    `forcing` is a factor on the forcing over Omega, see `frahm.harmonic_balance.kernels.forcing_factor`.
    """
    return curve_and_branches(system, lo, hi, harmonics, forcing)[0]


def curve_and_branches(
    system: System, lo: float, hi: float, harmonics: int | None, forcing: Floats | None = None
) -> tuple[ResponseCurve, Search | None, list[SolutionBranch]]:
    """`exact_curve`, with the search and the branches behind it; a linear system has none."""
    settings: dict[str, Any] = {
        "method": "harmonic-balance",
        "harmonics": "auto" if harmonics is None else harmonics,
        "frequency_window": (lo, hi),
    }
    if is_linear(system) or not np.any(system.forcing):
        return _linear_curve(system, lo, hi, settings, forcing), None, []
    search = search_over(system, lo, hi, harmonics, forcing)
    branches = find_branches(search)
    settings["inventory"] = inventory_text(search) + exchanges_text(search)
    settings["truncation"] = max((float(np.max(branch.points.truncations)) for branch in branches), default=math.nan)
    return _assembled(system, branches, search, settings), search, branches


def _assembled(
    system: System, branches: list[SolutionBranch], search: Search, settings: dict[str, Any]
) -> ResponseCurve:
    special, doubtful = [], [*search.unsearched, *search.budget.sentences(), *not_proven(search)]
    for number, branch in enumerate(branches):
        for event in branch.bifurcations:
            W, _, _, pipe, relative = (float(value) for value in event.columns)
            sigma = float(detuning_of(system, W))
            status = "located" if event.located else "unverified"
            interval = (W - event.half_width, W + event.half_width)
            special.append(SpecialPoint(event.kind, W, sigma, pipe, relative, number, interval, status))
        doubtful += _not_located(number, branch) + _beyond_numbers(number, branch)
        rest = float(np.max(branch.points.truncations))
        if settings["harmonics"] == "auto" and rest > ROUGH:
            doubtful.append(
                f"Branch {number}: up to {100 * rest:.3g} % of the forces lie beyond the highest"
                " harmonic there is room for, as stops and friction make them; its peaks are no better than that."
            )
    doubtful += unfinished(branches)
    hanging = connected(branches)
    columns = np.concatenate([branch.points.columns for branch in branches]) if branches else np.empty((0, 5))
    growth = np.concatenate([_growth(branch) for branch in branches]) if branches else np.empty(0)
    if not branches:
        doubtful.append(NONE_FOUND)
    return ResponseCurve(
        frequency=columns[:, 0],
        detuning=detuning_of(system, columns[:, 0]),
        pipe_amplitude=columns[:, 1],
        relative_amplitude=columns[:, 2],
        pipe_peak=columns[:, 3],
        relative_peak=columns[:, 4],
        branch=np.repeat(np.arange(len(branches)), [len(branch.points) for branch in branches]),
        piece=np.concatenate([branch.points.pieces for branch in branches]) if branches else np.empty(0, int),
        stable=growth < 0,
        growth_rate=growth,
        detached=tuple(not any(branch is other for other in hanging) for branch in branches),
        asymmetric=tuple(search.problem.odd and not branch.odd for branch in branches),
        special_points=tuple(sorted(special, key=lambda p: p.frequency)),
        unverified=tuple(doubtful),
        settings=settings,
        system=system.name,
    )


def _not_located(number: int, branch: SolutionBranch) -> list[str]:
    """What was seen but not located on a branch: a sentence for each, or one for many of a kind."""
    sentences = []
    for kind in dict.fromkeys(event.kind for event in branch.bifurcations if not event.located):
        at = sorted(float(e.columns[0]) for e in branch.bifurcations if e.kind == kind and not e.located)
        if len(at) <= _MOST_SENTENCES:
            sentences += [f"A {kind} near {W:.6g} rad/s was seen but not located." for W in at]
        else:
            where = f"between {at[0]:.6g} and {at[-1]:.6g} rad/s"
            sentences.append(f"Branch {number}: {len(at)} {kind} points {where} were seen but not located.")
    return sentences


def _beyond_numbers(number: int, branch: SolutionBranch) -> list[str]:
    """Sentences where multipliers are no numbers."""
    multipliers, W = branch.points.multipliers, branch.points.frequency
    unknown = np.any(np.isnan(multipliers), axis=1)
    beyond = ~np.all(np.isfinite(multipliers), axis=1) & ~unknown
    reasons = (
        (beyond, "a disturbance grows beyond all numbers within a period: it is unstable there, and"),
        (unknown, "a period takes more steps than a search is given: its stability is not known there, nor are"),
    )
    return [
        f"Branch {number}: between {np.min(W[where]):.6g} and {np.max(W[where]):.6g} rad/s"
        f" {reason} its special points" + (" are not known." if where is beyond else ".")
        for where, reason in reasons
        if np.any(where)
    ]


def _growth(branch: SolutionBranch) -> Floats:
    """Largest growth rate [1/s] from the multipliers of the map over half a period or a whole one."""
    span = (math.pi if branch.odd else 2 * math.pi) / branch.points.frequency
    largest = np.max(np.abs(branch.points.multipliers), axis=1)
    return np.asarray(np.log(np.maximum(largest, _ROUNDING)) / span)  # what decays faster is lost beside 1


def _linear_curve(
    system: System, lo: float, hi: float, settings: dict[str, Any], forcing: Floats | None
) -> ResponseCurve:
    check_rest(system)
    W = resonant_grid(system, lo, hi)
    driven = bool(np.any(system.forcing))
    X = linear_response(system, W) if driven else np.zeros((W.size, system.size))
    if forcing is not None and forcing.size:
        row = np.clip(np.searchsorted(forcing[:, 0], W, side="right") - 1, 0, len(forcing) - 1)
        x = W - forcing[row, 0]
        X = X * sum(forcing[row, 1 + k] * x**k for k in range(4))[:, None]
    first = system.elements[0].direction if system.elements else np.zeros(system.size)
    pipe, relative = np.abs(X @ system.output), np.abs(X @ first)
    growth = np.full(W.size, linear_growth(system))
    none = np.zeros(W.size, int)
    one = "A linear system has one periodic response at every frequency."
    settings["inventory"] = one if driven else "Nothing drives the system: the response is its rest."
    return ResponseCurve(
        W, detuning_of(system, W), pipe, relative, pipe, relative, none, none, growth < 0, growth,
        (False,), (False,), (), (), settings, system.name,
    )  # fmt: skip
