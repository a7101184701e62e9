"""From the findings of the validation to one message a user can act on."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from frahm.case.documents import check_mapping, place
from frahm.case.fields import FieldFacts, children, field_table, kinds
from frahm.errors import ParameterError, nearest

_SHOWN = 5
_COMPARED = 100  # unknown names that are compared with those of the fields
Model = TypeVar("Model", bound=BaseModel)
Where = Callable[[str], str | None]


class _Nothing:
    def __repr__(self) -> str:
        return "nothing"


def model_from_data(
    model: type[Model], data: Any, what: str, sections: str, source: str | None, lines: Mapping[str, int] | None
) -> Model:
    """A case or a study of plain data; what is wrong is said with the line of the `source` where there is one."""
    check_mapping(data, what, sections, source)
    try:
        return model(**data)
    except ParameterError as error:
        if source is None or not isinstance(error.__cause__, ValidationError):
            raise error from None
        raise parameter_error(error.__cause__, model, functools.partial(place, source, lines or {})) from None


def parameter_error(error: ValidationError, model: type[BaseModel], where: Where | None = None) -> ParameterError:
    """Return the first problem as a `ParameterError`; further ones follow, a line each.

    Parameters
    ----------
    error : ValidationError
        What the validation found.
    model : type of BaseModel
        The model that was validated.
    where : callable, optional
        File and line of a field path.

    Returns
    -------
    ParameterError
        With the path of the field, the value given and what is allowed.
    """
    found = error.errors(include_url=False)
    unknown = [entry for entry in found if entry["type"] == "extra_forbidden"]
    rest = [entry for entry in found if entry["type"] != "extra_forbidden"]
    if rest:  # a misspelt name is not reported as missing, too
        meant = {_key([*e["loc"][:-1], near], model) for e in unknown[:_COMPARED] if (near := _near(e["loc"], model))}
        rest = [entry for entry in rest if _key(entry["loc"], model) not in meant]
    chosen = [*unknown, *rest]
    first, *others = (_problem(entry, model, where) for entry in chosen[: 1 + _SHOWN])
    also = [*first.also, *(f"Also: {str(other).splitlines()[0]}" for other in others)]
    also += [f"And {len(chosen) - 1 - _SHOWN} more."] if len(chosen) > 1 + _SHOWN else []
    return ParameterError(first.name, first.value, first.allowed, where=first.where, hint=first.hint, also=also)


def field_path(loc: Sequence[int | str], model: type[BaseModel]) -> str:
    """Path as a user writes it: absorbers[0].law.stiffness."""
    parts = [part for part, word in zip(loc, _words(loc, model), strict=True) if word is None]
    return "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in parts).lstrip(".")


def _key(loc: Sequence[int | str], model: type[BaseModel]) -> str:
    """Path in the table of fields: absorbers[].law(cubic).stiffness."""
    path = ""
    for part, word in zip(loc, _words(loc, model), strict=True):
        path += ("[]" if isinstance(part, int) else f".{part}") if word is None else word
    return path.lstrip(".")


def _words(loc: Sequence[int | str], model: type[BaseModel]) -> list[str | None]:
    """For each part of a location that is the kind of a section, what the path in the table of fields says for it."""
    choices, path = kinds(model), ""
    words: list[str | None] = []
    for part in loc:
        new = bool(words) and words[-1] is None and isinstance(part, str)
        word = choices.get(path.lstrip("."), {}).get(str(part)) if new else None
        path += ("[]" if isinstance(part, int) else f".{part}") if word is None else word
        words.append(word)
    return words


def _near(loc: Sequence[int | str], model: type[BaseModel]) -> str | None:
    return nearest(str(loc[-1]), _siblings(loc, model))


def _siblings(loc: Sequence[int | str], model: type[BaseModel]) -> list[str]:
    parent = _key(loc, model)[: -len(str(loc[-1]))].rstrip(".")
    return children(model, parent)


def _problem(entry: Mapping[str, Any], model: type[BaseModel], where: Where | None) -> ParameterError:
    loc, context = entry["loc"], entry.get("ctx", {})
    path, value, hint, also = field_path(loc, model), entry.get("input"), None, ()
    facts = _facts_at(loc, model)
    if entry["type"] == "parameter":
        path, allowed, hint = context["path"] or path, context["allowed"], context["hint"]
        also = context["also"]
        value = context["given"] if context["path"] else value
    elif entry["type"] == "extra_forbidden":
        near = _near(loc, model)
        allowed = "no such field here, only " + ", ".join(_siblings(loc, model))
        hint = f"Did you mean {near!r}?" if near else None
    elif entry["type"] == "missing":
        value, allowed = _Nothing(), f"{facts.allowed} (required)" if facts else "a value (required)"
    elif entry["type"] in ("union_tag_invalid", "union_tag_not_found"):
        return _wrong_kind(path, value, list(kinds(model).get(_key(loc, model), {})), where)
    else:
        allowed = facts.allowed if facts else entry["msg"]
    return ParameterError(path or "case", value, allowed, where=where(path) if where else None, hint=hint, also=also)


def _wrong_kind(path: str, value: Any, known: list[str], where: Where | None) -> ParameterError:
    given = value.get("kind", _Nothing()) if isinstance(value, dict) else _Nothing()
    near = nearest(given, known) if isinstance(given, str) else None
    path = f"{path}.kind"
    hint = f"Did you mean {near!r}?" if near else None
    return ParameterError(path, given, "one of " + ", ".join(known), where=where(path) if where else None, hint=hint)


def _facts_at(loc: Sequence[int | str], model: type[BaseModel]) -> FieldFacts | None:
    table, key = field_table(model), _key(loc, model)
    facts = table.get(key) or table.get(key.removesuffix("[]"))
    if facts and key.endswith("[]"):
        return dataclasses.replace(facts, allowed=facts.allowed.replace("a list of mappings", "a mapping"))
    return facts
