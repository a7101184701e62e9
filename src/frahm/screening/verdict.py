"""PASS, FAIL or LOOK CLOSER: what a member is judged by, and the sentences that say why."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from frahm import readable
from frahm.assessment import Utilisation
from frahm.published.dnv_rp_c203 import sn_curve
from frahm.screening.judging import Findings, expects_vibration

PASS, FAIL, LOOK_CLOSER, NOT_JUDGED = "PASS", "FAIL", "LOOK CLOSER", "NOT JUDGED"
VERDICTS = (FAIL, LOOK_CLOSER, NOT_JUDGED, PASS)  # the worst first
LIFT_MARGIN = 1.1  # what a lift, or a wind, one tenth larger would break is near its limit: a choice of this screen
_BAND = "the lock-in band"
_RESONANCE = "Lock-in band around 1/St"  # the criterion that says the same as the onset


@dataclass(frozen=True)
class MemberVerdict:
    """How a member is judged.

    Attributes
    ----------
    word : {"PASS", "FAIL", "LOOK CLOSER", "NOT JUDGED"}
    reasons : tuple of str
        What it rests on, or what speaks against a pass; the weightiest first.
    """

    word: str
    reasons: tuple[str, ...]

    @property
    def why(self) -> str:
        """The weightiest reason."""
        return self.reasons[0]


def verdict_of(found: Findings) -> MemberVerdict:
    """FAIL if a limit is exceeded, as in `frahm run`; PASS if all is known, within its validity and clear of limits."""
    beyond = sorted((row for row in found.limits if row.ratio > 1), key=lambda row: -row.ratio)
    if beyond:
        doubts = (*found.motion.unverified, *found.damage_doubts)
        words = [row.text if row.limit == 1 else f"{row.text}, {share(row.ratio)}" for row in beyond]
        return MemberVerdict(FAIL, (f"{'; '.join(words)}; {_where(found)}.", *doubts, *found.implausible))
    open_questions = tuple(_open_questions(found))
    if open_questions:
        return MemberVerdict(LOOK_CLOSER, open_questions)
    return MemberVerdict(PASS, (_passes(found),))


def _where(found: Findings) -> str:
    return f"excited by mode {found.mode} at {readable.speed(found.motion.wind_speed)}" if math.isfinite(
        found.motion.wind_speed) else f"in the resonance of mode {found.mode}"  # fmt: skip


def _passes(found: Findings) -> str:
    used = found.most_used
    limit = "" if used is None else f"; the limit used most is {named(used.name)}, {share(used.ratio)}"
    if not found.excited:
        return f"{_calm(found)}{limit}."
    return f"Excited{_from(found)}, and all limits are kept{limit}."


def _from(found: Findings) -> str:
    """From which wind on it is excited; nothing where the tables do not reach the band."""
    return "" if math.isnan(found.onset) else f" from {found.onset:.3g} m/s on"


def _calm(found: Findings) -> str:
    low, high = found.site
    if high >= found.onset:  # they blow harder than in any band
        return f"The winds of the site, {low:g} ... {high:.4g} m/s, lie outside {_BAND} of every mode"
    return (
        f"No wind of the site excites it: the strongest, {readable.speed(high)}, is below the {found.onset:.3g} m/s at"
        f" which {_BAND} begins ({found.band.standing})"
    )


def share(ratio: float) -> str:
    """A utilisation in per cent, or as a multiple where it is large."""
    return "below 1%" if 0 < ratio < 0.005 else readable.share(ratio)


def named(limit: str) -> str:
    """Name of a limit for people."""
    return limit.replace("_", " ")


def _open_questions(found: Findings) -> Iterator[str]:
    """What keeps a member that exceeds no limit from passing."""
    yield from found.motion.unverified
    yield from found.damage_doubts
    yield from (f"{row.text} cannot be judged." for row in found.limits if math.isnan(row.ratio))
    yield from _unknown(found)
    yield from _more_damage(found)
    yield from _near(found)
    yield from _criteria(found)
    if found.band.clipped:
        yield "The tables over the Reynolds number end inside the lock-in band."
    yield from found.implausible


def _unknown(found: Findings) -> Iterator[str]:
    if math.isinf(found.site[1]):
        yield (
            "The winds of the site are not known (highest wind, or a Weibull scale): only the lowest"
            f" {found.case.pipe.modal.count} modes were looked at, each in its own wind."
        )
    if found.lacks_modes:
        count = found.case.pipe.modal.count
        yield f"Winds of the site excite modes above the {count} that were looked at (modes)."
    if not found.limits and found.excited:
        motion = found.motion
        stress = (
            "" if math.isnan(motion.stress_range) else f" and a stress range of {readable.stress(motion.stress_range)}"
        )
        yield (
            f"It is excited{_from(found)}, with {readable.length(motion.pipe_peak)}{stress}, and"
            " nothing says what it may: give a climate with an S-N curve, or a limit."
        )


def _more_damage(found: Findings) -> Iterator[str]:
    """Damage that passes only if vortices do not lock in, or without the winds that excite no mode."""
    if found.damage is None or found.case.fatigue is None:
        return
    row = next(row for row in found.limits if row.name == "damage")
    factor = found.case.fatigue.design_fatigue_factor
    held = factor * max(found.damage["locked_in_with"], found.damage["held"])
    rest = factor * found.damage["outside"]
    if not (row.value + rest) / row.limit <= LIFT_MARGIN ** -_power(found, row) and rest > 0.05 * row.value:
        yield (
            f"{row.text}, and {rest:.2g} more by winds outside every lock-in band, most of it near"
            f" {readable.speed(found.damage['outside_wind'])}."
        )
    if row.ratio <= 1 < held / row.limit:
        yield (
            f"{row.text}, but {held:.3g} if vortices locked in over the whole lock-in band as at the worst wind"
            " (secondary): the truth lies between."
        )


def _near(found: Findings) -> Iterator[str]:
    """Limits that a lift one tenth larger would break, and a site whose winds nearly reach the onset."""
    for row in found.limits:
        if 1 / LIFT_MARGIN ** _power(found, row) < row.ratio <= 1:
            yield f"{row.text}: a lift {LIFT_MARGIN - 1:.0%} larger would break it."
    if not found.excited and found.site[1] < found.onset <= LIFT_MARGIN * found.site[1]:
        yield (
            f"The strongest wind of the site, {readable.speed(found.site[1])}, comes within {LIFT_MARGIN - 1:.0%} of"
            f" the {found.onset:.3g} m/s at which {_BAND} begins."
        )


def _power(found: Findings, row: Utilisation) -> float:
    """The power of the lift that a utilisation grows with: the steepest slope of the S-N curve for damage."""
    if row.name != "damage" or found.case.fatigue is None:
        return 1.0
    return sn_curve(found.case.fatigue.curve).m2


def _criteria(found: Findings) -> Iterator[str]:
    """Criteria that expect vibration where no wind of the site lies in the lock-in band."""
    if found.excited:
        return
    for criterion in found.criteria:
        low = math.nan if criterion.speeds is None else criterion.speeds[0]
        if criterion.name != _RESONANCE and criterion.speeds and expects_vibration(criterion, found.site):
            yield (
                f"{criterion.name} expects vibration from {low:.3g} m/s on ({criterion.condition}), below the"
                f" {found.onset:.3g} m/s at which {_BAND} begins."
            )
