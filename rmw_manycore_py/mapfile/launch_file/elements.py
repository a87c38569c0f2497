# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Common form of XML and YAML launch files: tags with attributes, children and lines."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.bounded_yaml import MAX_DEPTH
from rmw_manycore_py.mapfile.format.document import Document, KeyPath, read_text, read_yaml
from rmw_manycore_py.mapfile.launch_file.typed_values import Kind, coerce, coerce_list, is_of_kind

# Keys that hold children in YAML; all others are attributes.
_CHILD_LISTS = (
    *("param", "remap", "env", "arg", "let", "keep", "choice"),
    *("composable_node", "extra_arg"),
)
_CHILD_BLOCKS = ("group", "timer")


@dataclass
class Element:
    """A tag; `used` collects the attributes that were read."""

    file: Path
    line: int
    tag: str
    attributes: dict[str, Any] = field(default_factory=dict)
    children: list[Element] = field(default_factory=list)
    is_yaml: bool = False
    used: set[str] = field(default_factory=set)

    def problem(self, expected: str, found: str) -> MapfileError:
        """Return an error at this tag."""
        return MapfileError(Problem(self.file, self.line, self.tag, expected, found))

    def get(self, *names: str) -> Any:
        """Return the first of these attributes that is set."""
        self.used.update(names)
        return next((self.attributes[name] for name in names if name in self.attributes), None)

    def require(self, *names: str) -> Any:
        """Return a required attribute."""
        value = self.get(*names)
        if value is None:
            raise self.problem(f"the attribute '{names[0]}'", "no such attribute")
        return value

    def typed(self, name: str, kind: Kind | None) -> Any:
        """Return an attribute of a kind, or text that may hold substitutions; None if not set.

        XML converts its texts, and splits them at the attribute `NAME-sep`; YAML checks types.
        """
        value = self.get(name)
        if value is None:
            return None
        if self.is_yaml:
            if not is_of_kind(value, kind, may_be_text=True):
                wanted = "bool, number, text or list of one of them" if kind is None else kind
                raise self.problem(f"'{name}' of type {wanted}", repr(value))
            return value
        separator = self.get(f"{name}-sep")
        if separator is None:
            return coerce(value, kind, may_be_text=True)
        if separator == "":
            raise self.problem("a separator of values", "an empty text")
        return coerce_list(value.split(separator), kind)

    def take(self, *tags: str) -> list[Element]:
        """Remove and return the children with these tags."""
        taken = [child for child in self.children if child.tag in tags]
        self.children = [child for child in self.children if child.tag not in tags]
        return taken

    def check_all_used(self) -> None:
        """Raise an error for attributes and children that were not read."""
        unknown = [name for name in self.attributes if name not in self.used]
        if unknown:
            raise self.problem(f"one of {', '.join(sorted(self.used))}", f"'{unknown[0]}'")
        if self.children:
            child = self.children[0]
            raise child.problem(f"nothing of the kind in <{self.tag}>", f"<{child.tag}>")


def read_xml(path: Path) -> Element:
    """Read the tags of an XML launch file."""
    text = read_text(path)
    root = Element(path, 1, "")
    stack = [root]
    parser = expat.ParserCreate()

    def start(tag: str, attributes: dict[str, str]) -> None:
        element = Element(path, parser.CurrentLineNumber, tag, attributes)
        if len(stack) > MAX_DEPTH:
            raise element.problem(f"at most {MAX_DEPTH} levels of tags", "more")
        stack[-1].children.append(element)
        stack.append(element)

    def characters(words: str) -> None:
        if words.strip():
            raise stack[-1].problem("tags only", repr(words.strip()))

    def entity(name: str, *_declared: Any) -> None:
        expected = "no declarations of entities"
        raise MapfileError(Problem(path, parser.CurrentLineNumber, "", expected, f"'{name}'"))

    parser.StartElementHandler = start
    parser.EntityDeclHandler = entity
    parser.EndElementHandler = lambda _tag: stack.pop()
    parser.CharacterDataHandler = characters
    try:
        parser.Parse(text, True)
    except expat.ExpatError as error:
        problem = Problem(path, error.lineno, "", "valid XML", expat.ErrorString(error.code))
        raise MapfileError(problem) from error
    launch = _launch_tag(root.children[0])
    _refuse_ros_1(launch)
    return launch


# Tags and substitutions that only launch files of ROS 1 have.
_TAGS_OF_ROS_1 = ("rosparam", "machine", "test")
_SUBSTITUTIONS_OF_ROS_1 = ("$(find ", "$(arg ", "$(optenv ")


def _refuse_ros_1(element: Element) -> None:
    """Raise an error for a launch file of ROS 1, which has the same suffixes and root tag."""
    texts = [value for value in element.attributes.values() if isinstance(value, str)]
    is_node = element.tag == "node" and "type" in element.attributes
    if is_node or element.tag in _TAGS_OF_ROS_1:
        found = f"one of ROS 1: the tag <{element.tag}{' type=...' if is_node else ''}>"
        raise element.problem("a launch file of ROS 2", found)
    for start in _SUBSTITUTIONS_OF_ROS_1:
        if any(start in text for text in texts):
            raise element.problem("a launch file of ROS 2", f"one of ROS 1: '{start}...)'")
    for child in element.children:
        _refuse_ros_1(child)


def read_yaml_elements(path: Path) -> Element:
    """Read the tags of a YAML launch file."""
    document = read_yaml(path)
    data = document.data
    if not isinstance(data, dict) or list(data) != ["launch"]:
        raise MapfileError(document.problem((), "the one key 'launch'", _kind(data)))
    return _launch_tag(_element(document, "launch", data["launch"], ("launch",)))


def _launch_tag(element: Element) -> Element:
    if element.tag != "launch":
        raise element.problem("the tag 'launch'", f"'{element.tag}'")
    return element


def _element(document: Document, tag: str, value: Any, path: KeyPath) -> Element:
    element = Element(document.file, document.line(path), tag, is_yaml=True)
    if isinstance(value, list):
        _add_children(document, element, value, path)
    elif isinstance(value, dict):
        for key, item in value.items():
            _add_key(document, element, key, item, (*path, key))
    elif value is not None:
        raise element.problem("a mapping or a list", _kind(value))
    return element


def _add_key(document: Document, element: Element, key: str, item: Any, path: KeyPath) -> None:
    if key == "children" or (key in _CHILD_BLOCKS and isinstance(item, list)):
        _add_children(document, element, item, path)
    elif key in _CHILD_LISTS and isinstance(item, list):
        element.children += [
            _element(document, key, child, (*path, i)) for i, child in enumerate(item)
        ]
    else:
        element.attributes[str(key)] = item


def _add_children(document: Document, element: Element, items: Any, path: KeyPath) -> None:
    if not isinstance(items, list):
        raise element.problem("a list of tags", _kind(items))
    for index, item in enumerate(items):
        if not isinstance(item, dict) or len(item) != 1:
            raise MapfileError(document.problem((*path, index), "one tag", _kind(item)))
        for tag, value in item.items():
            element.children.append(_element(document, str(tag), value, (*path, index, tag)))


def _kind(value: Any) -> str:
    return f"the keys {', '.join(map(str, value))}" if isinstance(value, dict) else repr(value)
