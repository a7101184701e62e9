"""The first time on a machine, what later steps need is compiled on another core while the first ones run.

Another process compiles the stability of an orbit and the integration of motions, which are half of what an analysis
needs, and ends. What it keeps the analysis loads; what it has not come to, the analysis compiles itself.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterator

_CASE = "jacket-pipe"


@contextlib.contextmanager
def compiled_ahead() -> Iterator[None]:
    """Have another process compile meanwhile, unless that was done before, nothing can be kept or there is one core."""
    from frahm.compiled import is_to_be_kept
    from frahm.time_integration.propagate import propagate

    if (os.cpu_count() or 1) < 2 or not is_to_be_kept(propagate):
        yield
        return
    command = [sys.executable, "-c", "from frahm.cli.ahead import compile_ahead; compile_ahead()"]
    with contextlib.ExitStack() as stack:
        with contextlib.suppress(OSError):  # then there is one process
            nothing = subprocess.DEVNULL
            helper = subprocess.Popen(command, stdin=nothing, stdout=nothing, stderr=nothing)
            stack.callback(helper.wait)
            stack.callback(helper.terminate)
        yield


def compile_ahead() -> None:
    """Compile what the first steps of an analysis do not need at once."""
    compile_stability()
    compile_motions()


def compile_stability() -> None:
    """Compile what tells the multipliers and peaks of points of a branch."""
    import numpy as np
    from numba import typeof

    from frahm.case import load_case
    from frahm.harmonic_balance import search_over
    from frahm.harmonic_balance.orbits import describe
    from frahm.systems import build_system

    case = load_case(_CASE)
    search = search_over(build_system(case), 0.9 * case.pipe.frequency, 1.1 * case.pipe.frequency, None, None)
    table, numbers, complexes = np.empty((1, 1)), np.empty(1, np.int64), np.empty((1, 1), np.complex128)
    values = (search.problem, search.variation, True, table, numbers, table, complexes)
    describe.compile(tuple(typeof(value) for value in values))


def compile_motions() -> None:
    """Compile what follows motions of the exact equations."""
    from frahm.case import load_case
    from frahm.time_integration import integrate_batch

    integrate_batch(load_case(_CASE), detuning=0.0, periods=1)
