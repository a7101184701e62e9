"""Every public name is described: what goes in, with units, what comes out, and what is refused."""

import dataclasses
import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest

import frahm

NAMES = [name for name in frahm.__all__ if name != "__version__"]
FUNCTIONS = [name for name in NAMES if not inspect.isclass(getattr(frahm, name))]
CLASSES = [name for name in NAMES if inspect.isclass(getattr(frahm, name))]
NO_UNITS = {
    "load_case",
    "load_study",
    "sweep",
    "read_data",
    "read_table",
    "write_data",
    "beam_modes",
}  # units are those of what they are given


def section(text, title):
    """Text of a section of a docstring, empty if there is none."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\w[\w ]*\n-+\n|\Z)", text, re.DOTALL | re.MULTILINE)
    return found[1] if found else ""


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_says_what_goes_in_what_comes_out_and_what_is_refused(name):
    function = getattr(frahm, name)
    if inspect.ismodule(function):  # a room called like its verb
        function = getattr(function, name)
    text = inspect.getdoc(function)
    described = section(text, "Parameters")
    heads = [head for line in re.findall(r"^(\S.*?) : ", described, re.MULTILINE) for head in line.split(", ")]
    named = inspect.signature(function).parameters.values()
    asked = {parameter.name for parameter in named if parameter.kind is not parameter.VAR_KEYWORD}
    assert {head.lstrip("*") for head in heads} >= asked
    assert section(text, "Returns").strip()
    assert "ParameterError" in section(text, "Raises")
    assert name in NO_UNITS or re.search(r"\[(rad/s|m|1/s|s|-|m, m/s)\]|\[1/|\[kg|\[N|\[m/s|factor", text)


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_describes_its_fields_and_methods(name):
    kind = getattr(frahm, name)
    text = inspect.getdoc(kind)
    assert text
    if dataclasses.is_dataclass(kind):
        fields = [field.name for field in dataclasses.fields(kind) if not field.name.startswith("_")]
        assert [field for field in fields if not re.search(rf"\b{field}\b", text)] == []
    own = [
        (member, value)
        for base in kind.__mro__ if base.__module__.startswith("frahm")
        for member, value in vars(base).items() if not member.startswith("_")
    ]  # fmt: skip
    for member, value in own:
        if inspect.isfunction(value) or isinstance(value, property | classmethod | staticmethod):
            assert inspect.getdoc(getattr(kind, member)), member


ROOT = Path(__file__).resolve().parents[2]
_NAME = re.compile(r"`(frahm(?:\.[A-Za-z_]\w*)+)")
_ASK = """
import importlib, sys
for path in sys.argv[1:]:
    for module in [name for name in sys.modules if name == "frahm" or name.startswith("frahm.")]:
        del sys.modules[module]
    thing, *names = importlib.import_module("frahm"), *path.split(".")[1:]
    for name in names:
        thing = getattr(thing, name)
"""


def documented():
    """Names in the pages and in the script of README, by their path."""
    texts = [page.read_text(encoding="utf-8") for page in [*ROOT.glob("docs/*.md"), ROOT / "README.md"]]
    return sorted({name for text in texts for name in _NAME.findall(text)})


def test_every_documented_name_is_reachable_after_import_frahm_alone():
    names = documented()
    assert {"frahm.absorbers.sag", "frahm.design.pareto_front", "frahm.slow_flow.derivation"} <= set(names)
    rooms = [name for name in names if name.count(".") > 1]  # the others are those of the test above
    done = subprocess.run([sys.executable, "-c", _ASK, *rooms], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    public = {name.split(".")[1] for name in names if name.count(".") == 1}
    assert [name for name in sorted(public) if not hasattr(frahm, name)] == []


def test_a_name_that_does_not_exist_is_none():
    for thing in (frahm, frahm.slow_flow, frahm.plotting):
        with pytest.raises(AttributeError, match="no_such_name"):
            thing.no_such_name  # noqa: B018


def test_import_frahm_is_quick():
    code = "import time; start = time.perf_counter(); import frahm; print(time.perf_counter() - start)"
    run = [sys.executable, "-c", code]
    seconds = min(float(subprocess.run(run, capture_output=True, check=True).stdout) for _ in range(3))
    assert seconds < 0.3
