# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Room for a message in shared memory, filled where it is published from."""

from __future__ import annotations

from typing import Generic

import numpy as np
from numpy.typing import NDArray
from typing_extensions import Self

from rmw_manycore_py.native import _transport
from rmw_manycore_py.transport.errors import MessageInUseError, TransportError
from rmw_manycore_py.transport.multi_array import Scalar

_IN_USE = (
    "an array of the loan is still in use, so it is not published: let go of it inside `with` "
    "(del, or work in a function)"
)


class Loan(Generic[Scalar]):
    """A message in the making; it is published at the end of its `with` block.

    An exception inside of the block gives the room back, and nothing is published. Until then the
    publisher can publish and lend further messages.

    :ivar sequence: sequence number of the published message, from 1; None before.
    """

    def __init__(self, native: _transport.Loan, array: NDArray[Scalar]) -> None:
        self.sequence: int | None = None
        self._native: _transport.Loan | None = native
        self._array: NDArray[Scalar] | None = array

    @property
    def array(self) -> NDArray[Scalar]:
        """The array in shared memory: writable, C-contiguous, aligned, not cleared.

        It must not outlive the `with` block.

        :raises TransportError: if the message was published or given back.
        """
        if self._array is None:
            raise TransportError("the loan is over: fill its array inside `with`")
        return self._array

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        native, self._native, self._array = self._native, None, None
        if native is None:
            return
        if kind is not None:  # the traceback of the error may refer to arrays
            del native
            return
        try:
            self.sequence = native.publish()
        except BufferError as error:
            raise MessageInUseError(_IN_USE) from error


def array_in(
    native: _transport.Loan, shape: tuple[int, ...], dtype: np.dtype[Scalar]
) -> NDArray[Scalar]:
    """Return the array in the room of a loan."""
    if 0 in shape:
        return np.empty(shape, dtype)
    elements: NDArray[Scalar] = np.frombuffer(memoryview(native), dtype)
    return elements if len(shape) == 1 else elements.reshape(shape)
