# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Parts of the nodes that work without other processes."""

from __future__ import annotations

import subprocess
import sys
import time

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from tf2_msgs.msg import TFMessage

from rmw_manycore_py.ndt.geometry.poses import from_xyz_rpy, inverse
from rmw_manycore_py.ndt.messages.conversions import transform_stamped
from rmw_manycore_py.ndt.nodes.scan_matcher.frame_tree import FrameError, FrameTree
from rmw_manycore_py.process.cpu_time import tree_cpu_s

pytestmark = pytest.mark.unit

BUSY_FOR_A_WHILE = """
import time
while time.process_time() < 0.2:
    pass
input()
"""


def at(x: float) -> np.ndarray:
    return from_xyz_rpy((x, 0.0, 0.0))


def tree_of(*chain: tuple[str, str, np.ndarray]) -> FrameTree:
    tree = FrameTree()
    for parent, child, T in chain:
        tree.add(TFMessage(transforms=[transform_stamped(T, Time(), parent, child)]))
    return tree


def test_frames_up_and_down():
    T_base_mount = from_xyz_rpy((1.0, 0.0, 2.0), (0.0, 0.0, 1.0))
    T_mount_lidar, T_base_imu = from_xyz_rpy((0.1, 0.2, 0.0), (0.3, 0.0, 0.0)), at(-1.0)
    tree = tree_of(
        ("base", "mount", T_base_mount),
        ("/mount", "lidar", T_mount_lidar),
        ("base", "imu", T_base_imu),
    )
    T_base_lidar = T_base_mount @ T_mount_lidar
    np.testing.assert_allclose(tree.lookup("base", "lidar"), T_base_lidar)
    np.testing.assert_allclose(tree.lookup("lidar", "/base"), inverse(T_base_lidar), atol=1e-12)
    np.testing.assert_allclose(tree.lookup("imu", "lidar"), inverse(T_base_imu) @ T_base_lidar)
    with pytest.raises(FrameError, match="no transform connects 'map' and 'base'"):
        tree.lookup("base", "map")


def test_a_circle_of_frames_ends():
    tree = tree_of(("a", "b", at(1.0)), ("b", "c", at(1.0)), ("c", "a", at(1.0)))
    assert tree.lookup("a", "c") is not None
    with pytest.raises(FrameError):
        tree.lookup("map", "c")


def test_cpu_time_of_a_process_and_its_children():
    with subprocess.Popen([sys.executable, "-c", BUSY_FOR_A_WHILE], stdin=subprocess.PIPE) as child:
        start = time.monotonic()
        while tree_cpu_s(child.pid) < 0.15 and time.monotonic() < start + 30.0:
            pass
        assert tree_cpu_s(child.pid) >= 0.15
        assert tree_cpu_s() >= tree_cpu_s(child.pid)
        child.communicate(b"\n")
    assert tree_cpu_s(child.pid) == 0.0
