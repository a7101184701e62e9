from __future__ import annotations

import subprocess
import sys

import pytest

from frahm.published import yang2022
from frahm.published.yang2022_equations import PRINTED, terms


def test_claims_are_numbered_and_say_what_to_compute():
    assert [claim.id for claim in yang2022.CLAIMS] == list(range(1, 20))
    assert all(claim.statement.endswith(".") and claim.quantity for claim in yang2022.CLAIMS)


def test_ranges_ascend():
    for claim in yang2022.CLAIMS:
        bounds = {v.name: v.value for v in claim.printed}
        for name, value in bounds.items():
            if name.endswith(" from"):
                assert value < bounds[name.removesuffix("from") + "to"]


@pytest.mark.parametrize(
    ("tolerance", "printed", "computed", "allowed"),
    [
        (yang2022.READ_OFF, -0.164, -0.168, True),
        (yang2022.READ_OFF, -0.164, -0.170, False),
        (yang2022.APPROXIMATE, -0.1, -0.109, True),
        (yang2022.PEAK, 0.0493, 0.0557, False),
        (yang2022.UPPER_BOUND, 0.02, 0.0165, True),
        (yang2022.UPPER_BOUND, 0.02, 0.0201, False),
    ],
)
def test_tolerance(tolerance, printed, computed, allowed):
    assert tolerance.allows(printed, computed) is allowed


def test_terms_keep_the_sign_of_the_text_and_multiply_out_factors():
    first, second = terms("? 3/8 kappa b^3 cos1; - 2 b b omega^-1")
    assert (first.sign, first.leading, second.sign, second.leading) == ("?", True, "-", False)
    assert float(first.magnitude) == 0.375
    assert second.powers == (("b", 2), ("omega", -1))


def test_every_term_has_a_sign_and_no_symbol_is_misspelt():
    names = (
        "i E A B B1 B2 Bbar B1bar B2bar D1A D1B D1B1 F a b da db dalpha dbeta cos1 sin1 cos2 sin2 p1 q1 p2 q2 omega"
        " sigma xi1 xi2 kappa rho2 exp(3i*omega*t1)"
    )
    known = set(names.split())
    for term in (t for p in PRINTED for t in (*p.terms, *p.right)):
        assert term.sign in ("+", "-", "?")
        assert {name for name, _ in term.powers} <= known


def test_neither_data_nor_judge_loads_sympy_on_import():
    code = "import sys, frahm.published.yang2022, frahm.slow_flow.print_check; print('sympy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
