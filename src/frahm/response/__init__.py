"""Room `response`: one verb for the response curve, whatever the method, and maps of it."""

from typing import TYPE_CHECKING, Any

from frahm.response.curve import Branch, ResponseCurve, SpecialPoint
from frahm.response.frequency_response import frequency_response, periodic_responses, with_winds
from frahm.response.maps import slow_flow_map, slow_flow_values, stability_boundaries

if TYPE_CHECKING:
    from frahm.harmonic_balance.detached import DetachedCurveEvent
    from frahm.response.loci import bifurcation_curve, detached_curve_events

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
    "slow_flow_values",
    "stability_boundaries",
    "with_winds",
]

_LATER = ("DetachedCurveEvent", "bifurcation_curve", "detached_curve_events")  # with all of the harmonic balance


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'frahm.response' has no attribute {name!r}")
    from frahm.response import loci

    return getattr(loci, name)
