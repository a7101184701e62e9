"""How the work of a design is shared among its steps: what its length is judged by once the first of them is done."""

from __future__ import annotations

from typing import Any

from frahm.case import Case
from frahm.design.families import in_order
from frahm.design.problem import Problem
from frahm.design.settings import settings_for

# Of the worst motion of one device with a nonlinear spring under one disturbance. Linear devices have closed forms.
_CLOSED_FORM = 0.1
_BIRTHS = 0.5  # the search for detached curves beside it
_ERROR = 1.6  # a row of the table of frequency errors, over a window that is as wide as the error
_MARGIN = 0.4  # of the force margins, the screening included


def step_weights(case: Case, mass_ratio: float | tuple[float, float] | None = None, **changes: Any) -> list[float]:
    """Work of every step of `design_absorber`, in the order in which it tells them.

    Parameters
    ----------
    case : Case
    mass_ratio, changes
        As for `design_absorber`.
    """
    settings = settings_for(case, mass_ratio, changes=changes)
    count = len(Problem.of(case, settings).disturbances)
    nonlinear = {"sink": True, "tuned": False, "mixed": settings.family == "mixed"}
    weights = [
        float(count * number) if nonlinear[family] else _CLOSED_FORM * number
        for family in in_order(settings.family) for number in settings.counts
    ]  # fmt: skip
    weights.append(_CLOSED_FORM)
    own = bool(case.absorbers) and case.absorbers[0].law.kind != "linear"
    if case.absorbers:
        weights.append((1 + _BIRTHS) * count if own else _CLOSED_FORM)
    weights += [_CLOSED_FORM, _BIRTHS]
    if settings.errors:  # told by name: case, mixed, none, sink, tuned mass damper
        row = _ERROR * len(settings.errors)
        rows = ([row if own else _CLOSED_FORM] if case.absorbers else []) + [
            row if nonlinear["mixed"] else _CLOSED_FORM, _CLOSED_FORM, row, _CLOSED_FORM,
        ]  # fmt: skip
        weights += rows
    if settings.family != "tuned":
        weights.append(_MARGIN * len(settings.margins) * count)
    return weights
