"""`design_products`: the fewest kinds of absorber with which every member of a platform passes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from frahm.case import FAMILIES
from frahm.errors import ParameterError, check_choice, check_count, check_number
from frahm.products.checking import checked
from frahm.products.product import FAIL, FittedMember, Product, in_order, product_of
from frahm.products.search import Expected, ProductSearch
from frahm.products.served import ServedMember, served_member
from frahm.products.study import ProductStudy
from frahm.screening import FAIL as FAILS_ALONE
from frahm.screening import MemberScreen, screen_members, share
from frahm.tolerances import NO_BETTER

Progress = Callable[[str, int, int], None]
MOST_KINDS = 12
_ORDER = ("tuned", "sink", "mixed")  # the tuned product is what the others are held against


def design_products(
    table: Any,
    products: int | tuple[int, int] = (1, 3),
    *,
    family: str | None = None,
    mass_ratio: float = 0.02,
    force_margin: float = 1.05,
    progress: Progress | None = None,
) -> ProductStudy:
    """Fewest kinds of absorber (mass, springs, damper) with which every member that fails alone passes.

    Members are screened as by `frahm.screen_members`; those that fail are served. A kind is as heavy as the lightest
    member that takes it allows. Kinds and who takes them are found by the closed form of one harmonic, no detached
    curve up to the force margin; then the worst motion and the damage of members with their device are those of
    `frahm run`, over all attractors.

    Members expected to be used most are checked first. Once one of them is used as much as any member is with a product
    of as many kinds that was checked before, the others are left to the closed form, and reported as unverified with
    the reason; of a family that was asked for, only if that member fails. The tuned products, whose response is exact,
    come first.

    Parameters
    ----------
    table : str, Path, sequence of mapping or MemberScreen
        As for `frahm.screen_members`, or what it returned.
    products : int or tuple of int
        Number of kinds, or the least and the most.
    family : {"sink", "tuned", "mixed"}, optional
        Cubic spring, linear spring, or both, beside the tuned products; by default all three.
    mass_ratio : float
        Largest mass of an absorber over that of a member that carries it [-].
    force_margin : float
        Factor on the force up to which no detached curve may exist [-].
    progress : callable, optional
        Called with what is done, steps done and steps in all.

    Returns
    -------
    ProductStudy
        If interrupted once a product is known: what was found, with `interrupted` set.

    Raises
    ------
    ParameterError
        For bad input.
    """
    counts, families = check_products(products, family=family, mass_ratio=mass_ratio, force_margin=force_margin)
    screen = table if isinstance(table, MemberScreen) else screen_members(table)
    members = tuple(
        served_member(one, mass_ratio, force_margin) for one in screen.judged if one.verdict.word == FAILS_ALONE
    )
    work = _Work(members, families, counts, family, progress)
    interrupted = work.interrupted_run() if members else False
    return ProductStudy(screen, members, tuple(work.found), family, counts, mass_ratio, force_margin, interrupted)


def check_products(
    products: int | tuple[int, int], *, family: str | None, mass_ratio: float, force_margin: float
) -> tuple[tuple[int, ...], tuple[str, ...]]:
    """Numbers of kinds and families that are looked for; what `design_products` would refuse is refused.

    Raises
    ------
    ParameterError
        For bad input.
    """
    check_number("mass_ratio", mass_ratio, above=0, at_most=1)
    check_number("force_margin", force_margin, at_least=1, at_most=3)
    return _counts(products), _families(family)


def _counts(products: int | tuple[int, int]) -> tuple[int, ...]:
    ends = products if isinstance(products, tuple | list) else (products, products)
    if len(ends) != 2:
        raise ParameterError("products", products, "a whole number, or two of them (lo, hi)")
    lo, hi = (check_count("products", end, at_most=MOST_KINDS) for end in ends)
    if lo > hi:
        raise ParameterError("products", products, "the least number of kinds first, then the most")
    return tuple(range(lo, hi + 1))


def _families(family: str | None) -> tuple[str, ...]:
    if family is None:
        return _ORDER
    check_choice("family", family, FAMILIES)
    return tuple(one for one in _ORDER if one in ("tuned", family))


class _Work:
    """One run: products by number of kinds, then by family; what is found stays when it is interrupted."""

    def __init__(
        self,
        members: tuple[ServedMember, ...],
        families: tuple[str, ...],
        counts: tuple[int, ...],
        asked: str | None,
        progress: Progress | None,
    ):
        self.members, self.families, self.counts = members, families, counts
        self.asked, self.progress = asked, progress
        self.found: list[Product] = []
        self.searches = {family: ProductSearch(members, family) for family in families} if members else {}
        self.known: dict[str, list[Expected]] = {family: [] for family in families}

    def interrupted_run(self) -> bool:
        """Look for all products; whether that was interrupted once one was known."""
        try:
            for at, count in enumerate(self.counts):
                for number, family in enumerate(self.families):
                    done = at * len(self.families) + number
                    self._step(f"{count} of {family}: closed form", done)
                    if not any(one.family == family and one.passes for one in self.found):
                        self._look(family, count, done)
        except KeyboardInterrupt:
            if not self.found:
                raise
            return True
        return False

    def _step(self, title: str, done: int) -> None:
        if self.progress:
            self.progress(title, done, len(self.counts) * len(self.families))

    def _look(self, family: str, count: int, done: int) -> None:
        beside = [one for other in self.families for one in self.known[other][-1:] if family == "mixed"]
        best = self.searches[family].best(count, [*self.known[family][-1:], *beside])
        self.known[family].append(best)
        product = product_of(family, count, self.members, best.devices, best.takes, best.used)
        rivals = [one for one in self.found if one.count == count and one.complete]
        rival = min(rivals, key=lambda one: one.worst, default=None)
        same = next((one for one in self.found if one.count == count and _is_same(one, product)), None)
        self.found.append(replace(product, members=same.members) if same else self._checked(product, rival, done))

    def _checked(self, product: Product, rival: Product | None, done: int) -> Product:
        """The product with its members against all attractors, those expected to be used most first."""
        bar = NO_BETTER * rival.worst if rival else math.inf
        lost = ""
        fitted: list[FittedMember] = []
        for number, one in enumerate(product.members):
            if lost:
                fitted.append(replace(one, why_not=lost))
                continue
            self._step(f"{product.title}: {one.name}, {number + 1} of {len(product.members)}", done)
            now = replace(one, check=checked(one.case))
            fitted.append(now)
            decides = now.verdict == FAIL or product.family != self.asked
            if rival and decides and now.utilisation >= bar:
                lost = (
                    f"By the closed form alone: {now.name} is used {share(now.utilisation)} by all its attractors, and"
                    f" with {rival.title} no member is used more than {share(rival.worst)}."
                )
        return replace(product, members=in_order(fitted))


def _is_same(one: Product, other: Product) -> bool:
    """Whether two products are the same devices on the same members."""
    return [kind.members for kind in one.kinds] == [kind.members for kind in other.kinds] and all(
        bool((a.device == b.device).all()) for a, b in zip(one.kinds, other.kinds, strict=True)
    )
