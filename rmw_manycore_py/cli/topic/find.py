# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore topic find`, with the output format of `ros2 topic find`."""

from __future__ import annotations

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_message_types
from rmw_manycore_py.cli.common.finding import find_command

command = find_command("topic", "std_msgs/msg/String", complete_message_types, view.topics)
