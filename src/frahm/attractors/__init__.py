"""Room `attractors`: every long-term motion at a parameter point, how likely each is, and the worst of them."""

from frahm.attractors.attractor import Attractor, AttractorSet
from frahm.attractors.basins import basin_map
from frahm.attractors.finding import find_attractors
from frahm.attractors.lasting import lasting_motions
from frahm.attractors.modulated import modulated_response
from frahm.attractors.modulated_branches import modulated_branches
from frahm.attractors.modulated_curve import ModulatedCurve
from frahm.attractors.worst import BESIDE, WorstCase, driven_at, worst_case, worst_of, worst_over
from frahm.attractors.worst_motion import WorstMotion, joined

__all__ = [
    "BESIDE",
    "Attractor",
    "AttractorSet",
    "ModulatedCurve",
    "WorstCase",
    "WorstMotion",
    "basin_map",
    "driven_at",
    "find_attractors",
    "joined",
    "lasting_motions",
    "modulated_branches",
    "modulated_response",
    "worst_case",
    "worst_of",
    "worst_over",
]
