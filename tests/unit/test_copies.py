"""Errors and results cross to other processes, and are copied, as they are."""

import copy
import importlib
import inspect
import multiprocessing
import pickle
import pkgutil
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

import frahm
from frahm.errors import ParameterError, check_number

WAYS = {"pickle": lambda value: pickle.loads(pickle.dumps(value)), "deepcopy": copy.deepcopy, "copy": copy.copy}
CASE = frahm.load_case("jacket-pipe")


def _errors():
    """Every exception class of the package."""
    for module in pkgutil.walk_packages(frahm.__path__, "frahm."):
        if module.name.endswith("__main__"):
            continue
        try:
            found = importlib.import_module(module.name)
        except ParameterError:  # an extra that is not installed
            continue
        for _, value in inspect.getmembers(found, inspect.isclass):
            if issubclass(value, Exception) and value.__module__ == module.name:
                yield value


ERRORS = sorted(set(_errors()), key=lambda kind: kind.__qualname__)


def test_there_are_errors_to_copy():
    assert {ParameterError, frahm.ConvergenceError} <= set(ERRORS)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("kind", ERRORS, ids=lambda kind: kind.__qualname__)
def test_every_error_is_copied_with_all_it_says(kind, way):
    if issubclass(kind, ParameterError):
        error = kind("mass", -1.0, "> 0", where="case.yaml:3", hint="Did you mean 1?", also=("And so on.",))
    else:
        error = kind("It did not work.")
    other = WAYS[way](error)
    assert type(other) is kind
    assert str(other) == str(error)
    assert other.args == error.args
    assert vars(other) == vars(error)


def test_a_value_that_cannot_be_pickled_crosses_as_its_text():
    other = WAYS["pickle"](ParameterError("law", lambda z: z, "a law"))
    assert "lambda" in other.value
    assert str(other).startswith("law: given <function")


def _refuse(value):
    return check_number("mass", value, above=0)


def test_an_error_of_a_spawned_process_arrives():
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        future = pool.submit(_refuse, -1)
        with pytest.raises(ParameterError, match=r"mass: given -1; allowed: a finite number > 0") as raised:
            future.result()
    assert raised.value.name == "mass"


RESULTS = {
    "case": lambda: CASE,
    "system": lambda: frahm.build_system(CASE),
    "exact curve": lambda: frahm.frequency_response(CASE, detuning=(-0.3, -0.29)),
    "slow-flow curve": lambda: frahm.frequency_response(CASE, detuning=(-0.2, 0.2), method="slow-flow", points=10),
    "responses": lambda: frahm.periodic_responses(CASE, detuning=-0.3),
    "history": lambda: frahm.integrate(CASE, detuning=-0.3, periods=3),
    "attractors": lambda: frahm.find_attractors(CASE, detuning=-0.3, samples=2),
    "worst case": lambda: frahm.worst_case(CASE, detuning=(-0.3, -0.299), samples=2),
    "gusts": lambda: frahm.unsteady_response(CASE, record=([0.0, 10.0], [2.7, 2.6])),
    "lock-in": lambda: frahm.wake_response(CASE, speeds=2, most_periods=160),
    "modulated": lambda: frahm.modulated_branches(CASE, detuning=(-0.05, -0.04)),
    "loci": lambda: frahm.stability_boundaries(CASE, resolution=20),
    "map": lambda: frahm.slow_flow_map(CASE, detuning=[0.0, 0.1]),
    "settings": frahm.DesignSettings,
    "laws": lambda: [frahm.Cubic(1.0, 1.0), frahm.Linear(1.0), frahm.Polynomial([1.0, 2.0]), frahm.Bistable(1.0, 1.0)],
    "elements": lambda: frahm.Element((-1, 1), frahm.Cubic(1.0, 1.0)),
    "modes": lambda: frahm.load_case("jacket-pipe-elastic").pipe.modal,
    "study": lambda: frahm.load_study(
        {
            "name": "s",
            "case": "jacket-pipe",
            "axes": {"kappa": [50, 60]},
            "quantities": {"slow_flow": {"detuning": 0.0}},
        }
    ),
    "outcomes": lambda: tuple(frahm.Outcome),
}


@pytest.mark.parametrize("name", RESULTS)
def test_results_are_pickled_and_copied(name):
    result = RESULTS[name]()
    for way in WAYS.values():
        other = way(result)
        assert type(other) is type(result)
        if hasattr(result, "to_dataset"):
            assert other.to_dataset().identical(result.to_dataset())
        for key, value in vars(result).items() if hasattr(result, "__dict__") else ():
            if isinstance(value, np.ndarray):
                np.testing.assert_array_equal(getattr(other, key), value)
    assert list(getattr(WAYS["pickle"](result), "unverified", ())) == list(getattr(result, "unverified", ()))
