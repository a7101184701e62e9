"""The structure an absorber hangs on, as it is felt at the absorber: receptances over frequency and frequency error.

With D(Omega) of the structure without the absorber, f the forcing, n the row that gives the displacement at the
absorber and o the row that gives the displacement reported::

    at the absorber   u = u_F + a g,    a = n D^-1 n,   u_F = n D^-1 f
    at the output     x = x_F + b g,    b = o D^-1 n,   x_F = o D^-1 f

where g is the force of the absorber on the structure. This is exact for any number of modes.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from frahm.arrays import Complexes, Floats
from frahm.design.disturbance import Disturbance
from frahm.errors import ParameterError
from frahm.systems import System

_OFF_RESONANCE = 1e-10
Lift = Callable[[Floats], Floats]


@dataclass(frozen=True, eq=False)
class Conditions:
    """Excitations a design is judged under: rows are pairs of disturbance and force, columns frequencies.

    Attributes
    ----------
    disturbances : tuple of Disturbance, length D
        The rows go through all of them at the first force, then at the next.
    forces : ndarray, shape (R,)
        Factors on the force [-].
    frequency : ndarray, shape (R, W)
        Omega [rad/s], ascending in a row.
    a, u, b, x : ndarray of complex, shape (R, W)
        Receptances and free displacements, see above [m/N, m].
    absorber : ndarray, shape (R, 2)
        Factors on spring and damper of the absorber [-].
    """

    disturbances: tuple[Disturbance, ...]
    forces: Floats
    frequency: Floats
    a: Complexes
    u: Complexes
    b: Complexes
    x: Complexes
    absorber: Floats

    @property
    def arrays(self) -> tuple[Floats, Complexes, Complexes, Complexes, Complexes, Floats]:
        """What the kernels take."""
        return self.frequency, self.a, self.u, self.b, self.x, self.absorber

    @property
    def pipe_frequencies(self) -> Floats:
        """Frequency of the pipe over the nominal one in every row [-]."""
        return self._row("pipe_frequency")

    @property
    def pipe_dampings(self) -> Floats:
        """Damping ratio of the pipe over the nominal one in every row [-]."""
        return self._row("pipe_damping")

    def _row(self, name: str) -> Floats:
        values = np.array([getattr(one, name) for one in self.disturbances])
        return np.tile(values, len(self.forces) // len(values))

    @property
    def steps(self) -> Floats:
        """The different factors on the force [-], in their order."""
        return np.ascontiguousarray(self.forces[:: len(self.disturbances)])

    @property
    def first_force(self) -> Conditions:
        """The rows of the first force, scaled to a factor of 1."""
        part = slice(0, len(self.disturbances))
        scale = 1.0 / self.forces[part, None]
        return replace(
            self, forces=np.ones(len(self.disturbances)), frequency=self.frequency[part], a=self.a[part],
            u=scale * self.u[part], b=self.b[part], x=scale * self.x[part], absorber=self.absorber[part],
        )  # fmt: skip

    def reloaded(self, margin: float) -> Conditions:
        """The same with another factor on the force where it is not 1."""
        forces = np.where(self.forces == 1.0, 1.0, margin)
        scale = (forces / self.forces)[:, None]
        return replace(self, forces=forces, u=scale * self.u, x=scale * self.x)


@dataclass(frozen=True, eq=False)
class Host:
    """A system without the absorbers that are designed: its first elements and the masses that hang on them.

    Attributes
    ----------
    mass, damping, stiffness : ndarray, shape (n, n)
    forcing, output : ndarray, shape (n,)
    frequency : float
        Reference frequency omega [rad/s].
    other_damping, other_stiffness : ndarray, shape (n, n)
        Of linear absorbers that stay as they are when the pipe is off.
    attachments : ndarray, shape (N, n)
        Rows that give the displacement at every absorber.
    """

    mass: Floats
    damping: Floats
    stiffness: Floats
    forcing: Floats
    output: Floats
    frequency: float
    other_damping: Floats
    other_stiffness: Floats
    attachments: Floats

    @functools.cached_property
    def attachment(self) -> Floats:
        """The row of the absorber where the governing mode moves most, the first of those alike, (n,)."""
        return np.asarray(self.attachments[np.argmax(np.abs(self.attachments @ self._governing_mode))])

    @functools.cached_property
    def ratios(self) -> Floats:
        """Motion of the governing mode where each absorber hangs, over that at `attachment` [-], (N,); 1 at most."""
        moves, most = self.attachments @ self._governing_mode, self.attachment @ self._governing_mode
        return np.asarray(moves / most) if most else np.ones(len(moves))

    @functools.cached_property
    def modal_mass(self) -> float:
        """Mass of the governing mode as felt at the absorber [kg]: 1/(n phi)^2 with phi of unit modal mass."""
        moves = self.attachment @ self._governing_mode
        return float(1.0 / moves**2) if moves else math.inf

    @functools.cached_property
    def modal_damping(self) -> float:
        """Damping coefficient over mass of the governing mode, 2 zeta omega [1/s]."""
        phi = self._governing_mode
        return float(phi @ (self.damping + self.other_damping) @ phi)

    @functools.cached_property
    def blocked_force(self) -> float:
        """Force of the governing mode as felt at the absorber [N]."""
        phi = self._governing_mode
        return float(abs(phi @ self.forcing / (self.attachment @ phi)))

    @functools.cached_property
    def output_ratio(self) -> float:
        """Displacement of the governing mode at the output over that at the absorber [-]."""
        phi = self._governing_mode
        return float(abs(self.output @ phi / (self.attachment @ phi))) if self.attachment @ phi else math.inf

    def check_moves(self) -> None:
        """Refuse an absorber that sits where the governing mode does not move."""
        phi = self._governing_mode
        for at, attachment in enumerate(self.attachments):
            if abs(attachment @ phi) < 1e-9 * np.max(np.abs(phi)):
                raise ParameterError(f"absorbers[{at}]", "at a node", "a place where the governing mode moves")

    @functools.cached_property
    def _governing_mode(self) -> Floats:
        """The mode whose natural frequency is nearest the reference frequency, of unit modal mass."""
        import scipy.linalg

        squares, modes = scipy.linalg.eigh(self.stiffness + self.other_stiffness, self.mass)
        frequencies = np.sqrt(np.maximum(squares, 0.0))
        index = int(np.argmin(np.abs(frequencies - self.frequency)))
        return np.asarray(modes[:, index])

    def conditions(
        self,
        disturbances: Sequence[Disturbance],
        window: tuple[float, float],
        count: int,
        *,
        moving: bool = True,
        forces: Sequence[float] = (1.0,),
        lift: Lift | None = None,
    ) -> Conditions:
        """Conditions over a window of Omega [rad/s], `count` frequencies denser around the resonance.

        With `moving` the window moves with the frequency of the pipe. `lift` is a factor on the force over Omega.
        """
        rows = [
            _dense_grid(*_moved(window, d.pipe_frequency, moving), self.frequency * d.pipe_frequency, count)
            for d in disturbances
        ]
        return self.conditions_at(disturbances, np.array(rows), forces, lift)

    def conditions_at(
        self,
        disturbances: Sequence[Disturbance],
        frequency: Floats,
        forces: Sequence[float] = (1.0,),
        lift: Lift | None = None,
    ) -> Conditions:
        """Conditions at frequencies (D, W) [rad/s], a row for every disturbance."""
        found = [self.receptances(row, d) for row, d in zip(frequency, disturbances, strict=True)]
        a, u, b, x = (np.tile(np.array(table), (len(forces), 1)) for table in zip(*found, strict=True))
        absorber = np.tile([(d.kappa, d.xi2) for d in disturbances], (len(forces), 1))
        factors = np.repeat(np.asarray(forces, dtype=float), len(disturbances))
        grid = np.tile(frequency, (len(forces), 1))
        load = factors[:, None] * (1.0 if lift is None else lift(grid))
        return Conditions(tuple(disturbances), factors, grid, a, load * u, b, load * x, absorber)

    def receptances(
        self, frequency: Floats, disturbance: Disturbance | None = None
    ) -> tuple[Complexes, Complexes, Complexes, Complexes]:
        """a, u_F, b, x_F at frequencies (W,) of the pipe under a disturbance."""
        d = disturbance or Disturbance()
        # an undamped pipe has no receptance right at its resonance
        W = (frequency * (1 + _OFF_RESONANCE))[:, None, None]
        damping = d.pipe_frequency * d.pipe_damping * self.damping + self.other_damping
        stiffness = d.pipe_frequency**2 * self.stiffness + self.other_stiffness
        D = stiffness - W * W * self.mass + 1j * W * damping
        force = np.column_stack([self.attachment, d.load * self.forcing]).astype(complex)
        sides = np.linalg.solve(D, np.broadcast_to(force, (len(frequency), *force.shape)))
        at = np.asarray(self.attachment @ sides, dtype=complex)
        out = np.asarray(self.output @ sides, dtype=complex)
        return at[:, 0], at[:, 1], out[:, 0], out[:, 1]


def host_of(system: System, count: int = 1) -> Host:
    """The structure that carries the first elements of a system.

    Raises
    ------
    ParameterError
        If one of these elements carries no mass of its own, or other elements are nonlinear.
    """
    if len(system.elements) < count:
        raise ParameterError("absorbers", len(system.elements), f"a system with {count} absorbers to be designed")
    directions = [element.direction for element in system.elements[:count]]
    owns = [_own_coordinate(system, at) for at in range(count)]
    other_stiffness, other_damping = np.zeros((2, system.size, system.size))
    for index, element in enumerate(system.elements[count:], start=count):
        if not element.law.is_linear:
            hint = "It stays as it is beside what is designed, and may have a linear spring; --count designs more."
            raise ParameterError(f"absorbers[{index}].law", "nonlinear", "a linear spring", hint=hint)
        n = element.direction
        other_stiffness += element.law.coefficients[0] * np.outer(n, n)
        other_damping += element.law.damping * np.outer(n, n)
    rest = ~np.isin(np.arange(system.size), owns)
    attachments = np.array([-direction[rest] / direction[own] for own, direction in zip(owns, directions, strict=True)])
    keep = np.ix_(rest, rest)
    return Host(
        mass=np.array(system.mass[keep]),
        damping=np.array(system.damping[keep]),
        stiffness=np.array(system.stiffness[keep]),
        forcing=np.array(system.forcing[rest]),
        output=np.array(system.output[rest]),
        frequency=system.reference_frequency,
        other_damping=other_damping[keep],
        other_stiffness=other_stiffness[keep],
        attachments=attachments,
    )


def _own_coordinate(system: System, at: int) -> int:
    """Coordinate of the own mass of an element, coupled to nothing else."""
    direction = system.elements[at].direction
    for index in reversed(range(system.size)):
        coupled = np.count_nonzero(system.mass[index]) > 1 or np.any(system.stiffness[index])
        others = any(element.direction[index] for i, element in enumerate(system.elements) if i != at)
        if direction[index] and not coupled and not others and not system.forcing[index]:
            return index
    raise ParameterError(f"absorbers[{at}]", "no mass of its own", "an absorber with a mass that hangs on nothing else")


def _moved(window: tuple[float, float], error: float, moving: bool) -> tuple[float, float]:
    scale = error if moving else 1.0
    return window[0] * scale, window[1] * scale


def _dense_grid(lo: float, hi: float, middle: float, count: int) -> Floats:
    """Ascending frequencies from lo to hi, denser around the middle."""
    width = 0.12 * middle
    start, end = np.arcsinh((lo - middle) / width), np.arcsinh((hi - middle) / width)
    grid = middle + width * np.sinh(np.linspace(start, end, count))
    grid[0], grid[-1] = lo, hi
    return np.asarray(grid)
