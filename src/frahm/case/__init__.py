"""Room `case`: the input, as models of pipe, wind, absorbers, climate, fatigue and analysis; files in and out."""

from frahm.case.absorber import (
    Absorber,
    BistableLaw,
    CubicLaw,
    DryFriction,
    EndStops,
    LinearLaw,
    PolynomialLaw,
    TransverseSpringsLaw,
)
from frahm.case.analysis import Analysis
from frahm.case.case import Case
from frahm.case.climate import Climate, ClimateRow, Weibull
from frahm.case.design import FAMILIES, OBJECTIVES, Design, Scatter
from frahm.case.document import Document
from frahm.case.fatigue import SN_CURVE_NAMES, Fatigue
from frahm.case.fields import FieldFacts, FieldValue, field_table, field_values
from frahm.case.limits import Limits
from frahm.case.loading import (
    TEMPLATE_KINDS,
    builtin_names,
    builtin_text,
    case_from_text,
    load_case,
    template_text,
)
from frahm.case.mode_table import ModeTable
from frahm.case.pipe import AnyPipe, Pipe
from frahm.case.schema import case_schema
from frahm.case.tube import Tube
from frahm.case.wind import Turbulence, Wind

__all__ = [
    "FAMILIES",
    "OBJECTIVES",
    "SN_CURVE_NAMES",
    "TEMPLATE_KINDS",
    "Absorber",
    "Analysis",
    "AnyPipe",
    "BistableLaw",
    "Case",
    "Climate",
    "ClimateRow",
    "CubicLaw",
    "Design",
    "Document",
    "DryFriction",
    "EndStops",
    "Fatigue",
    "FieldFacts",
    "FieldValue",
    "Limits",
    "LinearLaw",
    "ModeTable",
    "Pipe",
    "PolynomialLaw",
    "Scatter",
    "TransverseSpringsLaw",
    "Tube",
    "Turbulence",
    "Weibull",
    "Wind",
    "builtin_names",
    "builtin_text",
    "case_from_text",
    "case_schema",
    "field_table",
    "field_values",
    "load_case",
    "template_text",
]
