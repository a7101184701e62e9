"""Many motions by adaptive Taylor integration (heyoka), which shares nothing with the integrator of the package."""

from __future__ import annotations

from dataclasses import dataclass

import heyoka
import numpy as np

import frahm

LANES = 8
FINE = 64  # samples of a displacement per period
_TOLERANCE = 1e-11
_CHUNK = 500  # periods watched at once: bounds the memory
_TURN = 2 * np.pi


@dataclass(frozen=True)
class Watched:
    """What N motions showed over their last K periods.

    `states` (N, 2n) last of all, NaN where lost; `strobes` (N, K, 2n) at the end of every period; `peaks` (N, K, 2) of
    pipe and first element in every period.
    """

    states: np.ndarray
    strobes: np.ndarray
    peaks: np.ndarray


class Oracle:
    """Equations of motion over tau = Omega t; Omega and a factor of the force belong to each motion."""

    def __init__(self, system):
        self.system = system
        size = 2 * system.size
        self._lanes = heyoka.taylor_adaptive_batch(
            _equations(system), np.zeros((size, LANES)), tol=_TOLERANCE, pars=np.ones((2, LANES))
        )

    def watch(self, states, frequency, periods, window, factor=1.0):
        """Carry states (N, 2n) over `periods`, watched over the last `window` of them."""
        count = len(states)
        frequency, factor = (np.broadcast_to(np.asarray(v, dtype=float), (count,)) for v in (frequency, factor))
        parts = [
            self._together(states[at], frequency[at], factor[at], periods, window)
            for at in np.array_split(np.arange(count), range(LANES, count, LANES))
        ]
        return Watched(*(np.concatenate([getattr(p, name) for p in parts]) for name in ("states", "strobes", "peaks")))

    def _together(self, states, frequency, factor, periods, window):
        """At most as many motions as there are lanes; what escapes is started again from rest and lost."""
        count, lanes = len(states), self._lanes
        filled = np.arange(LANES) % count
        lost = np.zeros(LANES, dtype=bool)
        while True:
            lanes.set_time(0.0)
            lanes.pars[0], lanes.pars[1] = frequency[filled], factor[filled]
            lanes.state[:] = np.where(lost, 0.0, states[filled].T)
            seen = self._seen(periods, window)
            if isinstance(seen, Watched):
                break
            assert np.any(seen & ~lost), "a motion from rest is lost"
            lost |= seen
        for part in (seen.states, seen.strobes, seen.peaks):
            part[lost] = np.nan
        return Watched(seen.states[:count], seen.strobes[:count], seen.peaks[:count])

    def _seen(self, periods, window):
        lanes, system = self._lanes, self.system
        if periods > window:
            lanes.propagate_until((periods - window) * _TURN)
            if _failed(lanes).any():
                return _failed(lanes)
        strobes, peaks = np.empty((LANES, window, 2 * system.size)), np.empty((LANES, window, 2))
        first = system.elements[0].direction if system.elements else np.zeros(system.size)
        for begin in range(0, window, _CHUNK):
            turns = min(_CHUNK, window - begin)
            grid = (periods - window + begin + np.arange(FINE * turns + 1) / FINE) * _TURN
            samples = lanes.propagate_grid(np.repeat(grid[:, None], LANES, axis=1))[-1]
            if _failed(lanes).any():
                return _failed(lanes)
            part = slice(begin, begin + turns)
            strobes[:, part] = samples[FINE::FINE].transpose(2, 0, 1)
            for column, row in enumerate((system.output, first)):
                displacement = _peaked(np.abs(np.einsum("tkl,k->lt", samples[:, 0::2], row)))
                peaks[:, part, column] = displacement.reshape(LANES, turns, FINE).max(axis=2)
        return Watched(lanes.state.T.copy(), strobes, peaks)


def _peaked(samples):
    """Samples (N, K + 1) but the first, those that are larger than their neighbours raised to the parabola's top."""
    before, here, after = samples[:, :-2], samples[:, 1:-1], samples[:, 2:]
    bend = before - 2 * here + after
    is_peak = (here >= before) & (here >= after) & (bend < 0)
    raised = here - np.where(is_peak, (after - before) ** 2 / (8 * np.where(is_peak, bend, 1.0)), 0.0)
    return np.concatenate([raised, samples[:, -1:]], axis=1)


def _failed(lanes):
    bad = np.array([int(outcome[0]) not in _GOOD for outcome in lanes.propagate_res])
    return bad | ~np.isfinite(lanes.state).all(axis=0) | (np.abs(lanes.state) > 1e12).any(axis=0)


_GOOD = tuple(int(code) for code in (heyoka.taylor_outcome.time_limit, heyoka.taylor_outcome.success))


def _equations(system):
    """Derivatives by tau of (x_0, v_0, x_1, ...), par[0] being Omega and par[1] the factor of the force."""
    size = system.size
    names = [f"{letter}{k}" for k in range(size) for letter in "xv"]
    made = heyoka.make_vars(*names)
    x, v = made[0::2], made[1::2]
    force = [
        heyoka.par[1] * float(system.forcing[k]) * heyoka.cos(heyoka.time)
        - _along(system.damping[k], v)
        - _along(system.stiffness[k], x)
        for k in range(size)
    ]
    for element in system.elements:
        push = _force(element.law, _along(element.direction, x), _along(element.direction, v))
        force = [f - float(n) * push if n else f for f, n in zip(force, element.direction, strict=True)]
    inverse = np.linalg.inv(system.mass)
    found = []
    for k in range(size):
        found += [(x[k], v[k] / heyoka.par[0]), (v[k], _along(inverse[k], force) / heyoka.par[0])]
    return found


def _along(row, values):
    return heyoka.sum([float(c) * value for c, value in zip(row, values, strict=True) if c] or [heyoka.expression(0.0)])


def _force(law, z, w):
    """The law's force as its documentation states it."""
    assert (law.stops, law.friction, law.weight) == (None, None, 0)
    if isinstance(law, frahm.TransverseSprings):
        q = heyoka.sqrt(law.length**2 + z * z)
        spring = 2.0 * law.spring_stiffness * z * (1.0 - law.length / q) + 2.0 * law.pretension * z / q
    else:
        spring = 0.0 * z
        for coefficient in reversed(law.coefficients):  # a power of z has no Taylor series at z = 0 here, products have
            spring = (spring + float(coefficient)) * z
    return spring + float(law.damping) * w
