"""`beam_modes`: natural frequencies and shapes of a beam, and what a response in a mode means for it."""

from __future__ import annotations

import functools
import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike

from frahm import readable
from frahm.arrays import Floats, finite_array, frozen, labelled
from frahm.errors import ParameterError, check_count
from frahm.structure.beam import Beam
from frahm.structure.polynomial_beam import matrices, segment_basis

if TYPE_CHECKING:
    import xarray as xr

MOST_MODES = 60
_SECTIONS = 401


@dataclass(frozen=True, eq=False)
class BeamModes:
    """Modes of a beam by ascending frequency, every shape scaled to a largest displacement of +1.

    Attributes
    ----------
    beam : Beam
    frequencies : ndarray, shape (n,)
        Natural frequencies omega [rad/s].
    modal_masses : ndarray, shape (n,)
        int m phi^2 ds, point masses included [kg].
    peak_sections : ndarray, shape (n,)
        Section of the largest displacement of each mode [m].
    coefficients : ndarray, shape (segments, degree + 1, n)
        Shapes as Legendre series between the nodes of the beam.
    """

    __repr__ = readable.summary

    beam: Beam
    frequencies: Floats
    modal_masses: Floats
    peak_sections: Floats
    coefficients: Floats

    @property
    def count(self) -> int:
        """Number of modes."""
        return self.frequencies.size

    def shape(self, section: ArrayLike) -> Floats:
        """Displacement phi_k of every mode [-] at sections [m], shape (..., n)."""
        return self._derivative(section, 0)

    def slope(self, section: ArrayLike) -> Floats:
        """Rotation phi_k' of every mode [1/m] at sections [m], shape (..., n)."""
        return self._derivative(section, 1)

    def curvature(self, section: ArrayLike) -> Floats:
        """Curvature phi_k'' of every mode [1/m^2] at sections [m], shape (..., n)."""
        return self._derivative(section, 2)

    def stress_per_displacement(self, section: ArrayLike) -> Floats:
        """Bending stress E (D/2) phi_k'' of every mode per displacement [Pa/m] at sections [m], shape (..., n)."""
        if self.beam.stress_per_curvature == 0:
            raise ParameterError("stress_per_curvature", 0, "a beam whose stress per curvature is known")
        return self.beam.stress_per_curvature * self.curvature(section)

    @functools.cached_property
    def stressed_sections(self) -> Floats:
        """Section of the largest curvature of each mode [m], shape (n,)."""
        return frozen([self._largest(mode, 2)[0] for mode in range(self.count)])

    @functools.cached_property
    def squares(self) -> Floats:
        """int phi_k^2 ds [m], shape (n,)."""
        weight = 2 / (2 * np.arange(self.coefficients.shape[1]) + 1)
        return frozen(np.einsum("s,k,skn->n", self._halves, weight, self.coefficients**2))

    @property
    def equivalent_masses(self) -> Floats:
        """m_e = int m phi^2 / int phi^2 of every mode [kg/m], shape (n,)."""
        return self.modal_masses / self.squares

    @functools.cached_property
    def participations(self) -> Floats:
        """int |phi_k| / int phi_k^2 [-], shape (n,): 1 for a rigid pipe, 1.566 for the first mode of a cantilever."""
        return frozen([self.lift_lengths(mode)[mode] for mode in range(self.count)] / self.squares)

    def lift_lengths(self, mode: int) -> Floats:
        """int sign(phi_mode) phi_k ds [m] of every mode k, shape (n,): a uniform lift in phase with one mode."""
        total = np.zeros(self.count)
        for segment, half in enumerate(self._halves):
            series = self.coefficients[segment]
            edges = np.array([-1.0, *self._zeros(series[:, mode]), 1.0])
            primitive = legendre.legval(edges, legendre.legint(series)).T  # (edges, n)
            sign = np.sign(legendre.legval(0.5 * (edges[1:] + edges[:-1]), series[:, mode]))
            total += half * (sign @ np.diff(primitive, axis=0))
        return total

    def products(self, mode: int) -> Floats:
        """int phi_mode phi_k ds [m] of every mode k, shape (n,): a lift in proportion to one mode's motion."""
        weight = 2 / (2 * np.arange(self.coefficients.shape[1]) + 1)
        own = self.coefficients[:, :, mode]
        return np.einsum("s,k,sk,skn->n", self._halves, weight, own, self.coefficients)

    def scruton_numbers(self, damping_ratio: ArrayLike, fluid_density: float, diameter: float) -> Floats:
        """K_s = 2 m_e delta/(rho D^2) of every mode with delta = 2 pi zeta [-], shape (n,)."""
        delta = 2 * math.pi * np.asarray(damping_ratio, dtype=float)
        return 2 * self.equivalent_masses * delta / (fluid_density * diameter**2)

    def to_dataset(self) -> xr.Dataset:
        """Frequencies, masses and shapes, dims `mode` and `section`."""
        import xarray as xr

        sections = np.union1d(np.linspace(0, self.beam.length, _SECTIONS), self.beam.nodes)
        variables = {
            "frequency": labelled("mode", self.frequencies, "natural frequency", "rad/s"),
            "modal_mass": labelled("mode", self.modal_masses, "modal mass, shape scaled to largest value 1", "kg"),
            "equivalent_mass": labelled("mode", self.equivalent_masses, "equivalent mass per length", "kg/m"),
            "participation": labelled("mode", self.participations, "int |phi| / int phi^2", "1"),
            "shape": labelled(("section", "mode"), self.shape(sections), "mode shape, largest value 1", "1"),
            "curvature": labelled(("section", "mode"), self.curvature(sections), "curvature of the shape", "1/m^2"),
        }
        if self.beam.stress_per_curvature:
            stress = self.stress_per_displacement(sections)
            variables["stress"] = labelled(("section", "mode"), stress, "stress per modal displacement", "Pa/m")
        coords = {
            "section": labelled("section", sections, "position along the pipe", "m"),
            "mode": labelled("mode", np.arange(1, self.count + 1), "number of the mode", "1"),
        }
        return xr.Dataset(variables, coords)

    @property
    def _halves(self) -> Floats:
        return 0.5 * np.diff(self.beam.nodes)

    def _derivative(self, section: ArrayLike, order: int) -> Floats:
        """Derivative of every shape by the position at sections, shape (..., n)."""
        s = np.asarray(section, dtype=float)
        at = finite_array("section", s.ravel(), (-1,))
        if at.size and (at.min() < 0 or at.max() > self.beam.length):
            raise ParameterError("section", section, f"sections of the pipe, 0 to {self.beam.length:g} m")
        nodes = np.array(self.beam.nodes)
        segment = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, nodes.size - 2)
        out = np.empty((at.size, self.count))
        for number in np.unique(segment):
            here = segment == number
            half = self._halves[number]
            local = np.clip((at[here] - nodes[number]) / half - 1.0, -1.0, 1.0)
            series = legendre.legder(self.coefficients[number], order) / half**order
            out[here] = legendre.legval(local, series).T
        return out.reshape((*s.shape, self.count))

    def _largest(self, mode: int, order: int) -> tuple[float, float]:
        """Section [m] of the largest absolute value of a derivative of one shape, first of equals, and its value."""
        places, values = [], []
        for number, half in enumerate(self._halves):
            series = legendre.legder(self.coefficients[number][:, mode], order) / half**order
            inside = [-1.0, *self._zeros(legendre.legder(series)), 1.0]
            places += [self.beam.nodes[number] + half * (1 + x) for x in inside]
            values += list(legendre.legval(inside, series))
        size = np.abs(values)
        best = int(np.flatnonzero(size > (1 - 1e-9) * size.max())[0])
        return float(min(places[best], self.beam.length)), float(values[best])

    def _zeros(self, series: Floats) -> list[float]:
        """Simple zeros of a Legendre series between -1 and 1, ascending."""
        from scipy.optimize import brentq  # takes long to load

        grid = -np.cos(np.linspace(0, math.pi, 4 * series.size + 1))
        values = legendre.legval(grid, series)
        known = np.abs(values) > 1e-11 * np.max(np.abs(values))  # a support is zero, but for rounding
        grid, values = grid[known], values[known]
        return [
            float(brentq(legendre.legval, grid[i], grid[i + 1], args=(series,), xtol=1e-14))
            for i in np.flatnonzero(values[:-1] * values[1:] < 0)
        ]


