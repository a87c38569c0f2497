# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Topic table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.errors.suggestions import closest
from rmw_manycore_py.mapfile.placing.crossings import CROSSINGS
from rmw_manycore_py.mapfile.placing.placement import PlacedNode, TopicEntry
from rmw_manycore_py.ros import ament
from rmw_manycore_py.ros.names import expand

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile
    from rmw_manycore_py.mapfile.format.model import TopicSection
    from rmw_manycore_py.mapfile.placing.start import NodeStart


def topic_table(mapfile: Mapfile, nodes: Sequence[PlacedNode]) -> tuple[TopicEntry, ...]:
    """Return the topics: those listed in the mapfile, then those of the nodes by name."""
    listed = {expand(name, "/"): topic for name, topic in mapfile.sections.topics.items()}
    seen = {name for node in nodes for name in (*node.publish, *node.subscribe)}
    entries = []
    for number, name in enumerate([*listed, *sorted(seen - set(listed))], start=1):
        publishers = tuple(node for node in nodes if name in node.publish)
        subscribers = tuple(node for node in nodes if name in node.subscribe)
        types = [node.publish[name] for node in publishers]
        types += [node.subscribe[name] for node in subscribers]
        section = listed.get(name)
        entries.append(
            TopicEntry(
                id=number,
                name=name,
                type=(section.type if section else None) or next(iter(types), None),
                topic_dsm_size=section.topic_dsm_size if section else None,
                publishers=publishers,
                subscribers=subscribers,
                **(_settings(section) if section else {}),
            )
        )
    return tuple(entries)


def _settings(section: TopicSection) -> dict[str, Any]:
    return {
        "transfer": section.transfer,
        "priority": section.priority or 0,
        "synchronous": section.synchronous,
        "zero_copy": section.zero_copy or "unset",
    }


def check_types(mapfile: Mapfile, topics: Iterable[TopicEntry]) -> Iterator[Problem]:
    """Yield types that are not installed, and nodes that disagree with the topic table."""
    sections = mapfile.sections
    named: set[str] = set()  # whose nodes need not be named as well
    for name, topic in sections.topics.items():
        if topic.type is not None:
            problems = list(_check_installed(mapfile, ("topics", name, "type"), topic.type))
            named.update(expand(name, "/") for _ in problems)
            yield from problems
    for node, section in sections.nodes.items():
        for key in ("publish", "subscribe", *CROSSINGS):
            for name, type_name in getattr(section, key).items():
                if type_name is not None:  # a pattern has none
                    yield from _check_installed(mapfile, ("nodes", node, key, name), type_name)
    for entry in topics:
        if entry.name in named:
            continue
        used = [(node, node.publish[entry.name]) for node in entry.publishers]
        used += [(node, node.subscribe[entry.name]) for node in entry.subscribers]
        for node_placed, type_name in used:
            if type_name != entry.type:
                expected = f"{entry.type} for the topic {entry.name}"
                yield mapfile.document.problem(("nodes", node_placed.name), expected, type_name)


def check_crossing_types(
    mapfile: Mapfile, starts: Mapping[str, NodeStart], topics: Iterable[TopicEntry]
) -> Iterator[Problem]:
    """Yield routes whose type differs from the topic table or from an earlier line."""
    known = {("msg", entry.name): entry.type for entry in topics if entry.type is not None}
    for node, section in mapfile.sections.nodes.items():
        for key in CROSSINGS:
            for name, type_name in getattr(section, key).items():
                if type_name is None:
                    continue
                full = starts[node].topic(name)
                kind = type_name.split("/")[1]
                expected = known.setdefault((kind, full), type_name)
                if type_name != expected:
                    path = ("nodes", node, key, name)
                    yield mapfile.document.problem(path, f"{expected} for {full}", type_name)


def _check_installed(mapfile: Mapfile, path: tuple[str, ...], type_name: str) -> Iterator[Problem]:
    package = type_name.split("/")[0]
    installed = ament.interfaces(package)
    if not installed:
        expected = "a type of an installed package"
        yield mapfile.document.problem(path, expected, f"{type_name} of '{package}'")
    elif type_name not in installed:
        meant = closest(type_name, installed)
        such = f", such as {meant}" if meant else ""
        yield mapfile.document.problem(path, f"a type of the package '{package}'{such}", type_name)


def as_written(mapfile: Mapfile, topic: str) -> str:
    """Return a topic's name as the mapfile has it."""
    return next(name for name in mapfile.sections.topics if expand(name, "/") == topic)
