# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Forked peers behave as programs with an interpreter of their own."""

from __future__ import annotations

import signal

import pytest

from support.processes.commands import peer_command

pytestmark = pytest.mark.integration


def stay() -> None:
    signal.pause()


def test_a_peer_that_is_interrupted_at_once_ends(start) -> None:
    for _ in range(50):
        peer = start(peer_command(stay))
        peer.signal(signal.SIGINT)
        assert peer.wait() != 0
