"""Random systems for the tests of the exact response."""

import numpy as np
import pytest

import frahm

PARTS = {  # neither polynomial; odd, then not
    "sliding": lambda k, L, T: frahm.TransverseSprings(
        k, L, 0.1, pretension=T * k * L, stops=frahm.Stops(0.5, 2.0, 0.4), friction=frahm.Friction(0.3, 0.8)
    ),
    "heavy": lambda k, L, T: frahm.Polynomial(
        [T, 0.1, k], 0.1, stops=frahm.Stops(L, 2.0, 0.4), friction=frahm.Friction(0.3, 0.8), weight=0.4
    ),
}


def random_system(seed, *, n=None, elements=None, dependent=False, laws="cubic"):
    """A supported structure with full, non-proportional damping and local elements of any direction."""
    random = np.random.default_rng(seed)
    n = n or int(random.integers(2, 7))
    count = elements or int(random.integers(1, min(3, n - 1) + 1))

    def definite(low, high):
        Q = np.linalg.qr(random.normal(size=(n, n)))[0]
        return Q @ np.diag(random.uniform(low, high, n)) @ Q.T

    directions = random.normal(size=(count, n))
    if dependent:
        directions = np.vstack([directions, directions[0] - 0.5 * directions[-1]])
    made = []
    for direction in directions:
        c = random.uniform(-1, 1, 5)
        if laws in PARTS:
            law = PARTS[laws](1 + c[0], 1 + 0.3 * c[1], 0.2 * c[2])
            made.append(frahm.Element(direction, law))
            continue
        c = {"cubic": [0.3 * c[0], 0, 1 + c[2]], "odd": [c[0], 0, c[2], 0, c[4]], "any": c}[laws]
        made.append(frahm.Element(direction, frahm.Polynomial(c, damping=random.uniform(0, 0.3))))
    return frahm.System(
        definite(0.5, 2), definite(0.05, 0.4), definite(1, 9), random.normal(size=n), made,
        output=random.normal(size=n), reference_frequency=1.0,
    )  # fmt: skip


@pytest.fixture
def make_system():
    return random_system