@functools.lru_cache(maxsize=256)
def beam_modes(beam: Beam, count: int = 6) -> BeamModes:
    """Exact modes of a uniform Euler-Bernoulli beam.

    Shapes are polynomials of a degree between the nodes at which frequencies and curvatures are converged to about
    1e-10; frequencies are upper bounds.

    Parameters
    ----------
    beam : Beam
        The beam, its supports and point masses.
    count : int
        Number of modes, by ascending frequency.

    Returns
    -------
    BeamModes

    Raises
    ------
    ParameterError
        If the number of modes is out of bounds.
    """
    count = check_count("count", count, at_most=MOST_MODES)
    degree = 24
    while True:
        degree = max(degree, 3 + math.ceil((count + 8) / (len(beam.nodes) - 1)))
        squares, series = _solved(beam, degree, count)
        needed = _degree_for(beam, float(squares[-1]))
        if degree >= needed:
            return _scaled(beam, squares, series)
        degree = needed


def _solved(beam: Beam, degree: int, count: int) -> tuple[Floats, Floats]:
    """(omega^2 m l^4/(E I)) of the lowest modes (n,), and their series (segments, degree + 1, n)."""
    import scipy.linalg  # takes long to load

    K, M, rows = matrices(beam, degree)
    # 1/omega^2 as the eigenvalue: then it is the low modes whose error is of the order of rounding.
    try:
        inverse, vectors = scipy.linalg.eigh(M, K, subset_by_index=(len(K) - count, len(K) - 1))
    except (np.linalg.LinAlgError, ValueError) as error:
        raise ParameterError(
            "beam", f"{len(beam.nodes)} nodes over {beam.length:g} m", "a beam that its supports hold, whose stiffness"
            " and springs are within some twelve orders of magnitude",
            hint=f"Its modes cannot be computed: {error}",
        ) from None  # fmt: skip
    inverse, vectors = inverse[::-1], vectors[:, ::-1]
    padded = np.vstack([vectors, np.zeros((1, count))])  # row -1: what is held does not move
    nodes = np.array(beam.nodes) / beam.length
    series = [
        segment_basis(degree, 0.5 * (b - a))[0] @ padded[at]
        for (a, b), at in zip(itertools.pairwise(nodes), rows, strict=True)
    ]
    return 1.0 / inverse, np.array(series)


