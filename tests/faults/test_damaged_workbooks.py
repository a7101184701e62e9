"""Damaged and malicious workbooks end in one sentence, never with the process that reads them."""

import io
import subprocess
import sys
import zipfile

import openpyxl
import pytest

import frahm


def workbook_bytes(rows=(("name", "length [m]"), ("B1", 12.0))):
    book, stream = openpyxl.Workbook(), io.BytesIO()
    for row in rows:
        book.active.append(row)
    book.save(stream)
    return stream.getvalue()


def with_entry(raw, name, content):
    """The archive with one entry replaced."""
    stream = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(raw)) as old, zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as new:
        for entry in old.namelist():
            new.writestr(entry, content if entry == name else old.read(entry))
    return stream.getvalue()


def refused(tmp_path, raw, name="a.xlsx"):
    path = tmp_path / name
    path.write_bytes(raw)
    with pytest.raises(frahm.ParameterError) as error:
        frahm.screen_members(path)
    assert len(str(error.value).splitlines()) == 1
    return str(error.value)


SHEET = "xl/worksheets/sheet1.xml"
LAUGHS = '<?xml version="1.0"?><!DOCTYPE l [<!ENTITY a "{}">{}]><worksheet>&k;</worksheet>'.format(
    "ha" * 1000, "".join(f'<!ENTITY {b} "{f"&{a};" * 30}">' for a, b in zip("abcdefghij", "bcdefghijk", strict=True))
)


@pytest.mark.parametrize(
    ("raw", "says"),
    [
        (b"", "damaged"),
        (b"name,length\n", "damaged"),
        (workbook_bytes()[:3000], "damaged"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + b"\0" * 600, "password"),
        (with_entry(workbook_bytes(), SHEET, b"<worksheet><sheetData><row"), "damaged"),
        (with_entry(workbook_bytes(), SHEET, LAUGHS.encode()), "damaged"),
        (with_entry(workbook_bytes(), "xl/workbook.xml", b"<a/>"), "damaged|no sheet"),
        (workbook_bytes(()), "no sheet with anything in it"),
    ],
)
def test_a_damaged_workbook_is_one_sentence(tmp_path, raw, says):
    message = refused(tmp_path, raw)
    assert any(word in message for word in says.split("|")), message


def test_a_byte_turned_here_and_there_ends_in_a_sentence(tmp_path):
    raw = workbook_bytes()
    for place in range(0, len(raw), len(raw) // 8):
        damaged = bytearray(raw)
        damaged[place] ^= 0xFF
        path = tmp_path / "a.xlsx"
        path.write_bytes(bytes(damaged))
        with pytest.raises(frahm.ParameterError):  # the table lacks columns, at the least
            frahm.screen_members(path)


@pytest.mark.skipif(sys.platform != "linux", reason="memory is counted in other units")
def test_a_small_workbook_cannot_take_much_memory(tmp_path):
    """A sheet of 2 GB that is packed into 2 MB: nothing of it is unpacked."""
    stream = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(workbook_bytes())) as old,
        zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as new,
    ):
        for entry in old.namelist():
            if entry != SHEET:
                new.writestr(entry, old.read(entry))
        with new.open(SHEET, "w", force_zip64=True) as sheet:
            for _ in range(2000):
                sheet.write(b" " * 2**20)
    (tmp_path / "bomb.xlsx").write_bytes(stream.getvalue())
    code = (
        "import frahm, resource, sys\n"
        "try: frahm.screen_members('bomb.xlsx')\n"
        "except frahm.ParameterError as error: assert 'larger than 20 MB' in str(error), error\n"
        "else: sys.exit('read')\n"
        "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) < 300_000  # kB


def test_a_cell_in_the_last_row_of_a_sheet_is_soon_found(tmp_path):
    cell = (
        '<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData><row r="{0}">'
        '<c r="A{0}" t="inlineStr"><is><t>name</t></is></c></row></sheetData></worksheet>'
    )
    assert "beyond the last" in refused(tmp_path, with_entry(workbook_bytes(), SHEET, cell.format(3_000_000).encode()))


@pytest.mark.parametrize(
    ("name", "says"), [("a.xls", "Save it as .xlsx"), ("a.pdf", "ends in .csv"), ("a.ods", "Save it as .xlsx")]
)
def test_other_files_are_refused_by_their_name(tmp_path, name, says):
    assert says in refused(tmp_path, b"x", name)


def test_a_file_that_is_not_there_names_the_one_beside_it(tmp_path):
    (tmp_path / "members.csv").write_text("name\n")
    with pytest.raises(frahm.ParameterError, match=r"Did you mean .*members\.csv"):
        frahm.screen_members(tmp_path / "member.csv")
    with pytest.raises(frahm.ParameterError, match="Did you mean 'members-example'"):
        frahm.screen_members("members-exmple")
    with pytest.raises(frahm.ParameterError, match="a sequence of dictionaries"):
        frahm.screen_members(3)
