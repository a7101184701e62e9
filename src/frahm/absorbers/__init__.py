"""Room `absorbers`: force laws of sinks, dampers and springs."""

from frahm.absorbers.laws import Cubic, Linear, Polynomial

__all__ = ["Cubic", "Linear", "Polynomial"]
