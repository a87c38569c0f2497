# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A complete replay."""

from __future__ import annotations

import gc

import rclpy
from rclpy.signals import SignalHandlerOptions

from rmw_manycore_py.ndt.geometry.arrays import Points
from rmw_manycore_py.ndt.recordings.recording import Recording
from rmw_manycore_py.ndt.replay.guess_source import GuessSource
from rmw_manycore_py.ndt.replay.player import Player
from rmw_manycore_py.ndt.replay.progress import ReplayProgress
from rmw_manycore_py.ndt.replay.tally import Tally


def run(
    drive: Recording,
    source: GuessSource,
    tally: Tally,
    map_points: Points | None,
    voxel_m: float,
    rate_hz: float | None,
    waits: bool,
    timeout_s: float,
    pid: int | None,
) -> None:
    """Publish the map if there is one, wait for the matcher, play; fill the tally.

    :param pid: process whose CPU time is measured; None uses the matcher's diagnostics.
    """
    # rclpy's own signal handlers would shut down the context while the node is spinning.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    player = Player(drive, source, tally, voxel_m, pid)
    try:
        if map_points is not None:
            player.publish_map(map_points)
        player.warm_up(timeout_s)
        gc.freeze()  # keep the garbage collector from scanning loaded data during timing
        with ReplayProgress(tally, len(drive)) as progress:
            player.play(rate_hz, waits, progress.played)
    finally:
        player.destroy_node()
        rclpy.try_shutdown()
