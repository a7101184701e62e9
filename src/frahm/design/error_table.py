"""The step that tables every device at every error of the pipe's frequency, not retuned."""

from __future__ import annotations

from frahm.attractors import WorstMotion
from frahm.design.disturbance import Disturbance
from frahm.design.exact import ExcitedMode
from frahm.design.objective import Objective
from frahm.design.study import Rival
from frahm.design.verification import verification
from frahm.design.work import DesignWork, in_threads

_TABLE_SAMPLES = 16  # initial states at every frequency error


def error_table(work: DesignWork) -> None:
    """Every device at every frequency error, not retuned."""
    lock_in = not work.problem.within.over_wind
    if not work.settings.errors:
        return
    for name, rival in sorted(work.found.rivals.items()):
        work.step(f"frequency errors: {name}")
        modes = work.problem.modes_of_errors(work.case_of(rival))

        def row(error: float, modes: list[ExcitedMode] = modes, rival: Rival = rival) -> WorstMotion:
            if error == 1:  # known already, and better
                return rival.worst
            one = Disturbance(pipe_frequency=error, lock_in=lock_in)
            return verification(
                modes, [one], Objective(), samples=_TABLE_SAMPLES, seed=work.settings.seed, quick=True
            ).motion

        rows = in_threads(row, work.settings.errors)
        work.found.table[name] = tuple(row.pipe_peak for row in rows)
        work.found.table_doubts[name] = tuple(row.unverified for row in rows)
