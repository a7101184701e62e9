"""How many examples a property is tried on: the same ones in every run, and many new ones in `make fuzz`."""

from hypothesis import settings

SEARCH = "search"  # the profile of `make fuzz`
_MORE = 20


def at_most(examples, *, more=_MORE, **others):
    """Settings of a property: so many examples, `more` times as many where counterexamples are looked for."""
    factor = 1 if settings.default.derandomize else more
    return settings(max_examples=factor * examples, deadline=None, **others)
