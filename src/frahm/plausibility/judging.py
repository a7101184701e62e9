"""`plausibility`: every check of this room on one case."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from frahm.case import Case, load_case
from frahm.plausibility.absorbers import judged_absorbers
from frahm.plausibility.implausible import Implausible, Inputs
from frahm.plausibility.limiting import judged_limits
from frahm.plausibility.pipes import judged_pipe
from frahm.plausibility.ranges import judged_by_size
from frahm.plausibility.winds import judged_wind


def plausibility(case: Case | str | os.PathLike[str] | Mapping[str, Any]) -> tuple[Implausible, ...]:
    """What a practised engineer would ask about a case before computing anything: warnings, never refusals.

    Parameters
    ----------
    case : Case, str, Path or dict
        A case, or whatever `load_case` reads. The texts it was typed as are used: of a plain number it is asked
        whether another unit was meant, such as Hz of a frequency [rad/s].

    Returns
    -------
    tuple of Implausible
        Empty if nothing is odd. Most are rules of thumb, and each says which number it is judged by and where that
        comes from; what is quoted from memory was not checked against the standard.

    Raises
    ------
    ParameterError
        If the case cannot be read.
    """
    inputs = Inputs(load_case(case))
    judges = (judged_by_size, judged_pipe, judged_wind, judged_absorbers, judged_limits)
    found = [one for judge in judges for one in judge(inputs)]
    order = {path: place for place, path in enumerate(inputs.values)}
    return tuple(sorted(found, key=lambda one: order[one.name]))
