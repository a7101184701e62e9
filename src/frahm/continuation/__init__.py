"""Room `continuation`: follows residual(x, p) = 0 and locates zero curves; knows no physics."""

from frahm.continuation.contours import zero_curves

__all__ = ["zero_curves"]
