# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Errors of the transport without ROS, and the translation of the native module's errors."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rmw_manycore_py.errors import EXIT_BAD_INPUT, ManycoreError
from rmw_manycore_py.native._transport import PlatformError

IN_USE = (
    "an array of the message is still in use: let go of it inside `with` (del, or work in a "
    "function), or keep message.copy() instead"
)
LOAN_IN_USE = (
    "an array of the loan is still in use, so it is not published: let go of it inside `with` "
    "(del, or work in a function)"
)
# The native module raises ValueError if another thread has closed the object.
NATIVE_ERRORS = (PlatformError, MemoryError, ValueError, BufferError)


class TransportError(ManycoreError):
    """A platform, topic or message does not meet the request; the text has the remedy."""


class TransportTimeoutError(TransportError, TimeoutError):
    """No message or subscription arrived within the timeout."""


class MessageInUseError(TransportError, BufferError):
    """A message cannot be released, or the next one taken: an array still refers to its memory."""


def refusal(what: str, expected: str, found: object) -> TransportError:
    """Return the error for an invalid argument."""
    return TransportError(f"{what}: expected {expected}, found {found}", EXIT_BAD_INPUT)


@contextmanager
def native_errors(subject: str) -> Iterator[None]:
    """Raise a TransportError about `subject` for an error of the native module.

    Calls that each message makes catch NATIVE_ERRORS instead, which costs nothing without one.
    """
    try:
        yield
    except NATIVE_ERRORS as error:
        raise translated(subject, error) from error


def translated(subject: str, error: Exception) -> TransportError:
    """Return the TransportError about `subject` for one of NATIVE_ERRORS."""
    if isinstance(error, BufferError):
        return MessageInUseError(f"{subject}: {IN_USE}")
    return TransportError(f"{subject}: {error or 'out of memory'}")
