"""A study of stiffness and damping of the sink on a Dask cluster, and what its numbers do and do not say.

A small cluster is started on this machine; with the address of another scheduler everything else stays as it is. With a
folder as argument the map of the peaks is drawn into it; a second argument makes the study smaller.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import frahm

WINDOW = [-0.3, 0.3]  # detuning [rad/s]
COUNT = int(sys.argv[2]) if len(sys.argv) > 2 else 12  # values of each parameter
STUDY = {
    "name": "stiffness-and-damping",
    "case": "jacket-pipe",
    "axes": {
        "kappa": {"from": 100, "to": 10000, "count": COUNT, "spacing": "log"},
        "xi2": {"from": 0.005, "to": 0.2, "count": COUNT, "spacing": "log"},
    },
    "quantities": {"response": {"detuning": WINDOW}},
}


def computed(folder):
    """The study on a cluster of two workers, each a process of its own."""
    from distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=":0") as cluster,
        Client(cluster) as client,  # or Client("tcp://scheduler:8786")
    ):
        return frahm.sweep(STUDY, store=Path(folder) / "study.zarr", executor=client.get_executor(pure=False)).load()


def tell(data):
    """Print what was found and what it does not cover; return the number of the best point that can be trusted."""
    modulated = data.response_ranges_without_stable.values > 0
    detached = data.response_detached_branches.values > 0
    verified = data.response_verified.values == 1
    print(f"{data.status.size} points, every branch followed and every special point located at {verified.sum()}")
    print(f"no stable periodic response somewhere at {modulated.sum()}, a detached branch at {detached.sum()}")
    peak = np.where(verified & ~modulated & ~detached, data.response_stable_pipe_peak.values, np.inf)
    best = int(np.argmin(peak))
    kappa, xi2 = frahm.load_study(STUDY).values_at(best).values()
    print(f"smallest peak of the others: {peak.ravel()[best]:.4f} m at kappa {kappa:.1f}, xi2 {xi2:.4f}")
    return best


def verify(best):
    """The map is about periodic responses; look at one point for every other lasting motion, too."""
    worst = frahm.worst_case(frahm.load_study(STUDY).case_at(best), detuning=WINDOW, samples=8, min_basin=0.1)
    word = "verified" if worst.verified else "not verified"
    print(f"largest of all lasting motions there: {worst.pipe_peak:.4f} m, {worst.attractor.kind}, {word}")


def draw(data, folder):
    """The largest stable periodic peak, marked where it is not all there is."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, panel = plt.subplots(figsize=(7.5, 4.6), layout="constrained")
    kappa, xi2 = data.kappa.values, data.xi2.values
    peak = 1000 * data.response_stable_pipe_peak.values.T
    colours = panel.pcolormesh(kappa, xi2, peak, cmap="cividis", shading="nearest")
    for flags, marker in ((data.response_ranges_without_stable, "$/$"), (data.response_detached_branches, "x")):
        at = np.argwhere(flags.values > 0)
        panel.plot(kappa[at[:, 0]], xi2[at[:, 1]], linestyle="", marker=marker, color="white", markersize=5)
    panel.set(xscale="log", yscale="log", xlabel="kappa [1/(m² s²)]", ylabel="xi2 [1/s]")
    panel.set_xticks([100, 300, 1000, 3000, 10000], labels=["100", "300", "1000", "3000", "10000"])
    panel.set_yticks([0.005, 0.01, 0.02, 0.05, 0.1, 0.2], labels=["0.005", "0.01", "0.02", "0.05", "0.1", "0.2"])
    panel.minorticks_off()
    panel.set_title("/ no stable periodic response somewhere, × detached branch", fontsize="medium", loc="left")
    figure.colorbar(colours, label="largest stable periodic peak [mm]")
    figure.savefig(Path(folder) / "sweep_on_a_cluster.png", dpi=110)


def main():
    """Compute, tell, verify, draw."""
    with tempfile.TemporaryDirectory() as folder:
        data = computed(folder)
    verify(tell(data))
    if len(sys.argv) > 1:
        draw(data, sys.argv[1])


if __name__ == "__main__":
    main()
