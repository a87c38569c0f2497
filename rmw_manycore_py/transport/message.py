# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A taken message, in shared memory."""

from __future__ import annotations

from typing import Generic

import numpy as np
from numpy.typing import NDArray
from typing_extensions import Self

from rmw_manycore_py.native import _transport
from rmw_manycore_py.transport.errors import IN_USE, MessageInUseError, TransportError
from rmw_manycore_py.transport.multi_array import Heads, Scalar


class Message(Generic[Scalar]):
    """A message in shared memory, released at the end of its `with` block.

    Until then its publisher does not overwrite it, however many messages it publishes.

    :ivar sequence: sequence number of its publisher, from 1.
    :ivar source_timestamp_ns: time of publication [ns since 1970, CLOCK_REALTIME].
    :ivar publisher: GID of its publisher, 16 bytes.
    """

    def __init__(self, claim: _transport.Claim, dtype: np.dtype[Scalar], heads: Heads) -> None:
        self.sequence = claim.sequence
        self.source_timestamp_ns = claim.source_timestamp_ns
        self.publisher = claim.publisher
        self._claim: _transport.Claim | None = claim
        self._dtype = dtype
        self._heads = heads
        self._array: NDArray[Scalar] | None = None

    @property
    def array(self) -> NDArray[Scalar]:
        """The array in shared memory: read-only, with the publisher's shape, C-contiguous.

        It must not outlive the message; use `copy()` to keep it. Elements of 8 bytes are not
        aligned in CDR: numpy handles them a little more slowly.

        :raises TransportError: if the message was released, or is not an array of this type.
        """
        if self._array is None:
            self._array = self._view()
        return self._array

    def copy(self) -> NDArray[Scalar]:
        """Return a copy of the array, writable and aligned.

        :raises TransportError: as `array` does.
        """
        own: NDArray[Scalar] = self.array.copy()
        return own

    def release(self) -> None:
        """Release the message's memory to its publisher; idempotent.

        :raises MessageInUseError: if an array still refers to that memory; it is then released
            with the last such array.
        """
        claim, self._claim, self._array = self._claim, None, None
        if claim is None:
            return
        try:
            claim.release()
        except BufferError as error:
            raise MessageInUseError(IN_USE) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        try:
            self.release()
        except MessageInUseError:
            if kind is None:  # else the traceback of the error may refer to arrays
                raise

    def _view(self) -> NDArray[Scalar]:
        claim = self._claim
        if claim is None:
            raise TransportError("the message was released: use its array inside `with`, or copy()")
        view = memoryview(claim)
        layout = self._heads.layout_of(view)
        dtype = self._dtype if layout.is_little_endian else self._dtype.newbyteorder(">")
        if layout.size == 0:
            return np.empty(layout.shape, dtype)
        # This keeps the view of the claim as long as an array lives, which np.ndarray() would not.
        elements: NDArray[Scalar] = np.frombuffer(view, dtype, layout.size, layout.offset_bytes)
        return elements if len(layout.shape) == 1 else elements.reshape(layout.shape)
