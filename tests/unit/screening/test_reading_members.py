"""A table of members: as spreadsheets write it, as Python has it, and what is refused of it."""

import io

import openpyxl
import pytest

import frahm
from frahm.screening import COLUMNS, read_members, template_csv, template_xlsx

HEAD = "name,diameter [mm],wall thickness [mm],length [m],ends,damping ratio [%]"
ROW = "B1,508,12.7,25,fixed,0.15"


def written(tmp_path, text, name="members.csv", encoding="utf-8"):
    path = tmp_path / name
    path.write_bytes(text.encode(encoding))
    return path


def workbook(tmp_path, rows, name="members.xlsx"):
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append(row)
    book.save(tmp_path / name)
    return tmp_path / name


def values(table, row=0):
    return dict(table.rows[row].values)


EXPECTED = {
    "name": "B1", "diameter": "508 mm", "wall thickness": "12.7 mm", "length": 25.0, "ends": "fixed",
    "damping ratio": "0.15 %",
}  # fmt: skip


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        (f"{HEAD}\n{ROW}\n", "utf-8"),
        (f"{HEAD}\n{ROW}\n".replace(",", "\t"), "utf-8-sig"),
        (f"{HEAD}\n{ROW}\n".replace(",", ";").replace(".", ","), "cp1252"),
        ("Bauwerk Süd;;;;;\nName;OD (mm);WT (mm);L (m);Ends;Zeta (%)\nB1;508;12,7;25,0;fixed;0,15\n", "cp1252"),
        ("sep=;\nname;od;wt;span;supports;damping\n;mm;mm;m;;%\nB1;508;12,7;25;fixed;0,15\n", "utf-16"),
        (f"# a remark\n{HEAD},\n\n{ROW},\n", "utf-8"),
    ],
)
def test_what_spreadsheets_write(tmp_path, text, encoding):
    assert values(read_members(written(tmp_path, text, encoding=encoding))) == EXPECTED


def test_a_workbook_gives_what_the_text_gives(tmp_path):
    rows = [["# remark"], [None], HEAD.split(","), ["B1", 508, 12.7, 25, "fixed", 0.15]]
    book, text = read_members(workbook(tmp_path, rows)), read_members(written(tmp_path, f"{HEAD}\n{ROW}\n"))
    assert values(book) == values(text) == EXPECTED
    assert book.digest == text.digest
    assert book.rows[0].place.endswith("members.xlsx:4")


def test_rows_of_python_are_in_si_units():
    row = {"name": "B1", "diameter": 0.508, "wall": 0.0127, "length [mm]": 25000, "ends": 0.5, "damping ratio": 0.0015}
    assert values(read_members([row])) == {
        "name": "B1", "diameter": 0.508, "wall thickness": 0.0127, "length": "25000 mm", "ends": 0.5,
        "damping ratio": 0.0015,
    }  # fmt: skip


def test_a_cell_may_carry_its_unit(tmp_path):
    text = f"{HEAD}\nB1,20 inch,0.5 inch,25000 mm,fixed,0.15 %\n"
    assert values(read_members(written(tmp_path, text)))["diameter"] == "20 inch"


def test_a_name_may_begin_with_the_sign_of_a_remark(tmp_path):
    rows = ['"# a remark, in quotes"', "#", HEAD, "# another", ROW.replace("B1", "#1")]
    assert [row.name for row in read_members(written(tmp_path, "\n".join(rows))).rows] == ["#1"]
    book = workbook(tmp_path, [["# remark"], HEAD.split(","), ["#1", *ROW.split(",")[1:]]])
    assert [row.name for row in read_members(book).rows] == ["#1"]


