"""`screen_members`: every member of a table in the winds of its site, the worst first."""

from __future__ import annotations

import importlib.metadata
import platform
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from frahm import __version__
from frahm.errors import ParameterError, nearest
from frahm.screening.judging import findings
from frahm.screening.member import ScreenedMember
from frahm.screening.member_case import member_case
from frahm.screening.reading import MemberRow, MemberTable, read_members
from frahm.screening.verdict import FAIL, LOOK_CLOSER, NOT_JUDGED, VERDICTS, MemberVerdict, verdict_of

Progress = Callable[[str, int, int], None]
_SHOWN = 6
_INTERRUPTED = "The work was interrupted before it was its turn."


@dataclass(frozen=True, eq=False)
class MemberScreen:
    """The members of a table, judged.

    Attributes
    ----------
    table : MemberTable
        What was read.
    members : tuple of ScreenedMember
        The worst first; rows that could not be read have the verdict NOT JUDGED.
    interrupted : bool
        Whether members are missing because the work was stopped.
    version : str
        Version of the package.
    """

    table: MemberTable
    members: tuple[ScreenedMember, ...]
    interrupted: bool = False
    version: str = __version__

    def __getitem__(self, name: str) -> ScreenedMember:
        """The member of a name.

        Raises
        ------
        ParameterError
            If there is none, with the nearest name.
        """
        found = next((member for member in self.members if member.name == name), None)
        if found is None:
            near = nearest(str(name), [member.name for member in self.members])
            hint = f"Did you mean {near!r}?" if near else None
            raise ParameterError("name", name, "the name of a member of the table", hint=hint)
        return found

    def __iter__(self) -> Iterator[ScreenedMember]:
        return iter(self.members)

    def __len__(self) -> int:
        return len(self.members)

    @property
    def counts(self) -> dict[str, int]:
        """Number of members by verdict, the worst first."""
        found = Counter(member.verdict.word for member in self.members)
        return {word: found[word] for word in VERDICTS}

    @property
    def judged(self) -> tuple[ScreenedMember, ...]:
        """The members whose rows could be read."""
        return tuple(member for member in self.members if member.findings is not None)

    @property
    def failed(self) -> bool:
        """Whether a member fails."""
        return self.counts[FAIL] > 0

    @property
    def unverified(self) -> tuple[str, ...]:
        """A sentence for every member that neither passes nor fails."""
        doubtful = (member for member in self.members if member.verdict.word in (LOOK_CLOSER, NOT_JUDGED))
        return tuple(f"{member.name or member.place}: {member.verdict.why}" for member in doubtful)

    @property
    def sentence(self) -> str:
        """What it comes to, in one sentence."""
        counts = self.counts
        words = [f"{counts[word]} {word}" for word in VERDICTS if counts[word]]
        plural = "" if len(self.members) == 1 else "s"
        return f"{len(self.members)} member{plural} of {self.table.title}: {', '.join(words)}."

    @property
    def assumptions(self) -> dict[str, tuple[str, int]]:
        """What was taken because the table does not say it, and of how many members."""
        counts = Counter((name, text) for member in self.members for name, text in member.assumed.items())
        return {name: (text, count) for (name, text), count in counts.items()}

    def results(self) -> dict[str, Any]:
        """Plain data for the summary."""
        judged = [member.row() for member in self.members if member.findings is not None]
        return {
            "members": judged,
            "not_judged": [member.row() for member in self.members if member.findings is None],
            "counts": self.counts,
            "sentence": self.sentence,
            "assumptions": {name: {"taken": text, "members": n} for name, (text, n) in self.assumptions.items()},
            "columns": list(self.table.columns),
            "columns_not_read": list(self.table.ignored),
            "provenance": provenance(self.table),
            "interrupted": self.interrupted,
        }

    def __repr__(self) -> str:
        lines = [f"MemberScreen: {self.sentence}"]
        for member in self.members[:_SHOWN]:
            lines.append(f"  {member.name or member.place}: {member.verdict.word}. {member.verdict.why}"[:118])
        if len(self.members) > _SHOWN:
            lines.append(f"  and {len(self.members) - _SHOWN} more")
        return "\n".join(lines)


def screen_members(table: Any, *, progress: Progress | None = None) -> MemberScreen:
    """Judge every member of a table in the winds of its site: FAIL, LOOK CLOSER or PASS.

    Each member is an elastic tube without absorbers, whose response is known in closed form: its worst amplitude is
    that of `frahm.worst_case` of its case, over every mode that winds of the site excite.

    Parameters
    ----------
    table : str, Path or sequence of mapping
        ``"members-example"``, a CSV or XLSX file with one row a member, or such rows as dictionaries (or a data frame)
        by the names of the columns; numbers without a unit in the name are in SI units, as ``{"length": 25.0}`` [m].
    progress : callable, optional
        Called with the name of a member, its number from 0 and the number of members.

    Returns
    -------
    MemberScreen
        The worst first. A row that cannot be read is NOT JUDGED, with the reason, and the others go on.

    Raises
    ------
    ParameterError
        If there is no such table, a column is missing, a unit unknown, two members have one name, or no row can be
        read.
    """
    read = read_members(table)
    done: list[ScreenedMember] = []
    interrupted = False
    try:
        for number, row in enumerate(read.rows):
            if progress:
                progress(row.name, number, len(read.rows))
            done.append(_screened(row))
    except KeyboardInterrupt:
        interrupted = True
        done += [_not_judged(row, _INTERRUPTED) for row in read.rows[len(done) :]]
    if progress and not interrupted:
        progress("done", len(read.rows), len(read.rows))
    if not interrupted and all(member.findings is None for member in done):
        first = done[0]
        raise ParameterError("members", read.source, "a table with at least one row that can be read",
                             hint=f"{first.place}: {first.verdict.why}")  # fmt: skip
    return MemberScreen(read, tuple(sorted(done, key=lambda member: member.rank)), interrupted)


def _screened(row: MemberRow) -> ScreenedMember:
    if row.problem:
        return _not_judged(row, row.problem)
    try:
        member = member_case(row)
        found = findings(member)
    except ParameterError as error:
        return _not_judged(row, str(error))
    return ScreenedMember(row.name, row.place, verdict_of(found), member.ends, found, member.assumed)


def _not_judged(row: MemberRow, why: str) -> ScreenedMember:
    return ScreenedMember(row.name, row.place, MemberVerdict(NOT_JUDGED, (why,)))


def provenance(table: MemberTable) -> dict[str, Any]:
    """Digest of a table, and versions."""
    versions = {"python": platform.python_version()}
    versions |= {name: importlib.metadata.version(name) for name in ("numpy", "scipy")}
    return {"source": table.title, "digest": table.digest, "versions": versions}
