# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Limits, expansion and remapping of names, following rcl."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rmw_manycore_py.native._transport import NodeInfo

# Limits of rmw, same as in Fast DDS.
MAX_TOPIC_NAME = 247
MAX_NODE_NAME = 255
# Regular expression of what stands between slashes: ASCII only, as in rcl.
NAME_PART = "[A-Za-z_][A-Za-z0-9_]*"


def full_node_name(namespace: str, name: str) -> str:
    """Return /namespace/name."""
    return f"/{namespace.strip('/')}/{name}".replace("//", "/")


def file_stem(full_name: str) -> str:
    """Return a file name for a node, without suffix; unique, since ROS 2 names have no dots."""
    return full_name.strip("/").replace("/", ".")


def node_names_by_process(nodes: Iterable[NodeInfo]) -> defaultdict[int, list[str]]:
    """Return the full names of the nodes of each process, by its slot; none for other slots."""
    names: defaultdict[int, list[str]] = defaultdict(list)
    for node in nodes:
        names[node.process].append(full_node_name(node.namespace, node.name))
    return names


def is_hidden(name: str) -> bool:
    """Return whether a full name of a topic, service or node is hidden."""
    return any(part.startswith("_") for part in name.split("/"))


def expand(topic: str, node: str) -> str:
    """Return the full name of a topic as used by a node with this full name."""
    if topic.startswith("/"):
        return topic
    if topic.startswith("~"):
        return f"{node}/{topic[1:].lstrip('/')}".rstrip("/")
    return f"{node.rpartition('/')[0]}/{topic}"


def resolve_topic(topic: str, node: str, remappings: Sequence[tuple[str, str]]) -> str:
    """Return the full name after remapping; the first matching rule takes effect."""
    full = expand(topic, node)
    for source, target in remappings:
        if source.startswith("__"):
            continue
        # A rule may be restricted to a node: node:topic.
        owner, _, name = source.rpartition(":")
        if owner not in ("", node.rpartition("/")[2]):
            continue
        if expand(name.removeprefix("rostopic://"), node) == full:
            return expand(target, node)
    return full
