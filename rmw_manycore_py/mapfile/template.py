# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Generates a mapfile template from an application (ROS-lite, Fig. 5 a)."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import cycle
from pathlib import Path

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError, MapfileError, shorten
from rmw_manycore_py.mapfile.communication import by_communication, talk_of
from rmw_manycore_py.mapfile.launch_file import LaunchedNode, LaunchFile, read_launch_file
from rmw_manycore_py.mapfile.placing.launched import program_of
from rmw_manycore_py.mapfile.placing.parameters import Launched
from rmw_manycore_py.mapfile.programs.entry_script import scripts_of_module
from rmw_manycore_py.mapfile.programs.executables import find_module
from rmw_manycore_py.mapfile.programs.source import SourceNode, read_source
from rmw_manycore_py.platform.topology import Topology, profile
from rmw_manycore_py.ros.names import full_node_name
from rmw_manycore_py.ros.workspace import walk_sources

_ADVICE = "# Choose the clusters. A node gets the first free core unless 'core' is set."
_PLAN = "plan: true  # nodes need not be installed for map check and map show; run needs them"
_STARTS_NOTHING = "starts nothing: install its package, or call main() at its end"
_LAUNCH_SUFFIXES = (".launch.py", "_launch.py", ".launch", ".xml", ".yaml", ".yml")


@dataclass
class _Entry:
    name: str
    start: str = ""
    publish: dict[str, str] = field(default_factory=dict)
    subscribe: dict[str, str] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)
    missing: str = ""  # why it cannot run on this machine
    is_mapped: bool = True  # else only a comment
    cluster: int = 1
    core: int | None = None


def init(
    sources: Sequence[Path],
    directory: Path | None = None,
    platform: str = "host",
    arguments: Mapping[str, str] | None = None,
    *,
    plan: bool = False,
) -> str:
    """Return a mapfile with the nodes found in Python files, directories and one launch file.

    Its clusters are a proposal: nodes that exchange messages share one. They share cores where the
    platform has too few. `directory` is that of the future mapfile, `arguments` are those of the
    launch file. A plan has all nodes, also those that cannot run here, each on its own core.
    """
    directory = (directory or Path.cwd()).resolve()
    launches = [path for path in sources if path.is_file() and _is_launch_file(path)]
    if arguments and not launches:
        raise ManycoreError("NAME:=VALUE is for a launch file, and none is given", EXIT_BAD_INPUT)
    if len(launches) > 1:
        raise ManycoreError("a mapfile has one launch file", EXIT_BAD_INPUT)
    entries = [entry for file in _python_files(sources) for entry in _entries_of(file, directory)]
    unread: list[str] = []
    for launch in launches:
        launched = read_launch_file(launch.resolve(), arguments or {})
        found_here = _entries_to_plan if plan else _entries_to_run
        entries = [*found_here(launched, directory), *entries]
        unread += _unread(launched)
    entries = _with_own_names(entries)
    mapped = [entry for entry in entries if entry.is_mapped]
    if not mapped:
        places = ", ".join(map(str, sources))
        why = "".join(f"\n{entry.name}: {entry.missing}" for entry in entries)
        why += "".join(f"\n{notice}" for notice in unread)
        found = "no nodes that can run here" if entries else "no nodes"
        raise ManycoreError(f"{found} found in {places}{why}", EXIT_BAD_INPUT)
    head = [_ADVICE, f"platform: {platform}", *([_PLAN] if plan else [])]
    head += [f"launch_path: {_relative(launch, directory)}" for launch in launches]
    if arguments:
        head.append("launch_arguments:")
        head += [f"  {name}: {json.dumps(value)}" for name, value in arguments.items()]
    if _propose_places(mapped, profile(platform), own_cores=plan):
        head.append("allow_shared_cores: true  # there are more nodes than cores")
    if plan:
        head += [f"# {shorten(notice)}" for notice in unread]
    lines = (line for entry in entries for line in _lines(entry))
    text = "\n".join([*head, "nodes:", *lines]) + "\n"
    return text.replace(f"{directory}{os.sep}", "")  # in comments on missing things


