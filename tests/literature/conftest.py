"""Every comparison that holds is kept with its numbers, for the validation page of the documentation."""

import re

LONGEST = 160  # characters of one side of a comparison


def pytest_runtest_setup(item):
    parameters = item.callspec.params if hasattr(item, "callspec") else {}
    if all(isinstance(value, str | int | float | None) for value in parameters.values()):
        item.user_properties.append(("parameters", ", ".join(f"{name} {value}" for name, value in parameters.items())))


def pytest_assertion_pass(item, orig, expl):
    sides = re.search(r"Obtained: (.+)\n\s*Expected: (.+)", expl)
    numbers = [side[:LONGEST] for side in sides.groups()] if sides else []
    item.user_properties.append(("held", [orig[:LONGEST], *numbers]))
