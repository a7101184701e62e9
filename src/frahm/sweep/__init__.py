"""Room `sweep`: a study of many cases as one labelled store; local by default, the same on a cluster; resumable.

The room is called like its verb: ``frahm.sweep(study, store=path)`` is `frahm.sweep.sweep`.
"""

from frahm.lazy import make_callable
from frahm.sweep.layout import is_sweep
from frahm.sweep.local import processes
from frahm.sweep.store import stored_study
from frahm.sweep.study import Study
from frahm.sweep.study_file import load_study, study_schema, study_template
from frahm.sweep.summary import SweepSummary, summary_of, values_text
from frahm.sweep.sweeping import SweepWarning, opened, sweep

__all__ = [
    "Study",
    "SweepSummary",
    "SweepWarning",
    "is_sweep",
    "load_study",
    "opened",
    "processes",
    "stored_study",
    "study_schema",
    "study_template",
    "summary_of",
    "sweep",
    "values_text",
]

make_callable(__name__, sweep)
