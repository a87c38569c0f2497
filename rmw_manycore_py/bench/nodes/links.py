# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One message after the other in room that the middleware lends: ours, and iceoryx2.

A message begins with a number. Nothing else of it is touched.
"""

from __future__ import annotations

import ctypes
import importlib
import os
from typing import Any, Protocol

import numpy as np

from rmw_manycore_py import transport

PLATFORM = "MANYCORE_PLATFORM"  # its value names the services of iceoryx2, too


class Link(Protocol):
    """Sends on one topic, receives on another."""

    def send(self, number: int) -> None:
        """Publish a message."""

    def receive(self) -> int:
        """Wait for a message, and return its number."""


class ManycoreLink:
    """Our Python API; it waits as $MANYCORE_WAIT says."""

    def __init__(self, to: str, since: str, size_bytes: int) -> None:
        member = transport.join()
        self._shape = (size_bytes,)
        self._publisher = member.publisher(f"/{to}", np.uint8)
        self._subscription = member.subscription(f"/{since}", np.uint8)
        self._member = member

    def send(self, number: int) -> None:
        """Publish a message in lent room."""
        with self._publisher.lend(self._shape) as loan:
            loan.array.view(np.uint64)[0] = number

    def receive(self) -> int:
        """Read a message where it lies."""
        with self._subscription.take() as message:
            return int(message.array[:8].view(np.uint64)[0])


class IceoryxLink:
    """The Python binding of iceoryx2; with `sleeps`, an event announces each message."""

    def __init__(self, to: str, since: str, size_bytes: int, *, sleeps: bool) -> None:
        self._iceoryx: Any = importlib.import_module("iceoryx2")
        self._node = self._iceoryx.NodeBuilder.new().create(self._iceoryx.ServiceType.Ipc)
        self._size_bytes = size_bytes
        self._sleeps = sleeps
        publishing, receiving = (self._service(name) for name in (to, since))
        publisher = publishing.publisher_builder().initial_max_slice_len(size_bytes)
        self._publisher = publisher.create()
        self._subscriber = receiving.subscriber_builder().create()
        self._notifier = self._event(to).notifier_builder().create()
        self._listener = self._event(since).listener_builder().create()

    def _name(self, name: str) -> Any:
        return self._iceoryx.ServiceName.new(f"{os.environ[PLATFORM]}/{name}")

    def _service(self, name: str) -> Any:
        builder = self._node.service_builder(self._name(name))
        payload = self._iceoryx.Slice[ctypes.c_uint8]
        return (
            builder.publish_subscribe(payload)
            .payload_alignment(self._iceoryx.Alignment.new(8))
            .open_or_create()
        )

    def _event(self, name: str) -> Any:
        return self._node.service_builder(self._name(name)).event().open_or_create()

    def send(self, number: int) -> None:
        """Publish a message in lent room."""
        sample = self._publisher.loan_slice_uninit(self._size_bytes)
        ctypes.c_uint64.from_address(sample.payload().as_ptr()).value = number
        sample.assume_init().send()
        if self._sleeps:
            self._notifier.notify()

    def receive(self) -> int:
        """Read a message where it lies."""
        while (sample := self._subscriber.receive()) is None:
            if self._sleeps:
                self._listener.blocking_wait()
        number = ctypes.c_uint64.from_address(sample.payload().as_ptr()).value
        sample.delete()
        return number


def link(kind: str, to: str, since: str, size_bytes: int) -> Link:
    """Return a link of "manycore", "iceoryx2 (block)" or "iceoryx2 (spin)"."""
    if kind == "manycore":
        return ManycoreLink(to, since, size_bytes)
    return IceoryxLink(to, since, size_bytes, sleeps=kind.endswith("(block)"))
