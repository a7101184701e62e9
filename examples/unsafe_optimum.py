"""An optimum of periodic responses alone, and what the pipe really does there.

m1 = k1 = 1, c1 = 0.002, force 0.11, and a sink of mass 0.05: a published example of the package NLvib-py optimises its
cubic spring and damper over frequencies 0.8 to 1.4 by the largest periodic response. Its optimum, spring 0.010 and
damper 0.001, is reported with 0.66 rms.
"""

import numpy as np

import frahm

SINK = frahm.Element(direction=(-1, 1), law=frahm.Cubic(stiffness=0.010, damping=0.001))
SYSTEM = frahm.System(
    mass=np.diag([1.0, 0.05]), damping=np.diag([0.002, 0.0]), stiffness=np.diag([1.0, 0.0]),
    forcing=(0.11, 0.0), elements=[SINK],
)  # fmt: skip


def main():
    """Follow the branch the optimiser saw, then everything it did not see."""
    curve = frahm.frequency_response(SYSTEM, frequency=(0.8, 1.4))
    seen = curve.branches[0]
    first = seen.piece == 0
    rms, frequency = seen.pipe_amplitude[first] / np.sqrt(2), seen.frequency[first]
    top = int(np.argmax(rms))
    stable = "stable" if seen.stable[first][top] else "unstable"
    print(f"branch from low frequency: largest rms {rms[top]:.3f} at {frequency[top]:.3f}, where it is {stable}")
    for branch in curve.branches[1:]:
        print(f"detached branch {branch.number}: pipe peak up to {branch.pipe_peak.max():.1f}")
    for sentence in curve.unverified:
        print("unverified:", sentence)
    print("motion from rest:")
    for frequency in (0.970, 0.9729, 1.0):
        motion = frahm.integrate(SYSTEM, frequency=frequency, periods=8000, samples_per_period=64).last(500)
        print(f"  at {frequency}: pipe peak {motion.peaks().pipe:.2f}, rms {np.sqrt(np.mean(motion.x1**2)):.2f}")


if __name__ == "__main__":
    main()
