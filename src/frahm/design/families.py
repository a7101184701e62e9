"""Families of absorbers: the devices they are called by, and the order in which they are searched."""

from __future__ import annotations

DEVICES = {"sink": "sink", "tuned": "tuned mass damper", "mixed": "mixed"}
MIXED = "mixed"


def in_order(asked: str) -> tuple[str, ...]:
    """Families in the order of their search; the mixture is held against its corners, so they come first."""
    return ("tuned", "sink", MIXED) if asked == "tuned" else ("sink", "tuned", MIXED)


def devices(family: str, count: int) -> str:
    """So many devices of a family, in words."""
    return DEVICES[family] if count == 1 else f"{count} x {DEVICES[family]}"
