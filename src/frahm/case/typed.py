"""What was typed: the text of every field of a case that came in with a unit of its own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel

_LISTED = 12  # entries of a list that are still shown one by one


def typed_texts(data: Mapping[str, Any], section: BaseModel) -> dict[str, str]:
    """Text of every field that was given as text and became something else, such as a number in SI units.

    Parameters
    ----------
    data : Mapping
        What the section was made of; parts of it that are sections already say nothing here.
    section : BaseModel
        What became of it.

    Returns
    -------
    dict of str to str
        By the path of the field, such as ``pipe.diameter``. A list is one text; the name of a file stands for the
        table read from it. A plain number is in SI units as it stands, and is left out.
    """
    return dict(_texts(data, section, ""))


def unchanged_texts(texts: Mapping[str, str], old: BaseModel, new: BaseModel) -> dict[str, str]:
    """Those of the texts whose fields have the same value in both cases."""
    return {path: text for path, text in texts.items() if _same(_at(old, path), _at(new, path))}


def _texts(data: Mapping[str, Any], section: BaseModel, path: str) -> Iterator[tuple[str, str]]:
    for name in type(section).model_fields:
        if name in data:
            yield from _of_field(data[name], getattr(section, name), path + name)


def _of_field(given: Any, value: Any, path: str) -> Iterator[tuple[str, str]]:
    if isinstance(given, str):
        if isinstance(value, BaseModel):  # a section said in short: the text belongs to the one field it sets
            names = list(value.model_fields_set)
            path = f"{path}.{names[0]}" if len(names) == 1 else path
        if not isinstance(value, str):
            yield path, " ".join(given.split())
    elif isinstance(given, Mapping) and isinstance(value, BaseModel):
        yield from _texts(given, value, f"{path}.")
    elif isinstance(given, list | tuple) and isinstance(value, tuple):
        if value and isinstance(value[0], BaseModel):
            for i, (below, entry) in enumerate(zip(given, value, strict=True)):
                if isinstance(below, Mapping):
                    yield from _texts(below, entry, f"{path}[{i}].")
        elif len(given) <= _LISTED and _holds_text(given):
            yield path, _list_text(given)


def _holds_text(given: Any) -> bool:
    return isinstance(given, str) or (isinstance(given, list | tuple) and any(map(_holds_text, given)))


def _list_text(given: Any) -> str:
    if isinstance(given, list | tuple):
        return "[" + ", ".join(map(_list_text, given)) + "]"
    return " ".join(str(given).split())


def _at(section: Any, path: str) -> Any:
    """Value at a path such as absorbers[0].law.stiffness; a new object, equal to nothing, where there is none."""
    for part in path.replace("[", ".").replace("]", "").split("."):
        try:
            section = section[int(part)] if part.isdigit() else getattr(section, part)
        except (AttributeError, IndexError, TypeError):
            return object()
    return section


def _same(old: Any, new: Any) -> bool:
    return bool(type(old) is type(new) and old == new)
