# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Errors of the transport without ROS, and the translation of the native module's errors."""

from __future__ import annotations

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native._transport import PlatformError

IN_USE = (
    "an array of the message is still in use: let go of it inside `with` (del, or work in a "
    "function), or keep message.copy() instead"
)


class TransportError(ManycoreError):
    """A platform, topic or message does not meet the request; the text has the remedy."""


class TransportTimeoutError(TransportError, TimeoutError):
    """No message or subscription arrived within the timeout."""


class MessageInUseError(TransportError, BufferError):
    """A message cannot be released, or the next one taken: an array still refers to its memory."""


def refusal(what: str, expected: str, found: object) -> TransportError:
    """Return the error for an invalid argument."""
    return TransportError(f"{what}: expected {expected}, found {found}", EXIT_BAD_INPUT)


class native_errors:  # noqa: N801 (a context manager like contextlib's, on the way of a message)
    """Raise a TransportError about `subject` for an error of the native module.

    The native module raises ValueError if another thread has closed the object.
    """

    __slots__ = ("_subject",)

    def __init__(self, subject: str) -> None:
        self._subject = subject

    def __enter__(self) -> None:
        pass

    def __exit__(
        self, _: type[BaseException] | None, error: BaseException | None, *__: object
    ) -> None:
        if isinstance(error, BufferError):
            raise MessageInUseError(f"{self._subject}: {IN_USE}") from error
        if isinstance(error, (PlatformError, MemoryError, ValueError)):
            raise TransportError(f"{self._subject}: {error or 'out of memory'}") from error
