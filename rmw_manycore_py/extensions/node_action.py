# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Extension of launch_ros that places the nodes of an unmodified launch file.

`MANYCORE_MAPFILE` names the mapfile; without it the extension does nothing. launch_ros calls it
before starting each Node action, including LifecycleNode and ComposableNodeContainer.
See docs/design/ros2_launch.md.
"""

from __future__ import annotations

import atexit
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import Any

from launch import LaunchContext, LaunchDescription
from launch.actions import ExecuteProcess
from launch.event_handlers import OnShutdown
from launch.events import IncludeLaunchDescription
from launch.logging import get_logger
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.actions.node import Node, NodeActionExtension

from rmw_manycore_py.errors import ManycoreError, MapfileError
from rmw_manycore_py.extensions.foreign_launch import MAPFILE_VARIABLE, ForeignLaunch
from rmw_manycore_py.mapfile.placing.placement import PlacedNode
from rmw_manycore_py.mapfile.placing.prefix import placed_again
from rmw_manycore_py.ros.names import full_node_name

_RESTART_PAUSE_S = 1.0  # same as `manycore run`


class ManycoreNodeAction(NodeActionExtension):  # type: ignore[misc]
    """Pins a node to the host CPU of its core, and joins it to its cluster."""

    def __init__(self) -> None:
        super().__init__()
        # Create the platform before launch creates a node of its own, e.g. for lifecycles.
        # launch_ros only logs exceptions raised here; `prepare_for_execute` raises them again.
        if os.environ.get(MAPFILE_VARIABLE):
            _begin()

    def prepare_for_execute(
        self, context: LaunchContext, ros_specific_arguments: dict[str, Any], node_action: Node
    ) -> tuple[list[Any], dict[str, Any]]:
        """Place the node; its command line is unchanged."""
        if os.environ.get(MAPFILE_VARIABLE):
            launch = _launch(context)
            name, namespace, executable = _names(context, ros_specific_arguments, node_action)
            try:
                placed = launch.place(name, namespace, executable)
            except MapfileError as error:  # raising here would leave started nodes behind
                _logger().error(f"{error}; the last one is not pinned")
                return [], ros_specific_arguments
            if placed is None:
                full_name = full_node_name(namespace, name or executable)
                _logger().warning(f"{full_name} is not in the mapfile: it is not pinned")
                _start_with(node_action, None, lambda given: {**given, **launch.elsewhere(given)})
            else:
                _place(launch, node_action, placed)
        return [], ros_specific_arguments


def _names(
    context: LaunchContext, ros_specific_arguments: dict[str, Any], node_action: Node
) -> tuple[str | None, str, str]:
    """Return name (None: set by the program), namespace and executable of a node."""
    name = ros_specific_arguments.get("name", "").removeprefix("__node:=")
    namespace = ros_specific_arguments.get("ns", "").removeprefix("__ns:=")
    if namespace == Node.UNSPECIFIED_NODE_NAMESPACE:
        namespace = ""
    executable = normalize_to_list_of_substitutions(node_action.node_executable)
    return name or None, namespace or "/", perform_substitutions(context, executable)


def _place(launch: ForeignLaunch, action: Node, placed: PlacedNode) -> None:
    """Pin the action's process to its host CPU, and set the environment of its core."""
    _start_with(
        action,
        placed.host_cpu,
        lambda given: launch.environment(placed, given),
    )
    _logger().info(
        f"{placed.name}: cluster {placed.cluster} core {placed.core} -> host CPU {placed.host_cpu}"
    )


def _start_with(
    action: Node,
    host_cpu: int | None,
    environment_of: Callable[[Mapping[str, str]], Mapping[str, str]],
) -> None:
    """Start the action's process on a host CPU, in an environment made from that of launch."""
    description = action.process_description
    prepare = description.prepare

    def prepare_and_change(context: LaunchContext, action: Any) -> None:
        prepare(context, action)
        if host_cpu is not None:
            _pin(description, host_cpu)
        environment = environment_of(dict(description.final_env))
        description.final_env.clear()
        description.final_env.update(environment)

    description.prepare = prepare_and_change


def _pin(description: Any, host_cpu: int) -> None:
    """Pin a process before its launch prefix, so that a debugger starts the node itself.

    A prefix that pins is followed by another pin: the mapfile decides.
    """
    words = description.final_cmd
    count = len(words) - len(description.cmd)
    words[count:count] = placed_again(words[:count], host_cpu, None)
    words[:0] = _pinned([host_cpu])


def _pinned(host_cpus: Sequence[int]) -> list[str]:
    """Return the command prefix that pins a process before its first instruction."""
    if not host_cpus:
        return []
    taskset = shutil.which("taskset")
    if taskset is None:
        raise ManycoreError("expected taskset (to pin nodes), found none; apt install util-linux")
    return [taskset, "--cpu-list", ",".join(map(str, host_cpus))]


@cache
def _begin() -> ForeignLaunch | ManycoreError:
    """Configure the platform once per process; an error is raised with the first node.

    launch_ros would log an exception of a constructor and start the nodes anyway.
    """
    try:
        launch = ForeignLaunch(os.environ[MAPFILE_VARIABLE])
    except ManycoreError as error:
        return error
    atexit.register(launch.close)
    return launch


def _launch(context: LaunchContext) -> ForeignLaunch:
    launch = _begin()
    if isinstance(launch, ManycoreError):
        raise launch
    _accompany(launch, context)
    return launch


@cache
def _accompany(launch: ForeignLaunch, context: LaunchContext) -> None:
    """Report the placement, start the bridge, and clean up on shutdown."""
    for is_warning, text in launch.describe():
        (_logger().warning if is_warning else _logger().info)(text)

    def report_unstarted(_event: Any, _context: LaunchContext) -> None:
        if names := ", ".join(launch.not_started):
            _logger().warning(f"in the mapfile, but not started by the launch file: {names}")

    context.register_event_handler(OnShutdown(on_shutdown=report_unstarted))
    processes = [
        ExecuteProcess(
            cmd=[*_pinned(program.host_cpus), *program.command],
            name=program.name.strip("()").replace(" ", "_"),
            env=dict(program.environment),
            output="screen",
            respawn=True,
            respawn_delay=_RESTART_PAUSE_S,
        )
        for program in launch.bridge
    ]
    if processes:
        context.emit_event_sync(IncludeLaunchDescription(LaunchDescription(processes)))


def _logger() -> Any:
    return get_logger("manycore")
