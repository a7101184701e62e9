"""The wake oscillator of Facchinetti et al. with its published constants, and what follows in closed form.

Source: M. L. Facchinetti, E. de Langre, F. Biolley, Coupling of structure and wake oscillators in vortex-induced
vibrations, Journal of Fluids and Structures 19 (2004) 123-140, doi 10.1016/j.jfluidstructs.2003.12.004; the constants
were read there. With y = Y/D and time in units of 1/(2 pi St U/D):

    y'' + (2 zeta d + gamma/mu) y' + d^2 y = M q,    q'' + eps (q^2 - 1) q' + q = A y''
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from frahm.case import Case
from frahm.errors import check_number
from frahm.loads.vortex import vortex_shedding

DRAG_COEFFICIENT = 2.0  # C_D of a pipe that vibrates, as in the source


@dataclass(frozen=True)
class WakeState:
    """A periodic state of pipe and wake with one harmonic.

    Attributes
    ----------
    frequency : float
        Over the shedding frequency of the pipe at rest [-].
    pipe_amplitude : float
        Over the diameter [-].
    wake_amplitude : float
        Of q [-]; 2 for the pipe at rest.
    """

    frequency: float
    pipe_amplitude: float
    wake_amplitude: float


@dataclass(frozen=True)
class WakeOscillator:
    """Constants of the wake oscillator; the defaults are those printed, which were fitted together.

    Parameters
    ----------
    strouhal : float
        St [-].
    lift_coefficient : float
        Amplitude C_L0 of the lift coefficient of the pipe at rest [-].
    stall : float
        gamma = C_D / (4 pi St) [-], the damping by the drag; 0.8 is printed, for C_D = 2.
    coupling : float
        A [-], of the acceleration of the pipe on the wake.
    nonlinearity : float
        eps [-].

    Raises
    ------
    ParameterError
        If a constant is not positive (the stall parameter may be zero).
    """

    strouhal: float = 0.20
    lift_coefficient: float = 0.3
    stall: float = 0.8
    coupling: float = 12.0
    nonlinearity: float = 0.3

    def __post_init__(self) -> None:
        for name in ("strouhal", "lift_coefficient", "coupling", "nonlinearity"):
            check_number(name, getattr(self, name), above=0)
        check_number("stall", self.stall, at_least=0)

    @classmethod
    def of_case(cls, case: Case) -> WakeOscillator:
        """The published constants with the Strouhal number and the lift coefficient of a case at its wind speed."""
        shedding = vortex_shedding(case)
        stall = DRAG_COEFFICIENT / (4 * math.pi * shedding.strouhal)
        return cls(strouhal=shedding.strouhal, lift_coefficient=shedding.lift_coefficient, stall=stall)

    def mass_number(self, mass_ratio: float) -> float:
        """M = C_L0 / (16 pi^2 St^2 mu) [-] for the mass ratio mu = m / (rho D^2)."""
        return self.lift_coefficient / (16 * math.pi**2 * self.strouhal**2 * mass_ratio)

    def _fluid_damping(self, skop_griffin: float) -> float:
        """S_G + 4 pi^2 St^2 gamma."""
        S = check_number("skop_griffin", skop_griffin, at_least=0)
        return S + 4 * math.pi**2 * self.strouhal**2 * self.stall

    def lock_in_amplitude(self, skop_griffin: float) -> float:
        """Largest amplitude at lock-in over the diameter, Eq. 35 [-].

        Parameters
        ----------
        skop_griffin : float
            S_G = 8 pi^2 St^2 zeta mu [-], with the Strouhal number of these constants.
        """
        total = self._fluid_damping(skop_griffin)
        gain = self.coupling / self.nonlinearity * self.lift_coefficient / (4 * total)
        return self.lift_coefficient / (2 * total) * math.sqrt(1 + gain)

    @property
    def displacement_coupling_limit(self) -> float:
        """S_G below which the same oscillator coupled to the displacement has no lock-in; 1.7 is printed."""
        fluid = self._fluid_damping(0.0)
        return self.coupling * self.lift_coefficient / (4 * self.nonlinearity) - fluid

    def states(
        self, reduced_velocity: float, mass_ratio: float, damping_ratio: float, mass_number: float | None = None
    ) -> tuple[WakeState, ...]:
        """Periodic states with one harmonic, Eqs. 24 and 25, by ascending frequency; their stability is not told.

        Parameters
        ----------
        reduced_velocity : float
            U_r = U / (f D) [-].
        mass_ratio : float
            mu = m / (rho D^2), added mass included [-].
        damping_ratio : float
            zeta of the structure [-].
        mass_number : float, optional
            M [-]; from the lift coefficient by default.
        """
        mu = check_number("mass_ratio", mass_ratio, above=0)
        d = 1 / (self.strouhal * check_number("reduced_velocity", reduced_velocity, above=0))
        damping = 2 * check_number("damping_ratio", damping_ratio, at_least=0) * d + self.stall / mu
        M = self.mass_number(mu) if mass_number is None else check_number("mass_number", mass_number, above=0)
        # (1 - s) [(d^2 - s)^2 + damping^2 s] + A M s (d^2 - s) = 0 for s the squared frequency
        s = np.polynomial.Polynomial([0.0, 1.0])
        balance = (1 - s) * ((d**2 - s) ** 2 + damping**2 * s) + self.coupling * M * s * (d**2 - s)
        roots = balance.roots()
        squares = np.sort(roots[(np.abs(roots.imag) < 1e-9) & (roots.real > 0)].real)
        return tuple(self._state(float(square), d, damping, M) for square in squares)

    def _state(self, square: float, d: float, damping: float, M: float) -> WakeState:
        size = (d**2 - square) ** 2 + damping**2 * square
        q = 2 * math.sqrt(1 + self.coupling * M / self.nonlinearity * damping * square / size)
        return WakeState(math.sqrt(square), M * q / math.sqrt(size), q)