def _degree_for(beam: Beam, square: float) -> int:
    """Degree that resolves sin, cos and exp of the fastest wave on the longest segment: its half length in radians."""
    longest = max(np.diff(beam.nodes)) / beam.length
    return 24 + math.ceil(1.3 * 0.5 * square**0.25 * longest)


def _scaled(beam: Beam, squares: Floats, series: Floats) -> BeamModes:
    """Modes with shapes scaled to a largest displacement of +1."""
    unit = math.sqrt(beam.bending_stiffness / beam.mass_per_length) / beam.length**2
    raw = BeamModes(beam, frozen(unit * np.sqrt(squares)), np.ones(squares.size), np.zeros(squares.size), series)
    found = [raw._largest(mode, 0) for mode in range(squares.size)]
    sections, sizes = (np.array(column) for column in zip(*found, strict=True))
    scaled = BeamModes(beam, raw.frequencies, raw.modal_masses, frozen(sections), frozen(series / sizes))
    at = np.array([point.at for point in beam.point_masses])
    points = np.array([point.mass for point in beam.point_masses])
    masses = beam.mass_per_length * scaled.squares + (points @ scaled.shape(at) ** 2 if points.size else 0.0)
    return BeamModes(beam, raw.frequencies, frozen(masses), scaled.peak_sections, scaled.coefficients)
