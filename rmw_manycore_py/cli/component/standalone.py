# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore component standalone`."""

from __future__ import annotations

import signal
import subprocess
import sys
import uuid

import click

from rmw_manycore_py.cli.common.node_names import absolute_name, existing_node
from rmw_manycore_py.cli.common.options import discovery_options, examples, platform_option
from rmw_manycore_py.cli.common.printing import echo
from rmw_manycore_py.cli.common.tool_node import tool_node
from rmw_manycore_py.cli.component.containers import Container, Wanted, loaded_line
from rmw_manycore_py.cli.component.wanted_options import wanted_options
from rmw_manycore_py.errors import ManycoreError
from rmw_manycore_py.launch.processes.environment import enter_middleware, program_environment
from rmw_manycore_py.mapfile.programs.executables import find_executable
from rmw_manycore_py.process.parent_death import dies_with_this_process

PACKAGE, EXECUTABLE = "rclcpp_components", "component_container"
START_TIMEOUT_S, END_TIMEOUT_S = 30.0, 5.0


@click.command(
    "standalone",
    epilog=examples("manycore component standalone composition composition::Talker"),
)
@wanted_options
@click.option(
    "-c",
    "--container-node-name",
    "name",
    help="Name of the container node; default: a unique name.",
)
@discovery_options
@platform_option
def command(wanted: Wanted, name: str | None, platform: str) -> None:
    """Run PLUGIN of PACKAGE in its own container.

    Until Ctrl-C.
    """
    program = find_executable(PACKAGE, EXECUTABLE)
    if program is None:
        raise ManycoreError(
            f"Package '{PACKAGE}' not found: it provides the container '{EXECUTABLE}' "
            "and comes with a ROS 2 installation, not with the wheels on PyPI"
        )
    enter_middleware()  # re-executes this program, so do it before starting the container
    name = name or f"standalone_container_{uuid.uuid4().hex[:12]}"
    container = subprocess.Popen(
        [*program.argv, "--ros-args", "-r", f"__node:={name}"],
        env=program_environment({"MANYCORE_PLATFORM": platform}),
        start_new_session=True,  # only `_end` forwards Ctrl-C, once
        preexec_fn=dies_with_this_process(),
    )
    full_name = absolute_name(name)
    try:
        existing_node(platform, name, START_TIMEOUT_S, "Unable to find container node")
        with tool_node(platform) as tool:
            unique_id, node = Container(tool, full_name).load(wanted)
    except (ManycoreError, KeyboardInterrupt):
        _end(container)
        raise
    sys.exit(_end_of(container, loaded_line(unique_id, full_name, node)))


def _end_of(container: subprocess.Popen[bytes], line: str) -> int:
    """Print a line, wait for the container to exit, and return its exit status.

    From the line on, an interrupt ends the container and counts as success.
    """
    try:
        echo(line)
        return container.wait()
    except KeyboardInterrupt:
        return _end(container)


def _end(container: subprocess.Popen[bytes]) -> int:
    container.send_signal(signal.SIGINT)
    try:
        return container.wait(END_TIMEOUT_S)
    except subprocess.TimeoutExpired:
        container.kill()
        return container.wait()
