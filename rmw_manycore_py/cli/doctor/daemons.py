# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Doctor check: ros2cli daemons that keep an otherwise unused platform alive."""

from __future__ import annotations

from collections.abc import Iterator

from rmw_manycore_py.cli.doctor.finding import Finding, advised


def check_daemons() -> Iterator[Finding]:
    """Yield the daemons that alone keep platforms alive; none if that cannot be determined."""
    try:
        from rmw_manycore_py.launch.ros2_daemon import CURE, lone_daemons
        from rmw_manycore_py.native import _transport
    except ImportError:
        return
    try:
        found = {name: pids for name in _transport.platforms() if (pids := lone_daemons(name))}
    except _transport.PlatformError:
        return
    texts = (f"{name} (pid {', '.join(map(str, pids))})" for name, pids in found.items())
    shown = ", ".join(texts) or "none keeps a platform"
    advice = f"{CURE}; the next run of the platform ends it, too"
    yield advised("ros2 daemon", not found, shown, advice)
