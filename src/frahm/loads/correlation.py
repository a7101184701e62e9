"""How much of a vibrating pipe the vortices drive in step: correlation lengths at the antinodes of its mode."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from frahm.arrays import Floats, frozen, real_array
from frahm.errors import ParameterError, check_number

MOST_IN_STEP = 0.6  # upper limit of K_w in EN 1991-1-4
_DECIMALS = 6  # of |phi| over its largest value: what rises less is no antinode of its own


@dataclass(frozen=True, eq=False)
class Antinodes:
    """A mode shape cut into the ranges around its antinodes, see `antinodes`.

    Attributes
    ----------
    peaks : ndarray, shape (m,)
        Largest |phi| of each range over that of all [-].
    integrals : tuple of ndarray
        For each range, the integral over its 0, 1, 2, ... cells with the largest |phi|, over the diameter [-].
    edges : ndarray, shape (m + 1,)
        Ends of the ranges over the length of the pipe, 0 to 1 [-].
    cell : float
        Length of a cell over the diameter [-].
    """

    peaks: Floats
    integrals: tuple[Floats, ...]
    edges: Floats
    cell: float

    @property
    def count(self) -> int:
        """Number of antinodes m."""
        return self.peaks.size

    def correlation_factor(self, amplitude_ratio: float) -> float:
        """Effective correlation length factor K_w = sum int_(L_j) |phi| ds / sum int_(l_j) |phi| ds <= 0.6 [-].

        Parameters
        ----------
        amplitude_ratio : float
            A/D where the mode moves most [-]; it sets the length L_j at every antinode, see `correlation_length`.

        Raises
        ------
        ParameterError
            If the amplitude is negative.

        Notes
        -----
        EN 1991-1-4, E.1.5.2.4. Every antinode is driven at the same wind speed, since pipe and wind are the same all
        along; each L_j lies where its range moves most and ends where the range ends. Within a range |phi| rises and
        falls once, so the length L_j with the largest integral is that of the largest values.
        """
        in_step = [
            np.interp(correlation_length(amplitude_ratio * peak), self.cell * np.arange(integral.size), integral)
            for peak, integral in zip(self.peaks, self.integrals, strict=True)
        ]
        return min(MOST_IN_STEP, float(sum(in_step) / sum(integral[-1] for integral in self.integrals)))


def antinodes(shape: ArrayLike, slenderness: float) -> Antinodes:
    """Ranges around the antinodes of a mode, from one lowest |phi| to the next: nodes, or where |phi| only dips.

    Parameters
    ----------
    shape : array_like, shape (n,)
        phi at the middles of n equal cells along the pipe [-].
    slenderness : float
        Length of the pipe over its diameter [-].

    Raises
    ------
    ParameterError
        If the shape is not finite or zero everywhere, or the slenderness is not positive.
    """
    size = np.abs(real_array("shape", shape, "a mode shape that is finite and not zero"))
    if size.ndim != 1 or size.size < 1 or not 0 < np.max(size) < np.inf:
        raise ParameterError("shape", shape, "a mode shape that is finite and not zero")
    size = size / np.max(size)
    cell = check_number("slenderness", slenderness, above=0) / size.size
    lows = _lows(size)
    ranges = [np.sort(part)[::-1] for part in np.split(size, lows)]
    return Antinodes(
        peaks=frozen([part[0] for part in ranges]),
        integrals=tuple(frozen(cell * np.concatenate([[0.0], np.cumsum(part)])) for part in ranges),
        edges=frozen(np.array([0, *lows, size.size]) / size.size),
        cell=cell,
    )


def _lows(size: Floats) -> np.ndarray:
    """Indices of the lowest cells between humps of |phi|; the ends are not among them."""
    level = np.round(size, _DECIMALS)
    steps = np.flatnonzero(np.diff(level)) + 1  # the first cell after each change of level
    rises = np.diff(level)[steps - 1] > 0
    turns = np.flatnonzero(~rises[:-1] & rises[1:])
    return steps[turns]


def correlation_length(amplitude_ratio: float) -> float:
    """L_j/D of EN 1991-1-4: 6 below A/D = 0.1, 4.8 + 12 A/D to 0.6, then 12 [-].

    Parameters
    ----------
    amplitude_ratio : float
        A/D at the antinode [-].

    Raises
    ------
    ParameterError
        If the amplitude is negative.
    """
    y = check_number("amplitude_ratio", amplitude_ratio, at_least=0)
    return min(max(6.0, 4.8 + 12 * y), 12.0)
