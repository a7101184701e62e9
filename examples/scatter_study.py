"""Where a nonlinear spring pays under scatter of the pipe's frequency, and what several absorbers gain.

Verified designs of every family. Run it with `make scatter-study`: it takes hours on two cores, most of them for two
mixed absorbers, and writes out/scatter-study/table.json after every design, so that an interrupted run can be
continued; the figure of what is there is scatter-study.png beside it. `make scatter-study SCATTER=0.2` for one scatter.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import frahm
from frahm.design import DesignedAbsorber, DesignSettings, verified_designs, with_design
from frahm.design.disturbance import Disturbance
from frahm.design.exact import ExcitedMode, Windows
from frahm.design.objective import Objective
from frahm.design.study import rival_row
from frahm.design.verification import verification

SCATTERS = (0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3)
FAMILIES = {1: ("tuned", "sink", "mixed"), 2: ("tuned", "mixed"), 3: ("tuned",)}  # by the number of absorbers
# The best linear and cubic spring at 15 % scatter by the first-harmonic periodic responses alone.
UNVERIFIED = DesignedAbsorber(rho2=0.02, linear=0.297, kappa=735.0, xi2=0.0321)


def main(folder: Path, scatters: tuple[float, ...]) -> None:
    """Fill the table, one design after the other, and draw it."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "table.json"
    table = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    case = frahm.load_case("jacket-pipe")
    for scatter in scatters:
        for count, families in FAMILIES.items():
            name = f"{scatter:g}" if count == 1 else f"{scatter:g} x {count}"
            if name not in table:
                found = verified_designs(case, DesignSettings(scatter=scatter, count=count), families)
                table[name] = [rival_row(rival) for rival in found]
                _keep(file, table)
    draw(table, folder / "scatter-study.png")
    if "unverified 0.15" not in table and 0.15 in scatters:
        table["unverified 0.15"] = [_truth_of_the_unverified(case)]
        _keep(file, table)


def draw(table: dict[str, list[dict[str, object]]], file: Path) -> None:
    """Worst verified peak over the scatter, a line for every family and number of absorbers."""
    from matplotlib.figure import Figure

    looks = {"tuned mass damper": ("tab:blue", "--"), "sink": ("tab:orange", "-"), "mixed": ("tab:green", "-")}
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.subplots()
    lines: dict[tuple[str, int], list[tuple[float, float]]] = {}
    for name, rows in table.items():
        for row in rows:
            if row["verified"] and "name" in row:
                point = (100 * float(name.split()[0]), 1e3 * float(row["value"]))
                lines.setdefault((str(row["name"]), int(row["count"])), []).append(point)
    for (name, count), points in sorted(lines.items(), key=lambda item: -max(peak for _, peak in item[1])):
        color, style = looks[name]
        label = name if count == 1 else f"{count} x {name}"
        axes.plot(*zip(*sorted(points), strict=True), style, color=color, marker="osD"[count - 1], ms=4, label=label)
    axes.set(
        xlabel="scatter of the pipe's frequency [%]", ylabel="worst pipe peak [mm]", xlim=(0, None), ylim=(0, None)
    )
    axes.grid(alpha=0.3)
    axes.legend(frameon=False, fontsize=8)
    figure.savefig(file, dpi=150)


def _truth_of_the_unverified(case: frahm.Case) -> dict[str, object]:
    omega = case.pipe.frequency
    windows = Windows((0.7 * omega, 1.3 * omega), (0.7 * omega, 1.3 * omega), moving=True)
    system = frahm.build_system(with_design(case, UNVERIFIED))
    errors = [Disturbance(pipe_frequency=r) for r in (0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15)]
    found = verification([ExcitedMode(system, windows)], errors, Objective(), samples=200, seed=1)
    off = found.disturbance.pipe_frequency - 1
    return {"worst_pipe_peak": found.pipe_peak, "frequency_error": off, "kind": found.kind, "verified": found.verified}


def _keep(file: Path, table: dict[str, object]) -> None:
    file.write_text(json.dumps(table, indent=1), encoding="utf-8")
    name, rows = list(table.items())[-1]
    for row in rows:
        sys.stdout.write(f"{name} {row.get('name', '')}: {row['worst_pipe_peak']:.5f} m, verified {row['verified']}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    chosen = tuple(float(text) for text in sys.argv[1:]) or SCATTERS
    main(Path("out/scatter-study"), chosen)
