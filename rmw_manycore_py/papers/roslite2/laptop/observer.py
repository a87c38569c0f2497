# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Attributes commands to scans by stamps and arrivals: an upper bound of the latency.

```
 scan stamped ──► its pose arrives ──► first kinematics stamped after that arrive
              ──► first control_cmd stamped after that arrives ──► next cmd_vel
```

Each arrow ends on the laptop, after the bridge: the nodes on the platform had the message earlier
and may have used it one period before the counted one.
"""

from __future__ import annotations

import time
from typing import Any

from autoware_control_msgs.msg import Control
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node

from rmw_manycore_py.ndt.messages.conversions import nanoseconds, seconds
from rmw_manycore_py.papers.roslite2.laptop import topics
from rmw_manycore_py.papers.roslite2.laptop.drive_log import DriveLog, Scan


class Observer:
    """Subscriptions for measurement only; the wheelchair works without them."""

    def __init__(self, node: Node, log: DriveLog) -> None:
        self._log = log
        self._open: list[Scan] = []  # not followed by a command yet
        self.kinematics_s: float | None = None  # newest arrival
        node.create_subscription(PoseStamped, topics.POSE, self._on_pose, 10)
        node.create_subscription(Odometry, topics.KINEMATICS, self._on_kinematics, 10)
        node.create_subscription(Control, topics.CONTROL, self._on_control, 10)

    def sent(self, stamp_ns: int) -> None:
        """Record that a scan was sent."""
        scan = Scan(1e-9 * stamp_ns)
        self._log.scans[stamp_ns] = scan
        self._open.append(scan)

    def on_command(self, time_s: float) -> None:
        """Record the arrival of a cmd_vel."""
        for scan in self._open:
            if scan.control_s is not None:
                scan.command_s = time_s
        self._open = [scan for scan in self._open[-100:] if scan.command_s is None]

    def _on_pose(self, message: Any) -> None:
        scan = self._log.scans.get(nanoseconds(message.header.stamp))
        if scan is not None and scan.pose_s is None:
            scan.pose_s = time.time()

    def _on_kinematics(self, message: Any) -> None:
        stamp_s, self.kinematics_s = seconds(message.header.stamp), time.time()
        for scan in self._open:
            if scan.kinematics_s is None and scan.pose_s is not None and stamp_s >= scan.pose_s:
                scan.kinematics_s = self.kinematics_s

    def _on_control(self, message: Any) -> None:
        stamp_s, now_s = seconds(message.stamp), time.time()
        for scan in self._open:
            made_after = scan.kinematics_s
            if scan.control_s is None and made_after is not None and stamp_s >= made_after:
                scan.control_s = now_s
