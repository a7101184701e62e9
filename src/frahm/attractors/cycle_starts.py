"""Where branches of limit cycles of the slow flow begin: Hopf points, and modulations met by integration."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from frahm.arrays import Floats
from frahm.attractors.slow_cycles import NODES, Scales, Shooting, even_durations, integrated
from frahm.continuation.pseudo_arclength import newton
from frahm.slow_flow import LocatedPoint, SlowFlow, slow_manifold
from frahm.slow_flow.kernels import coefficients
from frahm.slow_flow.motion import slow_jacobian

FIRST_SIZES = (0.02, 0.005, 0.001)  # of cycles beside a Hopf point to begin with, in units of the scales
CLOSE = 1e-7  # last Newton step, in scaled unknowns, at which a cycle counts as found
_SETTLE, _WATCH = 12.0, 8.0  # in time constants of the pipe's damping
_MOST_TIME = 30_000.0  # radians of the pipe's motion
_RETURN = 0.05  # distance, in units of the scales, at which a motion has come back to where it was
_STILL = 1e-3


class Start(NamedTuple):
    """A problem, a cycle in its unknowns and the side to which to follow the branch."""

    shooting: Shooting
    y: Floats
    direction: Floats


def hopf_state(slow: SlowFlow, point: LocatedPoint) -> Floats:
    """The response (4,) at a Hopf point [m]."""
    _, a, _, _, e, g1, g2 = coefficients(slow.code, point.frequency, *slow.host)
    n = point.n
    d0, s0 = a * (g2 - e) - e * g1, a - e
    Z = e * slow.force / (d0 + n * s0)
    X = (slow.force + (g1 + n) * Z) / a
    return np.array([X.real, X.imag, Z.real, Z.imag])


def starts_at_hopf(slow: SlowFlow, scales: Scales, point: LocatedPoint) -> list[Start]:
    """Small cycles beside a Hopf point, to be followed away from it, the largest first."""
    u, W = hopf_state(slow, point), point.frequency
    J = slow_jacobian(slow.code, *slow.host, slow.kappa, W, complex(u[2], u[3]))
    if not np.all(np.isfinite(J)):
        return []
    values, vectors = np.linalg.eig(J)
    pairs = np.flatnonzero(values.imag > 0)
    if not pairs.size:
        return []
    at = pairs[np.argmin(np.abs(values[pairs].real))]
    v = vectors[:, at] / np.linalg.norm(vectors[:, at] / scales.state)
    swing = np.real(np.exp(2j * np.pi * np.arange(NODES) / NODES)[:, None] * v)
    durations = np.full(NODES, 2 * np.pi / values[at].imag / NODES)
    starts = []
    for size in FIRST_SIZES:
        shooting = Shooting(slow, scales, u + size * swing, durations, W)
        away = shooting.start - shooting.pack(u + 0 * swing, durations, W)
        first = newton(shooting.residual, shooting.start, away / np.linalg.norm(away), CLOSE, 25)
        if first is not None:
            starts.append(Start(shooting, first.y, first.tangent))
    return starts


def start_states(slow: SlowFlow, W: float) -> list[Floats]:
    """States from which modulation is looked for: rest, and the jumps of the slow manifold."""
    states = [np.zeros(4)]
    folds = slow_manifold(slow, W).folds
    if folds is not None:
        for pipe, relative in zip(folds.pipe, folds.landing, strict=True):
            states.append(np.array([pipe, 0.0, relative, 0.0]))
    return states


def start_from_motion(slow: SlowFlow, scales: Scales, state: Floats, W: float) -> tuple[Start | None, bool]:
    """The cycle on which the motion from a state ends; and whether it ends in motion that is neither cycle nor rest."""
    rate = max(slow.xi1, 1e-12) / 2
    settle, watch = (min(count / rate, _MOST_TIME / slow.omega) for count in (_SETTLE, _WATCH))
    _, path = integrated(slow, scales, state, settle, W, 1)
    if not np.all(np.isfinite(path[-1])):
        return None, False
    times, path = integrated(slow, scales, path[-1], watch, W, 200_000)
    scaled = path / scales.state
    if np.max(np.ptp(scaled[times > 0.5 * watch], axis=0)) < _STILL:
        return None, False
    period = _period(times, scaled)
    if period is None:
        return None, True
    start = _cycle_from(slow, scales, path[-1], period, W)
    return start, start is None


def _period(times: Floats, scaled: Floats) -> float | None:
    """Time after which a motion first comes back close to where it ends; None if it does not."""
    distance = np.linalg.norm(scaled - scaled[-1], axis=1)
    left = np.flatnonzero(distance > max(5 * _RETURN, 0.3 * np.max(distance)))
    if not left.size:
        return None
    for i in range(int(left[-1]), 0, -1):
        chord = scaled[i + 1] - scaled[i - 1]
        near = distance[i] <= min(distance[i - 1], distance[i + 1])
        if near and np.linalg.norm(scaled[i] - scaled[-1]) < _RETURN + 0.5 * np.linalg.norm(chord):
            return float(times[-1] - times[i])
    return None


def _cycle_from(slow: SlowFlow, scales: Scales, state: Floats, period: float, W: float) -> Start | None:
    """The cycle near a motion, corrected at constant Omega."""
    times, _ = integrated(slow, scales, state, period, W)
    durations, nodes = even_durations(times, NODES), [state]
    for duration in durations[:-1]:
        nodes.append(integrated(slow, scales, nodes[-1], duration, W)[1][-1])
    shooting = Shooting(slow, scales, np.array(nodes), durations, W)
    y = shooting.start
    along = np.zeros(y.size)
    along[-1] = 1.0
    point = newton(shooting.residual, y, along, CLOSE, 20)
    if point is None:
        return None
    nodes_found, _, _ = shooting.unpack(point.y)
    if np.max(np.ptp(nodes_found / scales.state, axis=0)) < _STILL:
        return None
    return Start(shooting, point.y, point.tangent)
