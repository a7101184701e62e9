"""Initial states worth trying besides a sample: rest, every periodic response, the jumps of the slow manifold.

Jumps of the slow invariant manifold: Starosvetsky and Gendelman (2008), doi 10.1016/j.physd.2008.01.019.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from frahm.arrays import Complexes, Floats
from frahm.attractors.orbits import orbit_size, unstable_directions
from frahm.attractors.stroboscope import Stroboscope
from frahm.errors import ParameterError
from frahm.harmonic_balance import PeriodicResponse
from frahm.slow_flow import slow_flow_of
from frahm.slow_flow.manifold import slow_manifold
from frahm.systems import System

_PUSH = 1e-3  # of the orbit's size, along a direction it is unstable in
_PHASES = np.exp(0.5j * np.pi * np.arange(4))


def seed_states(strobe: Stroboscope, responses: Sequence[PeriodicResponse]) -> Floats:
    """States (k, 2n) to start from; the first is rest."""
    seeds = [np.zeros((1, 2 * strobe.system.size)), jump_states(strobe)]
    for response in responses:
        if response.stable:
            continue
        state = np.array(response.state)
        pushes = _PUSH * unstable_directions(strobe, state)
        seeds += [state + pushes, state - pushes]
    found = np.concatenate(seeds)
    sizes = orbit_size(strobe, found)
    return np.asarray(found[np.all(np.abs(found) <= 1e6 * sizes, axis=1)])


def jump_states(strobe: Stroboscope) -> Floats:
    """States before and after the jumps of the slow invariant manifold, at four phases; none for other systems."""
    none = np.zeros((0, 2 * strobe.system.size))
    try:
        slow = slow_flow_of(strobe.system)
    except ParameterError:
        return none
    manifold = slow_manifold(slow, strobe.frequency)
    folds = manifold.folds
    if folds is None:
        return none
    W = strobe.frequency
    amplitudes = []
    for fold, landing in zip(folds.relative, folds.landing, strict=True):
        for relative in (fold, landing):
            nu = 0.75 * slow.kappa * relative**2 / (slow.rho2 * W**2)
            X = relative * (nu - 1 + 1j * manifold.lam)
            amplitudes += [(X * turn, relative * turn) for turn in _PHASES]
    x, z = np.array(amplitudes).T
    return states_of_amplitudes(strobe.system, x, z, W)


def states_of_amplitudes(system: System, X: Complexes, Z: Complexes, frequency: float) -> Floats:
    """States (k, 4) at phase 0 of one mode with one sink that swings with complex amplitudes X, Z (k,) [m]."""
    a, b = -system.elements[0].direction[0], system.elements[0].direction[1]
    host, sink = X / a, (X + Z) / b
    return np.column_stack([host.real, -frequency * host.imag, sink.real, -frequency * sink.imag])
