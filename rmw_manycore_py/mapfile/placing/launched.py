# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Matches nodes of the mapfile with nodes of the launch file, and extracts their settings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmw_manycore_py.errors import MapfileError, Problem
from rmw_manycore_py.errors.suggestions import did_you_mean
from rmw_manycore_py.mapfile.launch_file import (
    ExpandedFile,
    LaunchedComponent,
    LaunchedNode,
    LaunchFile,
    ParameterSource,
    read_launch_file,
)
from rmw_manycore_py.mapfile.launch_file.unavailable import missing_package
from rmw_manycore_py.mapfile.placing.parameters import Launched
from rmw_manycore_py.mapfile.placing.placement import LaunchRules, PlacedComponent
from rmw_manycore_py.mapfile.programs import executables
from rmw_manycore_py.mapfile.programs.executables import Program
from rmw_manycore_py.ros import ament
from rmw_manycore_py.ros.names import full_node_name
from rmw_manycore_py.ros.parameter_files import read_file, read_text, values_for

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile


def read_launch(mapfile: Mapfile) -> LaunchFile | None:
    """Read the launch file of a mapfile, if it has one."""
    sections = mapfile.sections
    if sections.launch_path is None:
        return None
    launch = read_launch_file(mapfile.file(sections.launch_path), sections.launch_arguments)
    undeclared = (name for name in sections.launch_arguments if name not in launch.arguments)
    notices = (_undeclared(mapfile, name, launch) for name in undeclared)
    return replace(launch, notices=(*launch.notices, *notices))


def _undeclared(mapfile: Mapfile, name: str, launch: LaunchFile) -> str:
    """Return the notice of an argument that the launch file may use all the same."""
    line = mapfile.document.line(("launch_arguments", name))
    declared = ", ".join(sorted(launch.arguments)) or "nothing"
    hint = did_you_mean(name, launch.arguments)
    return (
        f"{mapfile.path}:{line}: launch_arguments.{name}: {launch.file.name} does not declare it "
        f"(it declares {declared}){hint}"
    )


def find_launched(mapfile: Mapfile, name: str, launch: LaunchFile | None) -> Launched | None:
    """Return the node in the launch file; required if the mapfile cannot start it itself."""
    if launch is None:
        return None
    components = [one for node in launch.nodes for one in node.components]
    nodes: list[Launched] = [one for one in launch.nodes if is_meant(name, one)]
    found = nodes or [one for one in components if is_meant(name, one)]
    node = mapfile.sections.nodes[name]
    if len(found) > 1:
        full = ", ".join(full_node_name(one.namespace, one.label) for one in found)
        expected = "a name that one node of the launch file has"
        raise MapfileError(mapfile.document.problem(("nodes", name), expected, f"several: {full}"))
    if not found and not (node.module or node.script or node.executable or node.command):
        labels = {one.label for one in launch.nodes} | {one.label for one in components}
        known = ", ".join(sorted(labels)) or "none"
        expected = f"a node of {launch.file.name} ({known})"
        raise MapfileError(mapfile.document.problem(("nodes", name), expected, f"'{name}'"))
    return found[0] if found else None


def is_meant(name: str, launched: Launched) -> bool:
    """Return whether a name in the mapfile refers to this node."""
    if "/" in name:
        return full_node_name(launched.namespace, launched.label) == f"/{name.strip('/')}"
    return launched.label == name


def program_of(launched: Launched, directory: Path) -> Program:
    """Return the program of a node in a launch file; raise an error if it is not installed."""
    if isinstance(launched, LaunchedComponent):
        return _program_of_component(launched)
    if launched.problem is not None:
        raise MapfileError(launched.problem)
    if launched.package is not None and launched.executable is not None:
        found = executables.find_executable(launched.package, launched.executable)
        expected, instead = missing_executable(launched.package, launched.executable)
    else:
        found = executables.find_command(launched.command, directory)
        expected, word = expected_command(launched.command, directory)
        instead = f"'{word}'"
    if found is None:
        problem = Problem(launched.file, launched.line, launched.label, expected, instead)
        raise MapfileError(problem)
    return replace(found, prefix=launched.prefix)


def _program_of_component(component: LaunchedComponent) -> Program:
    found = executables.find_component(component.package, component.plugin)
    if found is None:
        expected = (
            f"an executable of the package '{component.package}' that starts {component.plugin} "
            "alone, or its container in the mapfile in place of it"
        )
        place = (component.file, component.line, component.label)
        raise MapfileError(Problem(*place, expected, "none"))
    return found


def expected_command(words: tuple[str, ...] | list[str], directory: Path) -> tuple[str, str]:
    """Return what is expected, and the word of the command that does not match it."""
    word = executables.unfound_script(words, directory)
    if word is None:
        return "an executable", words[0]
    return "an existing Python file" if word.endswith(".py") else "an installed Python module", word


def missing_executable(package: str, executable: str) -> tuple[str, str]:
    """Return what is expected and found where a package has no such executable."""
    known = executables.executables_of(package)
    has_directory = any((prefix / "lib" / package).is_dir() for prefix in ament.prefixes())
    if not known and not has_directory and ament.package_prefix(package) is None:
        error = missing_package(package)
        return error.expected, error.found
    names = ", ".join(known) or "it has none"
    return f"an executable of the package '{package}' ({names})", f"'{executable}'"


def launch_rules(
    name: str, launched: Mapping[str, Launched | None]
) -> tuple[LaunchRules, tuple[str, ...]]:
    """Return the launch file's rules for a mapped node, and notices."""
    own = launched[name]
    if own is None:
        return LaunchRules(), ()
    place = f"{own.file}:{own.line}"
    if isinstance(own, LaunchedComponent):
        return LaunchRules(), (f"{place}: '{name}' is a process of its own, in no container",)
    notices = []
    names = {one.serial: key for key, one in launched.items() if isinstance(one, LaunchedNode)}
    after = names.get(own.start.after) if own.start.after is not None else None
    if own.start.after is not None and after is None:
        notices.append(f"{place}: '{name}' does not wait for what is not in the mapfile")
    apart = [one for one in launched.values() if isinstance(one, LaunchedComponent)]
    respawn = None if own.ends_run else own.respawn  # ros2 launch shuts down at the first end
    rules = LaunchRules(
        after=after,
        after_exit=own.start.on_exit,
        delay_s=own.start.delay_s,
        respawn_delay_s=respawn.delay_s if respawn else None,
        max_respawns=respawn.max_retries if respawn else 0,
        ends_run=own.ends_run,
        transitions=own.transitions,
        components=tuple(_placed(one) for one in own.components if one not in apart),
    )
    return rules, tuple(notices)


def _placed(component: LaunchedComponent) -> PlacedComponent:
    full_name = full_node_name(component.namespace, component.name or "")
    return PlacedComponent(
        package=component.package,
        plugin=component.plugin,
        name=component.name or "",
        namespace=component.namespace,
        parameters=_values(component.parameters, full_name),
        remappings=component.remappings,
        extra_arguments=_values(component.extra_arguments, full_name),
    )


def _values(sources: tuple[ParameterSource, ...], full_name: str) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for source in sources:
        if isinstance(source, Path):
            values |= values_for(read_file(source), full_name)
        elif isinstance(source, ExpandedFile):
            values |= values_for(read_text(source.text, source.file), full_name)
        else:
            values |= source
    return {
        name: list(value) if isinstance(value, tuple) else value for name, value in values.items()
    }
