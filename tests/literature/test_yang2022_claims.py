"""Every claim of doi 10.3390/app12147272 against numbers of an independent prototype (closed form, shooting)."""

from __future__ import annotations

import dataclasses

import pytest

from frahm.published.yang2022 import CLAIMS
from frahm.reproduction.judging import ClaimVerdict, Evidence, judge

NOT_REPRODUCED = {3, 4, 7}
MISPRINT = {2}
BAD_EQUATIONS = {
    "14-x12", "16-second-solvability-condition", "18-row-3", "A1-p2", "A1-q2",
    "A2-J21", "A2-J22", "A2-J23", "A2-J24", "A2-J41", "A2-J42", "A2-J43",
}  # fmt: skip

# (row, quantity, value of the prototype, how near)
COMPUTED = [
    (1, "shedding frequency", 0.7972, 5e-5),
    (2, "pipe", 0.0498, 5e-5),
    (2, "relative", 0.0564, 5e-5),
    (3, "unstable from", 0.01164, 5e-6),
    (3, "unstable to", 0.0402, 1e-4),
    (4, "peak ratio", 1.575, 1e-3),
    (5, "several responses from", -0.1660, 5e-5),
    (5, "several responses to", -0.0969, 5e-5),
    (6, "unstable from", -0.0132, 5e-5),
    (6, "unstable to", 0.1330, 5e-5),
    (7, "saddle-node", 0.0513, 5e-5),
    (8, "pipe", 0.0045, 5e-5),
    (8, "relative", 0.0045, 5e-5),
    (9, "pipe", 0.0256, 5e-5),
    (9, "relative", 0.0520, 5e-5),
    (11, "ratio", 0.196, 1e-3),
    (12, "several responses from", -0.3414, 5e-5),
    (12, "several responses to", -0.0862, 5e-5),
    (12, "pipe", 0.0720, 5e-5),
    (12, "detuning of the peak", -0.0871, 2e-4),
    (13, "special points from", 0.0528, 5e-5),
    (13, "special points to", 0.2910, 5e-5),
    (14, "unstable from", -0.0117, 5e-5),
    (14, "unstable to", 0.0884, 1e-4),
    (14, "pipe, at most", 0.0171, 5e-5),
    (18, "pipe, at most", 0.0174, 3e-4),
]
BESIDE = [
    (2, "pipe, exact equations from rest", 0.0497, 5e-5),
    (2, "relative, exact equations from rest", 0.0566, 5e-5),
    # collocation (AUTO-07p) of the exact equations
    (3, "unstable from, exact equations by harmonic balance", 0.01149, 6e-6),
    (3, "unstable to, exact equations by harmonic balance", 0.04013, 6e-6),
    (5, "several responses from, exact equations by harmonic balance", -0.16923, 6e-6),
    (5, "several responses to, exact equations by harmonic balance", -0.09507, 6e-6),
    (6, "unstable from, exact equations by harmonic balance", -0.01347, 6e-6),
    (6, "unstable to, exact equations by harmonic balance", 0.13107, 6e-6),
    (7, "saddle-node, exact equations by harmonic balance", 0.05115, 6e-6),
    # shooting of the exact equations on a grid
    (12, "several responses from, exact equations by harmonic balance", -0.353, 3e-3),
    (12, "several responses to, exact equations by harmonic balance", -0.086, 3e-3),
    (13, "special points from, exact equations by harmonic balance", 0.0525, 5e-4),
    (13, "special points to, exact equations by harmonic balance", 0.28, 3e-3),
    (14, "unstable from, exact equations by harmonic balance", -0.0115, 6e-4),
    (14, "unstable to, exact equations by harmonic balance", 0.087, 1e-3),
    (14, "largest periodic response of the pipe, exact equations", 0.0164, 5e-5),
    # closed form, integration
    (3, "modulated from, exact equations from rest", -0.002, 2e-3),
    (3, "modulated to, exact equations from rest", 0.028, 2e-3),
    (4, "peak ratio, exact equations from rest", 1.575, 0.01),
    (5, "several responses from, slow flow with the exact frequency", -0.16809, 1e-5),
    (5, "several responses to, slow flow with the exact frequency", -0.09737, 1e-5),
    (6, "unstable from, slow flow with the exact frequency", -0.01307, 1e-5),
    (6, "unstable to, slow flow with the exact frequency", 0.12949, 1e-5),
    (6, "modulated from, exact equations from rest", -0.04, 0.006),
    (7, "saddle-node, slow flow with the exact frequency", 0.05099, 1e-5),
    (7, "exact equations from rest modulated up to", 0.062, 2e-3),
    (8, "pipe, slow flow in the paper's form", 0.0044, 5e-5),
    (9, "pipe, slow flow in the paper's form", 0.0258, 5e-5),
    (9, "relative, slow flow in the paper's form", 0.0498, 5e-5),
    (10, "relative, largest on the way", 0.25, 5e-3),
    (11, "ratio at the equilibrium, slow flow in the paper's form", 0.182, 5e-4),
    (12, "pipe, exact equations on the grid of detunings", 0.0712, 1e-4),
    (14, "largest pipe amplitude, slow flow in the paper's form", 0.0165, 5e-5),
    (16, "pipe, smallest peak of a period", 0.0012, 1e-4),
    (16, "pipe, largest", 0.0315, 5e-5),
    (16, "relative, largest", 0.112, 5e-4),
    (17, "pipe, kappa 24.425, from rest", 0.0497, 5e-5),
    (17, "pipe, kappa 97.97, from rest", 0.0316, 5e-5),
    (17, "pipe, kappa 367.38, from rest", 0.0170, 1e-4),
    (19, "range, kappa 367.38, xi2 0.0117", 0.0884 - 0.0496, 1e-4),
    (19, "range, kappa 367.38, xi2 0.0085", 0.1330 - 0.0513, 1e-4),
]


