# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""SMEM that endpoints take when they are created, as rmw_manycore/transport allocates it.

A test compares the sizes with its headers.
"""

from __future__ import annotations

from dataclasses import dataclass

SMALL_SMEM = 64 << 20  # with small granules up to here
SMALL_GRANULE = 1024
PAGE = 4096
CLUSTER_HEADER = 256
TOPIC_DSM_HEADER = 1536
LANDING_TABLE = 1024
LANDING_HEADER = 192
_MARK = 8  # of a landing, per descriptor
DESCRIPTOR = 64
RECORD_ALIGNMENT = 64
FIRST_DESCRIPTORS = 16
FIRST_DATA = 2048  # of a topic DSM that grows
SUBSCRIPTION_HEADER = 256
_HINT = 8
_PARAMETER_SERVICES = 6
_PARAMETER_DEPTH = 1000  # of rmw_qos_profile_parameters
DEFAULT_DEPTH = 10


@dataclass(frozen=True)
class Smem:
    """Sizes of allocations in a cluster with `size` bytes of SMEM, in whole granules."""

    size: int

    @property
    def _granule(self) -> int:
        return SMALL_GRANULE if self.size <= SMALL_SMEM else PAGE

    def _allocated(self, size_bytes: int) -> int:
        return _align_up(size_bytes, self._granule)

    @property
    def head(self) -> int:
        """The cluster's header and the map of its granules."""
        return self._allocated(CLUSTER_HEADER + _align_up(self.size // self._granule, 64) // 8)

    def publisher(self, depth: int, ring: int | None, *, transferred: bool = False) -> int:
        """Return the bytes of a topic DSM with a ring of fixed size, or of one that may grow."""
        header = TOPIC_DSM_HEADER + (LANDING_TABLE if transferred else 0)
        data = FIRST_DATA if ring is None else _align_up(ring, RECORD_ALIGNMENT)
        return self._allocated(header) + self._allocated(_descriptors(depth, ring) + data)

    def landing(self, depth: int, ring: int) -> int:
        """Return the bytes that a transferred topic DSM takes in a receiving cluster."""
        marks = _descriptors(depth, ring) // DESCRIPTOR * _MARK
        return self._allocated(LANDING_HEADER + marks + _align_up(ring, RECORD_ALIGNMENT))

    def subscription(self, depth: int) -> int:
        """Return the bytes of a subscription with its queue."""
        return self._allocated(SUBSCRIPTION_HEADER + _bit_ceil(depth) * _HINT)

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
        return FIRST_DESCRIPTORS * DESCRIPTOR
    max_count = max(ring // RECORD_ALIGNMENT, 2)
    return _bit_ceil(min(max_count, max(FIRST_DESCRIPTORS, 2 * depth))) * DESCRIPTOR


def _align_up(size_bytes: int, unit: int) -> int:
    return -(-size_bytes // unit) * unit


def _bit_ceil(count: int) -> int:
    """Return the smallest power of two that is not below a count."""
    return 1 << max(count - 1, 0).bit_length()
