"""The exact response: the complete curve of one mode and of twenty, beside AUTO, and the very first call.

The work: the jacket pipe with kappa 367.38, xi2 0.0085, rho2 0.02 over sigma in [-0.4, 0.4]. Goals: the complete curve,
detached branch included, within 20 ms of CPU time; twenty modes at most 5 times that; the first call after installation
within 30 s, with compiled kernels on disk within 3 s.

AUTO runs through the package xpplab where it is installed (`pip install xpplab`); it knows nothing of the detached
curve, and whether it sees the second Neimark-Sacker point depends on its step.
"""

import os
import subprocess
import sys
import tempfile
import time

import numpy as np
import pytest

import frahm

CASE = frahm.load_case("jacket-pipe").with_absorber(kappa=367.38, xi2=0.0085, rho2=0.02)
SYSTEM = frahm.build_system(CASE)
WINDOW = (-0.4, 0.4)
MODEL = """
par W={low:.12g}
x'=v
v'=-{c:.12g}*v-{k:.12g}*x+{kappa:.12g}*(y-x)^3+{xi2:.12g}*(u-v)+{force:.12g}*p
y'=u
u'=(-{kappa:.12g}*(y-x)^3-{xi2:.12g}*(u-v))/{rho2:.12g}
p'=p-W*q-p*(p^2+q^2)
q'=q+W*p-q*(p^2+q^2)
init p=1
@ total=100, dt=0.01, meth=5dp
done
"""


def test_complete_curve(benchmark):
    curve = benchmark.pedantic(lambda: frahm.frequency_response(SYSTEM, detuning=WINDOW), rounds=21, warmup_rounds=3)
    assert len(curve.frequency) >= 200
    assert [b.detached for b in curve.branches] == [False, True]
    assert sorted(p.kind for p in curve.special_points) == ["neimark-sacker"] * 2 + ["saddle-node"] * 4
    benchmark.extra_info["points"] = len(curve.frequency)


@pytest.mark.parametrize(("largest_step", "mesh"), [(0.005, 40)])
def test_the_curve_from_auto(benchmark, largest_step, mesh):
    xpplab = pytest.importorskip("xpplab", reason="pip install xpplab to run AUTO beside frahm")
    with tempfile.NamedTemporaryFile("w", suffix=".ode", delete=False) as file:
        file.write(_model())
    low = SYSTEM.reference_frequency + WINDOW[0]
    period = 2 * np.pi / low
    model = xpplab.load(file.name)
    model.run(total=1500 * period, dt=period / 200)  # AUTO starts from a settled motion; this is not counted
    model.ic_last()
    model.run(total=period, dt=period / 800)
    settings = {
        "ntst": mesh, "ncol": 4, "nmax": 2000, "npr": 5000, "ds": 0.002, "dsmin": 1e-6, "dsmax": largest_step,
        "parmin": low - 0.01, "parmax": SYSTEM.reference_frequency + WINDOW[1], "epsl": 1e-6, "epsu": 1e-6,
        "epss": 1e-4, "normmax": 1e3,
    }  # fmt: skip
    model.auto.set(**settings)
    diagram = benchmark.pedantic(lambda: model.auto.start("periodic", "W"), rounds=1)
    benchmark.extra_info["points"] = len(diagram)
    benchmark.extra_info["special"] = [str(point) for point in diagram.special()]
    os.unlink(file.name)


def _model():
    M, K, C = SYSTEM.mass, SYSTEM.stiffness, SYSTEM.damping
    host, low = M[0, 0], SYSTEM.reference_frequency + WINDOW[0]
    return MODEL.format(
        low=low,
        c=C[0, 0] / host,
        k=K[0, 0] / host,
        force=SYSTEM.forcing[0] / host,
        **CASE.absorbers[0].normalised(host),
    )


def pipe_of_modes(count):
    """A pinned pipe of `count` modes with the case's sink at 0.4 of its length, the first mode as in the case."""
    m, W, zeta = SYSTEM.mass[0, 0], SYSTEM.reference_frequency, CASE.pipe.damping_ratio
    number = np.arange(1, count + 1)
    omega, shape = W * number**2, np.sin(0.4 * np.pi * number)
    lift = np.where(number % 2 == 1, 4 / np.pi / number, 0.0) * SYSTEM.forcing[0]
    law = SYSTEM.elements[0].law
    return frahm.System(
        np.diag([*np.full(count, m), SYSTEM.mass[1, 1]]), np.diag([*(2 * zeta * m * omega), 0]),
        np.diag([*(m * omega**2), 0]), [*lift, 0], [frahm.Element([*-shape, 1], law)], output=[*shape, 0],
        reference_frequency=W,
    )  # fmt: skip


@pytest.mark.parametrize("modes", [1, 5, 20])
def test_modes(benchmark, modes):
    system = pipe_of_modes(modes)
    curve = benchmark.pedantic(lambda: frahm.frequency_response(system, detuning=WINDOW), rounds=9, warmup_rounds=2)
    benchmark.extra_info["points"] = len(curve.frequency)
    assert len(curve.special_points) > 0


@pytest.mark.parametrize("cached", [False, True])
def test_first_call(benchmark, cached, tmp_path):
    """Wall time of a new process: compiled on the spot, or with the kernels on disk."""
    command = [sys.executable, "-c", "import frahm; frahm.frequency_response('jacket-pipe', detuning=(-0.4, 0.4))"]
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    if cached:
        subprocess.run(command, env=environment, check=True)

    def call():
        start = time.perf_counter()
        subprocess.run(command, env=environment, check=True)
        return time.perf_counter() - start

    benchmark.extra_info["seconds"] = benchmark.pedantic(call, rounds=1)
