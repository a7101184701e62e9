"""What can go wrong, said once and clearly."""

from __future__ import annotations

import contextlib
import difflib
import enum
import math
import pickle
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

_LONGEST = {"name": 120, "value": 240, "allowed": 1500, "where": 400, "hint": 800}  # characters in a message
# Wrong types and sizes are what a damaged or foreign file leads to; these four are only ever mistakes of the program.
_MISTAKES = (AssertionError, ImportError, NameError, NotImplementedError)


def printable(text: str, longest: int | None = 2000) -> str:
    r"""Text as one line that is safe on a terminal: no control characters, no overrides of direction, not too long.

    What cannot be printed stands as an escape, such as ``\x1b``; of a text that is too long the middle is left out.
    """
    if longest is not None and len(text) > longest:
        half = (longest - 3) // 2
        text = f"{text[:half]}...{text[len(text) - half :]}"
    return text if text.isprintable() else "".join(c if c.isprintable() else _escape(c) for c in text)


def shown(value: Any) -> str:
    """What was given, as it is written in a message, whatever it is."""
    try:
        text = repr(value)
    except Exception:  # of any object: numbers of thousands of digits, lists a thousand deep, what users wrote
        return f"something of type {printable(type(value).__name__, 60)} that cannot be shown"
    longest = _LONGEST["value"]
    return printable(text if len(text) <= longest else text[: longest - 3] + "...")


def _escape(letter: str) -> str:
    return letter.encode("unicode_escape").decode("ascii")


class ParameterError(ValueError):
    """Bad input: which parameter, what was given, what is allowed.

    Parameters
    ----------
    name : str
        Name of the parameter, or the path of the field in a case file.
    value : object
        What was given.
    allowed : str
        What is allowed, as the end of the sentence "allowed: ...".
    where : str, optional
        File, or file and line, the value came from.
    hint : str, optional
        Nearest valid name or another way out.
    also : sequence of str
        Further sentences, each on a line of its own.
    """

    def __init__(
        self, name: str, value: Any, allowed: str, *,
        where: str | None = None, hint: str | None = None, also: Sequence[str] = (),
    ):  # fmt: skip
        self.name, self.value, self.allowed, self.where, self.hint = name, value, allowed, where, hint
        self.also = tuple(also)
        # A message quotes files and names that anybody may have written: it is made fit to print here, and only here.
        part = {key: printable(str(text), _LONGEST[key]) for key, text in
                (("name", name), ("allowed", allowed), ("where", where or ""), ("hint", hint or ""))}  # fmt: skip
        place = f"{part['where']}: " if where else ""
        message = f"{place}{part['name']}: given {shown(value)}; allowed: {part['allowed']}"
        message = f"{message}. {part['hint']}" if hint else message
        super().__init__("\n".join([message, *map(printable, self.also)]))

    def __reduce__(self) -> tuple[Any, ...]:
        """What crosses to another process or into a copy: the message as it is, and the value if it can be pickled."""
        return _remade, (type(self), self.args, vars(self) | {"value": _portable(self.value)})


def _remade(kind: type[ParameterError], args: tuple[Any, ...], facts: dict[str, Any]) -> ParameterError:
    error = kind.__new__(kind, *args)
    error.args = args
    vars(error).update(facts)
    return error


def _portable(value: Any) -> Any:
    """A value, or the text it is shown as if it cannot be pickled."""
    try:
        pickle.dumps(value)
    except Exception:  # of any object
        return shown(value)
    return value


@contextlib.contextmanager
def door(name: str, value: Any, allowed: str, hint: str | None = None) -> Iterator[None]:
    """Guard a block that takes apart what a file or a foreign object holds: what that leads to is a `ParameterError`.

    The block should do nothing else. Names that do not exist, failed assertions and the like are mistakes of the
    program, not of the file, and stay what they are.

    Parameters
    ----------
    name, value, allowed : str, object, str
        See `ParameterError`.
    hint : str
        What is wrong, probably; by default the words of the cause.

    Raises
    ------
    ParameterError
        If the block raises; the cause is kept.
    """
    try:
        yield
    except (ParameterError, *_MISTAKES):
        raise
    except Exception as error:
        words = getattr(error, "strerror", None) or (None if hint else str(error) or type(error).__name__)
        raise ParameterError(name, value, allowed, hint=f"{words.rstrip('.')}." if words else hint) from error


class ConvergenceError(RuntimeError):
    """A numerical method gave up and the caller asked for an exception (``throw=True``)."""


class Outcome(enum.Enum):
    """How a computation ended; the value is the sentence a user reads."""

    DONE = "Finished."
    DIVERGED = "The motion left every bound; the last finite state is kept."
    STEP_LIMIT = "The step limit was reached before the end of the interval; what was computed is kept."
    STEP_TOO_SMALL = "The step size fell below the resolution of the clock; what was computed is kept."
    NOT_CONVERGED = "The iteration did not reach its tolerance; the last iterate is kept."
    NOT_FINITE = "A value became infinite or undefined; what was computed before is kept."
    WINDOW_LEFT = "The branch left the window and did not come back within the margin searched."
    CLOSED = "The branch is a closed curve."
    INTERRUPTED = "Interrupted; what was finished is kept."

    @property
    def ok(self) -> bool:
        """Whether the result can be used as it is."""
        return self in (Outcome.DONE, Outcome.WINDOW_LEFT, Outcome.CLOSED)

    def known(self, value: float) -> float:
        """A number that stands for a whole run: NaN if the run did not reach its end, for it is then of another one."""
        return value if self.ok else math.nan


def nearest(name: str, choices: Iterable[str]) -> str | None:
    """Valid name most like `name`, or None."""
    found = difflib.get_close_matches(name, list(choices), n=1, cutoff=0.6) if len(name) <= _LONGEST["name"] else []
    return found[0] if found else None


def check_choice(name: str, value: Any, choices: Sequence[str]) -> str:
    """Return `value` if it is one of `choices`, otherwise raise with the nearest one named."""
    if isinstance(value, str) and value in choices:
        return value
    near = nearest(value, choices) if isinstance(value, str) else None
    raise ParameterError(name, value, "one of " + ", ".join(choices), hint=f"Did you mean {near!r}?" if near else None)


def check_number(
    name: str,
    value: Any,
    *,
    above: float = -math.inf,
    at_least: float = -math.inf,
    below: float = math.inf,
    at_most: float = math.inf,
    unit: str = "",
) -> float:
    """Return `value` as a float inside its bounds; text, NaN and infinity are refused."""
    bounds = [
        f"{sign} {bound:g}"
        for sign, bound in ((">", above), (">=", at_least), ("<", below), ("<=", at_most))
        if math.isfinite(bound)
    ]
    allowed = "a finite number" + (f" [{unit}]" if unit else "") + (" " + " and ".join(bounds) if bounds else "")
    if isinstance(value, bool | str | bytes):
        raise ParameterError(name, value, allowed)
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise ParameterError(name, value, allowed) from None
    if not (math.isfinite(number) and above < number < below and at_least <= number <= at_most):
        raise ParameterError(name, value, allowed)
    return number


def check_count(name: str, value: Any, *, at_least: int = 1, at_most: int = 2**31 - 1) -> int:
    """Return `value` as an integer inside its bounds."""
    allowed = f"a whole number >= {at_least} and <= {at_most}"
    number = check_number(name, value)
    if number != int(number) or not at_least <= number <= at_most:
        raise ParameterError(name, value, allowed)
    return int(number)
