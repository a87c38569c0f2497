# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Extracts names, topics and types from Python sources of nodes, without executing them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from rmw_manycore_py.errors import MapfileError, Problem, what_is_wrong
from rmw_manycore_py.mapfile.format.document import read_bytes

_CALLS = {
    "create_publisher": "publish",
    "create_lifecycle_publisher": "publish",
    "create_subscription": "subscribe",
}
_QOS_ARGUMENT = {"publish": 2, "subscribe": 3}
# Excludes the parts of services and actions (SetBool_Request), which are not listed as types.
_INTERFACE = re.compile(r"\w+\.(msg|srv|action)\.[A-Z][A-Za-z0-9]*")
_NODE_CLASSES = ("Node", "LifecycleNode")
# Calls that take a node and create no publisher of a topic on it.
_WITHOUT_PUBLISHER = (
    *("rclpy.", "message_filters.", "tf2_ros.TransformListener", "tf2_ros.transform_listener."),
)


@dataclass
class SourceNode:
    """A node found in a source; `unclear` holds the lines of computed topics.

    `depths` holds the literal QoS depths, by the key that lists the topic and its name.
    `is_shared` says whether other code gets the node, and may create publishers on it.
    """

    file: Path
    line: int
    name: str | None
    publish: dict[str, str] = field(default_factory=dict)
    subscribe: dict[str, str] = field(default_factory=dict)
    unclear: list[int] = field(default_factory=list)
    depths: dict[tuple[str, str], int] = field(default_factory=dict)
    is_shared: bool = False

    @property
    def shows_publishers(self) -> bool:
        """Return whether `publish` has all topics that the node publishes."""
        return not self.unclear and not self.is_shared


@dataclass(frozen=True)
class SourceFile:
    """A parsed Python file: its nodes in line order, and the interface types that it imports.

    `interfaces` are the unconditional imports, each with its line; `is_program` says whether it
    starts something by itself, instead of by an entry point of its package.
    """

    nodes: list[SourceNode]
    interfaces: dict[str, int]
    is_program: bool


class Sources:
    """Python files of the nodes of a mapfile; parses each file once."""

    def __init__(self) -> None:
        self._files: dict[Path, SourceFile | None] = {}

    def read(self, file: Path) -> SourceFile | None:
        """Return a file; None if it is not valid Python, which Python reports at run time."""
        if file not in self._files:
            try:
                self._files[file] = read_source(file)
            except MapfileError:
                self._files[file] = None
        return self._files[file]


def read_source(file: Path) -> SourceFile:
    """Parse a Python file; raise MapfileError if it is not valid Python."""
    tree = _parse(file)
    return SourceFile(_nodes(file, tree), _interfaces(tree), _is_program(tree))


def _is_program(tree: ast.Module) -> bool:
    """Return whether the module runs something when it is started."""
    starts = (
        *(ast.If, ast.Match, ast.Expr, ast.Assert, ast.Raise),
        *(ast.Try, ast.With, ast.While, ast.For),
    )
    return any(
        isinstance(node, ast.Call)
        for part in tree.body
        if isinstance(part, starts)
        for node in ast.walk(part)
    )


def _nodes(file: Path, tree: ast.Module) -> list[SourceNode]:
    names = _Names(tree)
    classes = [node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]
    nodes = [found for cls in classes if (found := _class_node(file, cls, names))]
    in_classes = {id(node) for cls in classes for node in ast.walk(cls)}
    rest = [node for node in ast.walk(tree) if id(node) not in in_classes]
    nodes += _function_nodes(file, rest, names)
    return sorted(nodes, key=lambda node: node.line)


def _interfaces(tree: ast.Module) -> dict[str, int]:
    imports = (part for part in tree.body if isinstance(part, ast.ImportFrom))
    return {
        f"{part.module}.{alias.name}".replace(".", "/"): part.lineno
        for part in imports
        for alias in part.names
        if _INTERFACE.fullmatch(f"{part.module}.{alias.name}") and not part.level
    }


def _parse(file: Path) -> ast.Module:
    try:
        return ast.parse(read_bytes(file), str(file))  # knows byte order marks and cookies
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        line = getattr(error, "lineno", None) or 0
        raise MapfileError(Problem(file, line, "", "valid Python", what_is_wrong(error))) from error


