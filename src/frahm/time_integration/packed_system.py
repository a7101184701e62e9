"""A `System` as flat tables for the compiled integrator: M^-1 taken once, zeros left out, one column per system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from frahm.absorbers.packed import POLYNOMIAL, pack_laws
from frahm.arrays import Floats
from frahm.errors import ParameterError
from frahm.lanes import LANES, address
from frahm.systems import System

Integers = NDArray[np.int64]


class Structure(NamedTuple):
    """Where the numbers stand, the same for every system of a batch; lists as addresses, see `frahm.lanes`.

    Rows and columns are places of coordinates in the state of all lanes. Entries of `linear` are kept
    per row r from start[r] to start[r + 1], those of `reach` and `input` per element likewise. `laws` are the codes of
    `frahm.absorbers.packed`.
    """

    size: int
    elements: int
    linear_start: int
    linear_column: int
    reach_start: int
    reach_column: int
    input_start: int
    input_row: int
    laws: int


class GeneralStructure(NamedTuple):
    """A `Structure` with laws that are no bare polynomials: a type of its own, so that polynomials pay nothing."""

    size: int
    elements: int
    linear_start: int
    linear_column: int
    reach_start: int
    reach_column: int
    input_start: int
    input_row: int
    laws: int


class Numbers(NamedTuple):
    """What stands there, one row per entry, one column per system (or per lane, inside the integrator).

    `linear` holds -M^-1 [K C], `reach` the directions n, `input` -M^-1 n, `law` the packed laws, `forcing` M^-1 f, and
    `monitor` two rows over the coordinates: the output and the first element's direction.
    """

    linear: Any
    reach: Any
    input: Any
    law: Any
    forcing: Any
    monitor: Any


@dataclass(frozen=True)
class PackedSystems:
    """Systems as tables: `structure` holds addresses into `lists`, which must live as long as it is used."""

    structure: Structure | GeneralStructure
    tables: Numbers
    lists: tuple[Integers, ...]


def pack_systems(systems: Sequence[System]) -> PackedSystems:
    """Tables of one or several systems of equal size whose elements have laws of the same kinds.

    Raises
    ------
    ParameterError
        If the systems differ in their number of coordinates or elements, or in the kind of a law.
    """
    first, count = systems[0], len(systems)
    packed = [pack_laws([element.law for element in system.elements]) for system in systems]
    for index, (system, (codes, _)) in enumerate(zip(systems, packed, strict=True)):
        if system.size != first.size or not np.array_equal(codes, packed[0][0]):
            raise ParameterError(
                f"system[{index}]", system.name,
                "a system with as many coordinates and elements as the first one, and laws of the same form",
            )  # fmt: skip
    n, elements = first.size, len(first.elements)
    linear, reach, inputs = np.empty((count, n, 2 * n)), np.empty((count, elements, n)), np.empty((count, elements, n))
    forcing, monitor = np.empty((count, n)), np.zeros((count, 2, n))
    for s, system in enumerate(systems):
        mass = scipy.linalg.cho_factor(system.mass)
        linear[s] = -scipy.linalg.cho_solve(mass, np.hstack([system.stiffness, system.damping]))
        forcing[s] = scipy.linalg.cho_solve(mass, system.forcing)
        reach[s] = np.reshape([element.direction for element in system.elements], (elements, n))
        inputs[s] = -scipy.linalg.cho_solve(mass, reach[s].T).T if elements else 0.0
        monitor[s, 0] = system.output
        monitor[s, 1] = reach[s][0] if elements else 0.0
    (linear_row, linear_column, linear_values) = _sparse(linear)
    (reach_element, reach_column, reach_values) = _sparse(reach)
    (input_element, input_row, input_values) = _sparse(inputs)
    lists = tuple(
        np.ascontiguousarray(values, dtype=np.int64)
        for values in (
            _starts(linear_row, n), LANES * linear_column,
            _starts(reach_element, elements), LANES * reach_column,
            _starts(input_element, elements), LANES * input_row, packed[0][0],
        )
    )  # fmt: skip
    kind = GeneralStructure if np.any(packed[0][0][:, 0] != POLYNOMIAL) else Structure
    structure = kind(n, elements, *(address(values) for values in lists))
    tables = Numbers(
        linear_values, reach_values, input_values, _columns(np.array([table for _, table in packed])),
        _columns(forcing), _columns(monitor.reshape(count, 2 * n)),
    )  # fmt: skip
    return PackedSystems(structure, tables, lists)


def _sparse(values: Floats) -> tuple[Integers, Integers, Floats]:
    """Rows, columns and values (entries, s) of what is not zero in all of the matrices (s, rows, columns)."""
    rows, columns = np.nonzero(np.any(values != 0, axis=0))
    return rows, columns, _columns(values[:, rows, columns])


def _starts(rows: Integers, count: int) -> Integers:
    return np.concatenate([[0], np.cumsum(np.bincount(rows, minlength=count))])


def _columns(values: Floats) -> Floats:
    return np.ascontiguousarray(values.T, dtype=float)
