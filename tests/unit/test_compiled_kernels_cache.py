"""Compiled code on disk is named after all sources it is made of: none may be missed."""

import ast
from pathlib import Path

import pytest

import frahm
from frahm import compiled

ROOT = Path(frahm.__file__).parent
MODULES = sorted(path for path in ROOT.rglob("*.py") if "@kernel" in path.read_text(encoding="utf-8"))


def imported(path):
    """Modules of this package a file imports, by the language's own parser."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("frahm"):
            found.add(node.module)
            found |= {f"{node.module}.{name.name}" for name in node.names}
        elif isinstance(node, ast.Import):
            found |= {name.name for name in node.names if name.name.startswith("frahm")}
    return {name for name in found if compiled._source(name) is not None}


def reachable(path):
    waiting, seen = [path], set()
    while waiting:
        for name in imported(waiting.pop()) - seen:
            seen.add(name)
            file = ROOT.joinpath(*name.split(".")[1:])
            waiting.append(file.with_suffix(".py") if file.with_suffix(".py").is_file() else file / "__init__.py")
    return seen


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_every_imported_module_counts(path, monkeypatch):
    read = set()
    source = compiled._source
    monkeypatch.setattr(compiled, "_source", lambda name: read.add(name) or source(name))
    name = ".".join(("frahm", *path.relative_to(ROOT).with_suffix("").parts))
    compiled._digest.__wrapped__(name)
    assert reachable(path) <= read
