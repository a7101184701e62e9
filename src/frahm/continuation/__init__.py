"""Room `continuation`: follows residual(y) = 0 and locates points and zero curves; knows no physics."""

from frahm.continuation.contours import bisected, zero_curves
from frahm.continuation.pseudo_arclength import (
    ContinuationSettings,
    CurvePoint,
    between_points,
    follow_curve,
    newton,
)

__all__ = ["ContinuationSettings", "CurvePoint", "between_points", "bisected", "follow_curve", "newton", "zero_curves"]