def test_columns_that_are_none_of_a_member_are_named(tmp_path):
    table = read_members(written(tmp_path, f"{HEAD},joint A,weight [kg]\n{ROW},J1,1200\n"))
    assert table.ignored == ("joint A", "weight")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "columns name, diameter, wall thickness, length, ends, damping ratio"),
        ("a,b\n1,2\n", "frahm new FILE --members"),
        (f"{HEAD}\n", "at least one member"),
        (HEAD.replace("length [m]", "lenght [m]") + f"\n{ROW}\n", "'lenght'.*Did you mean 'length'"),
        (HEAD.replace("length [m]", "leng [m]") + f"\n{ROW}\n", "length"),
        (HEAD.replace(",ends", ",note") + f"\n{ROW}\n", "the column ends"),
        (f"{HEAD},damping raito\n{ROW},1\n", "'damping raito'.*Did you mean 'damping ratio'"),
        (HEAD.replace("[mm],wall", "[mmm],wall") + f"\n{ROW}\n", r"diameter \[mmm\].*Unknown unit 'mmm'"),
        (HEAD.replace("length [m]", "length [kg]") + f"\n{ROW}\n", "'kg' does not measure"),
        (f"{HEAD},length [m]\n{ROW},3\n", "the column length once"),
        (f"{HEAD}\n{ROW}\n{ROW}\n", "'B1'; allowed: a name no other member has"),
        (f"{HEAD},weibull scale [m/s]\n{ROW},8\n", r"columns weibull shape, design life \[year\]"),
    ],
)
def test_a_table_that_is_wrong_as_a_whole_is_refused(tmp_path, text, message):
    with pytest.raises(frahm.ParameterError, match=message):
        read_members(written(tmp_path, text))


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("B2,508,12.7,25,fixed", "5 cells.*allowed: 6"),
        ("B2,508,12,7,25,fixed,0.15", "7 cells.*Decimal commas need semicolons"),
        ("B2,508,12.7,long,fixed,0.15", "length: given 'long'"),
        ("B2,508,12.7,,fixed,0.15", "length: given 'nothing'"),
        (",508,12.7,25,fixed,0.15", "a name in every row"),
        ("B2,508,12.7,25 kg,fixed,0.15", "length.*'kg' does not measure"),
        ("B2,nan,12.7,25,fixed,0.15", "diameter"),
    ],
)
def test_a_row_that_cannot_be_read_is_kept_with_the_reason(tmp_path, row, message):
    table = read_members(written(tmp_path, f"{HEAD}\n{ROW}\n{row}\n"))
    assert table.rows[0].problem == ""
    assert table.rows[1].place.endswith(":3")
    import re

    assert re.search(message, table.rows[1].problem)


def test_one_decimal_sign_holds_for_the_whole_table(tmp_path):
    text = f"{HEAD}\nB1,508,12.7,25,fixed,0.15\nB2,508,12,7.5,fixed,0.1\nB3,508,12,7,fixed,0\n".replace(",", ";")
    mixed = read_members(written(tmp_path, text.replace("0.1\n", "0,1\n")))
    assert "one decimal sign" in mixed.rows[1].problem
    assert mixed.rows[2].problem == ""


def test_numbers_without_a_unit_are_refused_where_it_matters(tmp_path):
    table = read_members(written(tmp_path, HEAD.replace(" [mm]", "") + f"\n{ROW}\n"))
    assert "diameter [mm]" in table.rows[0].problem


def test_the_template_is_read_back_and_names_every_column(tmp_path):
    text, path = template_csv(), tmp_path / "t.xlsx"
    path.write_bytes(template_xlsx())
    as_text, as_book = read_members(written(tmp_path, text)), read_members(path)
    assert as_text.digest == as_book.digest
    assert [row.problem for row in as_text.rows] == [""] * 3
    assert [column.head for column in COLUMNS if f"# {column.head}: " not in text] == []


def test_every_name_of_a_column_is_its_own():
    names = [name for column in COLUMNS for name in (column.name, *column.aliases)]
    assert len(names) == len(set(names))


def test_a_sheet_that_is_hidden_or_empty_is_passed_over(tmp_path):
    book = openpyxl.Workbook()
    book.active.title = "cover"
    hidden, members = book.create_sheet("hidden"), book.create_sheet("members")
    hidden.append(["not", "this"])
    hidden.sheet_state = "hidden"
    for line in (HEAD, ROW):
        members.append(line.split(","))
    stream = io.BytesIO()
    book.save(stream)
    (tmp_path / "b.xlsx").write_bytes(stream.getvalue())
    assert values(read_members(tmp_path / "b.xlsx"))["name"] == "B1"
