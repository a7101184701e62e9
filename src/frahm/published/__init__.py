"""Room `published`."""

from frahm.lazy import submodules

__getattr__ = submodules(__name__)
