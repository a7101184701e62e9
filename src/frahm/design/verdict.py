"""The verdict: sentences computed from the comparison and the table over frequency errors."""

from __future__ import annotations

from collections.abc import Sequence

from frahm.case import Scatter
from frahm.design.objective import Objective
from frahm.design.study import Rival, first_of

_ALIKE = 0.005  # values that differ less are equal
WORDS = {"case": "the case's own absorber", "sink": "the optimum sink", "none": "no absorber", "mixed": "the mixture"}


def verdict(
    rivals: Sequence[Rival], errors: Sequence[float], table: dict[str, tuple[float, ...]], scatter: Scatter,
    objective: Objective,
) -> str:  # fmt: skip
    """What the comparison says, and from which frequency error on a sink beats the tuned mass damper."""
    by_name = {rival.name: rival for rival in rivals}
    sentences = [_best(by_name, scatter, objective)]
    if "tuned mass damper" in table:
        for name in ("case", "sink"):
            if name in table:
                sentences.append(_rows(name, errors, table[name], table["tuned mass damper"]))
    doubtful = [word(rival.name) for rival in rivals if not rival.verified]
    if doubtful:
        sentences.append(f"Unverified: {', '.join(doubtful)}.")
    return " ".join(filter(None, sentences))


def word(name: str) -> str:
    """What a device is called in a sentence."""
    return WORDS.get(name, f"the {name}")


def _given(scatter: Scatter) -> str:
    words = {"pipe_frequency": "the pipe's frequency", "pipe_damping": "its damping", "kappa": "the absorber's spring",
             "xi2": "its damper", "force": "the force"}  # fmt: skip
    parts = [f"{words[name]} anywhere within {100 * getattr(scatter, name):.3g} %" for name in scatter.names]
    return "With " + " and ".join(parts) if parts else "With the pipe as given"


def _best(by_name: dict[str, Rival], scatter: Scatter, objective: Objective) -> str:
    first, none = first_of(list(by_name.values())), by_name.get("none")
    tuned, mixed = by_name.get("tuned mass damper"), by_name.get("mixed")
    text = f"{_given(scatter)}, {word(first.name)}{_many(first)} has the smallest {objective.title},"
    text += f" {objective.shown(first.value)}"
    if none and none is not first and none.value > 0:
        text += f", {100 * first.value / none.value:.3g} % of that without absorber"
    sink = by_name.get("sink")
    if sink and first is not sink:
        text += f"; the optimum sink{_many(sink)} reaches {objective.shown(sink.value)}"
        if first.value > 0:
            text += f", {sink.value / first.value:.3g} times as much"
    if tuned and mixed and mixed is first and tuned.value > 0:
        text += f"; it gains {100 * (1 - mixed.value / tuned.value):.3g} % over the best tuned mass damper"
    return text + "."


def _many(rival: Rival) -> str:
    return f" in {rival.count} parts" if rival.count > 1 else ""


def _rows(name: str, errors: Sequence[float], sink: Sequence[float], tuned: Sequence[float]) -> str:
    """In which rows of the table the device beats the tuned mass damper."""
    wins = [f"{100 * (r - 1):+.3g} %" for r, s, t in zip(errors, sink, tuned, strict=True) if s < (1 - _ALIKE) * t]
    start = word(name)[0].upper() + word(name)[1:]
    if not wins:
        return f"{start} is worse than the tuned mass damper at every frequency error of the table, without retuning."
    if len(wins) == len(list(errors)):
        return f"{start} beats the tuned mass damper at every frequency error of the table."
    where = ", ".join(wins)
    return f"{start} beats the tuned mass damper, without retuning either, only at a frequency error of {where}."
