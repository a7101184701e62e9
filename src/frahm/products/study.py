"""What a design of products came to: every product, the recommended one, and what it rests on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from frahm import __version__
from frahm.products.product import FAIL, Product
from frahm.products.served import ServedMember
from frahm.screening import FAIL as FAILS_ALONE
from frahm.screening import PASS, MemberScreen, share
from frahm.screening.screen import provenance
from frahm.tolerances import NO_BETTER


@dataclass(frozen=True, eq=False)
class ProductStudy:
    """Products for the members of a platform that fail alone.

    Attributes
    ----------
    screen : MemberScreen
        All members without absorbers.
    served : tuple of ServedMember
        Those that fail.
    products : tuple of Product
        By number of kinds, then by family; a family that passes is not asked for more kinds.
    family : str or None
        What was asked for; None for all families.
    counts : tuple of int
        Numbers of kinds asked for.
    mass_ratio, force_margin : float
    interrupted : bool
        Whether products are missing because the work was stopped.
    version : str
    """

    screen: MemberScreen
    served: tuple[ServedMember, ...]
    products: tuple[Product, ...]
    family: str | None
    counts: tuple[int, ...]
    mass_ratio: float
    force_margin: float
    interrupted: bool = False
    version: str = __version__

    @property
    def best(self) -> Product | None:
        """The fewest kinds with which all pass; else the smallest worst utilisation; None where no member fails.

        Of the family asked for, or of all.
        """
        own = [one for one in self.products if self.family in (None, one.family)]
        passing = [one for one in own if one.passes]
        if passing:
            return min(passing, key=lambda one: (len(one.kinds), one.worst))
        best: Product | None = None
        for one in own:  # fewer kinds come first, and the tuned ones before the others
            better = best is None or (not best.complete, NO_BETTER * best.worst) > (not one.complete, one.worst)
            best = one if better else best
        return best

    @property
    def not_served(self) -> tuple[tuple[str, str, str], ...]:
        """Name, verdict and reason of members that neither pass nor fail alone: nothing was designed for them."""
        return tuple(
            (one.name or one.place, one.verdict.word, one.verdict.why)
            for one in self.screen
            if one.verdict.word not in (PASS, FAILS_ALONE)
        )

    @property
    def verified(self) -> bool:
        """Whether the recommended product is verified, or none is needed."""
        return not self.interrupted and (self.best is None or self.best.verified)

    @property
    def fails(self) -> bool:
        """Whether a member exceeds a limit with the recommended product."""
        return self.best is not None and self.best.fails

    @property
    def unverified(self) -> tuple[str, ...]:
        """What speaks against the recommended product."""
        return () if self.best is None else self.best.unverified

    @property
    def sentence(self) -> str:
        """What it comes to."""
        best = self.best
        if not self.served:
            return f"No member of {self.screen.table.title} fails alone: nothing is designed."
        if best is None:
            return "The work was interrupted before a product was known."
        served = f"the {len(self.served)} members that fail alone" if len(self.served) > 1 else self.served[0].name
        if best.passes:
            lets = "lets" if len(best.kinds) == 1 else "let"
            return f"{best.title} {lets} {served} pass; {best.binds.name} is used most, {share(best.worst)}."
        known = "" if best.binds.verified else ", not verified"
        what = "fails" if best.binds.verdict == FAIL else "is not known to pass"
        number = f"no {max(self.counts)} kinds let" if max(self.counts) > 1 else "no single kind lets"
        return (
            f"With absorbers of at most {self.mass_ratio:.3g} of a member's mass {number} {served} pass."
            f" The best there is: {best.title}; {best.binds.name} binds, {what} and is used {share(best.worst)}{known}."
        )

    def results(self) -> dict[str, Any]:
        """Plain data for the summary."""
        best = self.best
        return {
            "products": [one.row() for one in self.products],
            "best": None if best is None else {"family": best.family, "count": best.count, "kinds": len(best.kinds)},
            "sentence": self.sentence,
            "served": [one.name for one in self.served],
            "not_served": [dict(zip(("member", "verdict", "why"), one, strict=True)) for one in self.not_served],
            "family": self.family,
            "counts": list(self.counts),
            "mass_ratio": self.mass_ratio,
            "force_margin": self.force_margin,
            "provenance": provenance(self.screen.table),
            "interrupted": self.interrupted,
        }

    def __repr__(self) -> str:
        lines = [f"ProductStudy: {self.sentence}"[:200]]
        for one in self.products[:9]:
            known = "verified" if one.verified else "not verified"
            lines.append(f"  {one.title}: {share(one.worst)} ({one.binds.name}), {known}")
        return "\n".join(lines)
