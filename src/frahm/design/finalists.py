"""Finalists: designs that are best by the closed form once it is corrected by the exact equations.

The closed form of one harmonic misses the true optimum by a few per cent, and the optimum lies where a detached curve
is born: a limit, not a hill. So the closed form is searched again with the birth, the stability and the peak shifted by
what the exact equations say at the last design, until both agree (space mapping).
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from frahm.arrays import Floats
from frahm.design.absorber import DesignedAbsorber, parameters_text
from frahm.design.disturbance import Disturbance
from frahm.design.exact import ExactJudgement, ExcitedMode, conditions_of, exact_birth, exact_judgement
from frahm.design.search import BIRTH, GROWTH, STROKE, ClosedFormSearch, Corrections, DesignLimits

_ROUNDS = 6
_SETTLED = 1e-3  # relative change of the exact peak that ends the rounds
_SHORT = 1.5e-3  # by which an exact birth may fall short of the margin while the rounds go on
_LEAST_DECAY = 4.5e-3  # per period: slower motions do not settle within the periods of the attractor search
_MISSED = 2e-3  # of the force: a detached curve so near its birth may be too small to be met
_TRUSTED = (0.95, 1.1)  # ratios of exact to screened peaks beyond these tell of a jump, not of a trend
_HOPELESS, _JUMPED = 4.0, 1.3  # ratios from where on the neighbourhood of a design is left, the second if wary
FAR = 1.1  # of the margin asked for: how far a birth is looked for


@dataclass(frozen=True)
class Finalist:
    """A design with what the exact periodic responses say of it.

    Attributes
    ----------
    design : DesignedAbsorber
    predicted : float
        Value of the objective expected of all attractors.
    exact : ExactJudgement
    force_margin : float
        Largest factor on the force up to which no detached curve was met [-].
    open_ended : bool
        Whether no birth was met at all.
    """

    design: DesignedAbsorber
    predicted: float
    exact: ExactJudgement
    force_margin: float
    open_ended: bool


def finalists(
    tier: ClosedFormSearch,
    modes_of: Callable[[DesignedAbsorber], Sequence[ExcitedMode]],
    disturbances: Sequence[Disturbance],
    limits: DesignLimits,
    wary: bool = False,
) -> tuple[list[Finalist], list[str]]:
    """Designs that keep the limits by the exact equations, best first, and why others were discarded.

    A design whose exact response is far larger than the closed form says is left, with its neighbourhood: by four
    times, or by a third if `wary`. Either way may find what the other passes by.
    """
    kept: list[Finalist] = []
    discarded: list[str] = []
    decay = _LEAST_DECAY * tier.screening.host.frequency / (2 * math.pi)
    corrections = Corrections()
    for stable in (True, False):
        goal = dataclasses.replace(limits, stable=stable)
        kept.sort(key=lambda finalist: finalist.predicted)
        corrections = dataclasses.replace(corrections, damping=decay if stable else -math.inf)
        last = math.inf
        for _ in range(_ROUNDS):
            found = tier.best(goal, corrections)
            if found is None or (not stable and kept and found[1] >= kept[0].predicted):
                break
            row, _ = found
            judged = tier.judge(row[None])
            finalist, birth = _judged(tier, row, judged, modes_of, disturbances, limits, corrections)
            ratio = float(np.max(tier.peak_ratios(finalist.exact.peaks, judged[0])))
            if ratio > (_JUMPED if wary else _HOPELESS):
                tier.avoid(row)  # the exact equations have a branch there that no correction lets the closed form see
                discarded.append(_jump(finalist))
                continue
            short = limits.force_margin - finalist.force_margin
            lazy = stable and finalist.exact.growth_rate > -0.5 * decay
            wide = finalist.exact.relative_peak > limits.stroke * 1.0005
            wide |= limits.filling(row[None], np.array([finalist.exact.relative_peak]))[0] > 1
            if short <= 0 and not (lazy or wide or finalist.exact.detached):
                kept.append(finalist)
            elif abs(finalist.predicted - last) < _SETTLED * last and short > _SHORT:
                discarded.append(_reason(finalist, limits))
            if kept and abs(finalist.predicted - last) < _SETTLED * last and short <= 0:
                break
            last = finalist.predicted
            corrections = _corrected(tier, corrections, judged[0], finalist, birth, decay if stable else -math.inf)
            # where the closed form has its detached curves too early, it must not be asked for the whole margin
            tier = tier.reloaded(limits.force_margin / corrections.birth)
    return sorted(kept, key=lambda finalist: finalist.predicted), list(dict.fromkeys(discarded))


def _judged(
    tier: ClosedFormSearch, row: Floats, judged: Floats, modes_of: Callable[[DesignedAbsorber], Sequence[ExcitedMode]],
    disturbances: Sequence[Disturbance], limits: DesignLimits, corrections: Corrections,
) -> tuple[Finalist, float]:  # fmt: skip
    """The finalist, and the birth factor between what is known to be free and what is known not to be."""
    design = tier.space.absorber(row)
    modes = modes_of(design)
    forces = sorted({1.0, limits.force_margin}) if design.nonlinear else [1.0]
    exact = exact_judgement(modes, disturbances, forces)
    free, taken = math.inf, math.inf
    if design.nonlinear:
        guess = judged[0, BIRTH] * corrections.birth
        most = FAR * limits.force_margin
        conditions = conditions_of(modes, disturbances)
        order = np.argsort(tier.screening.births_by_condition(row), kind="stable")
        critical_first = [conditions[i] for i in order]
        free, taken = exact_birth(critical_first, guess if math.isfinite(guess) else most, most)
    as_exact = judged.copy()
    as_exact[0, GROWTH] = exact.growth_rate
    as_exact[0, tier.peak_columns] = tier.peak_rows(exact.peaks)
    predicted = float(tier.objective.over_scatter(tier.values(as_exact, Corrections()))[0])
    known = free if math.isinf(taken) else free - _MISSED
    return Finalist(design, predicted, exact, known, math.isinf(taken)), 0.5 * (free + taken)


def _corrected(
    tier: ClosedFormSearch, old: Corrections, judged: Floats, finalist: Finalist, birth: float, decay: float
) -> Corrections:
    """Corrections that make the closed form agree with the exact equations at this design."""
    exact = finalist.exact
    known = math.isfinite(judged[BIRTH]) and not finalist.open_ended
    offset = exact.growth_rate - judged[GROWTH]
    return Corrections(
        peaks=np.clip(tier.peak_ratios(exact.peaks, judged), *_TRUSTED),
        stroke=exact.relative_peak / judged[STROKE],
        birth=(birth - 1.5 * _MISSED) / judged[BIRTH] if known else old.birth,
        damping=decay + offset if math.isfinite(decay) and math.isfinite(offset) else old.damping,
    )


def _jump(finalist: Finalist) -> str:
    return (
        f"{parameters_text(finalist.design)}: the exact equations have a response of"
        f" {max(finalist.exact.peaks):.4g} m that one harmonic does not show."
    )


def _reason(finalist: Finalist, limits: DesignLimits) -> str:
    return (
        f"{parameters_text(finalist.design)}: the exact equations have a detached curve at"
        f" {finalist.force_margin:.4g} times the force, short of {limits.force_margin:g}."
    )
