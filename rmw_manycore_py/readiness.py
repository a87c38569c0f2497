# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How a process tells the one that started it that it has come up."""

from __future__ import annotations

import os

# Names the eventfd that the process inherits.
_VARIABLE = "_RMW_MANYCORE_READY_FD"


class Readiness:
    """The parent's side: holds what its child has reported even when the child is dead."""

    def __init__(self) -> None:
        self.fd = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)

    @property
    def variables(self) -> dict[str, str]:
        """The environment in which the child finds the descriptor."""
        return {_VARIABLE: str(self.fd)}

    def close(self) -> bool:
        """Tell whether the child has come up, once and at the end."""
        try:
            return os.eventfd_read(self.fd) > 0
        except BlockingIOError:
            return False
        finally:
            os.close(self.fd)


def report_ready() -> None:
    """Tell the parent, if it asked, that this process has come up."""
    fd = os.environ.pop(_VARIABLE, None)
    if fd is not None:
        os.eventfd_write(int(fd), 1)
        os.close(int(fd))
