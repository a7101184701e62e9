"""The slow flow as a differential equation, integrated in time (paper Fig. 3a, b)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Complexes, Floats, frozen
from frahm.compiled import kernel
from frahm.errors import Outcome, ParameterError, check_count, check_number
from frahm.slow_flow.kernels import coefficients
from frahm.slow_flow.model import SlowFlow


@kernel
def slow_velocity(form, omega, xi1, xi2, k1, rho2, F, kappa, W, X, Z):
    """X' and Z' [m/s] of the slow flow at complex amplitudes X, Z [m]."""
    p, a, q, r, e, g1, g2 = coefficients(form, W, omega, xi1, xi2, k1, rho2)
    n = 0.75 * kappa * (Z.real * Z.real + Z.imag * Z.imag)
    dX = (F + (g1 + n) * Z - a * X) / p
    return dX, (e * (X + Z) - (g2 + n) * Z - q * dX) / r


@kernel
def slow_jacobian(form, omega, xi1, xi2, k1, rho2, kappa, W, Z):
    """Jacobian (4, 4) of (Re X', Im X', Re Z', Im Z') by (Re X, Im X, Re Z, Im Z) [1/s]."""
    J = np.empty((4, 4))
    put_jacobian(form, omega, xi1, xi2, k1, rho2, kappa, W, Z, J)
    return J


@kernel
def put_jacobian(form, omega, xi1, xi2, k1, rho2, kappa, W, Z, J):
    """`slow_jacobian` into J."""
    p, a, q, r, e, g1, g2 = coefficients(form, W, omega, xi1, xi2, k1, rho2)
    k = 0.75 * kappa
    N = Z.real * Z.real + Z.imag * Z.imag
    xx = -a / p
    # n Z varies by 2 n dZ + k Z^2 conj(dZ)
    xz, xc = (g1 + 2.0 * k * N) / p, k * Z * Z / p
    zx = (e - q * xx) / r
    zz = (e - g2 - 2.0 * k * N - q * xz) / r
    zc = (-k * Z * Z - q * xc) / r
    _insert(J, 0, 0, xx, 0j)
    _insert(J, 0, 2, xz, xc)
    _insert(J, 2, 0, zx, 0j)
    _insert(J, 2, 2, zz, zc)


@kernel
def _insert(J, i, j, u, c):
    """The real 2 x 2 block of dz -> u dz + c conj(dz)."""
    J[i, j], J[i, j + 1] = u.real + c.real, -u.imag + c.imag
    J[i + 1, j], J[i + 1, j + 1] = u.imag + c.imag, u.real - c.real


@dataclass(frozen=True)
class SlowMotion:
    """The slow flow in time.

    Attributes
    ----------
    time : ndarray, shape (samples,)
        [s].
    X, Z : ndarray of complex, shape (samples,)
        Complex amplitudes [m]: x1 = Re X e^{i Omega t}, z = Re Z e^{i Omega t}.
    frequency : float
        Omega [rad/s].
    outcome : Outcome
        How the integration ended.
    """

    time: Floats
    X: Complexes
    Z: Complexes
    frequency: float
    outcome: Outcome

    def x1(self, time: ArrayLike | None = None) -> Floats:
        """Pipe displacement [m] at the sampled times, or at others with the amplitudes interpolated."""
        return self._carried(self.X, time)

    def z(self, time: ArrayLike | None = None) -> Floats:
        """Relative displacement [m] at the sampled times, or at others with the amplitudes interpolated."""
        return self._carried(self.Z, time)

    def _carried(self, amplitude: Complexes, time: ArrayLike | None) -> Floats:
        t = self.time if time is None else np.asarray(time, dtype=float)
        slowly = amplitude if time is None else np.interp(t, self.time, amplitude)
        return np.asarray((slowly * np.exp(1j * self.frequency * t)).real)


def integrate_slow_flow(
    slow: SlowFlow,
    frequency: float,
    periods: float,
    initial: tuple[complex, complex] = (0j, 0j),
    samples_per_period: int = 4,
) -> SlowMotion:
    """Integrate the slow flow from complex amplitudes `initial` = (X, Z) [m] over `periods` of the excitation.

    Relative error 1e-9 a step (DOP853). `frequency` is Omega [rad/s].
    """
    from scipy.integrate import solve_ivp  # takes long to load

    W = check_number("frequency", frequency, above=0, unit="rad/s")
    periods = check_number("periods", periods, above=0, at_most=1e6)
    samples = check_count("samples_per_period", samples_per_period, at_most=4096)
    if not all(np.isfinite(complex(value)) for value in initial):
        raise ParameterError("initial", initial, "two finite complex amplitudes [m]")
    time = 2 * math.pi / W * np.arange(math.floor(periods * samples) + 1) / samples
    head = (slow.code, *slow.host, slow.force, slow.kappa, W)

    def velocity(_: float, y: Floats) -> Floats:
        dX, dZ = slow_velocity(*head, complex(y[0], y[1]), complex(y[2], y[3]))
        return np.array([dX.real, dX.imag, dZ.real, dZ.imag])

    X0, Z0 = complex(initial[0]), complex(initial[1])
    scale = slow.force / (slow.omega * max(slow.xi1, 1e-6 * slow.omega))
    answer = solve_ivp(
        velocity, (0.0, time[-1]), [X0.real, X0.imag, Z0.real, Z0.imag],
        method="DOP853", t_eval=time, rtol=1e-9, atol=1e-12 * max(scale, abs(X0), abs(Z0), 1e-300),
    )  # fmt: skip
    y = answer.y
    outcome = Outcome.DONE if answer.status == 0 else Outcome.STEP_TOO_SMALL
    return SlowMotion(frozen(answer.t), _complex(y[0], y[1]), _complex(y[2], y[3]), W, outcome)


def _complex(real: Floats, imaginary: Floats) -> Complexes:
    return frozen(real + 1j * imaginary, complex)
