# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Signals as a file descriptor for selectors, instead of interrupts, and deferred ones."""

from __future__ import annotations

import signal
import socket
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

STOP_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class SignalInbox:
    """Readable when signals have arrived."""

    def __init__(self, reader: socket.socket) -> None:
        self._reader = reader

    def fileno(self) -> int:
        """Return the descriptor, for selectors."""
        return self._reader.fileno()

    def take(self) -> list[signal.Signals]:
        """Return the signals received since the last call."""
        try:
            return [signal.Signals(number) for number in self._reader.recv(4096)]
        except BlockingIOError:
            return []


@contextmanager
def signal_inbox(signals: Iterable[signal.Signals] = STOP_SIGNALS) -> Iterator[SignalInbox]:
    """Collect these signals instead of acting on them; main thread only.

    SIGHUP stays ignored if it was, as under nohup.
    """
    reader, writer = socket.socketpair()
    with reader, writer:
        reader.setblocking(False)
        writer.setblocking(False)
        # First: a signal that is ignored before it can be collected would be lost.
        descriptor_before = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
        before = {
            number: signal.signal(number, _ignore)
            for number in signals
            if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN
        }
        try:
            yield SignalInbox(reader)
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)
            signal.set_wakeup_fd(descriptor_before)


@contextmanager
def interrupts_held(signals: Iterable[signal.Signals] = (signal.SIGINT,)) -> Iterator[None]:
    """Defer the handlers of these signals to the end of the block; main thread only.

    For calls of rclpy: in the middle of one, a KeyboardInterrupt may become another error, or one
    that Python prints and ignores.
    """
    noted: list[int] = []
    before = {
        number: signal.signal(number, lambda late, _frame: noted.append(late)) for number in signals
    }
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        for late in noted:
            handler = before[signal.Signals(late)]
            if callable(handler):
                handler(late, None)


def _ignore(_number: int, _frame: object) -> None:
    """Do nothing: the interpreter has already written the signal number to the inbox."""
