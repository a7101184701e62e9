"""What a search for branches proves, what it only searches, and where it could not go on."""

from __future__ import annotations

from frahm.harmonic_balance.alike import moving_alike
from frahm.harmonic_balance.births import MARGIN
from frahm.harmonic_balance.branch import SolutionBranch
from frahm.harmonic_balance.describing import PER_DECADE
from frahm.harmonic_balance.follow import CLOSED, LEFT, MIRRORED
from frahm.harmonic_balance.search import Search

_SPREAD = "first-harmonic solutions were searched from a fixed spread of starts (not proven complete)"

_NOT_SEARCHED = (
    "Not searched: responses whose period is a multiple of the excitation's (period doublings are located, the doubled"
    " motions not followed), and responses without any first-harmonic counterpart."
)

NONE_FOUND = "No periodic response was found: Newton's method failed from every seed."
_NEAR = 0.01  # of a frequency: how far from it a detached curve may be and still reach there


def inventory_text(search: Search) -> str:
    """What the search for branches proves and what it only searches."""
    seeder, start = search.seeder, ""
    dense = f"first-harmonic roots searched on a dense grid of {PER_DECADE} amplitudes a decade (not proven complete)"
    if seeder.spring is not None:
        start = "all first-harmonic roots, with every free third harmonic beside them, and births of detached curves"
        if seeder.table is not None:
            start += f"; about other means than 0 from {dense}"
    elif seeder.table is not None:
        start = dense
    elif seeder.shared is not None:
        start = (
            "all first-harmonic solutions of every frequency at which there are more of them than responses on branches"
            " already followed, births of detached curves, and motions of equal absorbers alike"
        )
    else:
        start = _SPREAD
        if search.problem.odd and not seeder.buckled:
            start += ", about the mean 0 only"
    return f"Branches were followed from {start}. {_NOT_SEARCHED}"


def exchanges_text(search: Search) -> str:
    """What to say of branches where absorbers are equal; nothing where none are."""
    if moving_alike(search.system) is None:
        return ""
    return " Absorbers are equal: branches that differ only in which of them carries the motion are all listed."


def continued_text() -> str:
    """What is known where responses were continued from all solutions of one harmonic at one frequency."""
    return (
        "All solutions of the equations of one harmonic at this frequency were continued to exact responses, those and"
        " the extremes of the force that just miss it were followed over the force, asymmetric responses from where"
        " the symmetry is lost there. The fixed-point indices of all responses add up as they must, and those of the"
        f" symmetric ones, too. {_NOT_SEARCHED}"
    )


def not_proven(search: Search, at: float | None = None) -> tuple[str, ...]:
    """A sentence where responses were searched without proof that all were found, in the window or `at` a frequency."""
    seeder, found = search.seeder, []
    lo, hi = (search.lo, search.hi) if at is None else ((1 - _NEAR) * at, (1 + _NEAR) * at)
    for W in search.undecided:
        if lo <= W <= hi and not all_known(search, at):
            found.append(
                f"Whether a small detached curve exists near {W:.6g} rad/s could not be told: it is born within"
                f" {MARGIN:.0e} of the force, or its birth could not be located."
            )
    if search.problem.directions.shape[0] > 1 and (seeder.shared is None or seeder.buckled):
        found.append(f"With several absorbers there may be further responses: {_SPREAD}.")
    if seeder.doubtful:
        lo, hi = min(seeder.doubtful), max(seeder.doubtful)
        found.append(
            f"There may be further responses: at {len(seeder.doubtful)} frequencies between {lo:.6g} and {hi:.6g} rad/s"
            " the first-harmonic solutions found do not add up to the degree of their equations."
        )
    return tuple(found)


def unstable_unproven(search: Search) -> tuple[str, ...]:
    """A sentence where unstable responses are known to lack at times: about other means than 0, of high harmonics."""
    seeder = search.seeder
    if seeder.table is None or (search.problem.odd and not seeder.buckled):
        return ()
    return (
        "There may be further unstable responses: about other means than 0 such were met to which no first-harmonic"
        " solution leads.",
    )


def all_known(search: Search, at: float | None) -> bool:
    """Whether the equations of one harmonic are asked for at a frequency where all their solutions are known."""
    seeder = search.seeder
    proven = seeder.shared is not None or (seeder.spring is not None and seeder.table is None)
    return at is not None and search.harmonics == 1 and proven and at not in seeder.doubtful


def unfinished(branches: list[SolutionBranch]) -> list[str]:
    """A sentence on every branch that could not be followed to its end."""
    return [
        f"Branch {number} could not be followed to its end; it stops near"
        f" {branch.points.frequency[0]:.6g}, {branch.points.frequency[-1]:.6g} rad/s."
        for number, branch in enumerate(branches)
        if any(ending not in (LEFT, CLOSED, MIRRORED) for ending in branch.endings)
    ]
