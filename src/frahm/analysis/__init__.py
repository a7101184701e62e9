"""Room `analysis`: one case through every step that tells something about it, stored and read back."""

from frahm.analysis.analysis import (
    STEPS,
    CaseAnalysis,
    Progress,
    Step,
    analyse,
    defaulted_fields,
    plain,
    provenance,
    step_weights,
)
from frahm.analysis.linear import bare_motions
from frahm.analysis.margin import FORCE_MARGIN, margin_sentence
from frahm.analysis.section import Check, Section, Work
from frahm.analysis.store import load_analysis, missing_arrays, read_summary, save_analysis

__all__ = [
    "FORCE_MARGIN",
    "STEPS",
    "CaseAnalysis",
    "Check",
    "Progress",
    "Section",
    "Step",
    "Work",
    "analyse",
    "bare_motions",
    "defaulted_fields",
    "load_analysis",
    "margin_sentence",
    "missing_arrays",
    "plain",
    "provenance",
    "read_summary",
    "save_analysis",
    "step_weights",
]
