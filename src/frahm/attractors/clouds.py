"""Attractors that are no periodic orbits, known by the cloud of their strobes.

Two long motions are on the same attractor if each comes back, again and again, to where the other has been. A motion
that lingers near the ghost of an attractor does so too, for a while: a cloud is taken for an attractor only after eight
of sixteen motions started on it have stayed there for thousands of periods. A chaotic set may leak all the same: those
that left are counted.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from frahm.arrays import Floats, frozen
from frahm.attractors.modulation import Exponent, lyapunov
from frahm.attractors.orbits import Orbit
from frahm.attractors.stroboscope import Stroboscope
from frahm.tolerances import TINY

MEMBERS = 8
STAY, WATCH = 1500, 1000  # periods a cloud must hold its members before it is believed, and while they are watched
STRETCH = 50  # periods over each of which the peak is kept
_STARTED = 2 * MEMBERS
_STATIONARY, BELONGS, INSIDE = 0.8, 0.5, 0.9  # shares of strobes that must lie where others have been
_LEAST_REACH = 0.25  # in standard deviations of the strobes: clouds nearer to each other than this count as one
_REACHED = 0.99  # share of a motion's strobes that those of others on the attractor come near to
_QUERIES = 100  # strobes of a motion that are looked at
_FLAT = 1e-9  # of the largest coordinate: a coordinate that varies by less does not vary
_LEAST_BLOCKS, _MOST_ROUNDS = 64, 32  # of WATCH periods of each member, and rounds of them: for peaks that are rare
_STRETCHES, _STRETCH, _HIGHEST = 48, 251, 17  # of a drift: stretches, their periods (a prime), strobes at their ends


@dataclass(frozen=True, eq=False)
class Cloud:
    """Attractor known by its strobes.

    Attributes
    ----------
    scale : ndarray, shape (2n,)
        Standard deviation of the strobes [m, m/s].
    tree : cKDTree
        Strobes over `scale`.
    reach : float
        Distance, over `scale`, within which a state counts as being where the attractor has been.
    members : ndarray, shape (8, K, 2n)
        Strobes of the eight motions that confirmed it.
    stretches : ndarray, shape (8, S, 6)
        What they showed over each of the stretches of 50 periods that make up the last K, see `Glimpse.seen`.
    exponent : Exponent
        Largest Lyapunov exponent on it.
    followed, left : int
        Periods that the sixteen motions started on it were followed in all, and how many of them left for an orbit.
    """

    scale: Floats
    tree: cKDTree
    reach: float
    members: Floats
    stretches: Floats
    exponent: Exponent
    followed: int
    left: int

    @property
    def seen(self) -> Floats:
        """What the eight motions showed over the last K periods, shape (8, 6), see `Glimpse.seen`."""
        each = self.stretches
        peaks, least, square = np.max(each, axis=1), np.min(each, axis=1), np.mean(each**2, axis=1)
        rms = np.sqrt(square)
        return np.stack([peaks[:, 0], least[:, 1], rms[:, 2], peaks[:, 3], least[:, 4], rms[:, 5]], axis=1)

    def share(self, strobes: Floats) -> Floats:
        """Share of the strobes (N, K, 2n) of each motion that lie where the attractor has been, shape (N,)."""
        return _share(self.tree, self.scale, self.reach, strobes)


def looks_stationary(strobes: Floats) -> bool:
    """Whether either half of a motion's strobes (2 K, 2n) covers what the other has covered."""
    half = len(strobes) // 2
    parts = strobes[:half], strobes[half : 2 * half]
    return all(_covers(here, there) for here, there in (parts, parts[::-1]))


def drift(strobe: Stroboscope, state: Floats) -> Floats | None:
    """Strobes (K, 2n) of a motion spread over a long time, for beats that nearly fit a few periods; None if lost."""
    found, states = [], state[None]
    for _ in range(_STRETCHES):
        seen = strobe.run(states, _STRETCH, strobes=_HIGHEST)
        if np.any(seen.codes):
            return None
        states = seen.states
        found.append(seen.strobes[0])
    return np.concatenate(found)


def _covers(here: Floats, there: Floats) -> bool:
    tree, scale, reach = _tree(here)
    return bool(_share(tree, scale, reach, there[None])[0] >= _STATIONARY)


