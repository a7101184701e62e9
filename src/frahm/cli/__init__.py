"""Room `cli`: the command `frahm`."""

from frahm.cli.app import app, main

__all__ = ["app", "main"]
