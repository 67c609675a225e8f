"""YAML text as plain values, together with where each of them stands.

Scalars are read by the rules of YAML 1.2 (core schema): only `true` and `false` are booleans, `12:30` and
dates are text, `010` is ten. With the rules of YAML 1.1 `on` would be a boolean and `12:30` the number 750.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import yaml

try:
    from yaml import CSafeLoader as _Loader
except ImportError:  # PyYAML built without libyaml: slower, otherwise the same
    from yaml import SafeLoader as _Loader  # type: ignore[assignment]

Path: TypeAlias = tuple[str | int, ...]
Place: TypeAlias = tuple[int, int]

_TAG: Final = "tag:yaml.org,2002:"
_MOST_DIGITS: Final = 18  # a whole number with more of them is not exact anyway
_DEEPEST: Final = 40  # levels; libyaml's composer overflows the stack at some ten thousand
_TOO_DEEP: Final = f"lists and sections nest deeper than {_DEEPEST} levels"
_MOST_NODES: Final = 200_000  # aliases of aliases can stand for billions


class _CoreLoader(_Loader):
    """Resolves plain scalars by the core schema of YAML 1.2 (section 10.3.2)."""

    yaml_implicit_resolvers: dict[str, list[Any]] = {}  # noqa: RUF012 (PyYAML adds to it)


for _name, _pattern, _first in (
    ("null", r"~|null|Null|NULL|", "~nN"),
    ("bool", r"true|True|TRUE|false|False|FALSE", "tTfF"),
    ("int", r"[-+]?[0-9]+", "-+0123456789"),
    ("float", r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?", "-+.0123456789"),
    ("float", r"[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)", "-+."),
):
    _CoreLoader.add_implicit_resolver(
        _TAG + _name, re.compile(f"(?:{_pattern})$"), [*_first, *([""] if _name == "null" else [])]
    )


class MarkedError(ValueError):
    """YAML text that does not parse, and where."""

    def __init__(self, message: str, line: int, column: int) -> None:
        self.message, self.line, self.column = message, line, column
        super().__init__(message)


@dataclass(frozen=True, slots=True)
class Marks:
    """Where the values of a YAML text stand; lines and columns count from 1."""

    root: yaml.Node

    def place(self, path: Sequence[str | int]) -> Place:
        """Line and column of the value at a path, or of its nearest ancestor that exists."""
        return _start(self._walk(path)[0])

    def key_place(self, path: Sequence[str | int]) -> Place:
        """Line and column of the key at a path; those of `place` for an entry of a list or an absent key."""
        parent, known = self._walk(path[:-1])
        pair = _pair(parent, path[-1]) if path and len(known) == len(path) - 1 else None
        return self.place(path) if pair is None else _start(pair[0])

    def written(self, path: Sequence[str | int]) -> Path:
        """A path of the model as the file shows it.

        A short form (`cost: time`, a polygon as a list) has fewer levels than the model: parts of the path
        that the file does not have are left out, except an absent field of a section.
        """
        node, known = self.root, list[str | int]()
        for part in path:
            child = _child(node, part)
            if child is None and isinstance(node, yaml.ScalarNode):
                break
            if child is None and isinstance(node, yaml.SequenceNode) and isinstance(part, str):
                continue
            known.append(part)
            if child is None:
                break
            node = child
        return tuple(known)

    def _walk(self, path: Sequence[str | int]) -> tuple[yaml.Node, Path]:
        node, known = self.root, list[str | int]()
        for part in path:
            child = _child(node, part)
            if child is None:
                break
            node = child
            known.append(part)
        return node, tuple(known)


def compose(text: str) -> Marks | None:
    """The marks of a YAML text, None where it holds nothing; raises `MarkedError`."""
    _check_depth(text)
    root = yaml.compose(text, Loader=_CoreLoader)
    return None if root is None else Marks(root)


def _check_depth(text: str) -> None:
    depth = 0
    for event in yaml.parse(text, Loader=_CoreLoader):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > _DEEPEST:
            raise MarkedError(_TOO_DEEP, *_start(event))


class Values:
    """Plain values of the nodes (`value`), and what is wrong with the YAML itself (`findings`).

    A finding is the path, the place and the message.
    """

    def __init__(self, marks: Marks) -> None:
        self.findings: list[tuple[Path, Place, str]] = []
        self._nodes = 0
        self._open: set[int] = set()
        self.value: object = self._build(marks.root, ())

    def _build(self, node: yaml.Node, path: Path) -> object:
        self._nodes += 1
        if self._nodes > _MOST_NODES:
            raise MarkedError(f"more than {_MOST_NODES} values; aliases (*name) multiply", *_start(node))
        if id(node) in self._open:
            raise MarkedError("an alias (*name) stands inside of what it stands for", *_start(node))
        if len(self._open) > _DEEPEST:
            raise MarkedError(_TOO_DEEP, *_start(node))
        if isinstance(node, yaml.ScalarNode):
            return self._scalar(node, path)
        self._open.add(id(node))
        try:
            return self._mapping(node, path) if isinstance(node, yaml.MappingNode) else self._list(node, path)
        finally:
            self._open.discard(id(node))

    def _list(self, node: yaml.Node, path: Path) -> list[object]:
        self._check_tag(node, path, "seq")
        return [self._build(child, (*path, index)) for index, child in enumerate(node.value)]

    def _mapping(self, node: yaml.Node, path: Path) -> dict[str, object]:
        self._check_tag(node, path, "map")
        built: dict[str, object] = {}
        first: dict[str, int] = {}
        for key, child in node.value:
            name = key.value
            if not isinstance(key, yaml.ScalarNode) or not name:
                self.findings.append((path, _start(key), "a field's name is expected before the ':'"))
            elif name in built:
                message = f"appears twice, first in line {first[name]}; keep one of the two"
                self.findings.append(((*path, name), _start(key), message))
            else:
                first[name] = _start(key)[0]
                built[name] = self._build(child, (*path, name))
        return built

    def _scalar(self, node: yaml.ScalarNode, path: Path) -> object:
        kind, text = node.tag.removeprefix(_TAG), node.value
        if kind == "null" and path:
            self.findings.append((path, _start(node), "is empty; give it a value or leave the field out"))
            return None
        try:
            return _plain(kind, text)
        except (ValueError, KeyError):
            self._check_tag(node, path, "str")
            return text

    def _check_tag(self, node: yaml.Node, path: Path, kind: str) -> None:
        if node.tag != _TAG + kind:
            tag = node.tag.replace(_TAG, "!!")
            self.findings.append((path, _start(node), f"the tag {tag!r} has no meaning here; leave it out"))


def _plain(kind: str, text: str) -> object:
    """A scalar's value; a `ValueError` or `KeyError` where an explicit tag does not fit."""
    if kind == "str":
        return text
    if kind == "null":
        return None
    if kind == "bool":
        return {"true": True, "false": False}[text.lower()]
    if kind == "int" and len(text) <= _MOST_DIGITS:
        return int(text)
    if kind in ("int", "float"):
        return float(text.lower().replace(".inf", "inf").replace(".nan", "nan"))
    raise ValueError(kind)


def _start(node: yaml.Node | yaml.Event) -> Place:
    mark = node.start_mark
    return (1, 1) if mark is None else (mark.line + 1, mark.column + 1)


def _pair(node: yaml.Node, part: str | int) -> tuple[yaml.Node, yaml.Node] | None:
    if not isinstance(node, yaml.MappingNode):
        return None
    return next(((key, child) for key, child in node.value if key.value == str(part)), None)


def _child(node: yaml.Node, part: str | int) -> yaml.Node | None:
    if isinstance(node, yaml.SequenceNode):
        inside = isinstance(part, int) and 0 <= part < len(node.value)
        found: yaml.Node | None = node.value[part] if inside else None
        return found
    pair = _pair(node, part)
    return None if pair is None else pair[1]
