# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""One message after the other in room that the middleware lends: ours, and iceoryx2.

A message begins with a number. Nothing else of it is touched. Kinds: "manycore", which waits as
$MANYCORE_WAIT says, "iceoryx2 (block)", with an event for each message, and "iceoryx2 (spin)".
"""

from __future__ import annotations

import ctypes
import importlib
import os
import struct
from functools import cache
from typing import Any, Protocol

import numpy as np

from rmw_manycore_py import transport

PLATFORM = "MANYCORE_PLATFORM"  # its value names the services of iceoryx2, too
DEPTH = 10
NUMBER = struct.Struct("=Q")


class Sender(Protocol):
    """A publisher of one topic."""

    def send(self, number: int) -> None:
        """Publish a message."""


class Receiver(Protocol):
    """A subscription to one topic."""

    def receive(self) -> int:
        """Wait for a message, and return its number."""


class ManycoreSender:
    """A publisher of our Python API."""

    def __init__(self, topic: str, size_bytes: int) -> None:
        self._shape = (size_bytes,)
        self._publisher = _member().publisher(f"/{topic}", np.uint8, qos=DEPTH)

    def send(self, number: int) -> None:
        """Publish a message in lent room."""
        with self._publisher.lend(self._shape) as loan:
            NUMBER.pack_into(loan.array.data, 0, number)


class ManycoreReceiver:
    """A subscription of our Python API."""

    def __init__(self, topic: str) -> None:
        self._subscription = _member().subscription(f"/{topic}", np.uint8, qos=DEPTH)

    def receive(self) -> int:
        """Read a message where it lies."""
        with self._subscription.take() as message:
            return int(NUMBER.unpack_from(message.array.data)[0])


@cache
def _member() -> transport.Member:
    return transport.join()


class IceoryxSender:
    """A publisher of iceoryx2's Python binding."""

    def __init__(self, topic: str, size_bytes: int, *, sleeps: bool) -> None:
        service = _service(topic).open_or_create()
        self._size_bytes = size_bytes
        self._sleeps = sleeps
        self._publisher = service.publisher_builder().initial_max_slice_len(size_bytes).create()
        self._notifier = _event(topic).notifier_builder().create()

    def send(self, number: int) -> None:
        """Publish a message in lent room."""
        sample = self._publisher.loan_slice_uninit(self._size_bytes)
        ctypes.c_uint64.from_address(sample.payload().as_ptr()).value = number
        sample.assume_init().send()
        if self._sleeps:
            self._notifier.notify()


class IceoryxReceiver:
    """A subscription of iceoryx2's Python binding."""

    def __init__(self, topic: str, *, sleeps: bool) -> None:
        service = _service(topic).open_or_create()
        self._sleeps = sleeps
        self._subscriber = service.subscriber_builder().buffer_size(DEPTH).create()
        self._listener = _event(topic).listener_builder().create()

    def receive(self) -> int:
        """Read a message where it lies."""
        while (sample := self._subscriber.receive()) is None:
            if self._sleeps:
                self._listener.blocking_wait()
        number = ctypes.c_uint64.from_address(sample.payload().as_ptr()).value
        sample.delete()
        return number


def _service(topic: str) -> Any:
    iceoryx = _iceoryx()
    payload = iceoryx.Slice[ctypes.c_uint8]
    return (
        _node()
        .service_builder(_name(topic))
        .publish_subscribe(payload)
        .payload_alignment(iceoryx.Alignment.new(8))
        .subscriber_max_buffer_size(DEPTH)
    )


def _event(topic: str) -> Any:
    return _node().service_builder(_name(topic)).event().open_or_create()


def _name(topic: str) -> Any:
    return _iceoryx().ServiceName.new(f"{os.environ[PLATFORM]}/{topic}")


@cache
def _node() -> Any:
    return _iceoryx().NodeBuilder.new().create(_iceoryx().ServiceType.Ipc)


@cache
def _iceoryx() -> Any:
    return importlib.import_module("iceoryx2")


def sender(kind: str, topic: str, size_bytes: int) -> Sender:
    """Return a publisher of a kind."""
    if kind == "manycore":
        return ManycoreSender(topic, size_bytes)
    return IceoryxSender(topic, size_bytes, sleeps=_sleeps(kind))


def receiver(kind: str, topic: str) -> Receiver:
    """Return a subscription of a kind."""
    return (
        ManycoreReceiver(topic)
        if kind == "manycore"
        else IceoryxReceiver(topic, sleeps=_sleeps(kind))
    )


def _sleeps(kind: str) -> bool:
    return kind.endswith("(block)")
