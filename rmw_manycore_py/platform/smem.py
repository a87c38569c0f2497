# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""SMEM that endpoints take when they are created, as rmw_manycore/transport allocates it.

Sizes are those of the structs in rmw_manycore/transport/layout and of generation.hpp.
"""

from __future__ import annotations

from dataclasses import dataclass

_SMALL_SMEM = 64 << 20  # up to here granules have 1 KiB, else one page
_CLUSTER_HEADER = 256
_TOPIC_DSM_HEADER = 1536
_LANDING_TABLE = 1024
_LANDING_HEADER = 192
_MARK = 8  # of a landing, per descriptor
_DESCRIPTOR = 64
_RECORD_ALIGNMENT = 64
_FIRST_DESCRIPTORS = 16
_FIRST_DATA = 2048  # of a topic DSM that grows
_SUBSCRIPTION_HEADER = 256
_HINT = 8
_PARAMETER_SERVICES = 6
_PARAMETER_DEPTH = 1000  # of rmw_qos_profile_parameters
DEFAULT_DEPTH = 10


@dataclass(frozen=True)
class Smem:
    """Sizes of allocations in a cluster with so much SMEM, in whole granules."""

    size: int

    @property
    def _granule(self) -> int:
        return 1024 if self.size <= _SMALL_SMEM else 4096

    def _allocated(self, size_bytes: int) -> int:
        return _aligned(size_bytes, self._granule)

    @property
    def head(self) -> int:
        """The cluster's header and the map of its granules."""
        return self._allocated(_CLUSTER_HEADER + _aligned(self.size // self._granule, 64) // 8)

    def publisher(self, depth: int, ring: int | None, *, transferred: bool = False) -> int:
        """Return the bytes of a topic DSM with a ring of fixed size, or of one that may grow."""
        header = _TOPIC_DSM_HEADER + (_LANDING_TABLE if transferred else 0)
        data = _FIRST_DATA if ring is None else _aligned(ring, _RECORD_ALIGNMENT)
        return self._allocated(header) + self._allocated(_descriptors(depth, ring) + data)

    def landing(self, depth: int, ring: int) -> int:
        """Return the bytes that a transferred topic DSM takes in a receiving cluster."""
        marks = _descriptors(depth, ring) // _DESCRIPTOR * _MARK
        return self._allocated(_LANDING_HEADER + marks + _aligned(ring, _RECORD_ALIGNMENT))

    def subscription(self, depth: int) -> int:
        """Return the bytes of a subscription with its queue."""
        return self._allocated(_SUBSCRIPTION_HEADER + _power_of_two(depth) * _HINT)

    def service(self, depth: int = DEFAULT_DEPTH) -> int:
        """Return the bytes of a service or client: a queue, and a topic DSM that may grow."""
        return self.subscription(depth) + self.publisher(depth, None)

    @property
    def node(self) -> int:
        """What each rclpy node has: log, parameter events and services, type description."""
        parameters = _PARAMETER_SERVICES * self.service(_PARAMETER_DEPTH)
        return 2 * self.publisher(_PARAMETER_DEPTH, None) + parameters + self.service()


def _descriptors(depth: int, ring: int | None) -> int:
    """Return the bytes of a topic DSM's first descriptors."""
    if ring is None:
        return _FIRST_DESCRIPTORS * _DESCRIPTOR
    most = max(ring // _RECORD_ALIGNMENT, 2)
    return _power_of_two(min(most, max(_FIRST_DESCRIPTORS, 2 * depth))) * _DESCRIPTOR


def _aligned(size_bytes: int, unit: int) -> int:
    return -(-size_bytes // unit) * unit


def _power_of_two(at_least: int) -> int:
    return 1 << max(at_least - 1, 0).bit_length()
