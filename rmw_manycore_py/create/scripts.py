# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Launch script of a node: its command and full environment, for any shell."""

from __future__ import annotations

import os
import shlex
from pathlib import PurePosixPath

from rmw_manycore_py.mapfile.placing.placement import PlacedNode
from rmw_manycore_py.mapfile.placing.show import rules_in_words

# Variables that locate a ROS 2 installation; copied from the environment of `create`.
_OF_THE_INSTALLATION = ("AMENT_PREFIX_PATH", "PYTHONPATH")


def launch_script(node: PlacedNode, parameter_files: list[PurePosixPath]) -> str:
    """Return the script; paths of parameter files are relative to its parent directory."""
    inherited = {key: os.environ[key] for key in _OF_THE_INSTALLATION if key in os.environ}
    # The placement is that of this domain, so the script must not take another from its shell.
    inherited["ROS_DOMAIN_ID"] = os.environ.get("ROS_DOMAIN_ID") or "0"
    lines = [
        "#!/bin/sh",
        f"# {node.full_name} on {node.place}, host CPU {node.host_cpu}.",
        *(f"# With manycore run: {rule}." for rule in rules_in_words(node)),
        'created=$(cd "$(dirname "$0")/.." && pwd) || exit 1',
        *(f"export {key}={shlex.quote(value)}" for key, value in {**inherited, **node.env}.items()),
        f"cd {shlex.quote(str(node.cwd))} || exit 1",
        f"exec {_scheduler(node)}taskset --cpu-list {node.host_cpu} \\",
        *_command(node, parameter_files),
    ]
    return "\n".join(lines) + "\n"


def _scheduler(node: PlacedNode) -> str:
    scheduling = node.scheduling
    return f"chrt --{scheduling.policy} {scheduling.priority} " if scheduling else ""


def _command(node: PlacedNode, parameter_files: list[PurePosixPath]) -> list[str]:
    """Return the command, one option per line; parameters come from files."""
    options = [shlex.join(node.program)]
    for word in node.ros_arguments:
        if word.startswith("-"):
            options.append(shlex.quote(word))
        else:
            options[-1] += f" {shlex.quote(word)}"
    options += [f'--params-file "$created"/{shlex.quote(str(file))}' for file in parameter_files]
    last = len(options) - 1
    return [f"  {option}" + (" \\" if i < last else ' "$@"') for i, option in enumerate(options)]
