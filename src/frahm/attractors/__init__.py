"""Room `attractors`: every long-term motion at a parameter point, how likely each is, and the worst of them."""

from frahm.attractors.attractor import Attractor, AttractorSet
from frahm.attractors.finding import find_attractors

__all__ = ["Attractor", "AttractorSet", "find_attractors"]
