"""Room `absorbers`: force laws of sinks, dampers and springs, with stops, friction and weight."""

from frahm.absorbers.attachments import Friction, Stops
from frahm.absorbers.laws import Bistable, Cubic, Law, Linear, Polynomial, TransverseSprings
from frahm.absorbers.statics import STANDARD_GRAVITY, cubic_stroke_limit, equilibria, sag, wells

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
