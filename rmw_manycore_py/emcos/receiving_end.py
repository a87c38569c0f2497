# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""What the receiving ends of transfers have in common: waiting for the next arrival."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from typing import Generic, TypeVar

from rmw_manycore_py.emcos.end import End
from rmw_manycore_py.emcos.errors import PeerGoneError
from rmw_manycore_py.emcos.waiting import wait_for_any
from rmw_manycore_py.transport.arguments import Deadline

T = TypeVar("T")


class ReceivingEnd(End, Generic[T]):
    """An end that yields what arrives."""

    def __iter__(self) -> Iterator[T]:
        """Yield arrivals until the other side closes its end.

        :raises PeerGoneError: if the other process ended without closing its end.
        """
        while True:
            try:
                arrival = self._receive()
            except PeerGoneError:
                if self._link.was_closed:
                    return
                raise
            yield arrival

    @abstractmethod
    def _receive(self) -> T:
        """Sleep until there is an arrival, and return it."""

    def _sleep_until(
        self,
        look: Callable[[], T | None],
        what: str,
        timeout_s: float | None,
        readable: Callable[[], list[int]] = list,
    ) -> T:
        """Return the first arrival that `look` finds, which takes the notes of the other side.

        :param readable: descriptors that become readable with an arrival, beside the link's.
        """
        deadline = Deadline(timeout_s)
        while True:
            if (found := look()) is not None:
                return found
            self._link.require_peer()
            if not wait_for_any([*self._link.descriptors, *readable()], deadline):
                raise self._timeout(f"no {what}", timeout_s)
