"""Vectors of a MAT file as a table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from frahm.errors import ParameterError
from frahm.tables.table import Table
from frahm.untrusted import binary_content


def mat_table(path: Path, label: str, largest: int) -> Table:
    """Vectors of numbers of a MAT file, those of a struct if there are none outside of it.

    The longest ones make the table; those of another length are left out, and named.
    """
    found = binary_content("mat", path, most_bytes=largest)
    if not any(_is_vector(value) and value.size > 1 for value in found.values()):
        found |= {name: value for entry in found.values() if isinstance(entry, dict) for name, value in entry.items()}
    every = {name: np.ravel(value).astype(float) for name, value in found.items() if _is_vector(value)}
    most = max((vector.size for vector in every.values()), default=0)
    if most < 2:
        raise ParameterError("file", label, "a MAT file with vectors of numbers", hint="It holds no vector of numbers.")
    vectors = {name: vector for name, vector in every.items() if vector.size == most}
    others = {name: vector.size for name, vector in every.items() if vector.size != most}
    return Table(label, tuple(vectors), ("",) * len(vectors), tuple(vectors.values()), left_out=others)


def _is_vector(value: Any) -> bool:
    numeric = isinstance(value, np.ndarray) and value.dtype.kind in "biuf"
    return numeric and value.size > 0 and max(value.shape, default=0) == value.size