def confirmed(strobe: Stroboscope, strobes: Floats, orbits: Sequence[Orbit]) -> Cloud | None:
    """Cloud of the attractor a motion with these strobes (K, 2n) is on, or None if most motions started there leave."""
    starts = strobes[np.linspace(len(strobes) // 2, len(strobes) - 1, _STARTED).astype(int)]
    stretches, watched, good = _kept(strobe, starts, orbits)
    left = int(np.count_nonzero(~good))
    tree, scale, reach = _tree(strobes)
    good[good] = _share(tree, scale, reach, watched[good, -len(strobes) // 2 :]) >= BELONGS
    on = np.flatnonzero(good)[:MEMBERS]
    if len(on) < MEMBERS:
        return None
    members = frozen(watched[on])
    if left:  # or never arrived: those that have stayed so long tell
        states = members[:, :: WATCH * MEMBERS // _STARTED].reshape(_STARTED, -1)
        left = int(np.count_nonzero(~_kept(strobe, states, orbits)[2]))
    tree, scale, _ = _tree(np.concatenate([strobes, members.reshape(-1, strobes.shape[1])]))
    return Cloud(
        frozen(scale), tree, _reach(strobes / scale, members / scale), members, frozen(stretches[on]),
        lyapunov(strobe, members[:, -1]), _STARTED * (STAY + WATCH), left,
    )  # fmt: skip


def _kept(strobe: Stroboscope, starts: Floats, orbits: Sequence[Orbit]) -> tuple[Floats, Floats, np.ndarray]:
    """What motions show in the end and their strobes, see `_watched`, and which are on none of the orbits, nor lost."""
    stayed = strobe.run(starts, STAY)
    alive = stayed.codes == 0
    stretches, watched, _, good = _watched(strobe, np.where(alive[:, None], stayed.states, starts))
    good &= alive
    for orbit in orbits:
        good &= ~orbit.attracts(watched)
    return stretches, watched, good


def peaks_of_long_motions(
    strobe: Stroboscope, cloud: Cloud, orbits: Sequence[Orbit], enough: Callable[[Floats], bool]
) -> Floats:
    """Peaks (B, 20, 2) of pipe and first element over the stretches of B blocks of 1000 periods on an attractor.

    The members are followed on until `enough` says so of the peaks of either, or 32 blocks each are seen; what leaves
    the attractor in a block is followed no longer, and that block is not counted.
    """
    blocks, states = cloud.stretches[:, :, [0, 3]], cloud.members[:, -1]
    for _ in range(1, _MOST_ROUNDS):
        if len(blocks) >= _LEAST_BLOCKS and enough(blocks[..., 0]) and enough(blocks[..., 1]):
            break
        stretches, strobes, states, good = _watched(strobe, states)
        for orbit in orbits:
            good &= ~orbit.attracts(strobes)
        good[good] = cloud.share(strobes[good, -WATCH // 2 :]) >= BELONGS
        if not np.any(good):
            break
        blocks, states = np.concatenate([blocks, stretches[good][:, :, [0, 3]]]), states[good]
    return blocks


def _watched(strobe: Stroboscope, states: Floats) -> tuple[Floats, Floats, Floats, np.ndarray]:
    """Motions over 1000 periods: what they show over stretches of 50, strobes, last states, and which are not lost."""
    starts, good = states, np.ones(len(states), dtype=bool)
    stretches, strobes = [], []
    for _ in range(WATCH // STRETCH):
        seen = strobe.run(states, STRETCH, window=STRETCH, strobes=STRETCH)
        good &= seen.codes == 0
        states = np.where(good[:, None], seen.states, starts)  # what is lost is not carried on into infinity
        stretches.append(seen.seen)
        strobes.append(seen.strobes)
    return np.stack(stretches, axis=1), np.concatenate(strobes, axis=1), states, good


def _tree(points: Floats) -> tuple[cKDTree, Floats, float]:
    """Tree of the points (K, 2n), the scale they are divided by, and how far they may be from each other."""
    scale = np.std(points, axis=0)
    scale = np.maximum(scale, _FLAT * np.max(np.abs(points), initial=TINY, axis=0))
    tree = cKDTree(points / scale)
    nearest = tree.query(tree.data, k=2)[0][:, 1]
    return tree, scale, max(2.0 * float(np.quantile(nearest, 0.95)), _LEAST_REACH)


def _reach(strobes: Floats, members: Floats) -> float:
    """Distance within which nearly all strobes of each member (m, K, 2n) lie from those of the others and `strobes`.

    No more: a smaller attractor may lie in what a chaotic motion leaves empty.
    """
    others = (np.concatenate([strobes, *np.delete(members, k, axis=0)]) for k in range(len(members)))
    apart = [cKDTree(points).query(member)[0] for points, member in zip(others, members, strict=True)]
    return max(float(np.quantile(apart, _REACHED)), _LEAST_REACH)


def _share(tree: cKDTree, scale: Floats, reach: float, strobes: Floats) -> Floats:
    if not len(strobes):
        return np.zeros(0)
    looked = strobes[:, :: max(1, strobes.shape[1] // _QUERIES)]
    distance = tree.query((looked / scale).reshape(-1, looked.shape[2]), distance_upper_bound=reach)[0]
    return np.asarray(np.mean(np.isfinite(distance).reshape(looked.shape[:2]), axis=1))
