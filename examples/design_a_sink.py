"""The best sink for the built-in pipe, verified over all attractors and held against a tuned mass damper.

Fewer initial states than the default of 200 keep this short. With a folder as argument the comparison is drawn into it.
"""

import math
import sys
from pathlib import Path

import frahm


def main():
    """Design, compare, and check the promise with another sample of initial states."""
    print(f"frahm {frahm.__version__}")
    study = frahm.design_absorber("jacket-pipe", samples=48, errors=(0.9, 1.0, 1.1), margins=())
    sink = study.best.design
    print(f"best sink: kappa {sink.kappa:.2f} 1/(m^2 s^2), xi2 {sink.xi2:.5f} 1/s, rho2 {sink.rho2:g}")
    print(f"no detached response up to {study.best.force_margin:.3f} times the force")
    print("worst pipe peak over all attractors found:")
    for rival in study.comparison:
        margin = "none can be" if math.isinf(rival.force_margin) else f"{rival.force_margin:.3f}"
        margin = "not searched" if math.isnan(rival.force_margin) else margin
        state = "verified" if rival.verified else "unverified"
        print(f"  {rival.name:18} {rival.worst_pipe_peak:.5f} m, {state}; detached response from: {margin}")
    print(study.verdict)

    again = frahm.worst_case(study.best_case, detuning=(-0.4, 0.4), samples=100, seed=7)
    print(f"another sample of initial states: {again.pipe_peak:.5f} m, {again.attractor.kind}")
    for sentence in (*study.unverified, *again.unverified):
        print("unverified:", sentence)
    if len(sys.argv) > 1:
        from frahm.plotting.design_figures import comparison_figure
        from frahm.plotting.style import figure_style

        with figure_style():
            comparison_figure(study.to_dataset()).savefig(Path(sys.argv[1]) / "design_a_sink.png", dpi=110)


if __name__ == "__main__":
    main()