class _Names:
    """Resolves names: imported message types and module constants."""

    def __init__(self, tree: ast.Module) -> None:
        self._imported: dict[str, str] = {}
        self._constants: dict[str, str] = {}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
                for alias in node.names:
                    self._imported[alias.asname or alias.name] = f"{node.module}.{alias.name}"
            elif isinstance(node, ast.Import):
                for alias in node.names:
                    self._imported[alias.asname or alias.name.split(".")[0]] = (
                        alias.name if alias.asname else alias.name.split(".")[0]
                    )
            elif isinstance(node, ast.Assign):
                self._note_constant(node)

    def _note_constant(self, node: ast.Assign) -> None:
        if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            for target in node.targets:
                if isinstance(target, ast.Name):
                    self._constants[target.id] = node.value.value

    def qualified(self, node: ast.expr) -> str:
        """Return a dotted name with its first part replaced by its import."""
        if isinstance(node, ast.Name):
            return self._imported.get(node.id, node.id)
        if isinstance(node, ast.Attribute):
            return f"{self.qualified(node.value)}.{node.attr}"
        return ""

    def message_type(self, node: ast.expr) -> str | None:
        """Return package/msg/Name for an expression such as String or std_msgs.msg.String."""
        parts = self.qualified(node).split(".")
        return "/".join(parts) if len(parts) == 3 and parts[1] == "msg" else None

    def text(self, node: ast.expr) -> str | None:
        """Return the value of a string literal or string constant."""
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            return node.value
        return self._constants.get(node.id) if isinstance(node, ast.Name) else None


def _class_node(file: Path, cls: ast.ClassDef, names: _Names) -> SourceNode | None:
    calls = list(_calls(list(ast.walk(cls))))
    is_node = any(names.qualified(b).split(".")[-1] in _NODE_CLASSES for b in cls.bases)
    if not is_node and not any(_method(call) in _CALLS for call in calls):
        return None
    node = SourceNode(file, cls.lineno, None)
    node.is_shared = any(_shares(call, {"self"}, names) for call in calls)
    for call in calls:
        if _is_super_init(call):
            node.name = _argument_text(call, 0, "node_name", names)
    _add_topics(node, calls, names)
    return node


def _function_nodes(file: Path, rest: list[ast.AST], names: _Names) -> list[SourceNode]:
    """Return nodes created outside classes; topics belong to the node created before them."""
    calls = sorted(_calls(rest), key=lambda call: call.lineno)
    variables = {
        target.id
        for part in rest
        if isinstance(part, ast.Assign) and _creates_node(part.value, names)
        for target in part.targets
        if isinstance(target, ast.Name)
    }
    nodes: list[SourceNode] = []
    for call in calls:
        if _creates_node(call, names):
            name = _argument_text(call, 0, "node_name", names)
            nodes.append(SourceNode(file, call.lineno, name))
        elif _method(call) in _CALLS and nodes:
            _add_topics(nodes[-1], [call], names)
        elif nodes and _shares(call, variables, names):
            nodes[-1].is_shared = True
    return nodes


def _creates_node(value: ast.expr, names: _Names) -> bool:
    made = names.qualified(value.func) if isinstance(value, ast.Call) else ""
    return made.endswith("create_node") or made in ("rclpy.node.Node", "rclpy.Node")


def _shares(call: ast.Call, variables: set[str], names: _Names) -> bool:
    """Return whether a call gets the node in one of the variables, and may publish with it."""
    function = names.qualified(call.func)
    is_quiet = function == "super" or function.startswith(_WITHOUT_PUBLISHER)
    if is_quiet or _method(call) == "add_node":
        return False
    given = (*call.args, *(keyword.value for keyword in call.keywords))
    return any(isinstance(value, ast.Name) and value.id in variables for value in given)


def _add_topics(node: SourceNode, calls: list[ast.Call], names: _Names) -> None:
    for call in calls:
        kind = _CALLS.get(_method(call))
        if kind is None:
            continue
        type_node = _argument(call, 0, "msg_type")
        message_type = names.message_type(type_node) if type_node is not None else None
        topic = _argument_text(call, 1, "topic", names)
        if message_type is None or topic is None:
            node.unclear.append(call.lineno)
        else:
            getattr(node, kind)[topic] = message_type
            depth = _depth(_argument(call, _QOS_ARGUMENT[kind], "qos_profile"))
            if depth is not None:
                node.depths[kind, topic] = depth


def _depth(qos: ast.expr | None) -> int | None:
    """Return the depth in 10 or QoSProfile(depth=10)."""
    if isinstance(qos, ast.Call):
        qos = next((keyword.value for keyword in qos.keywords if keyword.arg == "depth"), None)
    value = qos.value if isinstance(qos, ast.Constant) else None
    return value if type(value) is int else None


def _calls(nodes: list[ast.AST]) -> Iterator[ast.Call]:
    return (node for node in nodes if isinstance(node, ast.Call))


def _method(call: ast.Call) -> str:
    return call.func.attr if isinstance(call.func, ast.Attribute) else ""


def _is_super_init(call: ast.Call) -> bool:
    if _method(call) != "__init__" or not isinstance(call.func, ast.Attribute):
        return False
    owner = call.func.value
    return isinstance(owner, ast.Call) and getattr(owner.func, "id", "") == "super"


def _argument(call: ast.Call, index: int, name: str) -> ast.expr | None:
    if len(call.args) > index:
        return call.args[index]
    return next((keyword.value for keyword in call.keywords if keyword.arg == name), None)


def _argument_text(call: ast.Call, index: int, name: str, names: _Names) -> str | None:
    node = _argument(call, index, name)
    return None if node is None else names.text(node)
