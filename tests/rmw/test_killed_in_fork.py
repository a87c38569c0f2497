# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A parent that is killed while its child of fork() copies the messages that it inherits."""

from __future__ import annotations

import os
import signal
import sys

import pytest

from rmw_manycore_py.native import _transport
from support import IS_MANYCORE, wait_until
from support.nodes.exchanging import Exchange, in_record, large
from support.nodes.ros import announce, peer_node
from support.processes.commands import peer_command

pytestmark = pytest.mark.skipif(not IS_MANYCORE, reason="others copy")


@pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")
def test_a_child_whose_parent_is_killed_in_fork_reads_nothing_torn(node, start):
    """It has its copies of what the parent holds, or ends and says why."""
    python, *program = peer_command(fork_and_stop)
    peer = start([python, "-u", *program])  # not forked by a server, which converts messages before
    peer.wait_for("^forked$")
    peer.signal(signal.SIGKILL)
    with _transport.Platform(os.environ["MANYCORE_PLATFORM"]) as seen:
        wait_until(lambda: len(seen.processes()) == 1, "the killed parent is reclaimed")
    peer.say("go on")
    peer.wait_for("^Fatal Python error: .*parent was killed before its child had copied")


def fork_and_stop() -> None:
    """Fork while a message is held; the child goes on when it is told to."""

    def stop() -> None:
        announce("forked")
        sys.stdin.readline()

    os.register_at_fork(after_in_child=stop)  # before the one that copies what is held
    with peer_node() as node:
        held = Exchange(node)(large())
        assert in_record(held)
        if os.fork() == 0:
            announce("whole" if held == large() else "torn")
            os._exit(0)
