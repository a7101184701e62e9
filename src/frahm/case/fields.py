"""One table of all fields of a case: it feeds error messages, the nomenclature and forms."""

from __future__ import annotations

import functools
import types
import typing
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from frahm.case.quantities import Door


@dataclass(frozen=True)
class FieldFacts:
    """What is known about one field.

    Attributes
    ----------
    path : str
        Path in the case; ``[]`` stands for a position in a list, ``(cubic)`` for the kind of a law.
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
    elif typing.get_origin(annotation) in (typing.Union, types.UnionType):
        for kind in arguments:
            if isinstance(kind, type) and issubclass(kind, BaseModel):
                yield f"({kind.model_fields['kind'].default})", kind
    elif typing.get_origin(annotation) is typing.Annotated:
        yield from _sections(arguments[0])


def _facts(path: str, info: FieldInfo) -> FieldFacts:
    door = _door(info)
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


def _door(info: FieldInfo) -> Door | None:
    """How a value comes in; a pair of numbers comes in number by number."""
    inside = [entry for argument in typing.get_args(info.annotation) for entry in typing.get_args(argument)]
    return next((entry for entry in [*info.metadata, *inside] if isinstance(entry, Door)), None)


def _allowed_without_door(info: FieldInfo) -> str:
    sections = dict(_sections(info.annotation))
    if not sections:
        return "one of " + ", ".join(map(str, typing.get_args(info.annotation)))
    if all(suffix.startswith("(") for suffix in sections):
        return "a mapping with kind: " + " or ".join(suffix.strip("()") for suffix in sections)
    suffix, section = next(iter(sections.items()))
    names = ", ".join(section.model_fields)
    return f"a list of mappings with {names}" if suffix else f"a mapping with {names}"
