"""Which attractor each of many states ends on, with early classification.

States are carried on in stretches. After each, those inside the ball of a stable orbit are done: that is where most
periods are saved. The others are held against the clouds of the attractors already known and, after two windows in
which they show nothing new, are taken as evidence of an attractor not known yet. What has not settled in the end is
called unsettled.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from frahm.arrays import Floats
from frahm.attractors.clouds import Cloud, confirmed, drift, looks_stationary
from frahm.attractors.orbits import Orbit, orbit_at, orbit_size, refined
from frahm.attractors.stroboscope import Stroboscope
from frahm.errors import Outcome

START = (20, 30, 50, 50, 50)  # periods of the first stretches: only balls are asked
BLOCK, WINDOW = 100, 3  # periods of a further stretch, stretches of a window
_GROUP = 4096  # coordinates carried at a time: bounds the memory
_FAR = 1e9  # times the size of everything seen at the start
_ATTEMPTS = 8  # motions per call that may be tried as evidence of an attractor not known yet
_REST = 3 * BLOCK  # periods after which a motion that was tried in vain may be tried again
_CONSERVATIVE = 1e-9  # rate of contraction, over Omega, that rounding cannot tell from none
_HIGHEST_MULTIPLE = 16
_NEARLY_PERIODIC, _SAME = 0.02, 0.1  # distance of strobes, in sizes of the motion
UNLABELLED = -1


@dataclass(eq=False)
class Settled:
    """Where N states went.

    Attributes
    ----------
    labels : ndarray of int, shape (N,)
        Index of the attractor, -1 for none.
    outcomes : list of Outcome, length N
        DONE where there is a label; otherwise why there is none.
    states : ndarray, shape (N, 2n)
        Last states [m, m/s].
    periods : ndarray, shape (N,)
        Periods each was carried on.
    """

    labels: np.ndarray
    outcomes: list[Outcome]
    states: Floats
    periods: np.ndarray

    @property
    def interrupted(self) -> bool:
        """Whether an interruption left states without label."""
        return Outcome.INTERRUPTED in self.outcomes


@dataclass(eq=False)
class Settling:
    """Attractors known so far at one excitation frequency; `settle` adds to them what it meets.

    Attributes
    ----------
    strobe : Stroboscope
    periods : int
        Periods after which a motion that has not settled is given up.
    known : list of Orbit or Cloud
    """

    strobe: Stroboscope
    periods: int
    known: list[Orbit | Cloud] = field(default_factory=list)
    _attempts: int = 0

    @property
    def dissipative(self) -> bool:
        """Whether the flow contracts volumes in state space; where it does not, nothing attracts."""
        system = self.strobe.system
        damping = np.array(system.damping)
        for element in system.elements:
            damping += element.law.damping_at(0.0) * np.outer(element.direction, element.direction)
        return bool(np.trace(np.linalg.solve(system.mass, damping)) > _CONSERVATIVE * self.strobe.frequency)

    @property
    def orbits(self) -> list[Orbit]:
        """Those of the known attractors that are periodic orbits."""
        return [item for item in self.known if isinstance(item, Orbit)]

    def settle(self, states: Floats, resume: bool = True) -> Settled:
        """Label states (N, 2n); an interruption, or `resume` being false after one, leaves the rest unlabelled."""
        count = len(states)
        waiting = Outcome.NOT_CONVERGED if resume else Outcome.INTERRUPTED
        result = Settled(np.full(count, UNLABELLED), [waiting] * count, np.array(states), np.zeros(count, dtype=int))
        self._attempts = _ATTEMPTS
        done, group = 0, max(8, _GROUP // self.strobe.system.size)
        try:
            while resume and done < count:
                self._settle_group(result, np.arange(done, min(done + group, count)))
                done += group
        except KeyboardInterrupt:
            for i in range(done, count):
                if result.outcomes[i] is Outcome.NOT_CONVERGED:
                    result.outcomes[i] = Outcome.INTERRUPTED
        return result

    def _settle_group(self, result: Settled, active: np.ndarray) -> None:
        bound = _FAR * np.max(np.abs(result.states[active]), initial=0.0)
        bound = max(bound, _FAR * float(np.max(orbit_size(self.strobe, result.states[active][:1]))))
        active = self._drop_inside_balls(result, active)
        left = self.periods
        for stretch in START:
            active, _ = self._carry(result, active, min(stretch, left), 0, bound)
            active = self._drop_inside_balls(result, active)
            left -= min(stretch, left)
        history = np.empty((len(active), 0, result.states.shape[1]))
        tried = np.full(len(result.labels), -_REST)
        for _ in range(left // BLOCK):
            if not len(active):
                return
            before = active
            active, strobes = self._carry(result, active, BLOCK, BLOCK, bound)
            history = np.concatenate([history[np.isin(before, active)], strobes], axis=1)[:, -2 * WINDOW * BLOCK :]
            active, history = _kept(active, history, self._drop_inside_balls(result, active))
            if history.shape[1] >= WINDOW * BLOCK:
                active, history = self._drop_inside_clouds(result, active, history)
            if history.shape[1] == 2 * WINDOW * BLOCK:
                active, history = self._look_for_more(result, active, history, tried)

    def _carry(
        self, result: Settled, active: np.ndarray, periods: int, strobes: int, bound: float
    ) -> tuple[np.ndarray, Floats]:
        """Carry the active states on; those that fail are dropped with their reason."""
        if not len(active) or periods == 0:
            return active, np.empty((0, strobes, result.states.shape[1]))
        glimpse = self.strobe.run(result.states[active], periods, strobes=strobes)
        result.states[active] = glimpse.states
        result.periods[active] += periods
        with np.errstate(invalid="ignore"):
            near = np.max(np.abs(glimpse.states), axis=1) < bound
        good = (glimpse.codes == 0) & near
        for i, outcome in zip(active[~good], np.array(glimpse.outcomes, dtype=object)[~good], strict=True):
            result.outcomes[i] = Outcome.DIVERGED if outcome is Outcome.DONE else outcome
        return active[good], glimpse.strobes[good]

    def _drop_inside_balls(self, result: Settled, active: np.ndarray) -> np.ndarray:
        for index, attractor in enumerate(self.known):
            if len(active) and isinstance(attractor, Orbit):
                inside = attractor.contains(result.states[active])
                _label(result, active[inside], index)
                active = active[~inside]
        return active

    def _drop_inside_clouds(self, result: Settled, active: np.ndarray, history: Floats) -> tuple[np.ndarray, Floats]:
        for index, attractor in enumerate(self.known):
            if len(active) and isinstance(attractor, Cloud):
                inside = attractor.contains(history[:, -WINDOW * BLOCK :])
                _label(result, active[inside], index)
                active, history = active[~inside], history[~inside]
        return active, history

    def _look_for_more(
        self, result: Settled, active: np.ndarray, history: Floats, tried: np.ndarray
    ) -> tuple[np.ndarray, Floats]:
        """Try motions that have become stationary as evidence of an attractor not known yet."""
        at = 0 if self.dissipative else len(active)
        while at < len(active) and self._attempts > 0:
            i = active[at]
            if result.periods[i] - tried[i] < _REST:
                at += 1
                continue
            found = self._new_attractor(history[at])
            if found is None:
                at += 1
                continue
            tried[i] = result.periods[i]
            self._attempts -= 1
            if isinstance(found, Orbit | Cloud):
                self.known.append(found)
                active, history = _kept(active, history, self._drop_inside_balls(result, active))
                active, history = self._drop_inside_clouds(result, active, history)
        return active, history

    def _new_attractor(self, strobes: Floats) -> Orbit | Cloud | bool | None:
        """Attractor that strobes (K, 2n) give evidence of; False if a trial says there is none, None without one."""
        size = orbit_size(self.strobe, strobes)
        multiple = _period_multiple(strobes / size)
        if multiple:
            centres = [orbit.states for orbit in self.orbits]
            if any(np.min(np.max(np.abs((strobes[-1] - c) / size), axis=1)) < _SAME for c in centres):
                return None
            state = refined(self.strobe, strobes[-1], multiple)
            orbit = None if state is None else orbit_at(self.strobe, state, multiple)
            if orbit is not None and orbit.contains(strobes[-multiple:]).any():
                return orbit
            # a beat of nearly that many periods: what it covers shows only over a long time
            spread = drift(self.strobe, strobes[-1])
            if spread is None:
                return False
            strobes = spread
        if not looks_stationary(strobes):
            return None
        return confirmed(self.strobe, strobes, self.orbits) or False


def known_orbits(strobe: Stroboscope, states: Sequence[Floats]) -> list[Orbit | None]:
    """Orbits through the states of stable periodic responses; None where the monodromy matrix denies stability."""
    return [orbit_at(strobe, np.array(state)) for state in states]


def _period_multiple(strobes: Floats) -> int:
    """Smallest number of periods after which the last strobes (K, 2n), over the motion's size, nearly repeat; or 0."""
    last = strobes[-4 * _HIGHEST_MULTIPLE :]
    for multiple in range(1, _HIGHEST_MULTIPLE + 1):
        if np.max(np.abs(last[multiple:] - last[:-multiple])) < _NEARLY_PERIODIC:
            return multiple
    return 0


def _label(result: Settled, members: np.ndarray, index: int) -> None:
    result.labels[members] = index
    for i in members:
        result.outcomes[i] = Outcome.DONE


def _kept(active: np.ndarray, history: Floats, left: np.ndarray) -> tuple[np.ndarray, Floats]:
    return left, history[np.isin(active, left)]
