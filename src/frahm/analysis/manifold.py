"""Step `slow_manifold`: slow invariant manifold, folds, jumps, and the ceilings of the modulated response."""

from __future__ import annotations

from typing import Any

import numpy as np

from frahm.analysis.section import Section, Work
from frahm.arrays import labelled
from frahm.slow_flow import Folds, slow_manifold

_POINTS = 600
_NO_FOLDS = (
    "The slow invariant manifold has no folds at this damping of the sink: there are no jumps between its branches "
    "and no ceiling for a modulated response."
)


def manifold(work: Work) -> Section:
    """Slow invariant manifold at the natural frequency of the pipe, where a modulated response is to be expected."""
    import xarray as xr

    if isinstance(work.slow_flow, str):
        return Section()
    relation = slow_manifold(work.slow_flow, work.slow_flow.omega)
    Z = np.linspace(0.0, relation.reach, _POINTS)
    stable = np.ones(Z.size, dtype=int)
    if relation.folds is not None:
        low, high = relation.folds.relative
        stable = np.where((low < Z) & (high > Z), 0, 1)
    variables = {
        "relative_amplitude": labelled("point", Z, "relative amplitude |Z|", "m"),
        "pipe_amplitude": labelled("point", relation.pipe_amplitude(Z), "pipe amplitude |X| on the manifold", "m"),
        "attracting": labelled("point", stable, "branch of the manifold attracts (1) or repels (0)", "1"),
    }
    found = {"frequency": relation.frequency, "lambda": relation.lam, "folds": _folds(relation.folds)}
    return Section(
        results={"slow_manifold": found},
        data={"slow_manifold": xr.Dataset(variables)},
        notes=() if relation.folds else (_NO_FOLDS,),
    )


def _folds(folds: Folds | None) -> dict[str, Any] | None:
    if folds is None:
        return None
    return {
        "nu": list(folds.nu),
        "pipe": list(folds.pipe),
        "relative": list(folds.relative),
        "landing": list(folds.landing),
        "pipe_ceiling": folds.pipe_ceiling,
        "relative_ceiling": folds.relative_ceiling,
    }
