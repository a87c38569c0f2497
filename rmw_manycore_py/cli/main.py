# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""The command line `manycore`."""

from __future__ import annotations

import click

from rmw_manycore_py import __version__
from rmw_manycore_py.cli.common.group import LazyGroup
from rmw_manycore_py.cli.common.options import examples
from rmw_manycore_py.cli.common.streams import open_closed_streams

VERBS = {
    "run": "rmw_manycore_py.cli.run:command",
    "up": "rmw_manycore_py.cli.up:command",
    "ps": "rmw_manycore_py.cli.ps:command",
    "logs": "rmw_manycore_py.cli.logs:command",
    "restart": "rmw_manycore_py.cli.restart:command",
    "move": "rmw_manycore_py.cli.move:command",
    "attach": "rmw_manycore_py.cli.attach:command",
    "stop": "rmw_manycore_py.cli.stop:command",
    "pause": "rmw_manycore_py.cli.pause:command",
    "step": "rmw_manycore_py.cli.step:command",
    "resume": "rmw_manycore_py.cli.resume:command",
    "demo": "rmw_manycore_py.cli.demo:command",
    "create": "rmw_manycore_py.cli.create:command",
    "map": "rmw_manycore_py.cli.map:command",
    "status": "rmw_manycore_py.cli.status:command",
    "top": "rmw_manycore_py.cli.top:command",
    "view": "rmw_manycore_py.cli.view:command",
    "trace": "rmw_manycore_py.cli.trace:command",
    "profile": "rmw_manycore_py.cli.profile:command",
    "simulate": "rmw_manycore_py.cli.simulate:command",
    "advise": "rmw_manycore_py.cli.advise:command",
    "topic": "rmw_manycore_py.cli.topic:command",
    "node": "rmw_manycore_py.cli.node:command",
    "service": "rmw_manycore_py.cli.service:command",
    "action": "rmw_manycore_py.cli.action:command",
    "param": "rmw_manycore_py.cli.param:command",
    "lifecycle": "rmw_manycore_py.cli.lifecycle:command",
    "interface": "rmw_manycore_py.cli.interface:command",
    "component": "rmw_manycore_py.cli.component:command",
    "bag": "rmw_manycore_py.cli.bag:command",
    "clean": "rmw_manycore_py.cli.clean:command",
    "doctor": "rmw_manycore_py.cli.doctor:command",
    "env": "rmw_manycore_py.cli.env:command",
    "completion": "rmw_manycore_py.cli.completion:command",
    "ndt": "rmw_manycore_py.cli.ndt:command",
    "whill": "rmw_manycore_py.cli.whill:command",
    "bridge": "rmw_manycore_py.cli.bridge:command",
    "bench": "rmw_manycore_py.cli.bench:command",
}
SECTIONS = {
    "Run": (
        "run", "up", "ps", "logs", "restart", "move", "attach", "stop", "demo", "map", "create",
        "bridge", "pause", "step", "resume",
    ),
    "Inspect": ("status", "top", "view", "trace"),
    "Plan": ("profile", "simulate", "advise"),
    "ROS 2": (
        "topic", "node", "service", "action", "param", "lifecycle", "interface", "component", "bag",
    ),
    "Set up": ("doctor", "clean", "env", "completion"),
    "Measure": ("bench",),
    "Localize": ("ndt",),
    "Case studies": ("whill",),
}  # fmt: skip


@click.group(
    cls=LazyGroup,
    commands_at=VERBS,
    sections=SECTIONS,
    until_ctrl_c=("run", "demo", "logs", "view"),
    help="Run and inspect ROS 2 nodes on the cores of a clustered many-core platform.",
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=examples(
        "manycore demo",
        "manycore run talker_listener",
        "manycore status",
        "manycore topic echo /chatter",
    ),
)
@click.version_option(__version__, prog_name="manycore")
def cli() -> None:
    """Group of all verbs."""


def main() -> None:
    """Entry point of the command `manycore`."""
    open_closed_streams()
    cli(prog_name="manycore")
