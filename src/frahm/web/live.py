"""What is computed while a slider moves: closed forms of the slow flow, a few milliseconds in all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from frahm.arrays import Floats
from frahm.case import Case
from frahm.response import ResponseCurve, frequency_response, slow_flow_values
from frahm.slow_flow import Folds, slow_flow_of, slow_manifold
from frahm.systems import build_system
from frahm.web.scope import Axis

CURVE_POINTS = 400
_MANIFOLD_POINTS = 400
_MAP_COLUMNS, _MAP_ROWS = 121, 60

# Number of responses, and of stable ones -> position in `MAP_CLASSES`.
_CODES = {(1, 1): 0, (3, 2): 1, (2, 2): 1, (3, 1): 2, (2, 1): 2, (3, 0): 3, (2, 0): 3, (3, 3): 1, (1, 0): 4}


def slow_curve(case: Case) -> ResponseCurve:
    """Every response of the slow flow over the window of the case."""
    return frequency_response(
        case, detuning=Axis(case).ends, method="slow-flow", form=case.analysis.form, points=CURVE_POINTS
    )


def responses_at(case: Case, detuning: float) -> tuple[Floats, Floats, np.ndarray]:
    """Pipe and relative amplitude [m] of the responses of the slow flow at one detuning, and which are stable."""
    found = slow_flow_values(case, detuning=detuning, form=case.analysis.form)
    pipe, relative, stability = (values.reshape(-1) for values in found)
    there = stability >= 0
    return pipe[there], relative[there], stability[there] == 0


@dataclass(frozen=True)
class ManifoldLines:
    """Slow manifold: |Z| and |X| [m] of its attracting and repelling parts, and its folds."""

    relative: Floats
    attracting: Floats
    repelling: Floats
    folds: Folds | None


def manifold_lines(case: Case, detuning: float) -> ManifoldLines:
    """Slow invariant manifold at one detuning, up to a little beyond its jumps."""
    slow = slow_flow_of(build_system(case), case.analysis.form)
    relation = slow_manifold(slow, slow.omega + detuning)
    folds = relation.folds
    if folds is None:
        Z = np.linspace(0.0, relation.reach, _MANIFOLD_POINTS)
        X = relation.pipe_amplitude(Z)
        return ManifoldLines(Z, X, np.full(Z.size, np.nan), None)
    low, high = folds.relative
    Z = np.unique(np.concatenate([np.linspace(0.0, relation.reach, _MANIFOLD_POINTS - 2), (low, high)]))
    X = relation.pipe_amplitude(Z)
    between = (low < Z) & (high > Z)
    return ManifoldLines(Z, np.where(between, np.nan, X), np.where((low <= Z) & (high >= Z), X, np.nan), folds)


@dataclass(frozen=True)
class StabilityMap:
    """Classes of the responses over detuning (columns) and a parameter of the sink (rows)."""

    detuning: Floats
    parameter: Floats
    classes: np.ndarray


def stability_map(case: Case, plane: str, span: tuple[float, float]) -> StabilityMap:
    """How many responses the slow flow has and how many of them are stable, see `frahm.web.looks.MAP_CLASSES`.

    Parameters
    ----------
    case : Case
    plane : {"kappa", "xi2"}
        Parameter of the sink on the rows.
    span : tuple of float
        Its range; the rows are equal factors apart.
    """
    sigma = np.linspace(*Axis(case).ends, _MAP_COLUMNS)
    rows = np.geomspace(*span, _MAP_ROWS)
    given: dict[str, Any] = {plane: rows[:, None]}
    _, _, stability = slow_flow_values(case, detuning=sigma[None, :], form=case.analysis.form, **given)
    responses, stable = np.sum(stability >= 0, axis=-1), np.sum(stability == 0, axis=-1)
    classes = np.full(responses.shape, -1, dtype=np.int8)
    for (total, holding), code in _CODES.items():
        classes[(responses == total) & (stable == holding)] = code
    return StabilityMap(sigma, rows, classes)
