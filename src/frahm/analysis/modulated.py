"""Steps `modulated` and `basins`: modulated responses over the window, and who leads where at the design wind."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from frahm.analysis.section import PASS, UNVERIFIED, Check, Section, Work
from frahm.attractors import ModulatedCurve, basin_map, modulated_branches
from frahm.errors import ParameterError

_LOOKS = 17
_RESOLUTION = 45  # states along each axis of the basin map
_HELD = "Modulated responses of the slow flow are there in the exact equations"
_AGREES = 0.1  # relative difference of the largest pipe displacement


def modulated(work: Work) -> Section:
    """Modulated responses of the slow flow as branches over the detuning, and where they coexist with periodic ones."""
    slow = work.theory
    if isinstance(slow, str) or not slow.force:
        return Section()
    settings = work.case.analysis
    curve = modulated_branches(work.system, detuning=work.range.detuning, form=settings.form, looks=_LOOKS)
    return Section(
        results={
            "modulated": {
                "ranges": [list(r) for r in curve.ranges],
                "coexistence": [list(r) for r in curve.coexistence],
                "pipe_max": float(np.max(curve.pipe_max[curve.stable], initial=0.0)),
                "relative_max": float(np.max(curve.relative_max[curve.stable], initial=0.0)),
                "ends": [[end.sentence for end in pair] for pair in curve.ends],
            }
        },
        data={"modulated": curve.to_dataset()} if curve.frequency.size else {},
        checks=_checks(curve),
        notes=curve.unverified,
    )


def _checks(curve: ModulatedCurve) -> tuple[Check, ...]:
    if not curve.checks:
        return ()
    apart = [abs(c.exact_pipe_max - c.pipe_max) / c.pipe_max for c in curve.checks]
    good = max(apart) <= _AGREES and all(c.modulated for c in curve.checks)
    where = ", ".join(f"{c.detuning:.3g}" for c in curve.checks)
    detail = (
        f"Exact motions started on them at detunings {where} rad/s "
        + ("stay modulated" if all(c.modulated for c in curve.checks) else "do not all stay modulated")
        + f"; the largest pipe displacements differ by at most {100 * max(apart):.2g} %."
    )
    return (Check(_HELD, PASS if good else UNVERIFIED, detail),)


def basins(work: Work) -> Section:
    """Which attractor every initial displacement and velocity of the pipe leads to, where there are several.

    At the design wind if several motions last there, otherwise where the worst of the window is, if it is not alone.
    """
    detuning = _several_at(work.done.results)
    if detuning is None:
        return Section()
    W = work.system.reference_frequency + detuning
    try:
        data = basin_map(work.driven(W), frequency=W, resolution=_RESOLUTION)
    except ParameterError as refused:
        return Section(notes=(f"The basins at {work.range.place(W)} were not mapped: {refused}",))
    found = {"detuning": detuning, "wind_speed": float(work.range.speed(W))}
    return Section(results={"basin_map": found}, data={"basin_map": data})


def _several_at(results: dict[str, Any]) -> float | None:
    """Detuning [rad/s] worth a map, None if no place is."""
    worst = results.get("worst_case", {}).get("detuning")
    beside = [
        a for a in results.get("coexisting", [])
        if a["basin_fraction"] > 0 and worst is not None and math.isclose(a["detuning"], worst, abs_tol=1e-9)
    ]  # fmt: skip
    for found in (results.get("attractors", []), beside):
        settled = [a for a in found if a["kind"] != "unsettled"]
        if len(settled) > 1:
            return float(settled[0]["detuning"])
    return None
