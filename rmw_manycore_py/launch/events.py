# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the runner reports. `as_json` is the interface of `manycore run --json`."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from rmw_manycore_py.topology import HostCpu


@dataclass(frozen=True)
class Event:
    """Something that happened during a run."""

    def as_data(self) -> dict[str, Any]:
        """Return the kind of event, then its fields."""
        kind = re.sub(r"(?<!^)(?=[A-Z])", "_", type(self).__name__).lower()
        return {"event": kind, **asdict(self)}

    def as_json(self) -> str:
        """Return the same as one line."""
        return json.dumps(self.as_data())


@dataclass(frozen=True)
class PlacedCore:
    """A line of the table: a process's virtual core, and the host CPU or CPUs that it runs on."""

    node: str
    cluster: int
    core: int
    host_cpu: HostCpu


@dataclass(frozen=True)
class Platform(Event):
    """The platform is configured."""

    name: str
    profile: str
    clusters: int
    cores_per_cluster: int
    smem_size: int
    cores: tuple[PlacedCore, ...]


@dataclass(frozen=True)
class Notice(Event):
    """Something the user should know; nothing is wrong."""

    text: str


@dataclass(frozen=True)
class Started(Event):
    """A node runs."""

    node: str
    pid: int
    cluster: int
    core: int
    host_cpu: HostCpu


@dataclass(frozen=True)
class Output(Event):
    """A node printed a line."""

    node: str
    line: str


@dataclass(frozen=True)
class Stopping(Event):
    """From here on the nodes are asked to end."""

    reason: str


@dataclass(frozen=True)
class Insisting(Event):
    """A node did not end when it was asked to, and was sent a stronger signal."""

    node: str
    signal: str


@dataclass(frozen=True)
class Restarting(Event):
    """A supervised process, as those of the bridge are, ended by itself and is started again."""

    node: str
    reason: str
    last_lines: tuple[str, ...]


@dataclass(frozen=True)
class Ended(Event):
    """A node is over; `last_lines` are those of a failed one."""

    node: str
    state: str
    reason: str
    exit_status: int | None
    signal: str | None
    last_lines: tuple[str, ...]


@dataclass(frozen=True)
class Finished(Event):
    """The run is over."""

    failed: tuple[str, ...]
    exit_status: int


KINDS = (Platform, Notice, Started, Stopping, Insisting, Restarting, Ended, Finished)


def event_of(data: Mapping[str, Any]) -> Event | None:
    """Return the event of which `as_data` or `as_json` made this; None for a kind it lacks."""
    fields = dict(data)
    name = str(fields.pop("event", "")).title().replace("_", "")
    for kind in KINDS:
        if kind.__name__ == name:
            if kind is Platform:
                fields["cores"] = tuple(PlacedCore(**core) for core in fields["cores"])
            return kind(**fields)
    return None
