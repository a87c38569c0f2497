# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Reads launch files with launch and launch_ros themselves, which start nothing here.

For each line of standard input, a launch file and its arguments separated by tabs, prints a line of
JSON: the processes that it would start, or why launch refuses it.
"""

from __future__ import annotations

import json
import os
import traceback
from itertools import pairwise
from pathlib import Path
from typing import Any

from launch import LaunchContext
from launch.actions import ExecuteLocal, IncludeLaunchDescription, RegisterEventHandler, TimerAction
from launch.launch_description_sources import AnyLaunchDescriptionSource
from launch_ros.actions import LoadComposableNodes, Node, RosTimer
from launch_ros.actions.load_composable_nodes import get_composable_node_load_request


class Recorder:
    """What a launch file would start, in order."""

    def __init__(self) -> None:
        self.processes: list[dict[str, Any]] = []
        self.components: list[dict[str, Any]] = []

    def process(self, action: ExecuteLocal, context: LaunchContext) -> None:
        """Record a process instead of starting it."""
        action.prepare(context)
        description = action.process_description
        self.processes.append(
            {
                "node": isinstance(action, Node),
                "words": [str(word) for word in description.final_cmd],
                "env": dict(description.final_env),
                "cwd": description.final_cwd,
                "files": _files_of(description.final_cmd),
            }
        )

    def load(self, action: LoadComposableNodes, context: LaunchContext) -> None:
        """Record the components that an action would load."""
        described = vars(action)["_LoadComposableNodes__composable_node_descriptions"]
        for one in described:
            request = get_composable_node_load_request(one, context)
            if request is not None:
                self.components.append(
                    {
                        "plugin": request.plugin_name,
                        "name": request.node_name,
                        "namespace": request.node_namespace,
                        "remappings": list(request.remap_rules),
                        "parameters": [str(one) for one in request.parameters],
                    }
                )


def _files_of(words: list[str]) -> dict[str, str]:
    """Return the content of the parameter files that launch has written for a process."""
    names = [word for previous, word in pairwise(words) if previous == "--params-file"]
    return {name: Path(name).read_text() for name in names if "/launch_params_" in name}


def visit(recorder: Recorder, context: LaunchContext, entities: Any, later: list[Any]) -> None:
    """Visit entities as LaunchService does; timers and event handlers come last."""
    for entity in entities or ():
        if isinstance(entity, (TimerAction, RosTimer)):
            if entity.condition is None or entity.condition.evaluate(context):
                later.append(entity.actions)
        elif isinstance(entity, RegisterEventHandler):
            later.append(getattr(entity.event_handler, "entities", None) or ())
        elif isinstance(entity, LoadComposableNodes):
            if entity.condition is None or entity.condition.evaluate(context):
                recorder.load(entity, context)
        else:
            visit(recorder, context, entity.visit(context), later)


def read(file: str, arguments: dict[str, str]) -> dict[str, Any]:
    """Return what a launch file starts, or the error."""
    recorder, context = Recorder(), LaunchContext()
    ExecuteLocal.execute = lambda self, context: recorder.process(self, context)
    environment = dict(os.environ)
    try:
        source = AnyLaunchDescriptionSource(file)
        include = IncludeLaunchDescription(source, launch_arguments=arguments.items())
        later: list[Any] = [[include]]
        while later:
            visit(recorder, context, later.pop(0), later)
    except Exception as error:
        shown = "".join(traceback.format_exception_only(type(error), error)).strip()
        return {"error": shown[:400]}
    finally:
        os.environ.clear()
        os.environ.update(environment)
    return {"processes": recorder.processes, "components": recorder.components}


def main() -> None:
    lines, results = os.fdopen(os.dup(0)), os.fdopen(os.dup(1), "w")
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)  # commands in launch files read it
    os.dup2(2, 1)  # launch logs to it
    for line in lines:
        file, *words = line.rstrip("\n").split("\t")
        result = read(file, dict(word.split(":=", 1) for word in words))
        print(json.dumps(result), file=results, flush=True)


if __name__ == "__main__":
    main()
