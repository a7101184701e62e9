"""The title block of a case: one-line texts and a date."""

import pytest

import frahm
from frahm.case import case_schema, field_table

BLOCK = {
    "project": "Platform A", "number": "A-123-S-0001", "revision": "B", "date": "2026-03-31", "prepared": "N. N.",
    "checked": "O. O.", "approved": "P. P.",
}  # fmt: skip


def with_block(**entries):
    return frahm.load_case(frahm.load_case("jacket-pipe").to_dict() | {"document": BLOCK | entries})


def test_the_title_block_is_part_of_the_case():
    case = with_block()
    assert case.document.model_dump() == BLOCK
    assert frahm.load_case(case.to_dict()) == case
    assert case.with_document(revision="C").document.revision == "C"
    assert case.with_document(revision="C").document.project == "Platform A"
    assert frahm.load_case("jacket-pipe").document is None
    assert frahm.load_case("jacket-pipe").with_document(project="X").document.date == ""
    assert {f"document.{name}" for name in BLOCK} <= set(field_table(frahm.Case))
    assert set(case_schema()["$defs"]["Document"]["properties"]) == set(BLOCK)


@pytest.mark.parametrize("suffix", [".yaml", ".toml"])
def test_a_date_of_the_file_format_is_a_date(tmp_path, suffix):
    file, case = tmp_path / f"a{suffix}", with_block()
    text = "document: {date: 2026-03-31}" if suffix == ".yaml" else "document = {date = 2026-03-31}"
    sign = ": " if suffix == ".yaml" else " = "
    pipe = "{mass#1, frequency#1, damping_ratio#0.01, diameter#1}".replace("#", sign)
    wind = "{speed#1, lift_coefficient#1}".replace("#", sign)
    file.write_text(f"pipe{sign}{pipe}\nwind{sign}{wind}\n{text}\n")
    assert frahm.load_case(file).document.date == case.document.date


@pytest.mark.parametrize(
    ("entries", "says"),
    [
        ({"date": "31.3.2026"}, r"document.date: given '31.3.2026'; allowed: a date as year-month-day"),
        ({"date": "2026-02-30"}, r"document.date: given '2026-02-30'"),
        ({"date": 20260331}, r"document.date: given 20260331"),
        ({"revision": 2}, r"document.revision: given 2;.*Put it in quotes: \"2\""),
        ({"project": "two\nlines"}, r"document.project: given 'two\\nlines'"),
        ({"revison": "B"}, r"document.revison: given 'B'.*"),
    ],
)
def test_bad_entries_are_refused(entries, says):
    with pytest.raises(frahm.ParameterError, match=says):
        with_block(**entries)
