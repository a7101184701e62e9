"""From datasets to lines and marks: what static and interactive figures both draw."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import TYPE_CHECKING

import numpy as np

from frahm import readable
from frahm.arrays import Floats
from frahm.plotting.style import PAIR, PIPE, SINK

if TYPE_CHECKING:
    import xarray as xr

DETUNING_LABEL = "detuning σ = Ω − ω [rad/s]"
SPEED_LABEL = "wind speed U [m/s]"
AXIS_LABELS = {"detuning": DETUNING_LABEL, "wind_speed": SPEED_LABEL}
QUANTITY_LABELS = {"pipe_peak": "pipe displacement x₁ [mm]", "relative_peak": "relative displacement z [mm]"}
SHORT_NAMES = {
    "saddle-node": "SN",
    "hopf": "H",
    "neimark-sacker": "NS",
    "period-doubling": "PD",
    "branch-point": "BP",
}
KIND_NAMES = {
    "saddle-node": "saddle-node",
    "hopf": "Hopf point",
    "neimark-sacker": "Neimark-Sacker point",
    "period-doubling": "period doubling",
    "branch-point": "branch point",
}
MODULATED_NAMES = {True: "modulated (slow flow)", False: "the same, unstable"}
MM = 1e3  # figures show millimetres
HEADROOM = 1.2  # height of the axis over the largest response drawn
MOST_LABELS = 16  # special points: with more of them the labels would hide what they name


@dataclass(frozen=True)
class Line:
    """A stretch of one branch with one kind of stability; `x` is the detuning [rad/s] or wind [m/s], `y` is in m."""

    x: Floats
    y: Floats
    stable: bool
    detached: bool
    asymmetric: bool = False

    @property
    def name(self) -> str:
        """What a legend says."""
        kind = "asymmetric branch, " if self.asymmetric else "detached branch, " if self.detached else ""
        return kind + ("stable" if self.stable else "unstable")


@dataclass(frozen=True)
class Mark:
    """A special point: its label (SN1, H2, ...), its kind and where it lies."""

    label: str
    kind: str
    x: float
    y: float


def line_colour(line: Line) -> str:
    """Colour of a line by the kind of its branch."""
    return PAIR if line.asymmetric else SINK if line.detached else PIPE


def line_width(line: Line) -> float:
    """Width of a line [points]: detached branches are broad, so that they stand out without colour, too."""
    return 2.4 if line.detached else 1.5


def axis_of(curve: xr.Dataset) -> str:
    """What a response stands over: the wind speed where the lift follows it, otherwise the detuning."""
    return "wind_speed" if "wind_speed" in curve else "detuning"


def resonance_of(curve: xr.Dataset) -> float:
    """Where the detuning is nearest to nought, on the axis of `axis_of`."""
    nearest = int(np.argmin(np.abs(curve["detuning"].values)))
    return float(curve[axis_of(curve)].values[nearest]) if axis_of(curve) == "wind_speed" else 0.0


def response_lines(curve: xr.Dataset, quantity: str, axis: str | None = None) -> list[Line]:
    """Stretches of every branch over `axis`, by default that of `axis_of`.

    Neighbouring stretches share a point, so that no gap is seen between them.
    """
    branch, piece = curve["branch"].values, curve["piece"].values
    stable, detached, asymmetric = (curve[name].values.astype(bool) for name in ("stable", "detached", "asymmetric"))
    x, y = curve[axis or axis_of(curve)].values, curve[quantity].values
    return [
        Line(x[part], y[part], holds, bool(detached[branch[part.start]]), bool(asymmetric[branch[part.start]]))
        for part, holds in stretches(stable, piece, branch)
    ]


def lines_by_name(lines: list[Line]) -> dict[str, Line]:
    """Lines of the same name as one, with gaps (NaN) between them: one entry of a legend each, stable ones first."""
    named: dict[str, list[Line]] = {}
    for line in sorted(lines, key=lambda line: (line.asymmetric, line.detached, not line.stable)):
        named.setdefault(line.name, []).append(line)

    def joined(parts: list[Floats]) -> Floats:
        return np.concatenate([np.append(part, np.nan) for part in parts])[:-1]

    return {
        name: Line(joined([s.x for s in same]), joined([s.y for s in same]), same[0].stable, same[0].detached,
                   same[0].asymmetric)
        for name, same in named.items()
    }  # fmt: skip


def stretches(stable: np.ndarray, *numbers: np.ndarray) -> list[tuple[slice, bool]]:
    """Stretches of equal stability of points given in order, each running on to the first point of the next.

    Where one of `numbers` (branch, piece) changes, the line is broken.
    """
    breaks = {0, stable.size, *(int(i) + 1 for values in numbers for i in np.flatnonzero(np.diff(values)))}
    parts = []
    for first, last in pairwise(sorted(breaks)):
        cuts = [first, *(int(i) + 1 + first for i in np.flatnonzero(np.diff(stable[first:last]))), last]
        parts += [(slice(a, min(b + 1, last)), bool(stable[a])) for a, b in pairwise(cuts)]
    return parts


def special_marks(curve: xr.Dataset, quantity: str) -> list[Mark]:
    """Special points in order of frequency, numbered kind by kind."""
    if "special_kind" not in curve:
        return []
    kinds = curve.attrs["special_kind_names"].split(", ")
    count: dict[str, int] = {}
    marks = []
    places = curve[f"special_{axis_of(curve)}"].values
    columns = (curve["special_kind"].values, places, curve[f"special_{quantity}"].values)
    for code, x, y in zip(*columns, strict=True):
        kind = kinds[int(code)]
        count[kind] = count.get(kind, 0) + 1
        marks.append(Mark(f"{SHORT_NAMES[kind]}{count[kind]}", kind, float(x), float(y)))
    return marks


@dataclass(frozen=True)
class Beyond:
    """Where a curve leaves the figure at its top, on the side of larger `x`, and what to write there."""

    x: float
    text: str


def beyond_the_top(bare: xr.Dataset, top: float) -> Beyond | None:
    """What to say of the response without absorbers if it rises beyond `top` [m]; None if it stays below."""
    x, y = bare[axis_of(bare)].values, bare["pipe_peak"].values
    outside = np.flatnonzero(~(y <= top))
    if not top or outside.size == 0:
        return None
    finite = bool(np.all(np.isfinite(y)))
    reach = f"up to {readable.length(float(np.max(y)))}" if finite else "without bound"
    return Beyond(float(x[outside[-1]]), f"without absorber\n{reach} ↑")


def interesting_range(curve: xr.Dataset, modulated: xr.Dataset | None) -> tuple[float, float] | None:
    """Detunings [rad/s] or winds [m/s] around everything special, for a narrow screen; None to show all."""
    axis = axis_of(curve)
    x = curve[axis].values
    places = [curve[f"special_{axis}"].values] if f"special_{axis}" in curve else []
    places += [modulated["detuning"].values] if modulated is not None else []
    known = np.concatenate([*places, [float(x[np.nanargmax(curve["pipe_peak"].values)])]])
    lo, hi = float(np.min(known)), float(np.max(known))
    margin = max(0.6 * (hi - lo), 0.1 * float(np.ptp(x)))
    lo, hi = max(lo - margin, float(np.min(x))), min(hi + margin, float(np.max(x)))
    return None if hi - lo > 0.75 * float(np.ptp(x)) else (lo, hi)


def largest_finite(values: Floats) -> float:
    """Largest finite value, 0 if there is none."""
    return float(np.max(values[np.isfinite(values)], initial=0.0))


def thinned(x: Floats, y: Floats, most: int = 1000) -> tuple[Floats, Floats]:
    """Lowest and highest value of `y` in equal stretches, at most `most` points in all: extremes are never lost."""
    finite = np.isfinite(y)
    x, y = x[finite], y[finite]
    if y.size <= most:
        return x, y
    edges = np.linspace(0, y.size, most // 2 + 1).astype(int)
    kept = sorted({a + pick(y[a:b]) for a, b in pairwise(edges) if b > a for pick in (np.argmin, np.argmax)})
    return x[kept], y[kept]


@dataclass(frozen=True)
class Envelope:
    """A stretch of a modulated branch, ascending in detuning [rad/s]: smallest and largest amplitude [m]."""

    x: Floats
    low: Floats
    high: Floats
    stable: bool


def envelopes(modulated: xr.Dataset, quantity: str) -> list[Envelope]:
    """Stretches between neighbouring points of one branch, one stability and one direction."""
    name = "pipe" if quantity == "pipe_peak" else "relative"
    x, low, high = (modulated[key].values for key in ("detuning", f"{name}_min", f"{name}_max"))
    stable, branch = modulated["stable"].values.astype(bool), modulated["branch"].values
    if x.size < 2:
        return []
    steps = list(zip(branch[:-1], branch[:-1] == branch[1:], stable[:-1] & stable[1:], np.diff(x) > 0, strict=True))
    found = []
    for (_, joined, good, forward), run in groupby(range(x.size - 1), key=lambda k: steps[k]):
        indices = list(run)
        part = np.arange(indices[0], indices[-1] + 2)[:: 1 if forward else -1]
        if joined:
            found.append(Envelope(x[part], low[part], high[part], bool(good)))
    return found
