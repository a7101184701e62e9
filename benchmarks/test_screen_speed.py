"""Five hundred members of a platform, with fatigue over a climate. Goal: below 60 s of processor time."""

import dataclasses

import frahm
from frahm.screening import read_members

MEMBERS = 500


def members():
    """The built-in members again and again, each a little longer than the last."""
    table = read_members("members-example")
    rows = [
        dataclasses.replace(row, name=f"{row.name}-{turn}", values=dict(row.values) | {
            "name": f"{row.name}-{turn}", "length": row.values["length"] * (1 + 0.003 * turn)})
        for turn in range(1 + MEMBERS // len(table.rows)) for row in table.rows
    ]  # fmt: skip
    return dataclasses.replace(table, rows=tuple(rows[:MEMBERS]))


def test_five_hundred_members(benchmark):
    table = members()
    frahm.screen_members("members-example")
    found = benchmark.pedantic(frahm.screen_members, args=(table,), rounds=1)
    assert len(found.judged) == MEMBERS
    assert benchmark.stats.stats.max < 60
