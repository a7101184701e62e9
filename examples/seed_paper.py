"""The pipe and the three sinks of Yang et al. (2022), doi 10.3390/app12147272: what they printed, and what holds.

The slow flow in the paper's form, the exact equations by harmonic balance, and motion from rest by integration. With a
folder as argument the response curves are drawn into it.
"""

import sys
from pathlib import Path

import numpy as np

import frahm

STIFFNESSES = (24.425, 97.97, 367.38)  # kappa [1/(m^2 s^2)]; the softest, the middle and the stiffest sink of the paper
WINDOW = (-0.25, 0.25)  # detuning [rad/s]


def response_curves(case):
    """Print special points and largest responses of one sink; return the exact curve."""
    slow = frahm.frequency_response(case, detuning=WINDOW, method="slow-flow", form="paper")
    exact = frahm.frequency_response(case, detuning=WINDOW)
    for name, curve in (("slow flow", slow), ("exact", exact)):
        peak, frequency = curve.largest()
        stable, _ = curve.largest(stable_only=True)
        detuning = frequency - case.pipe.frequency
        print(f"  {name}: largest pipe peak {peak:.4f} m at sigma {detuning:.3f}, largest stable one {stable:.4f} m")
    for point in exact.special_points:
        detached = ", detached branch" if exact.detached[point.branch] else ""
        print(f"    {point.kind:15} sigma {point.detuning:8.5f} rad/s, pipe {point.pipe_peak:.5f} m{detached}")
    return exact


def draw(curves, folder):
    """One panel per sink: stable responses solid, unstable ones dotted."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(1, len(curves), figsize=(11, 3.4), sharey=True, layout="constrained")
    for panel, (kappa, curve) in zip(panels, curves.items(), strict=True):
        for stable, style in ((True, "-"), (False, ":")):
            for branch in curve.branches:
                shown = np.where(branch.stable == stable, branch.pipe_peak, np.nan)
                panel.plot(branch.detuning, shown, style, color="C3" if branch.detached else "C0")
        panel.set(title=f"kappa {kappa}", xlabel="detuning [rad/s]")
    panels[0].set_ylabel("pipe peak [m]")
    figure.savefig(Path(folder) / "seed_paper.png", dpi=110)


def main():
    """Print what is found for each sink."""
    case = frahm.load_case("jacket-pipe").with_absorber(xi2=0.0085, rho2=0.02)
    curves = {}
    for kappa in STIFFNESSES:
        print(f"kappa {kappa}")
        stiffer = case.with_absorber(kappa=kappa)
        curves[kappa] = response_curves(stiffer)
        motion = frahm.integrate(stiffer, detuning=0.0, periods=1500).last(1000)
        envelope = motion.envelope().pipe_amplitude
        print(f"  from rest at sigma 0: pipe peak {motion.peaks().pipe:.4f} m, stroke {motion.peaks().relative:.4f} m")
        if float(envelope.min()) < 0.95 * float(envelope.max()):
            print(f"  it beats: the amplitude runs from {float(envelope.min()):.4f} to {float(envelope.max()):.4f} m")
    if len(sys.argv) > 1:
        draw(curves, sys.argv[1])


if __name__ == "__main__":
    main()
