# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Sleeping until a descriptor is ready; a signal ends the sleep, as KeyboardInterrupt."""

from __future__ import annotations

import math
import select
from collections.abc import Iterable

from rmw_manycore_py.transport.arguments import Deadline


def wait_for_any(readable: Iterable[int], deadline: Deadline, writable: Iterable[int] = ()) -> bool:
    """Sleep until a descriptor is ready, or its other end closed; False after the deadline."""
    poll = select.poll()
    for descriptor in readable:
        poll.register(descriptor, select.POLLIN)
    for descriptor in writable:
        poll.register(descriptor, select.POLLOUT)
    left_s = deadline.left_s()
    return bool(poll.poll(None if left_s is None else math.ceil(left_s * 1000)))
