# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Errors of transfers between two processes."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

from rmw_manycore_py.native._transport import PlatformError
from rmw_manycore_py.transport.errors import TransportError


class PeerGoneError(TransportError, ConnectionError):
    """The process of the other side has closed its end, or was killed; the text names which."""


@contextmanager
def system_errors(subject: str) -> Iterator[None]:
    """Raise a TransportError about `subject` for an error of the system or of its settings."""
    try:
        yield
    except TransportError:
        raise
    except PlatformError as error:
        raise TransportError(f"{subject}: {error}") from error
    except MemoryError as error:
        raise TransportError(f"{subject}: out of memory") from error
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        raise TransportError(f"{subject}: {reason}") from error
