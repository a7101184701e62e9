"""Small helpers for arrays and labelled data."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from frahm.errors import ParameterError

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]


def frozen(values: ArrayLike, dtype: Any = float) -> NDArray[Any]:
    """Read-only contiguous copy of `values`."""
    array = np.array(values, dtype=dtype, order="C")
    array.flags.writeable = False
    return array


def finite_array(name: str, values: ArrayLike, shape: tuple[int, ...]) -> Floats:
    """Read-only float array of the given shape (``-1`` matches any length), all entries finite."""
    wanted = " x ".join("n" if length < 0 else str(length) for length in shape)
    allowed = f"a finite real array of shape ({wanted})"
    array = real_array(name, values, allowed).copy()
    if array.ndim != len(shape) or any(want not in (-1, got) for want, got in zip(shape, array.shape, strict=True)):
        raise ParameterError(name, f"shape {array.shape}", allowed)
    if not np.all(np.isfinite(array)):
        raise ParameterError(name, values, allowed)
    array.flags.writeable = False
    return array


def real_array(name: str, values: ArrayLike, allowed: str) -> Floats:
    """Float array of real numbers; text, booleans, dates and complex numbers are refused."""
    try:
        raw = np.asarray(values)
        if raw.dtype.kind in "USOMmbc":
            raise TypeError
        return np.asarray(raw, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(name, values, allowed) from None


def eigenvalues(matrix: Floats) -> NDArray[np.complex128]:
    """Eigenvalues of a matrix; NaN where it has entries that are not finite, or the iteration does not end."""
    try:
        return np.linalg.eigvals(matrix).astype(complex)
    except np.linalg.LinAlgError:
        return np.full(matrix.shape[:-1], np.nan, complex)


def labelled(dims: str | tuple[str, ...], data: ArrayLike, long_name: str, units: str, **more: Any) -> tuple[Any, ...]:
    """One variable of an `xarray.Dataset`: every variable says what it is and in which unit."""
    return dims, np.asarray(data), {"long_name": long_name, "units": units, **more}
