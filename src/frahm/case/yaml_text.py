"""YAML 1.2 in and out, without anything a case file has no use for."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

_CORE = "tag:yaml.org,2002:"
_MOST_NODES = 20_000
_DEEPEST = 40
_PLAIN = ("null", "bool", "int", "float", "str")
_AS_TEXT = ("timestamp", "merge", "value")  # tags of YAML 1.1 that mean nothing in 1.2


class TextError(ValueError):
    """A text that is no YAML or TOML a case can be made of; `line` counts from 1."""

    def __init__(self, problem: str, line: int | None = None):
        super().__init__(problem)
        self.line = line


@dataclass
class _Builder:
    """Builds plain data from the nodes of a document, and keeps the line of every path."""

    yaml: YAML
    lines: dict[str, int] = field(default_factory=dict)
    nodes: int = 0

    def build(self, node: Node, path: str = "", depth: int = 0) -> Any:
        # Aliases share nodes: every visit is counted, so that a small file cannot expand without end.
        self.nodes += 1
        line = node.start_mark.line + 1
        self.lines.setdefault(path, line)
        if self.nodes > _MOST_NODES or depth > _DEEPEST:
            raise TextError("the aliases or lists of this file expand beyond what a case can hold", line)
        if isinstance(node, ScalarNode):
            return self.scalar(node)
        if isinstance(node, MappingNode) and node.tag == f"{_CORE}map":
            return self.mapping(node, path, depth)
        if isinstance(node, SequenceNode) and node.tag == f"{_CORE}seq":
            return [self.build(item, f"{path}[{i}]", depth + 1) for i, item in enumerate(node.value)]
        raise TextError(f"the tag {_short(node.tag)} has no meaning in a case file", line)

    def mapping(self, node: MappingNode, path: str, depth: int) -> dict[str, Any]:
        data: dict[str, Any] = {}
        for key_node, value in node.value:
            line = key_node.start_mark.line + 1
            key = key_node.value if isinstance(key_node, ScalarNode) else None
            if not isinstance(key, str):
                raise TextError("a name must be plain text, not a list or a mapping", line)
            if key in data:
                raise TextError(f"the name {_short(key)} is given twice in the same section", line)
            below = f"{path}.{key}" if path else key
            self.lines[below] = line
            data[key] = self.build(value, below, depth + 1)
        return data

    def scalar(self, node: ScalarNode) -> Any:
        line, kind = node.start_mark.line + 1, str(node.tag).removeprefix(_CORE)
        if kind in _AS_TEXT:
            return node.value
        if kind not in _PLAIN:
            raise TextError(f"the tag {_short(node.tag)} has no meaning in a case file", line)
        try:
            return self.yaml.constructor.construct_object(node)
        except (ValueError, TypeError, ArithmeticError, LookupError, YAMLError):
            raise TextError(f"{_short(node.value)} cannot be read as {kind}", line) from None


def read_yaml(text: str) -> tuple[Any, dict[str, int]]:
    """Plain data of a YAML 1.2 document, and the line of every path in it.

    Raises
    ------
    TextError
        If the text is no YAML, or holds duplicate names, tags that build objects, or aliases that expand too far.
    """
    yaml = _yaml()
    yaml.composer.warn_double_anchors = False  # a later anchor replaces one of the same name, as YAML 1.2 has it
    reader = _Builder(yaml)
    try:
        root = yaml.compose(text)
        return (None if root is None else reader.build(root)), reader.lines
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        problem = ", ".join(part for part in (error.context, error.problem) if part) or "not readable"
        raise TextError(f"not valid YAML: {problem}", mark.line + 1 if mark else None) from None
    except RecursionError:
        raise TextError("lists or mappings are nested too deeply") from None
    except (YAMLError, ValueError, TypeError, AttributeError, LookupError, AssertionError) as error:
        if isinstance(error, TextError):
            raise
        raise TextError(f"not valid YAML: {_short(str(error).splitlines()[0] if str(error) else '')}") from None


def yaml_text(data: dict[str, Any]) -> str:
    """YAML 1.2 text of plain data, in the order given."""
    yaml: Any = _yaml()
    yaml.default_flow_style = False
    yaml.allow_unicode = True
    yaml.sort_base_mapping_type_on_output = False
    yaml.width = 10_000
    stream = io.StringIO()
    yaml.dump(data, stream)
    return stream.getvalue()


def _yaml() -> YAML:
    return YAML(typ="safe", pure=True)


def _short(value: object) -> str:
    text = str(value)
    return repr(text if len(text) <= 60 else text[:57] + "...")
