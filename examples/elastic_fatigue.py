"""An elastic pipe with a sink at its tip: modes, stress, and the fatigue damage of its wind climate.

The climate of the built-in case is an example; a site has its own. Few wind bins and few initial states keep this
short: take more for a design. With a folder as argument the damage under the uniform lift is drawn into it.
"""

import sys
from pathlib import Path

import numpy as np

import frahm


def damage_of(case):
    """Print the damage of a case; return it."""
    damage = frahm.fatigue_damage(case, bins=16, samples=8)
    print(f"lift {case.pipe.lift}, damage in 20 years, winds {damage.lower[0]:.2f} to {damage.upper[-1]:.2f} m/s:")
    print(f"  without the sink                 {damage.damage_without:.3g}")
    print(f"  with it, worst motion everywhere {damage.damage_with:.3g}")
    print(f"  with it, weighted by basins      {damage.damage_with_weighted:.3g}")
    worst = int(np.argmax(damage.range_with))
    print(
        f"  largest stress range with it     {damage.range_with[worst] / 1e6:.1f} MPa"
        f" at {damage.speeds[worst]:.3f} m/s ({damage.kinds[worst]})"
    )
    for sentence in damage.unverified:
        print("  unverified:", sentence)
    return damage


def main():
    """From the modes of the pipe to its damage, under the lift of a rigid pipe and under a uniform one."""
    print(f"frahm {frahm.__version__}")
    case = frahm.load_case("jacket-pipe-elastic")
    frequencies = np.array(case.pipe.modal.frequencies) / (2 * np.pi)
    print("natural frequencies:", ", ".join(f"{value:.3f} Hz" for value in frequencies))
    print(f"modal mass of the first mode: {case.pipe.mass:.0f} kg")
    print(f"stress at the clamped end over displacement of the tip: {frahm.stress_row(case)[0] / 1e6:.1f} MPa/m")
    damage_of(case.with_pipe(lift="mode-shape"))
    damage = damage_of(case.with_pipe(lift="uniform"))
    if len(sys.argv) > 1:
        from frahm.plotting.fatigue import fatigue_figure
        from frahm.plotting.style import figure_style

        with figure_style():
            fatigue_figure(damage.to_dataset()).savefig(Path(sys.argv[1]) / "elastic_fatigue.png", dpi=110)


if __name__ == "__main__":
    main()
