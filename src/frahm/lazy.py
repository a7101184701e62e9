"""Modules that are imported when they are first asked for, and packages that are called like their verb."""

from __future__ import annotations

import importlib
import importlib.util
import sys
import types
from collections.abc import Callable
from typing import Any


def submodules(package: str) -> Callable[[str], Any]:
    """The `__getattr__` of a package whose modules are reachable without an import of their own."""

    def find(name: str) -> Any:
        path = f"{package}.{name}"
        if name.startswith("_") or importlib.util.find_spec(path) is None:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return importlib.import_module(path)

    return find


def make_callable(package: str, function: Callable[..., Any]) -> None:
    """Let a package be called like its verb: the public name and the folder are the same attribute of the parent."""
    room = type("CallableRoom", (types.ModuleType,), {"__call__": staticmethod(function)})
    sys.modules[package].__class__ = room
