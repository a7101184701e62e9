"""After how many periods a motion nearly repeats."""

from __future__ import annotations

import numpy as np

from frahm.arrays import Floats

HIGHEST_MULTIPLE = 64
_NEARLY = 0.02  # distance of strobes, in sizes of the motion, that nearly repeat
_NEARER = 0.5  # of the distance after a smaller number: a motion on a doubled orbit also nearly repeats halfway
_MOST = 6
_LESS, _NOTHING = 0.75, 1e-4  # of an earlier distance: what shrinks; in sizes of the motion: what has shrunk to nothing


def repeats(strobes: Floats) -> list[list[int]]:
    """Numbers of periods after which the last strobes (N, K, 2n), over the motion's size, nearly repeat, ascending.

    A further number is named only if they repeat twice as well after it as after every smaller one. Numbers up to 64
    are tried, each over the last 64 periods; K must be 128 at least.
    """
    last = strobes[:, -HIGHEST_MULTIPLE:]
    distance = np.empty((len(strobes), HIGHEST_MULTIPLE))
    for multiple in range(1, HIGHEST_MULTIPLE + 1):
        before = strobes[:, -HIGHEST_MULTIPLE - multiple : -multiple]
        distance[:, multiple - 1] = np.max(np.abs(last - before), axis=(1, 2))
    return [_records(row) if np.min(row) < _NEARLY else [] for row in distance]


def _records(distance: Floats) -> list[int]:
    found, least = [], _NEARLY
    for multiple, value in enumerate(distance, start=1):
        if value < least:
            found.append(multiple)
            least = _NEARER * value
    return found[:_MOST]


def approaching(strobes: Floats, multiples: list[int]) -> list[int]:
    """Those numbers of periods after which a motion repeats better and better; on a beat it repeats as well as ever.

    The strobes (K, 2n), over the motion's size, are compared with those so many periods before, early and late.
    """
    found = []
    for multiple in multiples:
        distance = np.max(np.abs(strobes[multiple:] - strobes[:-multiple]), axis=1)
        third = len(distance) // 3
        early, late = float(np.max(distance[:third])), float(np.max(distance[-third:]))
        if late < max(_LESS * early, _NOTHING):
            found.append(multiple)
    return found
