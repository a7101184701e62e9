"""Counts of a standing attack."""

from __future__ import annotations

from collections import Counter


def summary(done):
    """Counts of all parts, as plain data."""
    return {
        "attractors": _attractors(done["attractors"]),
        "worst": _promises(done["worst"]),
        "designs": _promises(done["designs"]),
    }


def _attractors(systems):
    rows = [row for system in systems for row in system["attractors"]]
    missed = [group for system in systems for group in system["missed"]]
    counted = [row for row in rows if max(row["brute"], row["paired"]) > 0.02]
    several = sum(sum(row["brute"] > 0 for row in system["attractors"]) > 1 for system in systems)
    return {
        "systems": len(systems),
        "of_several_attractors": several,
        "attractors": dict(Counter(row["kind"] for row in rows)),
        "missed": sum(group["called"] == "nothing" for group in missed),
        "called_unsettled": sum(group["called"] != "nothing" for group in missed),
        "of_another_kind": sum(row["kind"] != row["kind_brute"] for row in counted),
        "basin_fractions": {
            kind: _share([row["agrees"] for row in counted if row["kind"] == kind])
            for kind in ("periodic", "quasi-periodic", "chaotic")
        },
        "sample_labelled_otherwise": _mean([system["shifted"] for system in systems]),
        "sample_labelled_otherwise_after_a_nudge": _mean([system["shifted_by_a_nudge"] for system in systems]),
        "expected_peaks": _expected(rows),
    }


def _expected(rows):
    levels = [
        row["expected"][name]
        for row in rows
        for name in ("pipe_peak", "relative_peak")
        if name in row.get("expected", {})
    ]
    return _share([level["holds"] for level in levels]) | {"of_other_samples": _mean([v["coverage"] for v in levels])}


def _promises(rows):
    verified = [row for row in rows if row["verified"]]
    return {
        "asked": len(rows),
        "verified": len(verified),
        "motions": sum(row["states"] for row in verified),
        "broken": sum(any(f["breaks"] for f in row["found"]) for row in verified),
        "larger_with_a_small_basin": sum(
            bool(row["found"]) and not any(f["breaks"] for f in row["found"]) for row in verified
        ),
    }


def _share(values):
    return {"of": len(values), "held": sum(values), "share": _mean(values)}


def _mean(values):
    return round(sum(values) / len(values), 4) if values else None


def text(counts):
    """The counts as a table in Markdown."""
    found = counts["attractors"]
    rows = [
        ("random systems", found["systems"]),
        ("of these with more than one attractor that random states reach", found["of_several_attractors"]),
        *((f"{kind} attractors found", number) for kind, number in sorted(found["attractors"].items())),
        ("attractors with a basin above 2 % that were missed", found["missed"]),
        ("such motions that were called unsettled", found["called_unsettled"]),
        ("attractors of another kind than was said", found["of_another_kind"]),
        *(
            (f"basin fractions of {kind} motions that agree", _of(share))
            for kind, share in found["basin_fractions"].items()
        ),
        ("share of a sample that brute force labels otherwise, mean", _percent(found["sample_labelled_otherwise"])),
        (
            "share that it labels otherwise itself after a nudge of 1e-7, mean",
            _percent(found["sample_labelled_otherwise_after_a_nudge"]),
        ),
        ("levels of rare peaks inside their interval", _of(found["expected_peaks"])),
        ("the same for other samples of the same motions, mean", _percent(found["expected_peaks"]["of_other_samples"])),
    ]
    for part, words in (("worst", "random ranges"), ("designs", "designed devices, as designed or off")):
        promises = counts[part]
        rows += [
            (f"{words} whose worst was asked for", promises["asked"]),
            ("of these verified", promises["verified"]),
            ("random motions held against them", promises["motions"]),
            ("verified worsts passed by more than 1 %", promises["broken"]),
            ("passed by motions with a basin below the one stated", promises["larger_with_a_small_basin"]),
        ]
    return "\n".join(["| what | count |", "|---|---|", *(f"| {name} | {value} |" for name, value in rows)]) + "\n"


def _of(share):
    return f"{share['held']} of {share['of']}"


def _percent(share):
    return "-" if share is None else f"{100 * share:.2g} %"
