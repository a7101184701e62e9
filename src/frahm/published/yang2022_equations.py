"""The printed equations of doi 10.3390/app12147272 as lists of terms, exactly as its text gives them.

In the text of the paper letters, digits, exponents and plus signs survive, while most minus signs and all fraction
bars do not. So every term carries the sign *found in the text*: "+", "-", or "?" where there is none. Between two
terms "?" can only be a minus sign that was lost; before the first term, or before a whole expression, it may as well
be the plus sign nobody prints. Nothing is corrected here.

Names: i the imaginary unit, E = e^{i sigma t1}, D1A and D1B slow rates, a bar as B1bar; in polar form da, db,
dalpha, dbeta are rates, cos1 = cos(gamma1) and so on.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class PrintedTerm:
    """One monomial of a printed equation.

    Parameters
    ----------
    sign : {"+", "-", "?"}
        The sign in the text; "?" where the text has none.
    magnitude : Fraction
        Absolute value of the coefficient.
    powers : tuple of (str, int)
        Symbols with their exponents, by name.
    text : str
        The term as recorded here.
    leading : bool
        Whether the term is the first of its side.
    """

    sign: str
    magnitude: Fraction
    powers: tuple[tuple[str, int], ...]
    text: str
    leading: bool


@dataclass(frozen=True)
class PrintedExpression:
    """A printed equation: `name` = sign / denominator * (terms), or left = right.

    Parameters
    ----------
    number : str
        Number of the equation in the paper.
    name : str
        What the expression is equal to, or what the equation says.
    terms : tuple of PrintedTerm
        Right-hand side (of an explicit expression), or left-hand side (of an equation).
    right : tuple of PrintedTerm
        Right-hand side of an equation; empty where the right-hand side is zero or the expression is explicit.
    sign : {"+", "-", "?"}
        Sign before the whole expression.
    denominator : str
        Common denominator, in Python's notation.
    """

    number: str
    name: str
    terms: tuple[PrintedTerm, ...]
    right: tuple[PrintedTerm, ...] = ()
    sign: str = "+"
    denominator: str = "1"


def terms(text: str) -> tuple[PrintedTerm, ...]:
    """Return the terms of "sign coefficient symbol^power ...", separated by semicolons."""
    return tuple(_term(part.split(), leading=index == 0) for index, part in enumerate(text.split(";")) if part.strip())


def _term(words: list[str], *, leading: bool) -> PrintedTerm:
    sign, *factors = words
    magnitude, powers = Fraction(1), dict[str, int]()
    for factor in factors:
        symbol, _, power = factor.partition("^")
        if symbol[0].isdigit():
            magnitude *= Fraction(symbol)
        else:
            powers[symbol] = powers.get(symbol, 0) + int(power or 1)
    return PrintedTerm(sign, magnitude, tuple(sorted(powers.items())), " ".join(factors), leading)


_SINK = "16*rho2**2*omega**2 + 4*xi2**2"
_SINK_QUARTER = "4*omega**2*rho2**2 + xi2**2"
_SHORT = "a*rho2*omega*(2*sigma + omega)"

ASYMPTOTICS = (
    PrintedExpression(
        "12", "slow invariant manifold",
        terms("? 3 kappa B1^2 B1bar E; + i xi2 B1 omega E; ? rho2 B1 omega^2 E; ? rho2 A omega^2"),
    ),
    PrintedExpression(
        "13", "D1 A",
        terms("? 3/2 i kappa B1^2 B1bar omega^-1 E; + 1/2 xi2 B1 E; ? 1/2 xi1 A; ? 1/4 i F omega^-1 E"),
    ),
    PrintedExpression("14", "x12", terms("? 1/8 kappa A^3 exp(3i*omega*t1)")),
    PrintedExpression(
        "15", "second order of the sink",
        terms(
            "? 6 kappa B1 B1bar B2 E; + i xi2 B2 omega E; ? rho2 B2 omega^2 E; + 3 kappa B1^2 B2bar E;"
            "+ 2 i rho2 omega D1B1 E; + i xi2 B1 sigma E; ? 2 rho2 B1 sigma omega E; + 2 i rho2 D1A omega; + xi2 D1B1 E"
        ),
    ),
    PrintedExpression(
        "16", "second solvability condition",
        terms(
            "? i xi2 sigma B E; + i xi2 omega B E; ? 2 rho2 sigma omega B E; ? rho2 omega^2 B E; + 3 kappa B^2 Bbar E;"
            "+ 2 i rho2 omega D1B E; + xi2 D1B E; + 2 i rho2 D1A omega"
        ),
    ),
)  # fmt: skip

POLAR = (
    PrintedExpression(
        "18", "row 1", terms("? omega a dalpha"),
        terms("? 3/8 kappa b^3 cos1; ? 1/2 xi2 b omega sin1; ? 1/2 F cos2"),
    ),
    PrintedExpression(
        "18", "row 2", terms("? da omega"),
        terms("? 3/8 kappa b^3 sin1; + 1/2 xi2 b omega cos1; ? 1/2 xi1 a omega; ? 1/2 F sin2"),
    ),
    PrintedExpression(
        "18", "row 3",
        terms("? rho2 b dbeta omega; + rho2 da omega cos1; + rho2 a dalpha omega cos1; + 1/2 xi2 db"),
        terms("? 3/8 kappa b^3; ? rho2 b sigma omega; ? 1/2 rho2 b omega^2; ? 1/2 rho2 a omega^2 cos1"),
    ),
    PrintedExpression(
        "18", "row 4",
        terms("? rho2 a dalpha omega sin1; ? rho2 db omega; ? rho2 da omega cos1; ? 1/2 xi2 b dbeta"),
        terms("? 1/2 xi2 b sigma; + 1/2 xi2 b omega; ? 1/2 rho2 a omega^2 sin1"),
    ),
)  # fmt: skip

EQUILIBRIUM = (
    PrintedExpression("20", "sin1", terms("? xi2 b sigma; + xi2 b omega"), sign="?", denominator=_SHORT),
    PrintedExpression(
        "20", "sin2",
        terms(
            "? 8 a^2 sigma rho2 xi1 omega^2; + 4 a^2 rho2 xi1 omega^3; + 3 b^4 kappa sigma xi2;"
            "+ 8 b^2 sigma rho2 xi2 omega^2; + 4 b^2 rho2 xi2 omega^3"
        ),
        sign="?", denominator=f"4*F*{_SHORT}",
    ),
    PrintedExpression(
        "20", "cos1", terms("? 3 b^3 kappa; ? 8 b sigma rho2 omega; ? 4 b rho2 omega^2"),
        sign="?", denominator=f"4*{_SHORT}",
    ),
    PrintedExpression(
        "20", "cos2",
        terms(
            "? 9 b^6 kappa^2; ? 24 b^4 kappa sigma rho2 omega; ? 12 b^4 kappa rho2 omega^2;"
            "+ 64 a^2 sigma^2 rho2 omega^2; + 32 a^2 sigma rho2 omega^3; + 16 b^2 sigma xi2^2 omega;"
            "+ 16 b^2 xi2^2 omega^2"
        ),
        sign="?", denominator=f"16*F*{_SHORT}",
    ),
)  # fmt: skip

CARTESIAN = (
    PrintedExpression(
        "A1", "p1'",
        terms("? 3 kappa p2^2 q2; + 3 kappa q2^3; ? 4 xi1 omega p1; + 4 xi2 omega p2; + 8 omega sigma q1"),
        sign="?", denominator="8*omega",
    ),
    PrintedExpression(
        "A1", "q1'",
        terms(
            "? 3 kappa p2^3; + 3 kappa p2 q2^2; + 8 omega sigma p1; + 4 xi1 omega q1; ? 4 xi2 omega q2; + 4 F"
        ),
        sign="?", denominator="8*omega",
    ),
    PrintedExpression(
        "A1", "p2'",
        terms(
            "? 6 kappa p2^2 rho2^2 q2 omega; + 6 kappa rho2^2 q2^3 omega; + 3 kappa p2^3 rho2 xi2;"
            "+ 6 kappa p2^2 rho2 q2 omega; + 3 kappa p2 rho2 q2^2 xi2; + 6 kappa rho2 q2^3 omega;"
            "? 8 p1 rho2^2 xi1 omega^2; + 8 p1 rho2^2 xi2 omega^2; ? 16 sigma rho2^2 q2 omega^2;"
            "? 8 rho2^2 q2 omega^3; + 3 kappa p2^3 xi2; + 3 kappa p2 q2^2 xi2; + 4 p2 rho2 xi2 omega^2;"
            "+ 4 rho2 q1 xi1 xi2 omega; ? 4 rho2 q2 xi2^2 omega; ? 4 sigma q2 xi2^2; ? 4 q2 xi2^2 omega;"
            "+ 4 F rho2 xi2"
        ),
        sign="?", denominator=_SINK,
    ),
    PrintedExpression(
        "A1", "q2'",
        terms(
            "? 6 kappa p2^2 rho2^2 omega; + 6 kappa p2 rho2^2 q2^2 omega; + 6 kappa p2^3 rho2 omega;"
            "? 3 kappa p2^2 rho2 q2 xi2; + 6 kappa p2 rho2 q2^2 omega; ? 3 kappa rho2 q2^3 xi2;"
            "? 16 p2 sigma rho2^2 omega^2; ? 8 p2 rho2^2 omega^3; + 8 rho2^2 q1 xi1 omega^2;"
            "? 8 rho2^2 q2 xi2 omega^2; ? 3 kappa p2^2 q2 xi2; ? 3 kappa q2^3 xi2; + 4 p1 rho2 xi1 xi2 omega;"
            "? 4 p2 rho2 xi2^2 omega; ? 4 rho2 q2 xi2 omega^2; + 8 F rho2^2 omega; ? 4 p2 sigma xi2^2;"
            "? 4 p2 xi2^2 omega"
        ),
        sign="?", denominator=_SINK,
    ),
)  # fmt: skip

# Rows and columns are in the order p1, p2, q1, q2, although the heading says (p1, q1, p2, q2).
JACOBIAN_ORDER = ("p1", "p2", "q1", "q2")
JACOBIAN = (
    PrintedExpression("A2", "J11", terms("? 1/2 xi1")),
    PrintedExpression("A2", "J12", terms("? 3 p2 q2 kappa; + 2 xi2 omega"), denominator="4*omega", sign="?"),
    PrintedExpression("A2", "J13", terms("? sigma")),
    PrintedExpression("A2", "J14", terms("? 3 p2^2 kappa; + 9 q2^2 kappa"), denominator="8*omega", sign="?"),
    PrintedExpression("A2", "J21", terms("? 2 xi1 omega^2 rho2^2"), denominator=_SINK_QUARTER, sign="?"),
    PrintedExpression(
        "A2", "J22",
        terms(
            "? 12 p2 q2 kappa omega rho2^2; + 9 p2^2 xi2 kappa rho2; + 12 p2 q2 kappa omega rho2;"
            "+ 3 kappa rho2 q2^2 xi2; + 8 rho2^2 xi2 omega^2; + 9 kappa q2^2 xi2; + 3 kappa q2^2 xi2;"
            "+ 4 rho2 xi2 omega^2"
        ),
        sign="-", denominator=_SINK,
    ),
    PrintedExpression("A2", "J23", terms("? xi1 xi2 omega rho2"), denominator=_SINK_QUARTER, sign="?"),
    PrintedExpression(
        "A2", "J24",
        terms(
            "? 6 p2^2 kappa omega rho2^2; + 18 q2^2 kappa omega rho2^2; + 6 p2^2 kappa omega rho2;"
            "+ 6 p2 q2 xi2 kappa rho2; + 18 q2^2 kappa omega rho2; - 16 sigma rho2^2 omega^2; - 8 rho2^2 omega^3;"
            "+ 6 kappa p2 q2 xi2; ? 4 rho2 xi2^2 omega; ? 4 sigma xi2^2; ? 4 xi2^2 sigma"
        ),
        sign="?", denominator=_SINK,
    ),
    PrintedExpression("A2", "J31", terms("? sigma")),
    PrintedExpression("A2", "J32", terms("? 9 p2^2 kappa; + 3 q2^2 kappa"), denominator="8*omega", sign="?"),
    PrintedExpression("A2", "J33", terms("? 1/2 xi1")),
    PrintedExpression("A2", "J34", terms("- 3 p2 q2 kappa; + 2 xi2 omega"), denominator="4*omega", sign="?"),
    PrintedExpression("A2", "J41", terms("? xi1 xi2 omega rho2"), denominator=_SINK_QUARTER, sign="?"),
    PrintedExpression(
        "A2", "J42",
        terms(
            "? 18 kappa p2^2 rho2^2 omega; + 6 kappa rho2^2 q2^2 omega; + 18 kappa q2^2 rho2 omega;"
            "? 6 kappa p2 rho2 q2^2 xi2; + 6 kappa rho2 q2^2 omega; ? 16 sigma rho2^2 omega^2; ? 8 rho2^2 omega^3;"
            "? 6 kappa q2 p2 xi2; ? 4 rho2 xi2^2 omega; ? 4 sigma xi2^2; ? 4 xi2^2 omega"
        ),
        sign="?", denominator=_SINK,
    ),
    PrintedExpression("A2", "J43", terms("? 2 xi1 omega^2 rho2^2"), denominator=_SINK_QUARTER, sign="?"),
    PrintedExpression(
        "A2", "J44",
        terms(
            "? 12 kappa p2 rho2^2 q2 omega; ? 3 kappa p2^2 rho2 xi2; + 12 kappa p2 rho2 q2 omega;"
            "? 9 kappa rho2 q2^2 xi2; ? 8 rho2^2 xi2 omega^2; ? 3 kappa xi2 p2^2; ? 9 kappa q2^2 xi2;"
            "? 4 rho2 xi2 omega^2"
        ),
        sign="?", denominator=_SINK,
    ),
)  # fmt: skip

PRINTED = (*ASYMPTOTICS, *POLAR, *EQUILIBRIUM, *CARTESIAN, *JACOBIAN)
