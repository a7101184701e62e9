"""`make bounds` holds every direct dependency at the bound of pyproject.toml, and knows the Python it runs on."""

import importlib.util
import sys
import tomllib
from importlib.machinery import SourceFileLoader
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def bounds(monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    loader = SourceFileLoader("bounds", str(ROOT / ".ci" / "bounds"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("bounds", loader))
    loader.exec_module(module)
    return module


def test_every_dependency_is_held_at_its_bound(bounds):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert [line.replace("==", ">=") for line in bounds.lower_bounds()] == project["dependencies"]


def test_the_tests_it_runs_are_there(bounds):
    assert all((ROOT / "tests" / "unit" / name).exists() for name in bounds.QUICK)


def test_a_dependency_without_a_lower_bound_ends_it(bounds, monkeypatch, tmp_path):
    (tmp_path / "pyproject.toml").write_text('[project]\ndependencies = ["numpy>=2.0", "scipy"]\n', encoding="utf-8")
    monkeypatch.setattr(bounds, "ROOT", tmp_path)
    with pytest.raises(SystemExit, match="'scipy' has no lower bound"):
        bounds.lower_bounds()
