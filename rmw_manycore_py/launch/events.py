# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Events of the runner. `as_json` is the interface of `manycore run --json`."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from rmw_manycore_py.platform.topology import HostCpu


@dataclass(frozen=True)
class Event:
    """Base of all events of a run."""

    def as_data(self) -> dict[str, Any]:
        """Return the kind of event and its fields."""
        kind = re.sub(r"(?<!^)(?=[A-Z])", "_", type(self).__name__).lower()
        return {"event": kind, **asdict(self)}

    def as_json(self) -> str:
        """Return the event as one line of JSON."""
        return json.dumps(self.as_data())


@dataclass(frozen=True)
class PlacedCore:
    """Row of the placement table: a process's core, and the host CPU or CPUs it runs on."""

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
    """Information for the user; not an error."""

    text: str


@dataclass(frozen=True)
class Held(Event):
    """Virtual time stands, `at_s` after its begin, until it is resumed."""

    at_s: float
    why: str


@dataclass(frozen=True)
class Started(Event):
    """A node has started."""

    node: str
    pid: int
    cluster: int
    core: int
    host_cpu: HostCpu


@dataclass(frozen=True)
class Output(Event):
    """A node has printed a line."""

    node: str
    line: str


@dataclass(frozen=True)
class Stopping(Event):
    """The run is stopping its nodes."""

    reason: str


@dataclass(frozen=True)
class SignalEscalated(Event):
    """A node did not stop in time and was sent a stronger signal."""

    node: str
    signal: str


@dataclass(frozen=True)
class Restarting(Event):
    """A supervised process, e.g. of the bridge, ended by itself and is restarted."""

    node: str
    reason: str
    last_lines: tuple[str, ...]


@dataclass(frozen=True)
class Ended(Event):
    """A node has ended; `last_lines` are set if it failed."""

    node: str
    state: str
    reason: str
    exit_status: int | None
    signal: str | None
    last_lines: tuple[str, ...]


@dataclass(frozen=True)
class Finished(Event):
    """The run has ended."""

    failed: tuple[str, ...]
    exit_status: int


KINDS = (Platform, Notice, Held, Started, Stopping, SignalEscalated, Restarting, Ended, Finished)


def event_of(data: Mapping[str, Any]) -> Event | None:
    """Return the event from `as_data` or parsed `as_json` output; None for an unknown kind."""
    fields = dict(data)
    name = str(fields.pop("event", "")).title().replace("_", "")
    for kind in KINDS:
        if kind.__name__ == name:
            if kind is Platform:
                fields["cores"] = tuple(PlacedCore(**core) for core in fields["cores"])
            return kind(**fields)
    return None
