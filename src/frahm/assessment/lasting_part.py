"""The lasting part of motions that seemed not to repeat: what decays onto a periodic one is that one.

A slow free vibration of a lower mode, seen over the hundreds of periods of a higher one, is as stationary as a
modulated motion; followed until it has died out it is none.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from frahm.attractors import Attractor, AttractorSet
from frahm.attractors.attractor import clopper_pearson
from frahm.attractors.finding import attractors_reached
from frahm.attractors.orbits import Orbit, orbit_at, orbit_size
from frahm.attractors.settling import known_orbits
from frahm.attractors.stroboscope import Stroboscope
from frahm.harmonic_balance import PeriodicResponse

_CHUNK = 500  # periods carried at a time
_SEEMING = "quasi-periodic"  # a chaotic motion may last as long as anyone cares, and its rate of leaving is told


def lasting(strobe: Stroboscope, responses: Sequence[PeriodicResponse], found: AttractorSet) -> AttractorSet:
    """The same without quasi-periodic motions that end on a periodic one within the periods of the search.

    Their share of the basins is that of the motion they end on.
    """
    seeming = [one for one in found if one.kind == _SEEMING]
    orbits = _orbits(strobe, responses, found) if seeming else []
    if not orbits:
        return found
    ends = _ends(strobe, orbits, seeming, found.periods)
    kept = [one for one in found if one.kind != _SEEMING]
    kept += [one for one, end in zip(seeming, ends, strict=True) if end is None]
    for index, orbit in enumerate(orbits):
        gone = [one for one, end in zip(seeming, ends, strict=True) if end == index]
        if not gone:
            continue
        at = next((at for at, one in enumerate(kept) if _is_on(strobe, one, orbit)), None)
        if at is None:
            kept += attractors_reached(strobe, responses, orbit.states[:1], found.periods)
            at = len(kept) - 1
        kept[at] = _with_basins(kept[at], gone, found.samples)
    kept.sort(key=lambda one: -np.nan_to_num(one.pipe_peak, nan=-1.0, posinf=np.inf))
    return dataclasses.replace(found, attractors=tuple(kept))


def _orbits(strobe: Stroboscope, responses: Sequence[PeriodicResponse], found: AttractorSet) -> list[Orbit]:
    """Orbits of the stable periodic responses, and of the periodic motions found beside them."""
    orbits = [one for one in known_orbits(strobe, [r.state for r in responses if r.stable]) if one is not None]
    for one in found:
        if one.kind == "periodic" and not any(_is_on(strobe, one, orbit) for orbit in orbits):
            orbit = orbit_at(strobe, np.array(one.representative_state), one.period_multiple)
            orbits += [] if orbit is None else [orbit]
    return orbits


def _ends(strobe: Stroboscope, orbits: Sequence[Orbit], motions: Sequence[Attractor], periods: int) -> list[int | None]:
    """Index of the orbit each of the motions has settled onto when followed on; None if on none."""
    ends: list[int | None] = [None] * len(motions)
    states = np.array([one.representative_state for one in motions])
    left = np.arange(len(motions))
    for _ in range(0, periods, _CHUNK):
        glimpse = strobe.run(states[left], _CHUNK, strobes=max(orbit.multiple for orbit in orbits))
        states[left] = glimpse.states
        good = glimpse.codes == 0
        left, strobes = left[good], glimpse.strobes[good]
        for index, orbit in enumerate(orbits):
            ended = orbit.attracts(strobes)
            for at in left[ended]:
                ends[at] = index
            left, strobes = left[~ended], strobes[~ended]
        if not left.size:
            break
    return ends


def _is_on(strobe: Stroboscope, one: Attractor, orbit: Orbit) -> bool:
    state = one.representative_state[None]
    return one.kind == "periodic" and orbit.holds(state, orbit_size(strobe, state))


def _with_basins(one: Attractor, others: Sequence[Attractor], samples: int) -> Attractor:
    """A motion with the basins of others added to its own; none of them is known where nothing was sampled."""
    if not samples:
        return one
    share = one.basin_fraction + sum(other.basin_fraction for other in others)
    return dataclasses.replace(
        one, basin_fraction=share, basin_interval=clopper_pearson(round(share * samples), samples),
        from_rest=one.from_rest or any(other.from_rest for other in others),
    )  # fmt: skip
