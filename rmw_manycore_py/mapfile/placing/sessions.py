# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sessions between clusters: topics that are transferred by `session`."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from rmw_manycore_py.errors import Problem
from rmw_manycore_py.mapfile.placing.placement import TopicEntry
from rmw_manycore_py.mapfile.placing.topics import as_written

if TYPE_CHECKING:
    from rmw_manycore_py.mapfile.format.mapfile import Mapfile

# Of a cluster in each direction, as max_sessions of rmw_manycore/transport: the UC of the MPPA.
MAX_SESSIONS = 8


def check_sessions(mapfile: Mapfile, topics: Iterable[TopicEntry]) -> Iterator[Problem]:
    """Yield one problem for each cluster and direction that has too many sessions."""
    ends: dict[tuple[int, str], list[tuple[str, str]]] = defaultdict(list)
    for topic in topics:
        for node, receiver in topic.landings if topic.transfer == "session" else ():
            name = f"{topic.name} of {node.name}"
            ends[node.cluster, "to others"].append((topic.name, f"{name} to {receiver}"))
            ends[receiver, "from others"].append((topic.name, f"{name} from {node.cluster}"))
    for (cluster, direction), sessions in sorted(ends.items()):
        if len(sessions) <= MAX_SESSIONS:
            continue
        topic_name, found = sessions[MAX_SESSIONS]
        held = ", ".join(session for _, session in sessions[:MAX_SESSIONS])
        expected = (
            f"at most {MAX_SESSIONS} sessions of cluster {cluster} {direction}, which it has with "
            f"{held}"
        )
        path = ("topics", as_written(mapfile, topic_name), "transfer")
        yield mapfile.document.problem(path, expected, found)
