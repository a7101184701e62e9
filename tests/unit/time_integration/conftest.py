import numpy as np
import pytest

import frahm

OMEGA = 2 * np.pi * 0.78


@pytest.fixture(scope="session")
def jacket_pipe():
    """One mode of the jacket pipe with the cubic sink, by its normalised parameters."""

    def make(kappa=367.38, xi2=0.0085, rho2=0.02):
        return frahm.System(
            mass=np.diag([247.0, 247.0 * rho2]),
            damping=np.diag([247.0 * 2 * 0.0015 * OMEGA, 0.0]),
            stiffness=np.diag([247.0 * OMEGA**2, 0.0]),
            forcing=(247.0 * 0.00624696, 0.0),
            elements=[frahm.Element((-1, 1), frahm.Cubic(247.0 * kappa, 247.0 * xi2))],
        )

    return make


@pytest.fixture(scope="session")
def random_system():
    """Five coupled coordinates, two elements with full polynomials, from a seed."""

    def make(seed, elements=2, n=5):
        random = np.random.default_rng(seed)
        root = random.normal(size=(n, n))
        direction = random.normal(size=(2, n))
        laws = [frahm.Polynomial([0.5, 0.2, 0.3], 0.05), frahm.Polynomial([0.0, 0.0, 0.4, 0.0, 0.1], 0.02)]
        return frahm.System(
            mass=root @ root.T / n + np.eye(n),
            damping=0.05 * np.diag(random.uniform(0.5, 1.5, n)),
            stiffness=np.diag(random.uniform(0.5, 4.0, n)) + 0.1,
            forcing=0.3 * random.normal(size=n),
            elements=[frahm.Element(d, law) for d, law in zip(direction, laws, strict=True)][:elements],
            output=random.normal(size=n),
        )

    return make