@pytest.mark.parametrize(("row", "name", "expected", "near"), COMPUTED)
def test_computed_value_is_that_of_the_prototype(reproduction, row, name, expected, near):
    assert reproduction.claims[str(row)]["computed"][name] == pytest.approx(expected, abs=near)


@pytest.mark.parametrize(("row", "name", "expected", "near"), BESIDE)
def test_value_beside_is_that_of_the_prototype(reproduction, row, name, expected, near):
    (value,) = [beside["value"] for beside in reproduction.claims[str(row)]["beside"] if beside["name"] == name]
    assert value == pytest.approx(expected, abs=near)


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: str(claim.id))
def test_verdict(reproduction, claim):
    expected = {**dict.fromkeys(NOT_REPRODUCED, "not-reproduced"), **dict.fromkeys(MISPRINT, "misprint")}
    assert reproduction.claims[str(claim.id)]["verdict"] == expected.get(claim.id, "reproduced")


def printed_numbers():
    for claim in CLAIMS:
        for value in claim.printed:
            marks = []
            if claim.id in NOT_REPRODUCED | MISPRINT:
                word = "misprint: exchanged" if claim.id in MISPRINT else "not reproduced"
                reason = f"{word}, row {claim.id}: printed {value.value:g} {value.unit}"
                marks = [pytest.mark.xfail(strict=True, reason=reason)]
            yield pytest.param(claim.id, value, marks=marks, id=f"{claim.id}-{value.name}")


@pytest.mark.parametrize(("row", "printed"), list(printed_numbers()))
def test_printed_number(reproduction, row, printed, record_property):
    computed, near = reproduction.claims[str(row)]["computed"][printed.name], printed.tolerance
    bound = "at most " if near.upper_bound else ""
    expected = f"{bound}{printed.value:g} ± {max(near.absolute, near.relative * abs(printed.value)):.2g} {printed.unit}"
    record_property("held", [printed.name, f"{computed:.5g}", expected])
    assert near.allows(printed.value, computed)


def test_both_values_stand_beside_each_other_where_they_differ(reproduction):
    for row in NOT_REPRODUCED | MISPRINT:
        claim = reproduction.claims[str(row)]
        for value in CLAIMS[row - 1].printed:
            assert claim["printed"][value.name] == value.value
            assert f"{claim['computed'][value.name]:.4g}" in claim["explanation"]


def test_exchanged_amplitudes_are_named(reproduction):
    assert "exchanged: pipe 0.0493 m, relative 0.0557 m" in reproduction.claims["2"]["explanation"]


def test_exact_peak_on_the_detached_branch_is_above_any_that_was_integrated(reproduction):
    beside = {value["name"]: value["value"] for value in reproduction.claims["12"]["beside"]}
    integrated = beside["pipe, exact equations on the grid of detunings"]
    assert pytest.approx(integrated, abs=1e-4) == 0.0712
    assert integrated < beside["pipe, exact equations by harmonic balance"] < 1.02 * integrated


def test_exceptions_are_said_even_where_a_claim_holds(reproduction):
    assert "a stable periodic response exists beside it" in reproduction.claims["3"]["explanation"]
    assert "does not hold for every stable motion" in reproduction.claims["17"]["explanation"]
    assert "at xi2 0.0044" in reproduction.claims["15"]["explanation"]


def test_equations_with_misprints_are_those_known(reproduction):
    equations = {key: row for key, row in reproduction.claims.items() if not key.isdigit()}
    assert len(equations) == 33
    assert {key for key, row in equations.items() if row["verdict"] == "misprint"} == BAD_EQUATIONS
    assert all(row["verdict"] == "reproduced" for key, row in equations.items() if key not in BAD_EQUATIONS)
    assert equations["A2-J22"]["computed"]["term 1"] == "+ 9 kappa p2^2 xi2"


def evidence_for(claim, **changes):
    values = {value.name: value.value for value in claim.printed}
    return Evidence("given", values | changes, dict.fromkeys(claim.statements, True))


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: str(claim.id))
def test_a_claim_that_is_computed_as_printed_is_reproduced(claim):
    assert judge(claim, evidence_for(claim)).verdict is ClaimVerdict.REPRODUCED


@pytest.mark.parametrize("claim", [c for c in CLAIMS if c.printed], ids=lambda claim: str(claim.id))
def test_a_claim_whose_number_comes_out_otherwise_is_not(claim):
    name = claim.printed[0].name
    judged = judge(claim, evidence_for(claim, **{name: claim.printed[0].value + 1.0}))
    assert judged.verdict is ClaimVerdict.NOT_REPRODUCED
    assert name in judged.explanation


@pytest.mark.parametrize("claim", [c for c in CLAIMS if c.statements], ids=lambda claim: str(claim.id))
def test_a_claim_with_a_statement_that_fails_is_not(claim):
    failing = dataclasses.replace(evidence_for(claim), statements=dict.fromkeys(claim.statements, False))
    assert judge(claim, failing).verdict is ClaimVerdict.NOT_REPRODUCED


def test_ends_of_a_range_are_not_taken_for_exchanged_amplitudes():
    claim = CLAIMS[4]
    low, high = claim.printed
    judged = judge(claim, evidence_for(claim, **{low.name: high.value, high.name: low.value}))
    assert judged.verdict is ClaimVerdict.NOT_REPRODUCED
