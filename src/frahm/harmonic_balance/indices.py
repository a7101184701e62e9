"""Whether responses found at one frequency can be all: the fixed-point indices of a damped system have a known sum.

Every periodic response is a fixed point of the map over one period, of index sign det(1 - Phi), Phi being the
monodromy matrix. Where all motion is damped and the springs hold the structure far out, its displacements over a period
stay below a bound that the force sets, and the indices of all responses add up to the degree of the restoring force
there: 1, whatever the structure does further in; of one mass (g(R) / |g(R)| - g(-R) / |g(-R)|) / 2. See Krasnosel'skii
and Zabreiko (1984), doi 10.1007/978-3-642-69409-7. A sum that differs proves that responses are missing; one that is
right does not prove that none is, for those of a saddle-node pair cancel.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from frahm.arrays import Complexes
from frahm.systems import System

_FAR = 1e9  # of the largest displacement found: where the highest power of a spring is alone
_SINGULAR = 1e-7  # |1 - mu| below which rounding may decide on which side of a saddle-node a response is
_NONE = 1e-12  # of the largest: what is rounding


def missing(system: System, multipliers: Sequence[Complexes], largest: float) -> tuple[str, ...]:
    """A sentence if the responses with these multipliers cannot be all; nothing where their number tells nothing.

    Parameters
    ----------
    system : System
    multipliers : sequence of ndarray of complex
        Floquet multipliers of all responses found.
    largest : float
        Largest displacement of an element among them [m].
    """
    indices = [index(values) for values in multipliers]
    expected = degree(system, _FAR * largest) if largest > 0 else None
    if expected is None or not indices or 0 in indices or sum(indices) == expected:
        return ()
    return (
        f"There are further responses: the fixed-point indices of those found add up to {sum(indices)}, those of all to"
        f" {expected}.",
    )


def add_up(system: System, multipliers: Sequence[Complexes], largest: float) -> bool:
    """Whether the indices of responses are all certain, and their sum is known to be that of all responses.

    The same holds of the symmetric responses alone, the fixed points of the map over half a period to the opposite
    state, with the multipliers of that map.
    """
    indices = [index(values) for values in multipliers]
    expected = degree(system, _FAR * largest) if largest > 0 else None
    return expected is not None and 0 not in indices and sum(indices) == expected


def index(multipliers: Complexes) -> int:
    """Index of the fixed point with these multipliers, 1 or -1; 0 where rounding decides or a multiplier is unknown."""
    apart = 1 - multipliers
    if not np.all(np.isfinite(apart)) or np.any(np.abs(apart) < _SINGULAR):
        return 0
    return int(np.sign(np.prod(apart / np.abs(apart)).real))


def degree(system: System, far: float) -> int | None:
    """Degree of the restoring force at displacements of `far` [m]; None where motions may grow or damping lacks."""
    if not _is_damped(system):
        return None
    if system.size == 1:
        ends = [_restoring(system, side * far) for side in (1, -1)]
        return int(np.sign(ends[0]) - np.sign(ends[1])) // 2
    return 1 if _holds(system, far) else None


def _restoring(system: System, x: float) -> float:
    """Static force of a system of one coordinate at x [m]."""
    own = float(system.stiffness[0, 0]) * x
    return own + sum(float(e.direction[0]) * float(e.law.static_force(e.direction[0] * x)) for e in system.elements)


def _is_damped(system: System) -> bool:
    """Whether every motion loses energy."""
    damping = np.array(system.damping)
    for element in system.elements:
        damping += element.law.damping * np.outer(element.direction, element.direction)
    values = np.linalg.eigvalsh(damping)
    return bool(values[0] > _NONE * values[-1])


def _holds(system: System, far: float) -> bool:
    """Whether the springs push every displacement back far out."""
    stiffness = np.array(system.stiffness)
    cap = float(np.max(np.abs(stiffness), initial=0.0))
    for element in system.elements:
        ends = [float(element.law.static_force(side * far)) * side / far for side in (1, -1)]
        if element.law.is_linear:
            least = ends[0]
        elif min(ends) > 0:
            least = min(*ends, cap) if cap > 0 else min(ends)
        else:
            return False
        stiffness += least * np.outer(element.direction, element.direction)
    values = np.linalg.eigvalsh(stiffness)
    return bool(values[0] > _NONE * values[-1])
