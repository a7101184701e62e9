"""Equations of motion as arrays; this room knows no solver."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm import readable
from frahm.absorbers import Law
from frahm.arrays import Floats, finite_array, frozen
from frahm.errors import ParameterError, check_number


@dataclass(frozen=True, eq=False, init=False)
class Element:
    """A local element between coordinates: its displacement is n.x, its force on the structure -n g(n.x, n.x').

    Parameters
    ----------
    direction : array_like, shape (n,)
        n [-]; for a sink between coordinates 0 and 1 it is (-1, 1), so that z = x2 - x1.
    law : Law
        Force law g(z, w) [N].
    """

    direction: Floats
    law: Law

    def __init__(self, direction: ArrayLike, law: Law):
        n = finite_array("direction", direction, (-1,))
        if not np.any(n):
            raise ParameterError("direction", direction, "a vector that is not zero")
        if not isinstance(law, Law):
            raise ParameterError("law", law, "a force law such as frahm.Cubic(stiffness=..., damping=...)")
        object.__setattr__(self, "direction", n)
        object.__setattr__(self, "law", law)


@dataclass(frozen=True, eq=False, init=False)
class System:
    """M x'' + C x' + K x + sum_e n_e g_e(n_e.x, n_e.x') = forcing cos(Omega t), in absolute coordinates.

    Parameters
    ----------
    mass, damping, stiffness : array_like, shape (n, n)
        M [kg], C [N s/m], K [N/m]. M must be symmetric and positive definite.
    forcing : array_like, shape (n,)
        Amplitude of the harmonic force [N].
    elements : sequence of Element
        Local elements, linear or not.
    output : int or array_like, shape (n,)
        The coordinate reported as pipe displacement, or a row that combines coordinates into it.
    reference_frequency : float, optional
        The frequency [rad/s] detuning is counted from; by default the lowest non-zero natural frequency of (M, K).
    name : str
        What it is called in results and messages.

    Raises
    ------
    ParameterError
        Naming the array, what was given and what is allowed.
    """

    __repr__ = readable.summary

    mass: Floats
    damping: Floats
    stiffness: Floats
    forcing: Floats
    elements: tuple[Element, ...]
    output: Floats
    name: str

    def __init__(
        self,
        mass: ArrayLike,
        damping: ArrayLike,
        stiffness: ArrayLike,
        forcing: ArrayLike,
        elements: Sequence[Element] = (),
        output: int | ArrayLike = 0,
        reference_frequency: float | None = None,
        name: str = "system",
    ):
        M = finite_array("mass", mass, (-1, -1))
        n = M.shape[0]
        _check_mass(M)
        put = functools.partial(object.__setattr__, self)
        put("mass", M)
        put("damping", finite_array("damping", damping, (n, n)))
        put("stiffness", finite_array("stiffness", stiffness, (n, n)))
        put("forcing", finite_array("forcing", forcing, (n,)))
        put("elements", tuple(elements))
        for index, element in enumerate(self.elements):
            if not isinstance(element, Element):
                raise ParameterError(f"elements[{index}]", element, "a frahm.Element")
            if element.direction.size != n:
                raise ParameterError(f"elements[{index}].direction", element.direction.tolist(), f"{n} numbers")
        put("output", _output_row(output, n))
        put("name", name)
        if reference_frequency is not None:
            put(
                "_given_reference",
                check_number("reference_frequency", reference_frequency, above=0, unit="rad/s"),
            )

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return self.mass.shape[0]

    @functools.cached_property
    def natural_frequencies(self) -> Floats:
        """Natural frequencies of (M, K) [rad/s], elements excluded, ascending, rigid-body ones as 0."""
        import scipy.linalg  # takes long to load

        symmetric = np.array_equal(self.stiffness, self.stiffness.T)
        values = scipy.linalg.eigvalsh(self.stiffness, self.mass) if symmetric else None
        if values is None:
            values = np.sort(scipy.linalg.eigvals(self.stiffness, self.mass).real)
        floor = 1e-13 * np.max(np.abs(values), initial=0.0)
        return frozen(np.sqrt(np.where(values > floor, values, 0.0)))

    @property
    def reference_frequency(self) -> float:
        """The frequency detuning is counted from [rad/s]."""
        given = self.__dict__.get("_given_reference")
        if given is not None:
            return float(given)
        positive = self.natural_frequencies[self.natural_frequencies > 0]
        if positive.size == 0:
            raise ParameterError(
                "reference_frequency", None, "a positive number [rad/s]",
                hint="The linear part (M, K) has no natural frequency above zero: name one, or give frequency=.",
            )  # fmt: skip
        return float(positive[0])

    def acceleration(self, x: ArrayLike, v: ArrayLike, phase: float, scale: float = 1.0) -> Floats:
        """x'' [m/s^2] at state (x, v) and forcing phase Omega t [rad]: the plain statement of the equations."""
        x, v = np.asarray(x, dtype=float), np.asarray(v, dtype=float)
        force = scale * self.forcing * math.cos(phase) - self.damping @ v - self.stiffness @ x
        for element in self.elements:
            n = element.direction
            force = force - n * element.law.force(n @ x, n @ v)
        return np.asarray(np.linalg.solve(self.mass, force))


def _check_mass(M: Floats) -> None:
    allowed = "a symmetric positive definite matrix [kg]"
    if M.shape[0] == 0 or M.shape[0] != M.shape[1]:
        raise ParameterError("mass", f"shape {M.shape}", allowed)
    if not np.allclose(M, M.T, rtol=1e-12, atol=0.0):
        raise ParameterError("mass", M.tolist(), allowed)
    try:
        np.linalg.cholesky(M)
    except np.linalg.LinAlgError:
        raise ParameterError("mass", M.tolist(), allowed) from None


def _output_row(output: int | ArrayLike, n: int) -> Floats:
    if isinstance(output, int | np.integer) and not isinstance(output, bool):
        if not 0 <= output < n:
            raise ParameterError("output", output, f"a coordinate 0 ... {n - 1}, or a row of {n} numbers")
        return frozen(np.eye(n)[output])
    return finite_array("output", output, (n,))
