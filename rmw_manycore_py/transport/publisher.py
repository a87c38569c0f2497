# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Publishers of numpy arrays."""

from __future__ import annotations

from typing import Any, Generic

import numpy as np
from numpy.typing import NDArray

from rmw_manycore_py.native import _transport
from rmw_manycore_py.native._transport import Loan
from rmw_manycore_py.transport.arguments import Deadline, checked_number
from rmw_manycore_py.transport.closing import Closing
from rmw_manycore_py.transport.errors import (
    NATIVE_ERRORS,
    TransportError,
    TransportTimeoutError,
    native_errors,
    refusal,
    translated,
)
from rmw_manycore_py.transport.multi_array import Scalar, checked_shape, head_of, room_for

MAX_SUBSCRIPTIONS = 32_768


class Publisher(Closing, Generic[Scalar]):
    """Publisher of arrays of one element type, created by `Member.publisher`; thread-safe.

    :ivar topic: full name of the topic.
    :ivar dtype: element type.
    """

    def __init__(
        self,
        topic: str,
        dtype: np.dtype[Scalar],
        platform: str,
        process: _transport.Process,
        native: _transport.Publisher,
    ) -> None:
        self.topic = topic
        self.dtype = dtype
        self._platform = platform
        self._process = process
        self._native: _transport.Publisher | None = native

    def __repr__(self) -> str:
        return f"<Publisher of {self.dtype} on {self.topic}>"

    def publish(self, array: NDArray[Scalar]) -> int:
        """Publish an array; its elements are copied once, into shared memory.

        With ``keep_all`` it blocks, up to a limit, until subscriptions have taken enough messages;
        otherwise it does not block.

        :param array: at least one dimension; an array that is not C-contiguous is copied once
            more.
        :return: the message's sequence number, from 1.
        :raises TransportError: if it is not an array of this type, or does not fit the memory.
        """
        native = self._opened()
        contiguous = self._checked(array)
        head = head_of(contiguous.shape, contiguous.itemsize)
        try:
            return native.publish_parts(head, contiguous.data)
        except NATIVE_ERRORS as error:
            raise translated(self.topic, error) from error

    def lend(self, shape: int | tuple[int, ...]) -> Loan[Scalar]:
        """Lend an array in shared memory, which is published without a copy.

        ```python
        with images.lend((1080, 1920, 3)) as loan:
            camera.read_into(loan.array)
        ```

        :param shape: of the array, at least one dimension.
        :return: the loan; the message is published at the end of its `with`.
        :raises TransportError: if no message can have this shape, if it does not fit the memory, or
            if the topic has a `topic_dsm_size` or a transfer: use `publish` there.
        """
        native = self._opened()
        wanted = shape if isinstance(shape, (int, tuple)) else checked_shape(shape)
        sizes, head, body_bytes = room_for(wanted, self.dtype.itemsize)
        try:
            loan = native.lend(head, body_bytes, sizes, self.dtype)
        except NATIVE_ERRORS as error:
            raise translated(self.topic, error) from error
        if loan is None:
            raise TransportError(
                f"{self.topic}: its messages lie in a ring of fixed size or are transferred, so no "
                "room can be lent: use publish()"
            )
        return loan

    @property
    def subscriptions(self) -> int:
        """Number of matching subscriptions."""
        return self._opened().matched()

    def wait_for_subscriptions(self, count: int = 1, timeout_s: float | None = None) -> None:
        """Wait until at least `count` subscriptions match.

        :param timeout_s: in seconds; None waits indefinitely.
        :raises TransportTimeoutError: if fewer match within the timeout.
        """
        checked_number("count", count, 0, MAX_SUBSCRIPTIONS)
        deadline = Deadline(timeout_s)
        with native_errors(self.topic):
            self._process.watch_graph()
            while True:
                native = self._opened()
                self._process.require_membership()
                seen = self._process.epoch()
                if (found := native.matched()) >= count:
                    return
                if not self._process.wait(seen, deadline.left_s()):
                    raise TransportTimeoutError(
                        f"{self.topic}: {found} of {count} subscriptions after {timeout_s:g} s; "
                        "they match by topic, type and QoS: see "
                        f"`manycore topic info -v --platform {self._platform} {self.topic}`"
                    )

    def close(self) -> None:
        """Destroy the publisher; subscriptions can still take its pending messages."""
        native, self._native = self._native, None
        if native is not None:
            native.close()

    def _opened(self) -> _transport.Publisher:
        if self._native is None:
            raise TransportError(f"{self.topic}: the publisher is closed")
        return self._native

    def _checked(self, array: Any) -> NDArray[Scalar]:
        if not isinstance(array, np.ndarray):
            raise refusal("array", "a numpy array", type(array).__name__)
        if array.dtype != self.dtype:
            expected = f"elements of {self.dtype} on {self.topic} (array.astype('{self.dtype}'))"
            raise refusal("array", expected, array.dtype)
        return np.ascontiguousarray(array) if array.ndim else array
