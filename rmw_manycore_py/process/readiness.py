# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""How a child process reports to its parent that it has come up."""

from __future__ import annotations

import os

# Variable with the number of the inherited eventfd.
_VARIABLE = "_RMW_MANYCORE_READY_FD"


class Readiness:
    """Parent side: keeps what the child has reported, even after the child's death."""

    def __init__(self) -> None:
        self.fd = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)

    @property
    def variables(self) -> dict[str, str]:
        """Environment variables that pass the descriptor to the child."""
        return {_VARIABLE: str(self.fd)}

    def close(self) -> bool:
        """Close the descriptor; return whether the child has come up."""
        try:
            return os.eventfd_read(self.fd) > 0
        except BlockingIOError:
            return False
        finally:
            os.close(self.fd)


def report_ready() -> None:
    """Report to the parent, if it has asked, that this process has come up."""
    fd = os.environ.pop(_VARIABLE, None)
    if fd is not None:
        os.eventfd_write(int(fd), 1)
        os.close(int(fd))
