"""How figures look: one palette that colour-blind readers can tell apart, one size of text, one way to save."""

from __future__ import annotations

import contextlib
import io
import math
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

# Okabe and Ito's palette. Meaning never hangs on colour alone: line style or marker says it too.
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
INK, GREY, GRID = "#1a1a1a", "#6b6b6b", "#e3e3e3"
PIPE, SINK, BARE, PAIR = BLUE, VERMILLION, GREY, PURPLE
UNSTABLE_DASHES = (0, (4.0, 2.0))

_RULES: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.edgecolor": "#444444",
    "axes.labelsize": 9.0,
    "axes.titlesize": 10.0,
    "axes.titlelocation": "left",
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": GRID,
    "grid.linewidth": 0.6,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "lines.linewidth": 1.5,
    "svg.hashsalt": "frahm",  # the same figure is the same file
    "svg.fonttype": "none",
}
_INCH = 25.4
NARROW = "-narrow"  # behind the name of a drawing for a narrow screen
_NARROW_WIDTH, _LEGEND_LINE = 94.0, 4.5  # [mm]
_NARROW_LABEL = 42  # characters
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@contextlib.contextmanager
def figure_style() -> Iterator[None]:
    """Drawing and saving inside this block follows the style of the package."""
    import matplotlib as mpl

    with mpl.rc_context(_RULES):
        yield


def new_figure(width: float = 160.0, height: float = 90.0) -> Figure:
    """Empty figure of the given size [mm] that arranges its own margins; it needs no display."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width / _INCH, height / _INCH), layout="constrained")


def legend_below(figure: Figure, columns: int = 3, *, loc: Any = "outside lower center", **options: Any) -> None:
    """Legend under the panels, in no more columns than the figure has room for."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    renderer = FigureCanvasAgg(figure).get_renderer()
    for count in range(columns, 0, -1):
        legend = figure.legend(loc=loc, ncols=count, **options)
        if count == 1 or legend.get_window_extent(renderer).width <= figure.bbox.width:
            return
        legend.remove()


def save_figure(figure: Figure, stem: str | Path, *, narrow: bool = False) -> list[Path]:
    """Write `stem`.png and `stem`.svg, each complete or not at all; return their paths.

    If `narrow`, `stem`-narrow.svg too: the same for the screen of a telephone.
    """
    paths = [Path(f"{stem}.svg"), Path(f"{stem}.png")]
    arrange(figure)
    for path in paths:
        _write(figure, path)
    if narrow:
        paths.append(Path(f"{stem}{NARROW}.svg"))
        _make_narrow(figure)
        _write(figure, paths[-1])
    return paths


def _write(figure: Figure, path: Path) -> None:
    from frahm.files import write_bytes

    metadata = {"Date": None} if path.suffix == ".svg" else {"Software": None}
    packed: dict[str, Any] = {"pil_kwargs": {"compress_level": 1}} if path.suffix == ".png" else {}
    drawn = io.BytesIO()
    figure.savefig(drawn, format=path.suffix.removeprefix("."), dpi=160, metadata=metadata, **packed)
    write_bytes(path, drawn.getvalue())


def _make_narrow(figure: Figure) -> None:
    """Arrange a figure anew: text as large as before, an entry of the legend a line, long labels in several lines."""
    more = 0
    for legend in list(figure.legends):
        handles = [handle for handle in legend.legend_handles if handle is not None]
        texts = [text.get_text() for text in legend.get_texts()]
        legend.remove()
        legend_below(figure, 1, handles=handles, labels=texts)
        more += len(texts) - 1
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_label_text(textwrap.fill(axis.get_label_text(), _NARROW_LABEL))
    figure.set_size_inches(_NARROW_WIDTH / _INCH, figure.get_figheight() + more * _LEGEND_LINE / _INCH)
    figure.set_layout_engine("constrained")
    arrange(figure)


def arrange(figure: Figure) -> None:
    """Find the places of everything once: they hold for all files, each of which would look for them twice."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine(None)


def decade_axis(axis: Axis) -> None:
    """Label the decades of a logarithmic axis in plain text, no ticks between them: both take long to set."""
    from matplotlib.ticker import FuncFormatter, NullLocator

    axis.set_major_formatter(FuncFormatter(lambda value, _: decade_label(value)))
    axis.set_minor_locator(NullLocator())


def decade_label(value: float) -> str:
    """A power of ten as 10⁻³; any other number as it is."""
    power = round(math.log10(value)) if value > 0 else 0
    if not math.isclose(value, 10.0**power):
        return f"{value:g}"
    return "10" + str(power).translate(_RAISED)
