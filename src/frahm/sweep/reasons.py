"""Why points failed or are unverified: whole numbers in the store, one sentence for each kind of reason."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field

import numpy as np

_NUMBER = re.compile(r"[-+]?\b\d+(?:\.\d+)?(?:[eE][-+]?\d+)?\b")


def kind_of_reason(sentence: str) -> str:
    """A sentence without its numbers: two that are alike then are of one kind."""
    return _NUMBER.sub("#", sentence)


@dataclass(eq=False)
class Reasons:
    """Table of code to sentence; the sentence is that of the first point of its kind.

    Codes are negative while points come in as they happen to; once all are there, the kinds are numbered from 1 in the
    order of their first points. A reader finds either sort in the table.
    """

    sentences: dict[int, str] = field(default_factory=dict)
    first: dict[int, int] = field(default_factory=dict)
    changed: bool = False
    _codes: dict[str, int] = field(default_factory=dict)

    @classmethod
    def read(cls, text: str, codes: np.ndarray) -> Reasons:
        """Table from the text in a store, and from the codes of its points."""
        sentences = {int(code): sentence for code, sentence in json.loads(text).items()}
        known = {kind_of_reason(sentence): code for code, sentence in sentences.items()}
        first = {code: int(np.argmax(codes == code)) for code in sentences if np.any(codes == code)}
        return cls(sentences, first, _codes=known)

    @property
    def text(self) -> str:
        """The table as JSON."""
        return json.dumps({str(code): self.sentences[code] for code in sorted(self.sentences, key=abs)})

    @property
    def unordered(self) -> bool:
        """Whether there are codes that depend on the order in which points came in."""
        return any(code < 0 for code in self.sentences)

    def code(self, sentence: str, index: int) -> int:
        """Code for the sentence of a point."""
        kind = kind_of_reason(sentence)
        code = self._codes.get(kind)
        if code is None:
            code = min([0, *self.sentences]) - 1
            self._codes[kind] = code
        if index <= self.first.get(code, index):
            self.first[code], self.sentences[code], self.changed = index, sentence, True
        return code

    def ordered(self, codes: np.ndarray) -> np.ndarray:
        """Codes numbered from 1 in the order of their first points; the table then holds both."""
        kinds: dict[str, int] = {}
        final: dict[int, int] = {}
        first: dict[int, int] = {}
        sentences: dict[int, str] = {}
        for code in sorted(self.first, key=lambda code: self.first[code]):
            number = kinds.setdefault(kind_of_reason(self.sentences[code]), len(kinds) + 1)
            final[code] = number
            first.setdefault(number, self.first[code])
            sentences.setdefault(number, self.sentences[code])
        self.sentences |= sentences
        self.first, self._codes = first, kinds
        return np.array([final.get(int(code), 0) for code in codes], dtype=codes.dtype) if final else codes

    def forget_provisional(self) -> None:
        """Leave the final codes alone."""
        self.sentences = {code: sentence for code, sentence in self.sentences.items() if code > 0}
