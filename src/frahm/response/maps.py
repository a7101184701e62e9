"""Maps of the slow flow over parameters, and its stability boundaries."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from frahm import __version__
from frahm.arrays import Floats, labelled, real_array
from frahm.case import Case
from frahm.errors import ParameterError, check_count, check_number
from frahm.slow_flow import AXES, SlowFlow, boundary_curves, pipe_scale, slow_flow_of
from frahm.slow_flow.kernels import map_into
from frahm.systems import System, as_system

if TYPE_CHECKING:
    import xarray as xr

BOUNDARY_KINDS = ("saddle-node", "hopf")
_LARGEST = 1e100
_UNITS = {"detuning": "rad/s", "kappa": "1/(m^2 s^2)", "xi2": "1/s"}


def slow_flow_map(
    case_or_system: Case | System | str,
    *,
    detuning: ArrayLike = 0.0,
    kappa: ArrayLike | None = None,
    xi2: ArrayLike | None = None,
    form: str = "averaged",
) -> xr.Dataset:
    """Every equilibrium of the slow flow, with its stability class, at every point of a parameter map.

    Parameters
    ----------
    case_or_system : Case, System or str
        One mode with one cubic sink.
    detuning : array_like
        sigma [rad/s].
    kappa : array_like, optional
        Cubic stiffness per pipe mass [1/(m^2 s^2)]; default: the case's.
    xi2 : array_like, optional
        Sink damping per pipe mass [1/s]; default: the case's. The three broadcast against each other.
    form : str
        "averaged" or "paper".

    Returns
    -------
    xarray.Dataset
        `pipe_amplitude` and `relative_amplitude` [m], NaN where there is no root, ascending in relative amplitude,
        and `stability`: -1 no root, 0 stable, 1 an odd, 2 an even number of unstable eigenvalues; axis "root" of 3.

    Raises
    ------
    ParameterError
        For bad input, or a system that is not one mode with one cubic sink.
    """
    import xarray as xr

    system = as_system(case_or_system)
    slow, given, shape = _on_map(system, detuning, kappa, xi2, form)
    pipe, relative, stability = _values(system, slow, given, shape)
    dims = (*_dims(given, shape), "root")
    text = "-1 no root, 0 stable, 1 odd, 2 even number of unstable eigenvalues"
    variables = {
        "pipe_amplitude": labelled(dims, pipe, "pipe amplitude", "m"),
        "relative_amplitude": labelled(dims, relative, "relative amplitude", "m"),
        "stability": labelled(dims, stability, "stability class", "1", codes=text),
    }
    coordinates = {
        name: labelled(name, values.reshape(-1), name, _UNITS[name]) for name, values in given.items() if name in dims
    }
    attributes = {"title": "slow-flow map", "system": system.name, "form": form, "frahm_version": __version__}
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def slow_flow_values(
    case_or_system: Case | System | str,
    *,
    detuning: ArrayLike = 0.0,
    kappa: ArrayLike | None = None,
    xi2: ArrayLike | None = None,
    form: str = "averaged",
) -> tuple[Floats, Floats, np.ndarray]:
    """Values of `slow_flow_map` as plain arrays, for whoever draws them many times a second.

    Returns
    -------
    tuple of ndarray
        Pipe and relative amplitude [m], NaN where there is no root, and stability class; last axis of 3 roots.
    """
    system = as_system(case_or_system)
    return _values(system, *_on_map(system, detuning, kappa, xi2, form))


def _on_map(
    system: System, detuning: ArrayLike, kappa: ArrayLike | None, xi2: ArrayLike | None, form: str
) -> tuple[SlowFlow, dict[str, Floats], tuple[int, ...]]:
    """The slow flow, the arrays of its parameters, and the shape they broadcast to."""
    slow = slow_flow_of(system, form)
    given = {
        "detuning": _axis(slow, "detuning", detuning),
        "kappa": _axis(slow, "kappa", slow.kappa if kappa is None else kappa),
        "xi2": _axis(slow, "xi2", slow.xi2 if xi2 is None else xi2),
    }
    try:
        shape = np.broadcast_shapes(*(values.shape for values in given.values()))
    except ValueError:
        shapes = {name: values.shape for name, values in given.items()}
        raise ParameterError("detuning, kappa, xi2", shapes, "arrays that broadcast against each other") from None
    return slow, given, shape


def _values(
    system: System, slow: SlowFlow, given: dict[str, Floats], shape: tuple[int, ...]
) -> tuple[Floats, Floats, np.ndarray]:
    points = int(np.prod(shape, dtype=int))
    pipe, relative = np.empty((points, 3)), np.empty((points, 3))
    stability = np.empty((points, 3), dtype=np.int8)
    columns = [_flat(values, shape) for values in given.values()]
    columns[0] = slow.omega + columns[0]
    map_into(slow.code, slow.omega, slow.xi1, 0.0, slow.rho2, slow.force, *columns, pipe, relative, stability)
    scale = pipe_scale(system)
    if scale != 1:
        pipe *= scale
    return pipe.reshape(*shape, 3), relative.reshape(*shape, 3), stability.reshape(*shape, 3)


def _axis(slow: SlowFlow, name: str, values: ArrayLike) -> Floats:
    above = slow.limits[0] - slow.omega if name == "detuning" else None
    allowed = f"numbers below {_LARGEST:g} in size [{_UNITS[name]}]" + ("" if above is None else f" > {above:.6g}")
    if name == "xi2":
        allowed += " >= 0"
    array = real_array(name, values, allowed)
    if array.size == 0 or not np.all(np.abs(array) < _LARGEST):
        raise ParameterError(name, values, allowed)
    if (above is not None and np.min(array) <= above) or (name == "xi2" and np.min(array) < 0):
        raise ParameterError(name, float(np.min(array)), allowed)
    return array


def _flat(values: Floats, shape: tuple[int, ...]) -> Floats:
    return values.reshape(-1) if values.size == 1 else np.broadcast_to(values, shape).reshape(-1)


def _dims(given: dict[str, Floats], shape: tuple[int, ...]) -> tuple[str, ...]:
    """Name every axis after the only parameter that varies along it, otherwise by its number."""
    names = []
    for axis, length in enumerate(shape):
        back = len(shape) - axis
        varying = [name for name, v in given.items() if v.ndim >= back and v.shape[-back] == length and length > 1]
        alone = len(varying) == 1 and given[varying[0]].size == length
        names.append(varying[0] if alone else f"axis_{axis}")
    return tuple(names)


def stability_boundaries(
    case_or_system: Case | System | str,
    plane: tuple[str, str] = ("detuning", "kappa"),
    bounds: tuple[tuple[float, float], tuple[float, float]] = ((-0.4, 0.4), (0.0, 1000.0)),
    *,
    detuning: float = 0.0,
    form: str = "averaged",
    resolution: int = 400,
) -> xr.Dataset:
    """Saddle-node and Hopf points of the slow flow as curves in a plane of two parameters.

    Parameters
    ----------
    case_or_system : Case, System or str
        One mode with one cubic sink.
    plane : tuple of str
        Two of "detuning" [rad/s], "kappa" [1/(m^2 s^2)], "xi2" [1/s], "rho2" [-], "force" (factor on the forcing).
    bounds : tuple of tuple of float
        (lo, hi) for both axes.
    detuning : float
        sigma [rad/s] where it is not an axis.
    form : str
        "averaged" or "paper".
    resolution : int
        Grid lines per axis on which the curves are looked for; every vertex is then located to rounding. Tips and
        loops narrower than the spacing of the lines are cut off or not seen.

    Returns
    -------
    xarray.Dataset
        Over "point": one variable for each axis, `kind` (0 saddle-node, 1 hopf), `curve`, and the amplitudes [m].

    Raises
    ------
    ParameterError
        For bad input, or a system that is not one mode with one cubic sink.
    """
    import xarray as xr

    system = as_system(case_or_system)
    slow = slow_flow_of(system, form)
    check_number("detuning", detuning, above=slow.limits[0] - slow.omega, unit="rad/s")
    count = check_count("resolution", resolution, at_least=10, at_most=5000)
    curves = boundary_curves(slow, plane, bounds, float(detuning), count)
    sizes = [curve.x.size for curve in curves]

    def column(name: str) -> Floats:
        return np.concatenate([getattr(curve, name) for curve in curves]) if curves else np.empty(0)

    kinds = np.repeat([BOUNDARY_KINDS.index(curve.kind) for curve in curves], sizes).astype(int)
    numbers = np.repeat(np.arange(len(curves)), sizes).astype(int)
    variables = {
        plane[0]: labelled("point", column("x"), plane[0], AXES[plane[0]]),
        plane[1]: labelled("point", column("y"), plane[1], AXES[plane[1]]),
        "kind": labelled("point", kinds, "kind of boundary", "1", codes="0 saddle-node, 1 hopf"),
        "curve": labelled("point", numbers, "number of the connected curve", "1"),
        "pipe_amplitude": labelled("point", pipe_scale(system) * column("pipe_amplitude"), "pipe amplitude", "m"),
        "relative_amplitude": labelled("point", column("relative_amplitude"), "relative amplitude", "m"),
    }
    attributes = {
        "title": "stability boundaries of the slow flow",
        "system": system.name,
        "form": form,
        "resolution": count,
        "kind_names": ", ".join(BOUNDARY_KINDS),
        "frahm_version": __version__,
    }
    return xr.Dataset(variables, attrs=attributes)
