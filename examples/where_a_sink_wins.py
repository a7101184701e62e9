"""Where a nonlinear energy sink beats a tuned mass damper of the same mass, and where it does not.

Three questions about the built-in pipe with a device of 2 % of its mass, every device the best of its family for the
question, verified over all attractors: how far the frequency of the pipe may be off; how little stroke there is; and a
wind that excites the second mode of the elastic pipe. Run it with `make where-a-sink-wins`; the first takes most of
half an hour (`make scatter-study` keeps its table).
"""

from __future__ import annotations

import sys

import numpy as np

import frahm
from frahm.design import DesignedAbsorber, DesignSettings, verified_designs, with_design

STROKES = (0.0125, 0.0135, 0.015, 0.02)
SCATTER = 0.25  # of the pipe's frequency: about where the pure sink begins to win
SECOND_MODE = (15.0, 17.5)  # winds that shed at the second natural frequency of the elastic pipe [m/s]
SINK = DesignedAbsorber(0.02, 0.0, 2938.76, 0.05741)
TUNED = DesignedAbsorber(0.02, 0.461426, 0.0, 0.0165834)


def stroke_limits(scatter: float, samples: int = 60) -> list[tuple[float, dict[str, float]]]:
    """Worst pipe peak [m] of the best tuned damper and the best sink under every limit on the stroke."""
    rows = []
    for stroke in STROKES:
        settings = DesignSettings(scatter=scatter, stroke=stroke, samples=samples)
        found = verified_designs(frahm.load_case("jacket-pipe"), settings, ("tuned", "sink"))
        rows.append((stroke, {rival.name: rival.worst_pipe_peak for rival in found if rival.verified}))
    return rows


def second_mode() -> dict[str, float]:
    """Largest periodic pipe response [m] in winds at the second mode, uniform lift, devices for the first mode."""
    case = frahm.load_case("jacket-pipe-elastic").with_pipe(lift="uniform")
    cases = {"none": case.without_absorbers(), "sink": with_design(case, SINK), "tuned": with_design(case, TUNED)}
    return {
        name: float(np.max(frahm.frequency_response(one, wind=SECOND_MODE).pipe_peak)) for name, one in cases.items()
    }


def main() -> None:
    """Print all three."""
    for scatter in (0.0, SCATTER):
        sys.stdout.write(f"pipe's frequency within {100 * scatter:g} %\n")
        for stroke, peaks in stroke_limits(scatter):
            text = ", ".join(f"{name} {peak:.5f} m" for name, peak in peaks.items()) or "no design"
            sys.stdout.write(f"  stroke up to {stroke} m: {text}\n")
            sys.stdout.flush()
    peaks = ", ".join(f"{name} {peak:.5f} m" for name, peak in second_mode().items())
    sys.stdout.write(f"second mode, winds {SECOND_MODE[0]:g} to {SECOND_MODE[1]:g} m/s: {peaks}\n")


if __name__ == "__main__":
    main()
