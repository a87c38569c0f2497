# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore service find`, with the output format of `ros2 service find`."""

from __future__ import annotations

from rmw_manycore_py.cli.common import view
from rmw_manycore_py.cli.common.completion import complete_service_types
from rmw_manycore_py.cli.common.finding import find_command

command = find_command("service", "std_srvs/srv/SetBool", complete_service_types, view.services)
