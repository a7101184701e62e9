"""Which attractor each of many states ends on.

States are carried on in stretches, and a motion is judged by its own convergence first. Those inside the ball of a
stable orbit are done: that is where most periods are saved. Those that nearly repeat are refined by Newton's method and
compared with the orbits known. Others show, after two windows in which they cover nothing new, an attractor that is no
orbit. As a chaotic motion can still end on an orbit, being where a chaotic set has been settles nothing before the
periods allowed are over; how many motions leave such a set on the way is kept. What has not settled in the end is
called unsettled.
"""

from __future__ import annotations

import enum
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from frahm.arrays import Floats
from frahm.attractors.clouds import BELONGS, INSIDE, Cloud, confirmed, drift, looks_stationary
from frahm.attractors.orbits import Orbit, orbit_at, orbit_size, refined, spectral_radius
from frahm.attractors.repetition import HIGHEST_MULTIPLE, approaching, repeats
from frahm.attractors.stroboscope import Stroboscope
from frahm.errors import Outcome

START = (20, 30, 50, 50, 50)  # periods of the first stretches: only balls are asked
BLOCK, WINDOW = 100, 3  # periods of a further stretch, stretches of a window
_GROUP = 4096  # coordinates carried at a time: bounds the memory
_FAR = 1e9  # times the size of everything seen at the start
_ATTEMPTS = 8  # motions per call that may be tried as evidence of an attractor that is no orbit
_AGAIN = 1.5  # times the periods at which it was tried: when a motion may be tried again
_AT_A_TIME = 24  # motions looked at after every block of periods for what they nearly repeat
_IN_VAIN = 4  # searches for an orbit without result in one round, and at the end on each regular cloud
_LATER = 1.25  # times the periods after which a round ended in vain: when the next one begins
_CONSERVATIVE = 1e-9  # rate of contraction, over Omega, that rounding cannot tell from none
_UNSTABLE = 1.01  # largest multiplier above which differences are enough to say that an orbit is not stable
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
    held : ndarray of int, shape (N,)
        Index of the first cloud each was seen in, -1 for none.
    held_from : ndarray, shape (N,)
        Periods after which it was seen there.
    """

    labels: np.ndarray
    outcomes: list[Outcome]
    states: Floats
    periods: np.ndarray
    held: np.ndarray
    held_from: np.ndarray

    @property
    def interrupted(self) -> bool:
        """Whether an interruption left states without label."""
        return Outcome.INTERRUPTED in self.outcomes

    def part(self, members: np.ndarray) -> Settled:
        """Where some of the states went."""
        outcomes = [self.outcomes[i] for i in members]
        kept = (self.states, self.periods, self.held, self.held_from)
        return Settled(self.labels[members], outcomes, *(values[members] for values in kept))

    def put(self, members: np.ndarray, part: Settled) -> None:
        """Say of some of the states where they went."""
        for i, outcome in zip(members, part.outcomes, strict=True):
            self.outcomes[i] = outcome
        for name in ("labels", "states", "periods", "held", "held_from"):
            getattr(self, name)[members] = getattr(part, name)


class _Nature(enum.IntEnum):
    """What the strobes of a motion have shown so far."""

    OPEN = 0
    ORBIT = 1  # it repeats better and better, and Newton's method finds a stable orbit there
    BEAT = 2  # it nearly repeats, and as well as ever


@dataclass(eq=False)
class _Watched:
    """Motions still followed: which of the N states, their last strobes (k, K, 2n), and what was tried with each."""

    active: np.ndarray
    history: Floats
    nature: np.ndarray
    tried: np.ndarray
    refused: np.ndarray  # periods at which Newton's method last found no orbit
    no_orbit_before: float = 0.0  # periods; set where a round was in vain
    no_cloud_before: float = 0.0

    def keep(self, left: np.ndarray) -> None:
        """Go on with the motions of the states `left` alone."""
        kept = np.isin(self.active, left)
        self.active, self.history = self.active[kept], self.history[kept]
        self.nature, self.tried, self.refused = self.nature[kept], self.tried[kept], self.refused[kept]

    def now(self, result: Settled) -> int:
        """Periods after which the motions are."""
        return int(np.max(result.periods[self.active], initial=0))

    def due(self, periods: np.ndarray) -> list[int]:
        """States whose turn to be tried has come; a trial is worth repeating only after half as long again."""
        return [int(i) for i, tried in zip(self.active, self.tried, strict=True) if periods[i] >= _AGAIN * tried]

    def to_refine(self, periods: np.ndarray, held: np.ndarray) -> list[int]:
        """States that may be near an orbit: due, not refused lately, and not where a known cloud has been.

        A few at a time, those first that were refused longest ago: what they lead to settles most of the others.
        """
        refused = dict(zip(self.active.tolist(), self.refused.tolist(), strict=True))
        asked = [i for i in self.due(periods) if periods[i] >= _AGAIN * refused[i] and held[i] == UNLABELLED]
        return sorted(sorted(asked, key=lambda i: refused[i])[:_AT_A_TIME])

    def place(self, state: int) -> int | None:
        """Where a state stands among those still followed."""
        at = int(np.searchsorted(self.active, state))
        return at if at < len(self.active) and self.active[at] == state else None


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
        count, result = len(states), _begun(states, resume)
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

    def settle_left(self, states: Floats, before: Settled, resume: bool = True) -> Settled:
        """As `settle`, but for the first of the states, which have been settled `before`, where these have a label."""
        result = _begun(states, resume)
        labelled = np.flatnonzero(before.labels != UNLABELLED)
        result.put(labelled, before.part(labelled))
        left = np.flatnonzero(result.labels == UNLABELLED)
        result.put(left, self.settle(states[left], resume))
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
        nothing = np.zeros(len(active), dtype=int)
        strobes = np.empty((len(active), 0, result.states.shape[1]))
        watched = _Watched(active, strobes, nothing, nothing.copy(), nothing.copy())
        for _ in range(left // BLOCK):
            if not len(watched.active):
                return
            self._follow(result, watched, bound)
            if watched.history.shape[1] == 2 * WINDOW * BLOCK and self.dissipative:
                self._look_for_orbits(result, watched)
                self._hold(result, watched)
                self._look_for_clouds(result, watched)
        self._judge(result, watched)

    def _follow(self, result: Settled, watched: _Watched, bound: float) -> None:
        """Carry the motions on by a block; those that reach a ball are done."""
        left, strobes = self._carry(result, watched.active, BLOCK, BLOCK, bound)
        watched.keep(left)
        watched.history = np.concatenate([watched.history, strobes], axis=1)[:, -2 * WINDOW * BLOCK :]
        self._drop_attracted(result, watched)

    def _drop_attracted(self, result: Settled, watched: _Watched) -> None:
        """Done is what came through a ball of an orbit in its last turn."""
        for index, attractor in enumerate(self.known):
            if len(watched.active) and isinstance(attractor, Orbit):
                _label(result, watched.active[attractor.attracts(watched.history)], index)
                watched.keep(watched.active[result.labels[watched.active] == UNLABELLED])

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

    def _look_for_orbits(self, result: Settled, watched: _Watched) -> None:
        """Refine motions that repeat better and better; what is found and was not known is known from now on."""
        now = watched.now(result)
        due = watched.to_refine(result.periods, result.held) if now >= watched.no_orbit_before else []
        places = np.flatnonzero(np.isin(watched.active, due))
        vain = 0
        for i, (multiples, nearing) in zip(due, self._repeats(watched.history[places]), strict=True):
            at = watched.place(i)
            if at is None or not multiples:
                continue
            if vain == _IN_VAIN:
                watched.no_orbit_before = _LATER * now
                return
            known = len(self.known)
            found = self._orbit_near(watched.history[at], nearing)
            vain += found is None and bool(nearing)
            watched.nature[at] = _Nature.ORBIT if found is not None else _Nature.OPEN if nearing else _Nature.BEAT
            watched.tried[at] = 0 if found is None else result.periods[i]  # a beat is for `_look_for_clouds` to try
            watched.refused[at] = result.periods[i] if found is None else 0
            if len(self.known) > known:
                self._drop_attracted(result, watched)

    def _repeats(self, strobes: Floats) -> list[tuple[list[int], list[int]]]:
        """After how many periods each of the motions (N, K, 2n) nearly repeats, and after which better and better."""
        sizes = np.array([orbit_size(self.strobe, motion) for motion in strobes])
        scaled = strobes / sizes.reshape(len(strobes), 1, strobes.shape[2])
        return [(found, approaching(motion, found)) for motion, found in zip(scaled, repeats(scaled), strict=True)]

    def _orbit_near(self, strobes: Floats, multiples: Sequence[int]) -> int | None:
        """Index of the stable orbit that the last of the strobes (K, 2n) refines to, made known if it was not."""
        size = orbit_size(self.strobe, strobes)
        for multiple in reversed(multiples):  # what repeats best first
            found = refined(self.strobe, strobes[-1], multiple)
            if found is None or spectral_radius(found[1]) > _UNSTABLE:
                continue
            state = found[0]
            for index, attractor in enumerate(self.known):
                if isinstance(attractor, Orbit) and attractor.passes(state, size):
                    return index
            orbit = orbit_at(self.strobe, state, multiple)
            if orbit is not None:
                self.known.append(orbit)
                return len(self.known) - 1
        return None

    def _hold(self, result: Settled, watched: _Watched) -> None:
        """Note which motions are where a known cloud has been; on a regular one they stay."""
        free = np.flatnonzero((result.held[watched.active] == UNLABELLED) & (watched.nature != _Nature.ORBIT))
        index, share = self._nearest_cloud(watched.history[free, -WINDOW * BLOCK :])
        free, index = free[share >= INSIDE], index[share >= INSIDE]
        members = watched.active[free]
        result.held[members], result.held_from[members] = index, result.periods[members]
        for at, i, cloud in zip(free, members, index, strict=True):
            if self._is_regular(cloud) and looks_stationary(watched.history[at]):
                _label(result, np.array([i]), cloud)
        watched.keep(watched.active[result.labels[watched.active] == UNLABELLED])

    def _is_regular(self, index: int) -> bool:
        attractor = self.known[index]
        return isinstance(attractor, Cloud) and not attractor.exponent.chaotic

    def _nearest_cloud(self, strobes: Floats) -> tuple[np.ndarray, Floats]:
        """Index of the cloud that holds the largest share of each motion's strobes (N, K, 2n), and that share."""
        best, largest = np.full(len(strobes), UNLABELLED), np.zeros(len(strobes))
        for index, attractor in enumerate(self.known):
            if isinstance(attractor, Cloud):
                share = attractor.share(strobes)
                best, largest = np.where(share > largest, index, best), np.maximum(share, largest)
        return best, largest

    def _look_for_clouds(self, result: Settled, watched: _Watched) -> None:
        """Try motions that have become stationary as evidence of an attractor that is no orbit."""
        now = watched.now(result)
        for i in watched.due(result.periods) if now >= watched.no_cloud_before else []:
            at = watched.place(i)
            if at is None or result.held[i] != UNLABELLED or watched.nature[at] == _Nature.ORBIT or not self._attempts:
                continue
            evidence = self._evidence(watched.history[at], watched.nature[at])
            if evidence is None and watched.nature[at] != _Nature.BEAT:
                continue
            watched.tried[at] = result.periods[i]
            self._attempts -= 1
            cloud = None
            if evidence is not None and not self._is_known(evidence):
                cloud = confirmed(self.strobe, evidence, self.orbits)
            if cloud is None:
                watched.no_cloud_before = _LATER * now
                return
            self.known.append(cloud)
            self._hold(result, watched)

    def _is_known(self, strobes: Floats) -> bool:
        """Whether strobes (K, 2n), which may be later ones than those of the motion they belong to, are on a cloud."""
        return bool(self._nearest_cloud(strobes[None])[1][0] >= INSIDE)

    def _evidence(self, strobes: Floats, nature: int) -> Floats | None:
        """Strobes (K, 2n) that cover what a motion covers, or None if they do not yet."""
        # of a beat of nearly a few periods, what it covers shows only over a long time
        seen = drift(self.strobe, strobes[-1]) if nature == _Nature.BEAT else strobes
        return seen if seen is not None and looks_stationary(seen) else None

    def _judge(self, result: Settled, watched: _Watched) -> None:
        """Label what is left when the periods are over: by what each motion converges to, then by where it is."""
        if not len(watched.active) or watched.history.shape[1] < 2 * WINDOW * BLOCK:
            return
        index, share = self._nearest_cloud(watched.history[:, -WINDOW * BLOCK :])
        refused: dict[int, int] = {}  # of motions on each regular cloud, how many approach no orbit
        for at, i in enumerate(watched.active):
            cloud = int(index[at]) if share[at] >= INSIDE and self._is_regular(int(index[at])) else UNLABELLED
            asked = self.dissipative and refused.get(cloud, 0) < _IN_VAIN
            orbit = self._orbit_approached(watched.history[at]) if asked else None
            if orbit is None and cloud != UNLABELLED:
                refused[cloud] = refused.get(cloud, 0) + 1
            if orbit is not None:
                _label(result, watched.active[at : at + 1], orbit)
            elif share[at] >= (INSIDE if result.held[i] == UNLABELLED else BELONGS):
                _label(result, watched.active[at : at + 1], index[at])

    def _orbit_approached(self, strobes: Floats) -> int | None:
        """Index of the stable orbit that a motion with these strobes (K, 2n) nearly repeats and comes nearer to."""
        index = self._orbit_near(strobes, self._repeats(strobes[None])[0][1])
        if index is None:
            return None
        orbit = self.known[index]
        assert isinstance(orbit, Orbit)
        distance, last = orbit.distance(strobes), strobes[-HIGHEST_MULTIPLE:]
        turns = HIGHEST_MULTIPLE // orbit.multiple
        nearer = np.max(distance[-turns:]) < np.min(distance[:turns])
        return index if nearer or orbit.holds(last, orbit_size(self.strobe, strobes)) else None


def _begun(states: Floats, resume: bool) -> Settled:
    """States (N, 2n) before anything is known of them."""
    count = len(states)
    waiting = Outcome.NOT_CONVERGED if resume else Outcome.INTERRUPTED
    return Settled(
        np.full(count, UNLABELLED), [waiting] * count, np.array(states), np.zeros(count, dtype=int),
        np.full(count, UNLABELLED), np.zeros(count, dtype=int),
    )  # fmt: skip


def known_orbits(strobe: Stroboscope, states: Sequence[Floats]) -> list[Orbit | None]:
    """Orbits through the states of stable periodic responses; None where the monodromy matrix denies stability."""
    return [orbit_at(strobe, np.array(state)) for state in states]


def _label(result: Settled, members: np.ndarray, index: int) -> None:
    result.labels[members] = index
    for i in members:
        result.outcomes[i] = Outcome.DONE
