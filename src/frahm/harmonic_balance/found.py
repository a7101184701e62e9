"""What a search gives back: a list, and words on how far it went."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

from frahm import readable

T = TypeVar("T")

MOST_POINTS = 30_000  # of all branches together, each counted with the work of its unknowns
MOST_BIFURCATIONS = 300  # located
_LIGHT = 100  # unknowns up to which a point counts once


class Found(list[T]):
    """A list of what was found that says what was searched.

    Attributes
    ----------
    searched : str
        What was looked at, and what was not.
    unverified : tuple of str
        Sentences on what was not verified; empty if nothing.
    """

    def __init__(self, items: Iterable[T] = (), searched: str = "", unverified: tuple[str, ...] = ()):
        super().__init__(items)
        self.searched = searched
        self.unverified = unverified

    def __repr__(self) -> str:
        return readable.listed(self, self.searched, *self.unverified)


@dataclass
class Budget:
    """Work that is left for a search, so that none goes on without end; the same on every machine."""

    points: float = MOST_POINTS
    bifurcations: int = MOST_BIFURCATIONS

    @property
    def reached(self) -> bool:
        """Whether no more branches are to be followed."""
        return self.points <= 0

    def take_points(self, count: int, size: int) -> None:
        """Count points of so many unknowns."""
        self.points -= count * max(1.0, (size / _LIGHT) ** 3)

    def points_of(self, size: int, most: int) -> int:
        """How many points of so many unknowns may still be followed, at least the two a branch is made of."""
        return max(2, min(most, int(self.points / max(1.0, (size / _LIGHT) ** 3))))

    def sentences(self) -> tuple[str, ...]:
        """What to say if the limit was met."""
        limit = "met its limit of work: what was found is kept, but there may be further"
        branches = [f"The search for branches {limit} responses."] if self.reached else []
        special = f"The search for special points {limit} ones, and branches born there."
        points = [special] if self.bifurcations <= 0 else []
        return (*branches, *points)
