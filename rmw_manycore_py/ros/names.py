# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Full topic names, as rcl makes them of what a node writes."""

from __future__ import annotations

from collections.abc import Sequence


def full_node_name(namespace: str, name: str) -> str:
    """Return /namespace/name."""
    return f"/{namespace.strip('/')}/{name}".replace("//", "/")


def is_hidden(name: str) -> bool:
    """Tell whether ROS hides a topic, service or node of that full name."""
    return any(part.startswith("_") for part in name.split("/"))


def expand(topic: str, node: str) -> str:
    """Return the full name of a topic that the node of that full name writes."""
    if topic.startswith("/"):
        return topic
    if topic.startswith("~"):
        return f"{node}/{topic[1:].lstrip('/')}".rstrip("/")
    return f"{node.rpartition('/')[0]}/{topic}"


def resolve_topic(topic: str, node: str, remappings: Sequence[tuple[str, str]]) -> str:
    """Return the full name after remapping; the first rule that fits wins."""
    full = expand(topic, node)
    for source, target in remappings:
        if source.startswith("__"):
            continue
        # A rule may name the node it is for: node:topic.
        owner, _, name = source.rpartition(":")
        if owner not in ("", node.rpartition("/")[2]):
            continue
        if expand(name.removeprefix("rostopic://"), node) == full:
            return expand(target, node)
    return full
