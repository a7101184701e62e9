"""Step `modes`: the modes of an elastic pipe, which of them the wind excites, and whether their number is enough."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from frahm.analysis.section import PASS, UNVERIFIED, Check, Section, Work
from frahm.arrays import Floats, labelled
from frahm.case import Case, Tube
from frahm.errors import ParameterError
from frahm.harmonic_balance import PeriodicResponse, is_linear
from frahm.loads import vortex_shedding
from frahm.response import periodic_responses
from frahm.response.curve import MARGINAL
from frahm.response.exact import exact_curve
from frahm.structure import ModalPipe
from frahm.structure.modes import MOST_MODES
from frahm.systems import build_system, stress_row

if TYPE_CHECKING:
    import xarray as xr

BOUND = 0.01
NAME = "The response does not depend on the number of modes"


def modes(work: Work) -> Section:
    """Modes of an elastic pipe; for a tube the response with twice as many of them beside it."""
    case, modal = work.case, work.case.pipe.modal
    if modal.shapes is None:
        return Section()
    checks = (_convergence(work),) if isinstance(case.pipe, Tube) else ()
    return Section(
        results={"modes": {"governing": case.pipe.governing_mode, "modes": _rows(modal)}},
        data={"modes": case.pipe.beam_modes.to_dataset() if isinstance(case.pipe, Tube) else _table(modal)},
        checks=tuple(check for check, _ in checks),
        unverified=(
            *(() if work.range.moves else _other_mode(work, modal)),
            *(doubt for _, doubts in checks for doubt in doubts),
        ),
        notes=(_about_lift(case, modal),),
    )


def _rows(modal: ModalPipe) -> list[dict[str, Any]]:
    try:
        stress = modal.stress()
    except ParameterError:  # a table of modes without stresses
        stress = np.full(modal.count, math.nan)
    return [
        {
            "frequency": float(modal.frequencies[k]),
            "modal_mass": float(modal.masses[k]),
            "damping_ratio": float(modal.damping_ratios[k]),
            "lift_length": float(modal.lift_lengths[k]),
            "stress_per_displacement": float(stress[k]),
        }
        for k in range(modal.count)
    ]


def _table(modal: ModalPipe) -> xr.Dataset:
    import xarray as xr

    return xr.Dataset(
        {
            "frequency": labelled("mode", modal.frequencies, "natural frequency, governing mode first", "rad/s"),
            "modal_mass": labelled("mode", modal.masses, "modal mass, shape scaled to largest value 1", "kg"),
        }
    )


def _about_lift(case: Case, modal: ModalPipe) -> str:
    share = modal.lift_lengths[0] / case.pipe.length
    text = f"The lift on the governing mode is that on {share:.3g} of the pipe's length."
    if not isinstance(case.pipe, Tube):
        return text
    participation = float(case.pipe.beam_modes.participations[case.pipe.governing_mode - 1])
    if case.pipe.lift == "uniform":
        return (
            f"{text} It acts in phase with this mode all along the pipe: {participation:.4g} times as much as a lift "
            "in proportion to the mode's motion, as on a rigid pipe, and an upper bound for vortices that lose step."
        )
    return (
        f"{text} It is in proportion to the mode's motion, as on a rigid pipe; a lift as strong all along the pipe "
        f"would be {participation:.4g} times as much."
    )


def _other_mode(work: Work, modal: ModalPipe) -> tuple[str, ...]:
    """What is not looked at when the wind is nearer to another mode than to the governing one."""
    if work.range.moves:  # every mode is looked at with a lift of its own
        return ()
    shedding = vortex_shedding(work.case).frequency
    nearest = int(np.argmin(np.abs(np.log(modal.frequencies / shedding))))
    if nearest == 0:
        return ()
    return (
        f"At the wind of the case vortices are shed at {shedding / (2 * math.pi):.4g} Hz, nearer to the mode at "
        f"{modal.frequencies[nearest] / (2 * math.pi):.4g} Hz than to the governing one at "
        f"{modal.frequencies[0] / (2 * math.pi):.4g} Hz: choose pipe.governing_mode, or another wind.",
    )


def _convergence(work: Work) -> tuple[Check, tuple[str, ...]]:
    """Largest stable response over the window, and stress at the wind of the case, with twice as many modes."""
    case = work.case
    count = case.pipe.modal.count
    more = min(2 * count, MOST_MODES)
    finer = _with_modes(case, more)
    changes = {}
    if "response" in work.done.data and not is_linear(work.system):
        curve = work.done.data["response"]
        settled = curve["growth_rate"].values <= MARGINAL * curve["frequency"].values
        largest = _largest(curve["pipe_peak"].values, settled)
        other = exact_curve(build_system(finer), *work.range.frequency, None, work.range.factor)
        changes["largest stable pipe peak"] = _change(largest, _largest(other.pipe_peak, other.stable_or_limit))
    stresses = [_stress_at_the_wind(c) for c in (case, finer)]
    if None not in stresses:
        changes["stress at the wind of the case"] = _change(*stresses)  # type: ignore[arg-type]
    if more <= count or not changes:
        return Check(NAME, UNVERIFIED, "Nothing could be compared."), (f"{NAME}: nothing could be compared.",)
    named = ", ".join(f"{name} {change:.2g}" for name, change in changes.items())
    detail = f"With {more} modes in place of {count} these change by: {named} (bound {BOUND:g})."
    if max(changes.values()) <= BOUND:
        return Check(NAME, PASS, detail), ()
    return Check(NAME, UNVERIFIED, detail), (f"{detail} Raise pipe.mode_count.",)


def _with_modes(case: Case, count: int) -> Case:
    pipe = case.pipe
    assert isinstance(pipe, Tube)
    ratios = (*pipe.damping_ratios, *[pipe.damping_ratio] * (count - pipe.mode_count)) if pipe.damping_ratios else ()
    return case.with_pipe(mode_count=count, damping_ratios=ratios)


def _largest(peak: Floats, stable: np.ndarray) -> float:
    return float(np.max(np.where(stable, peak, 0.0), initial=0.0))


def _stress_at_the_wind(case: Case) -> float | None:
    """Amplitude of the first harmonic of the stress of the smallest response [Pa]; None if there is none."""
    try:
        found: list[PeriodicResponse] = periodic_responses(case, detuning=float(vortex_shedding(case).detuning))
    except ParameterError:
        return None
    return abs(complex(stress_row(case) @ found[0].harmonics[1])) if found else None


def _change(before: float, after: float) -> float:
    return abs(after / before - 1) if before else float(after != 0)
