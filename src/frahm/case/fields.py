"""One table of all fields of a case: it feeds error messages, the nomenclature and forms."""

from __future__ import annotations

import functools
import types
import typing
from dataclasses import dataclass
from typing import Any, NamedTuple

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from frahm.case.quantities import FieldType

_LISTED = 9  # sections in a list that are still named one by one


@dataclass(frozen=True)
class FieldFacts:
    """What is known about one field.

    Attributes
    ----------
    path : str
        Path in the case; ``[]`` stands for a position in a list, ``(cubic)`` for the kind of a law. The kind that
        need not be said, a pipe of one mode, is left out.
    title, description : str
        Long name and one sentence.
    symbol, unit : str
        Symbol in formulas and SI unit, empty where there is none.
    allowed : str
        What is let in.
    default : object
        Value used when the field is left out; None if it is required.
    required : bool
        Whether the field must be given.
    """

    path: str
    title: str
    description: str
    symbol: str
    unit: str
    allowed: str
    default: Any
    required: bool


@functools.cache
def field_table(model: type[BaseModel]) -> dict[str, FieldFacts]:
    """All fields below a model, by path, sections included, in the order of the model."""
    return {facts.path: facts for facts in _walk(model, "")}


def children(model: type[BaseModel], path: str) -> list[str]:
    """Names of the fields directly below the section at `path`."""
    prefix = f"{path}." if path else ""
    below = [key.removeprefix(prefix) for key in field_table(model) if key.startswith(prefix)]
    return [name for name in below if not set(name) & set(".[(")]


class FieldValue(NamedTuple):
    """What a case says in one field: where, what is known about it, the value, whether and as what it was given.

    `typed` is the text of a value that came with a unit of its own, such as ``"24 inch"``; None for any other.
    """

    path: str
    facts: FieldFacts
    value: Any
    given: bool
    typed: str | None = None


def field_values(case: BaseModel) -> typing.Iterator[FieldValue]:
    """Every field of a case with its value, section by section; sections left out are left out, long lists are one."""
    texts: typing.Mapping[str, str] = getattr(case, "typed", {})
    for field in _values(case, "", "", field_table(type(case))):
        yield field._replace(typed=texts.get(field.path))


def _values(
    section: BaseModel, path: str, key: str, table: typing.Mapping[str, FieldFacts]
) -> typing.Iterator[FieldValue]:
    for name, info in type(section).model_fields.items():
        value, suffixes = getattr(section, name), {kind: suffix for suffix, kind in _sections(info.annotation)}
        entries = value if isinstance(value, tuple) and suffixes and 0 < len(value) <= _LISTED else ()
        if isinstance(value, BaseModel):
            yield from _values(value, f"{path}{name}.", f"{key}{name}{suffixes[type(value)]}.", table)
        elif entries:
            for i, entry in enumerate(entries):
                yield from _values(entry, f"{path}{name}[{i}].", f"{key}{name}{suffixes[type(entry)]}.", table)
        elif value is not None:
            yield FieldValue(path + name, table[key + name], value, name in section.model_fields_set)


@functools.cache
def kinds(model: type[BaseModel]) -> dict[str, dict[str, str]]:
    """Kinds of every section that comes in several, by its path, and what the path of each carries."""
    found: dict[str, dict[str, str]] = {}
    _collect_kinds(model, "", found)
    return found


def kind_of(section: type[BaseModel]) -> str:
    """The word that says which kind a section is."""
    return str(typing.get_args(section.model_fields["kind"].annotation)[0])


def _collect_kinds(model: type[BaseModel], prefix: str, found: dict[str, dict[str, str]]) -> None:
    for name, info in model.model_fields.items():
        sections = list(_sections(info.annotation))
        for suffix, section in sections:
            if len(sections) > 1:
                where = prefix + name + suffix[: suffix.rfind("(")] if "(" in suffix else prefix + name + suffix
                word = suffix[suffix.rfind("(") :] if "(" in suffix else ""
                found.setdefault(where, {})[kind_of(section)] = word
            _collect_kinds(section, f"{prefix}{name}{suffix}.", found)


def _walk(model: type[BaseModel], prefix: str) -> typing.Iterator[FieldFacts]:
    for name, info in model.model_fields.items():
        path = prefix + name
        yield _facts(path, info)
        for suffix, section in _sections(info.annotation):
            yield from _walk(section, f"{path}{suffix}.")


def _sections(annotation: Any) -> typing.Iterator[tuple[str, type[BaseModel]]]:
    """Sections inside an annotation, with what their path carries: [] in a list, (kind) in a choice of laws."""
    arguments = typing.get_args(annotation)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield "", annotation
    elif typing.get_origin(annotation) is tuple and arguments[-1] is Ellipsis:
        yield from (("[]" + suffix, section) for suffix, section in _sections(arguments[0]))
    elif typing.get_origin(annotation) in (typing.Union, types.UnionType) and type(None) in arguments:
        yield from (found for kind in arguments for found in _sections(kind))
    elif typing.get_origin(annotation) in (typing.Union, types.UnionType):
        for argument in arguments:
            kind = typing.get_args(argument)[0] if typing.get_origin(argument) is typing.Annotated else argument
            if isinstance(kind, type) and issubclass(kind, BaseModel):
                yield ("" if getattr(kind, "is_default_kind", False) else f"({kind_of(kind)})"), kind
    elif typing.get_origin(annotation) is typing.Annotated:
        yield from _sections(arguments[0])


def _facts(path: str, info: FieldInfo) -> FieldFacts:
    door = _field_type(info)
    return FieldFacts(
        path=path,
        title=info.title or "",
        description=info.description or "",
        symbol=getattr(door, "symbol", ""),
        unit=door.unit if door else "",
        allowed=door.allowed if door else _allowed_without_door(info),
        default=None if info.is_required() else info.default,
        required=info.is_required(),
    )


def _field_type(info: FieldInfo) -> FieldType | None:
    """How a value comes in; a pair of numbers comes in number by number."""
    return next((entry for entry in [*info.metadata, *_inside(info.annotation)] if isinstance(entry, FieldType)), None)


def _inside(annotation: Any) -> typing.Iterator[Any]:
    """What the annotation is made of, at any depth."""
    for argument in typing.get_args(annotation):
        yield argument
        yield from _inside(argument)


def _allowed_without_door(info: FieldInfo) -> str:
    sections = dict(_sections(info.annotation))
    if not sections:
        return "one of " + ", ".join(map(str, typing.get_args(info.annotation)))
    if len(sections) > 1:
        return "a mapping with kind: " + " or ".join(kind_of(section) for section in sections.values())
    suffix, section = next(iter(sections.items()))
    names = ", ".join(section.model_fields)
    return f"a list of mappings with {names}" if suffix else f"a mapping with {names}"
