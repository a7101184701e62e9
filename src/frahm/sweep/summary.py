"""A store in a few numbers: how its points stand, and the best and worst of them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from frahm.sweep.store import open_store, stored_version
from frahm.sweep.study import Axes, Study
from frahm.sweep.variables import Status, Variable, variables_of

_LISTED = 6


@dataclass(frozen=True)
class Extremes:
    """The smallest and the largest value of a variable, and at which points."""

    variable: Variable
    best: float
    best_at: dict[str, float]
    best_verified: bool
    worst: float
    worst_at: dict[str, float]
    worst_verified: bool


@dataclass(frozen=True, eq=False)
class SweepSummary:
    """What a store holds.

    Attributes
    ----------
    study : Study
    version : str
        Of frahm that made it.
    verified, unverified, failed, pending : int
        Number of points.
    extremes : tuple of Extremes
        Of what one compares points by.
    troubles : tuple of str
        A sentence for every reason why points failed or are unverified, the most frequent first.
    """

    study: Study
    version: str
    verified: int
    unverified: int
    failed: int
    pending: int
    extremes: tuple[Extremes, ...]
    troubles: tuple[str, ...]

    @property
    def counts(self) -> str:
        """How many points there are of each kind."""
        named = ((self.verified, "verified"), (self.unverified, "unverified"), (self.failed, "failed"),
                 (self.pending, "not computed"))  # fmt: skip
        return f"{self.study.size} points: " + ", ".join(f"{count} {word}" for count, word in named if count)

    @property
    def good(self) -> bool:
        """Whether every point is computed and verified."""
        return self.verified == self.study.size


def summary_of(store: str | os.PathLike[str]) -> SweepSummary:
    """Summary of a store.

    Raises
    ------
    ParameterError
        If the folder does not hold a sweep.
    """
    filled = open_store(Path(store))
    study, status = filled.study, filled.status
    verified, unverified, failed, pending = (
        int(np.count_nonzero(status == code))
        for code in (Status.VERIFIED, Status.UNVERIFIED, Status.FAILED, Status.PENDING)
    )
    found = (_extreme(study, v, filled.columns[v.name], status) for v in variables_of(study) if v.headline)
    return SweepSummary(
        study=study,
        version=stored_version(store),
        verified=verified,
        unverified=unverified,
        failed=failed,
        pending=pending,
        extremes=tuple(extreme for extreme in found if extreme is not None),
        troubles=tuple(_troubles(study, filled.reasons.sentences, filled.reason, status)),
    )


def values_text(values: dict[str, float]) -> str:
    """A point as text, with units."""
    return ", ".join(f"{name} {value:.6g}{_unit(name)}" for name, value in values.items())


def _unit(axis: str) -> str:
    from frahm.case import field_table

    unit = field_table(Axes)[axis].unit
    return f" {unit}" if unit else ""


def _extreme(study: Study, variable: Variable, values: np.ndarray, status: np.ndarray) -> Extremes | None:
    if np.all(np.isnan(values)):
        return None
    best, worst = int(np.nanargmin(values)), int(np.nanargmax(values))
    sure = status == Status.VERIFIED
    return Extremes(
        variable, float(values[best]), study.values_at(best), bool(sure[best]), float(values[worst]),
        study.values_at(worst), bool(sure[worst]),
    )  # fmt: skip


def _troubles(study: Study, sentences: dict[int, str], codes: np.ndarray, status: np.ndarray) -> Iterator[str]:
    groups = []
    for code, sentence in sentences.items():
        at = np.flatnonzero(codes == code)
        for state, word in ((Status.FAILED, "failed"), (Status.UNVERIFIED, "unverified")):
            points = at[status[at] == state]
            if points.size:
                groups.append((state is Status.FAILED, points.size, int(points[0]), word, sentence))
    groups.sort(key=lambda group: (not group[0], -group[1], group[2]))
    for _, count, first, word, sentence in groups[:_LISTED]:
        where = values_text(study.values_at(first))
        yield f"{count} {word}, {'at' if count == 1 else 'first at'} {where}: {_ended(sentence)}"
    if len(groups) > _LISTED:
        yield f"And {sum(g[1] for g in groups[_LISTED:])} more points for {len(groups) - _LISTED} other reasons."


def _ended(sentence: str) -> str:
    return sentence if sentence.endswith((".", "!", "?")) else sentence + "."