def _propose_places(entries: Sequence[_Entry], topology: Topology, *, own_cores: bool) -> bool:
    """Choose clusters by the topics that sources reveal; return whether nodes share cores."""
    cores = sum(len(cluster.free) for cluster in topology.clusters)
    per_core = -(-len(entries) // cores)
    if own_cores and per_core > 1:
        text = f"{len(entries)} nodes are more than the {cores} cores of '{topology.profile}'"
        raise ManycoreError(f"{text}: choose another --profile", EXIT_BAD_INPUT)
    talk = talk_of(
        ((entry.name, topic.lstrip("/"), 1.0) for entry in entries for topic in entry.publish),
        ((entry.name, topic.lstrip("/")) for entry in entries for topic in entry.subscribe),
    )
    room = {cluster.id: len(cluster.free) * per_core for cluster in topology.clusters}
    clusters = by_communication([entry.name for entry in entries], talk, room)
    free = {cluster.id: cycle(cluster.free) for cluster in topology.clusters}
    for entry in entries:
        entry.cluster = clusters[entry.name]
        if per_core > 1:
            entry.core = next(free[entry.cluster])
    return per_core > 1


def _is_launch_file(path: Path) -> bool:
    return path.name.endswith(_LAUNCH_SUFFIXES)


def _python_files(sources: Iterable[Path]) -> Iterator[Path]:
    for source in sources:
        if source.is_dir():
            found = sorted(_python_files_in(source))
            yield from (file for file in found if not _is_launch_file(file))
        elif not source.is_file():
            raise ManycoreError(f"{source}: no such file or directory", EXIT_BAD_INPUT)
        elif source.suffix == ".py" and not _is_launch_file(source):
            yield source
        elif not _is_launch_file(source):
            expected = "a Python file, a directory or a launch file"
            raise ManycoreError(f"{source}: expected {expected}", EXIT_BAD_INPUT)


def _python_files_in(top: Path) -> Iterator[Path]:
    for directory, _, files in walk_sources(top):
        yield from (
            directory / name for name in files if name.endswith(".py") and not name.startswith(".")
        )


def _entries_of(file: Path, directory: Path) -> list[_Entry]:
    """Return the process started by a file; several nodes in a file share a process."""
    source = read_source(file)
    nodes = source.nodes
    if not nodes:
        return []
    start = _start if source.is_program else _start_by_entry_point
    entry = _Entry(nodes[0].name or file.stem, start(file, directory))
    for node in nodes:
        entry.publish |= node.publish
        entry.subscribe |= node.subscribe
        entry.remarks += _remarks(node)
    if len(nodes) > 1:
        names = ", ".join(node.name or "a node without a constant name" for node in nodes)
        entry.remarks.append(f"one process with several nodes: {names}")
    return [entry]


def _remarks(node: SourceNode) -> list[str]:
    lines = ", ".join(str(line) for line in node.unclear)
    return [f"{node.file.name}:{lines}: topic or type is computed; add it here"] if lines else []


def _entries_to_run(launch: LaunchFile, directory: Path) -> list[_Entry]:
    """Return the nodes; those that cannot run here are comments."""
    nodes: list[Launched] = []
    for node in launch.nodes:
        nodes.append(node)
        if _missing(node, directory):  # then use its components, if they can run standalone
            nodes += [one for one in node.components if not _missing(one, directory)]
    entries = _named_entries(nodes, directory)
    for entry in entries:
        entry.is_mapped = not entry.missing
    return entries


def _entries_to_plan(launch: LaunchFile, directory: Path) -> list[_Entry]:
    """Return the nodes, each with a comment on missing packages."""
    entries = _named_entries(launch.nodes, directory)
    for entry in entries:
        if entry.missing:
            entry.remarks.append(f"cannot run here: {entry.missing}")
    return entries


def _unread(launch: LaunchFile) -> list[str]:
    """Return the notices of a launch file except those on its nodes, which have comments."""
    problems = [node.problem for node in launch.nodes if node.problem is not None]
    return [
        notice
        for notice in launch.notices
        if not any(
            notice.startswith(f"{one.file}:{one.line}:") and notice.endswith(f"found {one.found}")
            for one in problems
        )
    ]


def _named_entries(nodes: Sequence[Launched], directory: Path) -> list[_Entry]:
    labels = [node.label for node in nodes]
    return [
        _Entry(
            node.label
            if labels.count(node.label) == 1
            else full_node_name(node.namespace, node.label),
            remarks=_components(node),
            missing=_missing(node, directory),
        )
        for node in nodes
    ]


def _missing(node: Launched, directory: Path) -> str:
    try:
        program_of(node, directory)
    except MapfileError as error:
        return "; ".join(str(problem) for problem in error.problems)
    return ""


def _components(node: Launched) -> list[str]:
    if isinstance(node, LaunchedNode) and node.components:
        return [f"loads {', '.join(one.label for one in node.components)}"]
    return []


def _start_by_entry_point(file: Path, directory: Path) -> str:
    for package, executable in scripts_of_module(".".join(_module_parts(file))):
        return f"package: {package}\n    executable: {executable}"
    return f"{_start(file, directory)}  # {_STARTS_NOTHING}"


def _module_parts(file: Path) -> list[str]:
    parts = [file.stem] if file.stem != "__main__" else []
    parent = file.resolve().parent
    while (parent / "__init__.py").is_file():
        parts.insert(0, parent.name)
        parent = parent.parent
    return parts


def _start(file: Path, directory: Path) -> str:
    parts = _module_parts(file)
    program = find_module(".".join(parts), directory) if len(parts) > 1 else None
    if program is not None and program.source is not None and program.source.samefile(file):
        return f"module: {'.'.join(parts)}"
    return f"script: {_relative(file, directory)}"


def _relative(path: Path, directory: Path) -> str:
    return os.path.relpath(path.resolve(), directory)


def _with_own_names(entries: Iterable[_Entry]) -> list[_Entry]:
    """Merge sources with the nodes of the launch file; number duplicate names."""
    named: dict[str, _Entry] = {}
    for entry in entries:
        known = named.get(entry.name)
        if known is not None and not known.is_mapped:
            named[entry.name] = entry
            continue
        if known is not None and not known.start:
            known.publish, known.subscribe, known.remarks = (
                entry.publish,
                entry.subscribe,
                entry.remarks,
            )
            continue
        number = 2
        base = entry.name
        while entry.name in named:
            entry.name = f"{base}{number}"
            number += 1
        named[entry.name] = entry
    return list(named.values())


def _lines(entry: _Entry) -> Iterator[str]:
    if not entry.is_mapped:
        yield f"  # {entry.name} cannot run here: {entry.missing}"
        return
    yield f"  {entry.name}:"
    yield from (f"    # {remark}" for remark in entry.remarks)
    yield f"    cluster: {entry.cluster}  # choose"
    if entry.core is not None:
        yield f"    core: {entry.core}"
    if entry.start:
        yield f"    {entry.start}"
    for key, topics in (("publish", entry.publish), ("subscribe", entry.subscribe)):
        if topics:
            yield f"    {key}:"
            yield from (f"      {topic}: {type_name}" for topic, type_name in topics.items())
