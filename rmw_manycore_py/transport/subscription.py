# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Subscriptions to numpy arrays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Generic

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import Message
from rmw_manycore_py.transport.arguments import Deadline
from rmw_manycore_py.transport.closing import Closing
from rmw_manycore_py.transport.errors import (
    NATIVE_ERRORS,
    TransportError,
    TransportTimeoutError,
    translated,
)
from rmw_manycore_py.transport.multi_array import Scalar, layout_of


class Subscription(Closing, Generic[Scalar]):
    """Subscription to arrays of one element type, taken oldest first; see `Member.subscription`.

    The next message can be taken once the previous one was released.

    Any thread may take, and any thread may release. If the process is killed while it holds a
    message, the message is released.

    :ivar topic: full name of the topic.
    :ivar dtype: element type.
    """

    def __init__(
        self,
        topic: str,
        dtype: np.dtype[Scalar],
        process: _transport.Process,
        native: _transport.Subscription,
    ) -> None:
        self.topic = topic
        self.dtype = dtype
        self._process = process
        self._native: _transport.Subscription | None = native
        native.read_arrays(dtype, layout_of)

    def __repr__(self) -> str:
        return f"<Subscription to {self.dtype} on {self.topic}>"

    def take(self, timeout_s: float | None = None) -> Message[Scalar]:
        """Wait for the next message and return it; Ctrl-C interrupts the wait.

        :param timeout_s: in seconds; None waits indefinitely.
        :raises TransportTimeoutError: if none arrives within the timeout.
        :raises MessageInUseError: if the previous message is still in use.
        :raises TransportError: if the subscription was closed, or the platform was removed.
        """
        deadline = None if timeout_s is None else Deadline(timeout_s)
        seen = None  # what had arrived before the last look, of which a wait would not tell
        while (message := self.try_take()) is None:
            left_s = None if deadline is None else deadline.left_s()
            try:
                if seen is not None and not self._process.wait(seen, left_s):
                    raise TransportTimeoutError(f"{self.topic}: no message within {timeout_s:g} s")
                self._opened()
                seen = self._process.epoch()
            except NATIVE_ERRORS as error:
                raise translated(self.topic, error) from error
        return message

    def try_take(self) -> Message[Scalar] | None:
        """Return the next message, or None if there is none; otherwise like `take`."""
        native = self._opened()
        try:
            return native.claim()
        except NATIVE_ERRORS as error:
            raise translated(self.topic, error) from error

    def take_copy(self, timeout_s: float | None = None) -> NDArray[Scalar]:
        """Return a copy of the next message's array; otherwise like `take`."""
        with self.take(timeout_s) as message:
            return message.copy()

    def __iter__(self) -> Iterator[Message[Scalar]]:
        """Take messages one by one; each is released at the next iteration."""
        while True:
            with self.take() as message:
                yield message

    @property
    def publishers(self) -> int:
        """Number of matching publishers."""
        return self._opened().matched()

    @property
    def lost(self) -> int:
        """Number of messages known to be overwritten before they were taken."""
        return self._opened().lost()

    @property
    def superseded(self) -> int:
        """Number of messages that were not taken as a newer one was found; only with depth 1."""
        return self._opened().superseded()

    def close(self) -> None:
        """Destroy the subscription; a `take` that waits in another thread raises TransportError."""
        native, self._native = self._native, None
        if native is not None:
            native.close()
            self._process.notify()

    def _opened(self) -> _transport.Subscription:
        if self._native is None:
            raise TransportError(f"{self.topic}: the subscription is closed")
        return self._native
