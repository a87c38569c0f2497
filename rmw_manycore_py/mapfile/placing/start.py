# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How a node is started: settings of the mapfile override those of the launch file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.model import NodeSection
from rmw_manycore_py.mapfile.launch_file import LaunchedNode, LaunchFile
from rmw_manycore_py.mapfile.placing.launched import (
    expected_command,
    find_launched,
    missing_executable,
    program_of,
)
from rmw_manycore_py.mapfile.placing.parameters import (
    Launched,
    NodeName,
    Source,
    given_values,
    sources_of,
)
from rmw_manycore_py.mapfile.programs import executables
from rmw_manycore_py.mapfile.programs.executables import Program
from rmw_manycore_py.mapfile.programs.source import SourceFile, SourceNode, Sources
from rmw_manycore_py.ros.names import full_node_name, resolve_topic

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile


@dataclass(frozen=True)
class NodeStart:
    """Settings of a node from the mapfile, the launch file and its source."""

    full_name: str
    program: Program
    ros_arguments: bool
    namespace: str | None
    parameters: dict[str, Any]
    parameter_sources: tuple[Source, ...]
    remappings: tuple[tuple[str, str], ...]
    arguments: tuple[str, ...]
    raw_ros_arguments: tuple[str, ...]
    env: dict[str, str]
    is_named: bool = True  # else the node keeps the name set by its code
    directory: str | None = None
    launched: Launched | None = None
    missing: tuple[Problem, ...] = ()  # why there is no program
    source: SourceFile | None = None

    @property
    def shown(self) -> SourceNode | None:
        """The node as its source shows it; None if the source has several nodes, or none."""
        nodes = self.source.nodes if self.source else []
        return nodes[0] if len(nodes) == 1 else None

    def topic(self, name: str) -> str:
        """Return the full name of a topic, service or action that the node knows as `name`."""
        return resolve_topic(name, self.full_name, self.remappings)


def node_starts(
    mapfile: Mapfile, launch: LaunchFile | None, *, is_plan: bool = False
) -> dict[str, NodeStart]:
    """Return how each node is started; raise MapfileError for what does not exist.

    :param is_plan: whether programs may be missing.
    """
    starts: dict[str, NodeStart] = {}
    owners: dict[str, str] = {}
    problems: list[Problem] = []
    python_files = Sources()
    for name in mapfile.sections.nodes:
        try:
            start = node_start(mapfile, name, launch, python_files)
        except MapfileError as error:
            problems += error.problems
            continue
        if not is_plan:
            problems += start.missing
        starts[name] = start
        if start.full_name in owners and not _has_number(start):
            found = f"{start.full_name}, the name of '{owners[start.full_name]}'"
            problems.append(mapfile.document.problem(("nodes", name), "a name of its own", found))
        owners.setdefault(start.full_name, name)
    if problems:
        raise MapfileError(*problems)
    return starts


def _has_number(start: NodeStart) -> bool:
    """Return whether the launch file starts several nodes of one name."""
    return isinstance(start.launched, LaunchedNode) and start.launched.number > 1


def node_start(
    mapfile: Mapfile, name: str, launch: LaunchFile | None, python_files: Sources
) -> NodeStart:
    """Return how a node is started, or in `missing` why its program does not exist."""
    node = mapfile.sections.nodes[name]
    launched = find_launched(mapfile, name, launch)
    namespace, full_name = _names(name, node, launched)
    files = tuple(mapfile.file(file) for file in node.param_file)
    process = launched if isinstance(launched, LaunchedNode) else None
    is_plain = process is not None and process.executable is None
    is_named = process is None or process.name is not None
    takes_arguments = node.ros_arguments and not is_plain
    sources: tuple[Source, ...] = ()
    if takes_arguments:
        sources = sources_of(launched, files, node.parameters, NodeName(full_name, is_named))
    missing: tuple[Problem, ...] = ()
    try:
        program = _program(mapfile, name, node, launched)
    except MapfileError as error:
        program, missing = Program(()), error.problems
    return NodeStart(
        full_name=full_name,
        program=program,
        missing=missing,
        ros_arguments=takes_arguments,
        namespace=namespace,
        parameters=given_values(sources, launched, full_name),
        parameter_sources=sources,
        # In rcl the first matching rule takes effect.
        remappings=(*node.remappings.items(), *(launched.remappings if launched else ())),
        arguments=(*(process.arguments if process else ()), *node.arguments),
        raw_ros_arguments=process.ros_arguments if process else (),
        env={**(process.env if process else {}), **node.env},
        is_named=is_named,
        directory=process.cwd if process else None,
        launched=launched,
        source=python_files.read(program.source) if program.source else None,
    )


def ros_arguments(start: NodeStart) -> tuple[str, ...]:
    """Return the arguments from --ros-args on, except parameters."""
    if not start.ros_arguments:
        return ()
    words = ["--ros-args"]
    if start.is_named:
        words += ["-r", f"__node:={start.full_name.rpartition('/')[2]}"]
    if start.namespace is not None:
        words += ["-r", f"__ns:={start.namespace}"]
    for source, target in start.remappings:
        words += ["-r", f"{source}:={target}"]
    return (*words, *start.raw_ros_arguments)


def _names(name: str, node: NodeSection, launched: Launched | None) -> tuple[str | None, str]:
    """Return the namespace, if given, and the full name."""
    own, _, last = name.rpartition("/")
    namespace = node.namespace
    if namespace is None and launched is not None and launched.namespace != "/":
        namespace = launched.namespace
    if namespace is None and own:
        namespace = own
    if namespace is not None:
        namespace = f"/{namespace.strip('/')}"
    if isinstance(launched, LaunchedNode) and launched.number > 1 and launched.name:
        last = launched.name
    return namespace, full_node_name(namespace or "/", last)


def _program(mapfile: Mapfile, name: str, node: NodeSection, launched: Launched | None) -> Program:
    directory = mapfile.path.parent.resolve()
    problem = mapfile.document.problem
    if node.script is not None:
        return executables.find_script(mapfile.file(node.script))
    if node.module is not None:
        found, key = executables.find_module(node.module, directory), "module"
        missing = problem(("nodes", name, key), "an installed Python module", f"'{node.module}'")
    elif node.package is not None and node.executable is not None:
        found = executables.find_executable(node.package, node.executable)
        expected, instead = missing_executable(node.package, node.executable)
        missing = problem(("nodes", name, "executable"), expected, instead)
    elif node.command is not None:
        found = executables.find_command(node.command, directory)
        expected, word = expected_command(node.command, directory)
        missing = problem(("nodes", name, "command"), expected, f"'{word}'")
    else:
        assert launched is not None
        return program_of(launched, directory)
    if found is None:
        raise MapfileError(missing)
    return found
