"""Room `absorbers`: force laws of sinks, dampers and springs, with stops, friction and weight."""

from frahm.absorbers.attachments import Friction, Stops
from frahm.absorbers.law import Law
from frahm.absorbers.polynomial_laws import Bistable, Cubic, Linear, Polynomial
from frahm.absorbers.statics import STANDARD_GRAVITY, cubic_stroke_limit, equilibria, sag, wells
from frahm.absorbers.transverse_springs import TransverseSprings

__all__ = [
    "STANDARD_GRAVITY",
    "Bistable",
    "Cubic",
    "Friction",
    "Law",
    "Linear",
    "Polynomial",
    "Stops",
    "TransverseSprings",
    "cubic_stroke_limit",
    "equilibria",
    "sag",
    "wells",
]
