"""Room `plotting`: static and interactive figures."""

from frahm.lazy import submodules

__getattr__ = submodules(__name__)
