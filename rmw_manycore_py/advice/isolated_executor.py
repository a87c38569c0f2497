# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Placement for TIER IV's CallbackIsolatedExecutor, which gives each callback group a thread.

Its thread configurator finds a group by an id: the node's name, then its callbacks in order. Two
generations of it read `priority` or `nice` of ordinary policies; each ignores the other's key.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from rmw_manycore_py.errors import FileError, Problem
from rmw_manycore_py.mapfile import PlacedNode, Placement
from rmw_manycore_py.mapfile.format.document import read_yaml
from rmw_manycore_py.process.scheduling import REAL_TIME
from rmw_manycore_py.profile.model import Callback, Profile
from rmw_manycore_py.ros.names import full_node_name

_GROUPS = "callback_groups"
_PARAMETER_SERVICES = (
    *("describe_parameters", "get_parameter_types", "get_parameters", "list_parameters"),
    *("set_parameters", "set_parameters_atomically"),
)


def thread_configuration(
    placement: Placement, profile: Profile, template: Path | None = None
) -> str:
    """Return the YAML file for the thread configurator.

    :param template: of its pre-run, with the ids of all groups; without, each node is taken to
        have one group, with the callbacks of the profile.
    :raises FileError: if the template is not one.
    """
    nodes = dict(_nodes(placement))
    ids = _ids_of(template) if template else _ids_in(profile)
    groups = [
        {"id": one, **_entry(nodes[name])}
        for one in sorted(ids)
        if (name := one.partition("@")[0]) in nodes
    ]
    return yaml.safe_dump({_GROUPS: groups}, sort_keys=False, width=1 << 20)


def _nodes(placement: Placement) -> Iterator[tuple[str, PlacedNode]]:
    for node in placement.nodes:
        yield node.full_name, node
        for one in node.rules.components:
            if one.name:
                yield full_node_name(one.namespace, one.name), node


def _entry(node: PlacedNode) -> dict[str, Any]:
    scheduling = node.scheduling
    entry: dict[str, Any] = {"affinity": [node.host_cpu]}
    if scheduling is not None and scheduling.policy in REAL_TIME:
        policy = f"SCHED_{scheduling.policy.upper()}"
        return {**entry, "policy": policy, "priority": scheduling.priority}
    return {**entry, "policy": "SCHED_OTHER", "priority": 0, "nice": 0}


def _ids_of(template: Path) -> list[str]:
    data = read_yaml(template).data
    groups = data.get(_GROUPS) if isinstance(data, dict) else None
    if not isinstance(groups, list) or not all(
        isinstance(one, dict) and isinstance(one.get("id"), str) for one in groups
    ):
        expected = "callback_groups with ids, as the pre-run of thread_configurator_node writes"
        raise FileError(Problem(template, 0, _GROUPS, expected, "something else"))
    return [one["id"] for one in groups]


def _ids_in(profile: Profile) -> Iterator[str]:
    """Yield an id for each node: its default group with all callbacks, sorted."""
    callbacks: dict[int, set[str]] = defaultdict(set)
    for one in profile.callbacks:
        if one.node is not None and (text := _callback(one)):
            callbacks[one.node].add(text)
    for subscription in profile.subscriptions:
        if subscription.node is not None:
            callbacks[subscription.node].add(f"Subscription({subscription.topic})")
    for index, node in enumerate(profile.nodes):
        own = {f"Service({node.name}/{name})" for name in _PARAMETER_SERVICES}
        own |= {"Subscription(/parameter_events)", *callbacks[index]}
        yield "@".join([node.name, *sorted(own)])


def _callback(one: Callback) -> str:
    if one.kind == "timer":
        return f"Timer({one.period_ns})" if one.period_ns else ""
    kinds = {"subscription": "Subscription", "service": "Service", "client": "Client"}
    return f"{kinds[one.kind]}({one.trigger})" if one.kind in kinds and one.trigger else ""
