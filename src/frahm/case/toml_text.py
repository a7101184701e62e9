"""TOML in, with the lines the standard parser does not tell."""

from __future__ import annotations

import re
import tomllib
from typing import Any

from frahm.case.yaml_text import TextError

_TABLE = re.compile(r"\s*(\[\[?)\s*([\w.\-\s]+?)\s*\]\]?")
_KEY = re.compile(r"""\s*["']?([\w\-]+(?:\s*\.\s*[\w\-]+)*)["']?\s*=""")


def read_toml(text: str) -> tuple[Any, dict[str, int]]:
    """Plain data of a TOML document, and the line of the paths that stand on a line of their own.

    Raises
    ------
    TextError
        If the text is no TOML.
    """
    try:
        return tomllib.loads(text), _lines(text)
    except tomllib.TOMLDecodeError as error:
        line = re.search(r"at line (\d+)", str(error))
        number = int(line[1]) if line else max(1, text.count("\n") + (not text.endswith("\n")))
        raise TextError(f"not valid TOML: {error}", number) from None
    except RecursionError:
        raise TextError("lists or tables are nested too deeply") from None
    except ValueError as error:
        raise TextError(f"not valid TOML: {error}") from None


def _lines(text: str) -> dict[str, int]:
    lines: dict[str, int] = {}
    last: dict[str, int] = {}
    prefix = ""
    for number, line in enumerate(text.splitlines(), start=1):
        if table := _TABLE.match(line):
            prefix = _indexed(table[2], last, new=table[1] == "[[")
            lines[prefix] = number
        elif key := _KEY.match(line):
            name = re.sub(r"\s", "", key[1])
            lines.setdefault(f"{prefix}.{name}" if prefix else name, number)
    return lines


def _indexed(table: str, last: dict[str, int], *, new: bool) -> str:
    """Path of a table header, with positions where a part of it is a list of tables."""
    path, parts = "", re.sub(r"\s", "", table).split(".")
    for i, part in enumerate(parts):
        path = f"{path}.{part}" if path else part
        if new and i == len(parts) - 1:
            last[path] = last.get(path, -1) + 1
        if path in last:
            path = f"{path}[{last[path]}]"
    return path
