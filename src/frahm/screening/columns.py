"""The columns of a table of members: names, places in the case of a member, defaults."""

from __future__ import annotations

import re
from dataclasses import dataclass

from frahm.case import Case, field_table

REQUIRED = "required"


@dataclass(frozen=True)
class MemberColumn:
    """One column.

    Attributes
    ----------
    name : str
        In the head of the table, where its unit follows in brackets.
    path : str
        Field of the case of a member; empty for what is no field of its own.
    unit : str
        SI unit; empty for text and plain numbers.
    example_unit : str
        Unit of the template.
    aliases : tuple of str
        Other names it goes by.
    default : str
        What holds where the table says nothing, for people; `REQUIRED` if it must be there.
    text : bool
        Whether it holds words.
    """

    name: str
    path: str = ""
    unit: str = ""
    example_unit: str = ""
    aliases: tuple[str, ...] = ()
    default: str = ""
    text: bool = False

    @property
    def required(self) -> bool:
        """Whether the table must have it."""
        return self.default == REQUIRED

    @property
    def head(self) -> str:
        """Name with the unit of the template."""
        return f"{self.name} [{self.example_unit}]" if self.example_unit else self.name

    @property
    def description(self) -> str:
        """What it is, in the words of the case."""
        return _WORDS.get(self.name) or field_table(Case)[self.path.replace("pipe.", "pipe(tube).", 1)].description


COLUMNS = (
    MemberColumn("name", aliases=("member", "member name", "id", "mark", "tag"), default=REQUIRED, text=True),
    MemberColumn("diameter", "pipe.diameter", "m", "mm", ("outer diameter", "outside diameter", "od", "d"), REQUIRED),
    MemberColumn("wall thickness", "pipe.wall", "m", "mm", ("wall", "thickness", "wt", "t"), REQUIRED),
    MemberColumn("length", "pipe.length", "m", "m", ("span", "l"), REQUIRED),
    MemberColumn("ends", "pipe.supports", "", "", ("end conditions", "supports", "fixity"), REQUIRED, text=True),
    MemberColumn("damping ratio", "pipe.damping_ratio", "", "%", ("damping", "zeta"), REQUIRED),
    MemberColumn("rotational stiffness", "pipe.supports.rotation", "N m", "kN m", ("end stiffness",),
                 "none: pinned ends turn freely"),
    MemberColumn("youngs modulus", "pipe.youngs_modulus", "Pa", "GPa", ("young's modulus", "elastic modulus", "e"),
                 "206 GPa, structural steel"),
    MemberColumn("density", "pipe.density", "kg/m^3", "kg/m^3", ("steel density",), "7850 kg/m^3, structural steel"),
    MemberColumn("contained mass", "pipe.contained_mass", "kg/m", "kg/m", ("contents",), "none"),
    MemberColumn("added mass", "pipe.added_mass", "kg/m", "kg/m", ("coating", "coating and anodes"), "none"),
    MemberColumn("modes", "pipe.mode_count", default="all that winds of the site excite, at least 3"),
    MemberColumn("lift", "pipe.lift", default="uniform: as strong all along, in phase with the mode", text=True),
    MemberColumn("wind speed", "wind.speed", "m/s", "m/s", ("design wind",),
                 "the wind of the site nearest to the resonance of the first mode"),
    MemberColumn("lowest wind", "wind.range[0]", "m/s", "m/s", ("minimum wind",), "0 m/s"),
    MemberColumn("highest wind", "wind.range[1]", "m/s", "m/s", ("maximum wind", "wind limit"),
                 "the wind that the climate exceeds once in the design life; without a climate no bound"),
    MemberColumn("air density", "wind.air_density", "kg/m^3", "kg/m^3", (), "1.225 kg/m^3"),
    MemberColumn("viscosity", "wind.viscosity", "m^2/s", "m^2/s", (), "1.5e-5 m^2/s"),
    MemberColumn("strouhal", "wind.strouhal", "", "", ("strouhal number",), "en1991: 0.18 (secondary)"),
    MemberColumn("lift coefficient", "wind.lift_coefficient", "", "", (), "en1991, over the Reynolds number"),
    MemberColumn("weibull scale", "climate.weibull.scale", "m/s", "m/s", (),
                 "none: no climate, so that no fatigue damage is counted"),
    MemberColumn("weibull shape", "climate.weibull.shape", "", "", (), "none; needed beside the scale"),
    MemberColumn("direction factor", "climate.direction_factor", "", "", (), "1: all winds blow across the member"),
    MemberColumn("design life", "climate.duration", "s", "year", ("life", "duration"), "none; needed beside the scale"),
    MemberColumn("s-n curve", "fatigue.curve", aliases=("sn curve", "curve"),
                 default="none: no fatigue damage is counted", text=True),
    MemberColumn("stress concentration", "fatigue.stress_concentration", "", "",
                 ("stress concentration factor", "scf"), "1"),
    MemberColumn("design fatigue factor", "fatigue.design_fatigue_factor", "", "", ("dff",), "1"),
    MemberColumn("displacement limit", "limits.displacement", "m", "mm", (), "none"),
    MemberColumn("amplitude limit", "limits.amplitude_ratio", "", "", ("a/d limit",), "none"),
    MemberColumn("stress range limit", "limits.stress_range", "Pa", "MPa", (), "none"),
    MemberColumn("yield strength", "limits.yield_strength", "Pa", "MPa", ("fy",), "none"),
    MemberColumn("static stress", "limits.static_stress", "Pa", "MPa", (), "0 MPa"),
    MemberColumn("title", "title", aliases=("description", "remarks"), default="none", text=True),
)  # fmt: skip
BY_NAME = {column.name: column for column in COLUMNS}
_WORDS = {
    "strouhal": "A number or a published curve (en1991, facchinetti2004).",
    "lift coefficient": "Amplitude, a number or a published curve (en1991, facchinetti2004).",
    "damping ratio": "Fraction of critical damping of every mode, above 0.",
    "wall thickness": "At most the radius.",
    "length": "Between the supports.",
    "youngs modulus": "Of the material.",
    "density": "Of the material.",
    "design life": "How long the member stands in this wind.",
    "lift": "uniform, or mode-shape: in proportion to the mode.",
    "title": "One line about the member.",
    "name": "One for each member.",
    "ends": "pinned, fixed, fixed-pinned, cantilever, or a fixity from 0 (pinned) to 1 (fixed).",
    "rotational stiffness": "Moment per radian of the spring at every pinned end.",
    "modes": "How many modes take part.",
    "lowest wind": "Lowest speed the member can meet.",
    "highest wind": "Highest speed the member can meet: the limit of the site or of the operation.",
}
_FROM = {alias: column for column in COLUMNS for alias in (column.name, *column.aliases)}


def known_names() -> list[str]:
    """Every name a column can go by."""
    return list(_FROM)


def column_called(head: str) -> MemberColumn | None:
    """The column that goes by a name, whatever its case, hyphens and underscores; None if there is none."""
    plain = plain_name(head)
    return _FROM.get(plain) or _PLAIN.get(plain)


def plain_name(head: str) -> str:
    """A name in small letters with single blanks."""
    return re.sub(r"[\s_-]+", " ", head.strip().lower())


_PLAIN = {plain_name(name): column for name, column in _FROM.items()}
