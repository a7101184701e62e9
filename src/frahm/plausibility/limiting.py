"""The limits: whether anything could ever exceed them, and whether the case says enough to judge them."""

from __future__ import annotations

from collections.abc import Iterator

from frahm.case import Case
from frahm.errors import ParameterError
from frahm.plausibility.implausible import Implausible, Inputs

_OF_STRESS = ("stress_range", "yield_strength")


def judged_limits(inputs: Inputs) -> Iterator[Implausible]:
    """What is implausible about the limits of a case that has some."""
    if inputs.case.limits is None:
        return
    yield from _lengths(inputs)
    yield from _stresses(inputs)
    limits = inputs.case.limits
    if "damage" in limits.model_fields_set and inputs.case.fatigue is None:
        reason = "Without the section fatigue no damage is counted, so that this limit is not judged."
        yield inputs.implausible("limits.damage", reason)
    if limits.stroke is not None and not inputs.case.absorbers:
        reason = (
            "The case has no absorber, so that frahm run has no stroke to judge; frahm design judges that of the device"
            " it finds."
        )
        yield inputs.implausible("limits.stroke", reason)


def _lengths(inputs: Inputs) -> Iterator[Implausible]:
    limits, diameter = inputs.case.limits, inputs.case.pipe.diameter
    for name in ("displacement", "stroke"):
        value = getattr(limits, name)
        if value is None or value <= diameter:
            continue
        reason = (
            f"{value / diameter:.3g} times the diameter of the pipe, {diameter:.4g} m: pipes under vortices move by"
            " about one diameter at most, a rule of thumb, so that this limit would hardly ever be reached."
        )
        yield inputs.implausible(f"limits.{name}", reason, ["mm"] if value <= 1e3 * diameter else [])


def _stresses(inputs: Inputs) -> Iterator[Implausible]:
    missing = _what_stress_lacks(inputs.case)
    for name in _OF_STRESS:
        if missing and getattr(inputs.case.limits, name) is not None:
            yield inputs.implausible(f"limits.{name}", f"It cannot be judged, for the stress is not known: {missing}.")


def _what_stress_lacks(case: Case) -> str:
    """What a case would have to say for its stress to be known; nothing if it is."""
    if case.pipe.kind == "mode":
        given = case.fatigue is not None and case.fatigue.stress_per_displacement is not None
        return "" if given else "a pipe given as one mode needs fatigue.stress_per_displacement, or be given as a tube"
    try:
        case.pipe.modal.stress()
    except ParameterError:
        return "the modes of the table need their stresses"
    return ""
