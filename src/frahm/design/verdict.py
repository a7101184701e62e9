"""The verdict: sentences computed from the comparison and the table over frequency errors."""

from __future__ import annotations

from collections.abc import Sequence

from frahm.design.study import Rival

_ALIKE = 0.005  # values that differ less are equal
WORDS = {"case": "the case's own absorber", "sink": "the optimum sink", "none": "no absorber", "mixed": "the mixture"}


def verdict(
    rivals: Sequence[Rival], errors: Sequence[float], table: dict[str, tuple[float, ...]], scatter: float
) -> str:
    """What the comparison says, and from which frequency error on a sink beats the tuned mass damper."""
    by_name = {rival.name: rival for rival in rivals}
    sentences = [_best(by_name, scatter)]
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


def _best(by_name: dict[str, Rival], scatter: float) -> str:
    given = f"With the pipe's frequency anywhere within {100 * scatter:.3g} %" if scatter else "With the pipe as given"
    order = sorted(by_name.values(), key=lambda rival: rival.worst_pipe_peak)
    first, none = order[0], by_name.get("none")
    tuned, mixed = by_name.get("tuned mass damper"), by_name.get("mixed")
    if tuned and mixed and tuned.worst_pipe_peak <= (1 + _ALIKE) * mixed.worst_pipe_peak:
        first = tuned
    text = f"{given}, {word(first.name)} has the smallest worst pipe peak, {first.worst_pipe_peak:#.3g} m"
    if none and none is not first:
        text += f", {100 * first.worst_pipe_peak / none.worst_pipe_peak:.2g} % of that without absorber"
    sink = by_name.get("sink")
    if sink and first is not sink:
        text += f"; the optimum sink reaches {sink.worst_pipe_peak:#.3g} m"
        text += f", {sink.worst_pipe_peak / first.worst_pipe_peak:.3g} times as much"
    if tuned and mixed and mixed is first:
        gain = 1 - mixed.worst_pipe_peak / tuned.worst_pipe_peak
        text += f"; it gains {100 * gain:.2g} % over the best tuned mass damper"
    return text + "."


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
