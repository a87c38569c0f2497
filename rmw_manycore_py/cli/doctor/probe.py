# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Process that starts rclpy for the doctor and prints the middleware and loaded libraries."""

from __future__ import annotations

from pathlib import Path

import rclpy

LIBRARIES = (("librmw_manycore.so",), ("libfastrtps.so", "libfastdds.so"))


def main() -> None:
    """Print the RMW identifier, and for each library, by its names, whether it is loaded."""
    lines = Path("/proc/self/maps").read_text().splitlines()
    maps = [line for line in lines if "/standin/" not in line]
    print(rclpy.get_rmw_implementation_identifier())
    print(*(any(name in line for line in maps for name in names) for names in LIBRARIES))


if __name__ == "__main__":
    main()
