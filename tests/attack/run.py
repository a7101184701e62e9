"""The standing attack: `python tests/attack/run.py --systems 200 --worst 40 --designs 34 --minutes 60`.

Writes out/attack/attack.json, every number, and out/attack/attack.md, the counts, which the documentation keeps.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

import frahm
from attractors_attacked import attack
from random_systems import drawn
from summary import summary, text
from worst_attacked import MEMBERS, NO_SCATTER, RATIOS, SCATTER, SMALL, WIDE, attack_design, attack_random

GENTLE = 0.3  # factor on the force of systems whose worst is asked for: more of them can be verified


def run(arguments):
    """All parts, until the time is over; what is done is on disk after every system."""
    out = Path(arguments.out)
    out.mkdir(parents=True, exist_ok=True)
    done = {"version": frahm.__version__, "attractors": [], "worst": [], "designs": []}
    began = time.monotonic()
    for part, name, job in _jobs(arguments):
        if time.monotonic() - began > 60 * arguments.minutes:
            break
        done[part] += job()
        (out / "attack.json").write_text(json.dumps(done, indent=1, default=float), encoding="utf-8")
        (out / "attack.md").write_text(text(summary(done)), encoding="utf-8")
        print(f"{time.monotonic() - began:.0f} s, {part}: {name}", flush=True)
    return summary(done)


def _jobs(arguments):
    """Part, name and function of everything asked for; the parts take turns, so that each has its share of the time."""
    first = arguments.first
    attractors = [("attractors", n, lambda n=n: [attack(drawn(n))]) for n in range(first, first + arguments.systems)]
    gentle = [(n, drawn(n, GENTLE)) for n in range(first, first + arguments.worst)]
    worst = [("worst", n, lambda one=one: [attack_random(one)]) for n, one in gentle]
    asked = [(member, ratio, SCATTER) for ratio in RATIOS for member in MEMBERS] + [(one, 0.02, WIDE) for one in SMALL]
    asked += [(one, 0.02, NO_SCATTER, 2) for one in SMALL]  # two absorbers together
    asked = asked[: arguments.designs]
    designs = [("designs", one, lambda one=one: attack_design(*one)) for one in asked]
    parts = [part for part in (attractors, worst, designs) if part]
    order = [((at + 0.5) / len(part), job) for part in parts for at, job in enumerate(part)]
    return [job for _, job in sorted(order, key=lambda pair: pair[0])]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--systems", type=int, default=200)
    parser.add_argument("--worst", type=int, default=60)
    parser.add_argument("--designs", type=int, default=len(MEMBERS) * len(RATIOS) + 2 * len(SMALL))
    parser.add_argument("--first", type=int, default=0, help="number of the first system")
    parser.add_argument("--minutes", type=float, default=90.0)
    parser.add_argument("--out", default="out/attack")
    print(json.dumps(run(parser.parse_args()), indent=1))


if __name__ == "__main__":
    main()
