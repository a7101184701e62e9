"""Room `response`: one verb for the response curve, whatever the method, and maps of it."""

from frahm.harmonic_balance.detached import DetachedCurveEvent
from frahm.response.curve import Branch, ResponseCurve, SpecialPoint
from frahm.response.frequency_response import frequency_response, periodic_responses
from frahm.response.loci import bifurcation_curve, detached_curve_events
from frahm.response.maps import slow_flow_map, stability_boundaries

__all__ = [
    "Branch",
    "DetachedCurveEvent",
    "ResponseCurve",
    "SpecialPoint",
    "bifurcation_curve",
    "detached_curve_events",
    "frequency_response",
    "periodic_responses",
    "slow_flow_map",
    "stability_boundaries",
]
