"""Room `screening`: every member of a platform through the closed forms of the bare pipe, the worst first."""

from frahm.screening.columns import COLUMNS, MemberColumn
from frahm.screening.judging import Findings
from frahm.screening.member import ScreenedMember
from frahm.screening.reading import EXAMPLE, MemberTable, read_members
from frahm.screening.screen import MemberScreen, screen_members
from frahm.screening.store import (
    SCHEMA,
    cell,
    expecting,
    file_name,
    file_names,
    members_csv,
    save_cases,
    save_screen,
    summary_of,
    wanted_members,
)
from frahm.screening.template import template_csv, template_xlsx
from frahm.screening.verdict import FAIL, LOOK_CLOSER, NOT_JUDGED, PASS, VERDICTS, MemberVerdict, share

__all__ = [
    "COLUMNS",
    "EXAMPLE",
    "FAIL",
    "LOOK_CLOSER",
    "NOT_JUDGED",
    "PASS",
    "SCHEMA",
    "VERDICTS",
    "Findings",
    "MemberColumn",
    "MemberScreen",
    "MemberTable",
    "MemberVerdict",
    "ScreenedMember",
    "cell",
    "expecting",
    "file_name",
    "file_names",
    "members_csv",
    "read_members",
    "save_cases",
    "save_screen",
    "screen_members",
    "share",
    "summary_of",
    "template_csv",
    "template_xlsx",
    "wanted_members",
]
