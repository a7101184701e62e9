"""Room `slow_flow`: the mixed multiple-scales / harmonic-balance theory of one mode with one cubic sink."""

from frahm.lazy import submodules
from frahm.slow_flow.boundaries import AXES, BoundaryCurve, boundary_curves
from frahm.slow_flow.branches import LocatedPoint, SlowBranches, locate_points, slow_branches
from frahm.slow_flow.manifold import Folds, SlowManifold, slow_manifold
from frahm.slow_flow.model import FORMS, SlowFlow, pipe_scale, slow_flow_of
from frahm.slow_flow.motion import SlowMotion, integrate_slow_flow

__all__ = [
    "AXES",
    "FORMS",
    "BoundaryCurve",
    "Folds",
    "LocatedPoint",
    "SlowBranches",
    "SlowFlow",
    "SlowManifold",
    "SlowMotion",
    "boundary_curves",
    "integrate_slow_flow",
    "locate_points",
    "pipe_scale",
    "slow_branches",
    "slow_flow_of",
    "slow_manifold",
]

__getattr__ = submodules(__name__)  # the derivation and the check of the paper need SymPy, which loads slowly
