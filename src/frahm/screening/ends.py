"""How the ends of a member are held: from the words of a table to the supports of a case."""

from __future__ import annotations

import math
import re
from typing import Any

from frahm.errors import ParameterError, nearest

_KINDS = {"pinned": "pinned", "fixed": "clamped", "clamped": "clamped", "free": "free"}
_PAIRS = {
    **{kind: (held, held) for kind, held in _KINDS.items() if held != "free"},
    **{f"{a}-{b}": (held, other) for a, held in _KINDS.items() for b, other in _KINDS.items() if held != "free"},
    **{f"free-{b}": ("free", other) for b, other in _KINDS.items() if other != "free"},
    "cantilever": ("clamped", "free"),
}
WORDS = ("pinned", "fixed", "fixed-pinned", "pinned-fixed", "fixed-free", "cantilever")


def supports_of(ends: str | float, length: float, bending_stiffness: float, rotation: float) -> list[dict[str, Any]]:
    """Section `pipe.supports` of a case.

    Parameters
    ----------
    ends : str or float
        Words such as "pinned", "fixed" or "fixed-pinned"; or the fixity r of both ends: the rotation a moment causes
        at the end of a span that is pinned at both ends, over the rotation of span and end spring together, 0 pinned
        and 1 fixed. The spring of such an end is k = 3 r/(1 - r) E I/L (Monforton and Wu 1963, secondary).
    length : float
        [m]
    bending_stiffness : float
        E I [N m^2].
    rotation : float
        Stiffness of the spring at every pinned end [N m/rad].

    Raises
    ------
    ParameterError
        If the ends are unknown, or have no pinned one that could carry the spring.
    """
    if isinstance(ends, float):
        if rotation:
            raise ParameterError("rotational stiffness", rotation, "nothing beside a fixity of the ends")
        return _of_fixity(ends, length, bending_stiffness)
    words = "-".join(re.findall(r"[^\s/_-]+", ends.lower()))
    kinds = _PAIRS.get(words)
    if kinds is None:
        near = nearest(words, WORDS)
        hint = f"Did you mean {near!r}?" if near else None
        raise ParameterError("ends", ends, "one of " + ", ".join(WORDS) + ", or a fixity from 0 to 1", hint=hint)
    if rotation and "pinned" not in kinds:
        raise ParameterError("rotational stiffness", rotation, f"nothing for ends that are {ends}")
    places = zip(kinds, (0.0, length), strict=True)
    return [_support(kind, at, rotation) for kind, at in places if kind != "free"]


def _of_fixity(fixity: float, length: float, bending_stiffness: float) -> list[dict[str, Any]]:
    if not 0 <= fixity <= 1:
        raise ParameterError("ends", fixity, "a fixity from 0 (pinned) to 1 (fixed), or " + ", ".join(WORDS))
    spring = math.inf if fixity == 1 else 3 * fixity / (1 - fixity) * bending_stiffness / length
    kind = "clamped" if math.isinf(spring) else "pinned"
    return [_support(kind, at, spring) for at in (0.0, length)]


def _support(kind: str, at: float, rotation: float) -> dict[str, Any]:
    spring = {"rotation": rotation} if kind == "pinned" and rotation else {}
    return {"at": at, "kind": kind, **spring}
