"""Room `case`: the input, as models of pipe, wind, absorbers and analysis; files in and out."""

from frahm.case.absorber import Absorber, CubicLaw, LinearLaw, PolynomialLaw
from frahm.case.analysis import Analysis
from frahm.case.case import Case
from frahm.case.fields import FieldFacts, field_table
from frahm.case.loading import builtin_names, builtin_text, load_case, template_text
from frahm.case.pipe import Pipe
from frahm.case.schema import case_schema
from frahm.case.wind import Wind

__all__ = [
    "Absorber",
    "Analysis",
    "Case",
    "CubicLaw",
    "FieldFacts",
    "LinearLaw",
    "Pipe",
    "PolynomialLaw",
    "Wind",
    "builtin_names",
    "builtin_text",
    "case_schema",
    "field_table",
    "load_case",
    "template_text",
]
