# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How a node is started: what the mapfile says, over what the launch file says."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.mapfile.format.model import NodeSection
from rmw_manycore_py.mapfile.launch_file import LaunchedNode, LaunchFile, ParameterSource
from rmw_manycore_py.mapfile.placing.parameter_files import parameters_in
from rmw_manycore_py.mapfile.programs import executables
from rmw_manycore_py.mapfile.programs.executables import Program
from rmw_manycore_py.ros import ament
from rmw_manycore_py.ros.names import full_node_name

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile


@dataclass(frozen=True)
class NodeStart:
    """Everything that goes into the command line of a node."""

    full_name: str
    program: Program
    ros_arguments: bool
    namespace: str | None
    parameters: dict[str, Any]
    param_files: tuple[Path, ...]
    remappings: tuple[tuple[str, str], ...]
    arguments: tuple[str, ...]
    raw_ros_arguments: tuple[str, ...]
    env: dict[str, str]


def node_start(mapfile: Mapfile, name: str, launch: LaunchFile | None) -> NodeStart:
    """Return how the node of that name is started; what does not exist is an error."""
    node = mapfile.sections.nodes[name]
    launched = _launched(mapfile, name, launch)
    namespace, full_name = _names(name, node, launched)
    files = tuple(mapfile.file(file) for file in node.param_file)
    sources = (*(launched.parameters if launched else ()), *files, node.parameters)
    return NodeStart(
        full_name=full_name,
        program=_program(mapfile, name, node, launched),
        ros_arguments=node.ros_arguments and not (launched and launched.command),
        namespace=namespace,
        parameters=_merged(sources, full_name),
        param_files=tuple(source for source in sources if isinstance(source, Path)),
        # In rcl the first rule that fits wins.
        remappings=(*node.remappings.items(), *(launched.remappings if launched else ())),
        arguments=(*(launched.arguments if launched else ()), *node.arguments),
        raw_ros_arguments=launched.ros_arguments if launched else (),
        env={**(launched.env if launched else {}), **node.env},
    )


def ros_arguments(
    start: NodeStart, parameters: dict[str, Any], files: Sequence[Path | str]
) -> tuple[str, ...]:
    """Return the arguments from --ros-args on."""
    if not start.ros_arguments:
        return ()
    words = ["--ros-args", "-r", f"__node:={start.full_name.rpartition('/')[2]}"]
    if start.namespace is not None:
        words += ["-r", f"__ns:={start.namespace}"]
    for source, target in start.remappings:
        words += ["-r", f"{source}:={target}"]
    words += start.raw_ros_arguments
    for file in files:
        words += ["--params-file", str(file)]
    for name, value in parameters.items():
        words += ["-p", f"{name}:={parameter_text(value)}"]
    return tuple(words)


def parameter_text(value: Any) -> str:
    """Write a value so that rcl reads the same type: strings stay strings."""
    if isinstance(value, float) and not math.isfinite(value):
        return ".nan" if math.isnan(value) else ".inf" if value > 0 else "-.inf"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(parameter_text(item) for item in value)}]"
    return json.dumps(value, ensure_ascii=False)


def _merged(sources: Sequence[ParameterSource], full_name: str) -> dict[str, Any]:
    """Return the single values that hold, to be given after all files.

    rcl ranks sections by when their node name first appears, so a value given before a file
    could win over the file; here a later file always wins.
    """
    values: dict[str, Any] = {}
    for source in sources:
        if isinstance(source, Path):
            overruled = parameters_in(source, full_name)
            values = {name: value for name, value in values.items() if name not in overruled}
        else:
            values |= source
    return values


def _names(name: str, node: NodeSection, launched: LaunchedNode | None) -> tuple[str | None, str]:
    """Return the namespace, if one is given, and the full name."""
    own, _, last = name.rpartition("/")
    namespace = node.namespace
    if namespace is None and launched is not None and launched.namespace != "/":
        namespace = launched.namespace
    if namespace is None and own:
        namespace = own
    if namespace is not None:
        namespace = f"/{namespace.strip('/')}"
    return namespace, full_node_name(namespace or "/", last)


def _launched(mapfile: Mapfile, name: str, launch: LaunchFile | None) -> LaunchedNode | None:
    """Return the node in the launch file, which is needed where the mapfile cannot start it."""
    if launch is None:
        return None
    found = [node for node in launch.nodes if _is_meant(name, node)]
    node = mapfile.sections.nodes[name]
    if len(found) > 1:
        full = ", ".join(full_node_name(one.namespace, one.label) for one in found)
        expected = "a name that one node of the launch file has"
        raise MapfileError(mapfile.document.problem(("nodes", name), expected, f"several: {full}"))
    if not found and not (node.module or node.script or node.executable or node.command):
        known = ", ".join(sorted({one.label for one in launch.nodes})) or "none"
        expected = f"a node of {launch.file.name} ({known})"
        raise MapfileError(mapfile.document.problem(("nodes", name), expected, f"'{name}'"))
    return found[0] if found else None


def _is_meant(name: str, launched: LaunchedNode) -> bool:
    if "/" in name:
        return full_node_name(launched.namespace, launched.label) == f"/{name.strip('/')}"
    return launched.label == name


def _program(
    mapfile: Mapfile, name: str, node: NodeSection, launched: LaunchedNode | None
) -> Program:
    directory = mapfile.path.parent.resolve()
    problem = mapfile.document.problem
    if node.script is not None:
        return executables.find_script(mapfile.file(node.script))
    if node.module is not None:
        found, key = executables.find_module(node.module, directory), "module"
        missing = problem(("nodes", name, key), "an installed Python module", f"'{node.module}'")
    elif node.package is not None and node.executable is not None:
        found = executables.find_executable(node.package, node.executable)
        expected = _expected_executable(node.package)
        missing = problem(("nodes", name, "executable"), expected, f"'{node.executable}'")
    elif node.command is not None:
        found = executables.find_command(node.command, directory)
        expected, word = _expected_command(node.command, directory)
        missing = problem(("nodes", name, "command"), expected, f"'{word}'")
    else:
        assert launched is not None
        return _launched_program(launched, directory)
    if found is None:
        raise MapfileError(missing)
    return found


def _launched_program(launched: LaunchedNode, directory: Path) -> Program:
    if launched.package is not None and launched.executable is not None:
        found = executables.find_executable(launched.package, launched.executable)
        expected, wanted = _expected_executable(launched.package), launched.executable
    else:
        found = executables.find_command(launched.command, directory)
        expected, wanted = _expected_command(launched.command, directory)
    if found is None:
        problem = Problem(launched.file, launched.line, launched.label, expected, f"'{wanted}'")
        raise MapfileError(problem)
    return found


def _expected_command(words: Sequence[str], directory: Path) -> tuple[str, str]:
    """Return what is expected, and the word of the command that does not name such a thing."""
    word = executables.unfound_script(words, directory)
    if word is None:
        return "an executable", words[0]
    return "an existing Python file" if word.endswith(".py") else "an installed Python module", word


def _expected_executable(package: str) -> str:
    known = executables.executables_of(package)
    if known or ament.package_prefix(package):
        return f"an executable of the package '{package}' ({', '.join(known) or 'it has none'})"
    return f"an executable of the package '{package}' (it is not installed)"
