# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Extension of ros2cli: `ros2 manycore VERB` runs `manycore VERB`."""

from __future__ import annotations

import argparse
from typing import Any

from ros2cli.command import CommandExtension

from rmw_manycore_py.cli.main import VERBS, cli

_PROGRAM = "ros2 manycore"


class ManycoreCommand(CommandExtension):  # type: ignore[misc]
    """Run and inspect ROS 2 nodes on the cores of a clustered many-core platform."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Parse the verb and pass the rest on."""
        parser.epilog = f"Call `{cli_name} VERB --help` for more detailed usage."
        verb = parser.add_argument("verb", nargs="?", choices=sorted(VERBS), metavar="VERB")
        verb.help = f"one of {', '.join(sorted(VERBS))}"
        parser.add_argument("arguments", nargs=argparse.REMAINDER, help="arguments of the verb")

    def main(self, *, parser: argparse.ArgumentParser, args: Any) -> None:  # noqa: ARG002
        """Replace this process by the verb."""
        words = [args.verb, *args.arguments] if args.verb else ["--help"]
        cli.main(args=words, prog_name=_PROGRAM)
