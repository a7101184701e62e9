"""The table of reasons does not depend on the order in which points came in."""

import itertools

import numpy as np

from frahm.sweep.reasons import Reasons, kind_of_reason

SENTENCES = {4: "x: given 4; no.", 1: "y gave up at 2.5e-3.", 7: "x: given 7; no.", 2: "z"}


def test_sentences_that_differ_in_numbers_are_one_kind():
    assert kind_of_reason("branch 3 near 4.9, -5.1e-7 rad/s") == kind_of_reason("branch 12 near 1, 2 rad/s")
    assert kind_of_reason("x1 gave up") != kind_of_reason("x gave up")


def test_the_numbering_is_that_of_the_points_in_any_order():
    tables = set()
    for order in itertools.permutations(SENTENCES):
        reasons, codes = Reasons(), np.zeros(9, dtype="i4")
        for index in order:
            codes[index] = reasons.code(SENTENCES[index], index)
        assert np.all(codes <= 0)
        codes = reasons.ordered(codes)
        reasons.forget_provisional()
        assert codes.tolist() == [0, 1, 2, 0, 3, 0, 0, 3, 0]
        tables.add(reasons.text)
    assert tables == {'{"1": "y gave up at 2.5e-3.", "2": "z", "3": "x: given 4; no."}'}


def test_a_table_is_gone_on_with_where_it_was_left():
    reasons, codes = Reasons(), np.zeros(9, dtype="i4")
    for index in (7, 2):
        codes[index] = reasons.code(SENTENCES[index], index)
    again = Reasons.read(reasons.text, codes)
    for index in (1, 4):
        codes[index] = again.code(SENTENCES[index], index)
    assert again.ordered(codes).tolist() == [0, 1, 2, 0, 3, 0, 0, 3, 0]


def test_a_writer_killed_while_it_numbered_leaves_nothing_double():
    reasons, codes = Reasons(), np.zeros(9, dtype="i4")
    for index in (7, 2, 4, 1):
        codes[index] = reasons.code(SENTENCES[index], index)
    before = codes.copy()
    after = reasons.ordered(codes)
    half = np.concatenate([after[:3], before[3:]])  # the table holds both, some parts are renumbered
    again = Reasons.read(reasons.text, half)
    assert again.unordered
    assert again.ordered(half).tolist() == after.tolist()
