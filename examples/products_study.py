"""Where a nonlinear spring pays, if one absorber must serve pipes of different frequencies.

Five pipes of one tube, whose lengths spread their natural frequencies by 0 to 50 % either way around that of the middle
one, and ONE kind of absorber for all of them, of at most 2 % of the mass of the lightest: the best tuned mass damper,
the best with both springs, and the best pure sink, by `frahm.design_products`. Run it with `make products-study`; it
takes about a quarter of an hour on two cores and writes a table and a figure into the folder given, out/products-study
by default.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path

import numpy as np

import frahm

SPREADS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
FAMILIES = ("tuned", "mixed", "sink")
PIPES = 5
LENGTH, LIMIT = 22.4, 0.02  # of the pipe in the middle, and what every pipe may move [m]


def family_of_pipes(spread: float, pipes: int = PIPES) -> list[dict[str, object]]:
    """Members whose frequencies lie evenly within a spread either way."""
    shares = 1 + spread * np.linspace(-1, 1, pipes)
    return [
        {
            "name": f"pipe {number}", "diameter": 0.4572, "wall thickness": 0.0127, "length": LENGTH / math.sqrt(share),
            "ends": "fixed-pinned", "damping ratio": 0.0015, "added mass": 7.0, "lowest wind": 1.0,
            "highest wind": 40.0, "displacement limit": LIMIT, "modes": 1,
        }
        for number, share in enumerate(shares, start=1)
    ]  # fmt: skip


def one_kind(spread: float, pipes: int = PIPES) -> dict[str, object]:
    """Worst utilisation with one kind of every family, and how far that is verified."""
    study = frahm.design_products(family_of_pipes(spread, pipes), 1)
    return {"spread": spread, "none": max(one.screened.utilisation for one in study.served)} | {
        one.family: {
            "worst": one.worst, "closed_form": max(member.expected for member in one.members), "binds": one.binds.name,
            "verified": one.verified, "checked": sum(member.check is not None for member in one.members),
            "kind": one.kinds[0].row(),
        }
        for one in study.products
    }  # fmt: skip


def draw(table: list[dict[str, object]], path: Path) -> None:
    """Worst utilisation over the spread, a line a family; hollow where a member alone was checked."""
    from frahm.plotting.style import BLUE, GREEN, VERMILLION, figure_style, legend_below, new_figure, save_figure

    looks = {"tuned": (BLUE, "o", "-", "tuned"), "mixed": (GREEN, "D", "--", "both springs"),
             "sink": (VERMILLION, "s", "-.", "pure sink")}  # fmt: skip
    with figure_style():
        figure = new_figure(150, 85)
        axes = figure.subplots()
        for family, (colour, marker, style, label) in looks.items():
            x = [100 * row["spread"] for row in table]
            axes.plot(x, [row[family]["worst"] for row in table], style, color=colour, label=label)
            for share, row in zip(x, table, strict=True):
                face = colour if row[family]["verified"] else "white"
                axes.plot(share, row[family]["worst"], marker, color=colour, markerfacecolor=face)
        axes.set(xlabel="spread of the natural frequencies, either way [%]", ylabel="worst utilisation with one kind")
        axes.set_ylim(bottom=0)
        legend_below(figure, 3)
        save_figure(figure, path)


def main(folder: Path) -> None:
    """Fill the table, one spread after the other, and draw it."""
    folder.mkdir(parents=True, exist_ok=True)
    table: list[dict[str, object]] = []
    for spread in SPREADS:
        table.append(one_kind(spread))
        (folder / "products-study.json").write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
        words = [f"{name} {table[-1][name]['worst']:.4g} ({table[-1][name]['checked']} checked)" for name in FAMILIES]
        sys.stdout.write(f"spread {spread:.0%}: none {table[-1]['none']:.4g}; {', '.join(words)}\n")
        sys.stdout.flush()
    draw(table, folder / "products-study")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out/products-study"))
