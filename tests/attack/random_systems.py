"""Random systems, each known by its number: a host with sinks of every kind, forced where motions coexist."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import frahm
from frahm.systems import with_parameters

FAMILIES = ("sink", "stiff sink", "sinks", "softening host", "bistable", "polynomial", "modes")


@dataclass(frozen=True)
class Drawn:
    """A system and a frequency of excitation [rad/s]; `low` and `high` bound a range with the resonance."""

    number: int
    family: str
    system: frahm.System
    frequency: float
    low: float
    high: float


def drawn(number, force=1.0):
    """The system of a number; families take turns. `force` is a factor on its force.

    Made without units, where the first sink has the mass `ratio` and the force ratio (z'' + spring(z) + loss z'), and
    then given a mass, a frequency and a length of its own.
    """
    random = np.random.default_rng([2026, number])
    family = FAMILIES[number % len(FAMILIES)]
    ratio = between(random, 0.01, 0.1)
    units = between(random, 1.0, 1e4), between(random, 0.5, 50.0), between(random, 1e-3, 1.0)
    host = _host(random, family, ratio)
    sinks = [(ratio, _spring(random, family), between(random, 0.03, 0.5))]
    if family == "sinks":
        sinks += [_companion(random, ratio) for _ in range(random.integers(1, 3))]
    system = _assembled(host, sinks, units, f"{family} {number}")
    system = with_parameters(system, force=force)
    middle = 1 + ratio * random.uniform(-2.5, 2)
    if random.uniform() < 0.1:
        middle = between(random, 0.3, 3.2)
    if family == "softening host":
        middle = random.uniform(0.75, 1.05)
    if family == "modes" and random.uniform() < 0.5:
        middle *= host["frequencies"][1]
    low, high = min(middle, 1.0) - 3 * ratio, max(middle, 1.0) + 2 * ratio
    omega = units[1]
    return Drawn(number, family, system, middle * omega, low * omega, high * omega)


def between(random, low, high):
    """A number between two, its logarithm uniform."""
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def _host(random, family, ratio):
    """Modes (the first of frequency 1), their damping, force and displacement at the sink; the spring to ground."""
    loss, force = ratio * between(random, 0.02, 0.5), ratio * between(random, 0.15, 3.0)
    count = int(random.integers(2, 4)) if family == "modes" else 1
    gaps = [1.0, *(between(random, 1.05, 3.0) for _ in range(count - 1))]
    shape = [1.0, *(random.uniform(-1, 1) for _ in range(count - 1))]
    ground = None
    if family == "softening host":
        loss, force = between(random, 0.01, 0.06), between(random, 0.01, 0.2)
        soft = random.uniform(0.1, 0.4)
        ground = (0.0, 0.0, -soft, 0.0, random.uniform(0.47, 1.0) * soft**2)
    return {"frequencies": np.cumprod(gaps), "loss": loss, "force": force, "shape": np.array(shape), "ground": ground}


def _spring(random, family):
    """Coefficients of the first sink's spring over its mass."""
    if family == "bistable":
        return (-random.uniform(0.1, 1.0), 0.0, 1.0)
    if family == "polynomial":
        return (random.uniform(-0.3, 1.0), random.uniform(-1, 1), random.uniform(-0.5, 1), 0.0, random.uniform(0.2, 1))
    if family in ("stiff sink", "modes") and random.uniform() < 0.7:
        return (random.uniform(0.05, 1.2), 0.0, 1.0)
    return (0.0, 0.0, 1.0)


def _companion(random, ratio):
    """A further sink: its mass, its spring and its loss over its mass."""
    linear = random.uniform(0.0, 1.0) if random.uniform() < 0.5 else 0.0
    return ratio * between(random, 0.3, 1.5), (linear, 0.0, between(random, 0.2, 5.0)), between(random, 0.03, 0.6)


def _assembled(host, sinks, units, name):
    mass, omega, length = units
    modes, count = len(host["frequencies"]), len(sinks)
    size = modes + count
    rate = mass * omega**2
    damping, stiffness = np.zeros((size, size)), np.zeros((size, size))
    forcing, output = np.zeros(size), np.zeros(size)
    at = np.arange(modes)
    damping[at, at] = mass * omega * host["loss"] * host["frequencies"]
    stiffness[at, at] = rate * host["frequencies"] ** 2
    forcing[at], output[at] = rate * length * host["force"], host["shape"]
    elements = []
    for index, (ratio, spring, loss) in enumerate(sinks):
        direction = np.zeros(size)
        direction[at], direction[modes + index] = -host["shape"], 1.0
        law = frahm.Polynomial(ratio * rate * _in_length(spring, length), ratio * mass * omega * loss)
        elements.append(frahm.Element(direction, law))
    if host["ground"] is not None:
        elements.append(frahm.Element(np.eye(size)[0], frahm.Polynomial(rate * _in_length(host["ground"], length))))
    masses = np.array([*np.ones(modes), *(ratio for ratio, _, _ in sinks)]) * mass
    return frahm.System(np.diag(masses), damping, stiffness, forcing, elements, output, omega, name)


def _in_length(coefficients, length):
    return np.array([c / length**k for k, c in enumerate(coefficients)])
