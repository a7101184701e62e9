"""Which few rows of a table of utilisations leave the smallest worst one, where every column takes its best row."""

from __future__ import annotations

import numpy as np

from frahm.arrays import Floats

_TRIED = 400  # rows that stand for all where every choice of several is tried


def best_rows(values: Floats, count: int) -> tuple[int, ...]:
    """At most `count` rows of `values` (D, n) whose least value in the worst column is smallest.

    Exact if at most 400 rows are left once those are dropped that serve, at the best threshold, no column that
    another does not serve; otherwise of these the 400 that serve most columns.
    """
    levels = np.unique(np.min(values, axis=0))
    levels = np.unique(values[np.isfinite(values) & (values >= levels[-1])])
    best: tuple[int, ...] = (int(np.argmin(np.max(values, axis=1))),)
    lo, hi = 0, len(levels) - 1
    while lo <= hi:
        middle = (lo + hi) // 2
        found = _serving(values <= levels[middle], count)
        if found is None:
            lo = middle + 1
        else:
            best, hi = found, middle - 1
    return best


def _serving(serves: np.ndarray, count: int) -> tuple[int, ...] | None:
    """Rows of a table (D, n) of bool, at most `count`, that together serve every column; None if there are none."""
    masks: dict[int, int] = {}
    for row, mask in enumerate(_masks(serves)):
        masks.setdefault(mask, row)
    wanted = (1 << serves.shape[1]) - 1
    largest = _undominated(sorted(masks, key=lambda mask: -mask.bit_count()))
    chosen = _chosen(wanted, largest, count)
    return None if chosen is None else tuple(masks[mask] for mask in chosen)


def _masks(serves: np.ndarray) -> list[int]:
    packed = np.packbits(serves, axis=1, bitorder="little")
    return [int.from_bytes(row.tobytes(), "little") for row in packed]


def _undominated(masks: list[int]) -> list[int]:
    kept: list[int] = []
    for mask in masks:
        if len(kept) == _TRIED:
            break
        if not any(mask & other == mask for other in kept):
            kept.append(mask)
    return kept


def _chosen(wanted: int, masks: list[int], count: int) -> list[int] | None:
    """Masks, at most `count`, that hold all bits wanted: the lowest bit that is missing is served by one of them."""
    if not wanted:
        return []
    if count == 0:
        return None
    lowest = wanted & -wanted
    for mask in masks:
        if mask & lowest:
            rest = _chosen(wanted & ~mask, masks, count - 1)
            if rest is not None:
                return [mask, *rest]
    return None
