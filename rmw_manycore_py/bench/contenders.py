# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Contenders: variants of rmw_manycore and Fast DDS, and programs without middleware."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

Wait = Literal["block", "adaptive", "spin"]
WAITS: tuple[Wait, ...] = ("block", "adaptive", "spin")
MIB = 1024 * 1024

# Fast DDS uses a shared-memory segment of 512 KB unless a profile sets another size.
TUNED_SEGMENT_BYTES = 128 * MIB
TUNED_PROFILE = f"""<?xml version="1.0" encoding="UTF-8"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <transport_descriptors>
    <transport_descriptor>
      <transport_id>shared_memory</transport_id>
      <type>SHM</type>
      <segment_size>{TUNED_SEGMENT_BYTES}</segment_size>
    </transport_descriptor>
    <transport_descriptor>
      <transport_id>udp</transport_id>
      <type>UDPv4</type>
    </transport_descriptor>
  </transport_descriptors>
  <participant profile_name="tuned" is_default_profile="true">
    <rtps>
      <useBuiltinTransports>false</useBuiltinTransports>
      <userTransports>
        <transport_id>shared_memory</transport_id>
        <transport_id>udp</transport_id>
      </userTransports>
    </rtps>
  </participant>
</profiles>
"""


@dataclass(frozen=True)
class Middleware:
    """Configuration of a middleware; its processes are parties, numbered from 0."""

    name: str
    variables: dict[str, str] = field(default_factory=dict, hash=False)
    profile: str | None = None
    clusters: tuple[int, ...] = (1,)
    build: Path | None = None  # directory of a librmw_manycore.so other than the installed one

    @property
    def is_manycore(self) -> bool:
        """Return whether this is rmw_manycore."""
        return self.variables["RMW_IMPLEMENTATION"] == "rmw_manycore"

    def cluster_of(self, party: int) -> int:
        """Return the cluster of a party; additional parties share the last one's."""
        return self.clusters[min(party, len(self.clusters) - 1)]


def manycore(place: Literal["inside", "between"], wait: Wait = "block") -> Middleware:
    """Return rmw_manycore inside a cluster or between two, with a wait strategy."""
    return Middleware(
        name=f"manycore {place} ({wait})",
        variables={"RMW_IMPLEMENTATION": "rmw_manycore", "MANYCORE_WAIT": wait},
        clusters=(1,) if place == "inside" else (1, 2),
    )


INSIDE = manycore("inside")
BETWEEN = manycore("between")

_FAST_DDS = {"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}
FAST_DDS = Middleware("Fast DDS as installed", _FAST_DDS)
TUNED_FAST_DDS = Middleware("Fast DDS, 128 MB segment", _FAST_DDS, TUNED_PROFILE)


@dataclass(frozen=True)
class Peer:
    """Program that does the same with OS primitives; it contains all parties."""

    name: str
    program: str


FUTEX = Peer("futex + copy", "futex_round_trip")
RELAY = Peer("pipe -> thread -> node", "relay_round_trip")
