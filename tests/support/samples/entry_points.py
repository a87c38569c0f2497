# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""A package whose node has an entry point, and no script."""

from __future__ import annotations

from pathlib import Path

_CODE = """
import rclpy

def main():
    rclpy.init()
    rclpy.spin(rclpy.create_node("detector"))
"""


def write_entry_point(directory: Path) -> None:
    """Write `my_robot`, whose executable is `detector`, into a directory for PYTHONPATH."""
    (directory / "my_robot.py").write_text(_CODE)
    info = directory / "my_robot-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my_robot\nVersion: 1.0\n")
    (info / "RECORD").write_text("my_robot.py,,\n")
    (info / "entry_points.txt").write_text("[console_scripts]\ndetector = my_robot:main\n")
