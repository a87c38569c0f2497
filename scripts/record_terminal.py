# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""Run a command in a terminal and draw what it prints: record_terminal.py FILE.svg COMMAND..

Each line of the picture appears when the command printed it. A viewer without animations shows all
of them. Paths are shown relative to the working directory.
"""

from __future__ import annotations

import io
import os
import pty
import re
import shlex
import sys
import time
from pathlib import Path

from rich.console import Console
from rich.text import Text

COLUMNS = 100
NAME = "terminal"
COMMAND_ALONE_S = 0.5  # shown before its first output
FONTS_OF_OTHER_HOSTS = re.compile(r"@font-face \{.*?\}\s*", re.DOTALL)
LAST_CLASS = "</style>"


def record(command: list[str]) -> list[tuple[float, str]]:
    """Return each line that a command prints, and when, in seconds from its start."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.execvpe(command[0], command, {**os.environ, "COLUMNS": str(COLUMNS)})
    start_s = time.monotonic()
    lines = []
    with open(terminal, "rb") as output:
        try:
            for line in output:
                lines.append((time.monotonic() - start_s, line.decode().rstrip("\r\n")))
        except OSError:
            pass  # the terminal of a program that has ended
    if status := os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]):
        sys.exit(f"{shlex.join(command)} ended with status {status}")
    return lines


def drawn(command: list[str], lines: list[tuple[float, str]]) -> str:
    """Return the terminal as SVG, with an animation."""
    console = Console(record=True, width=COLUMNS, file=io.StringIO(), force_terminal=True)
    for _, line in [(0.0, f"$ {shlex.join(command)}"), *lines]:
        shown = Text.from_ansi(line.replace(f"{Path.cwd()}/", ""))
        console.print(shown, no_wrap=True, overflow="ellipsis")
    picture = console.export_svg(title=shlex.join(command[:2]), unique_id=NAME)
    first_s = lines[0][0] - COMMAND_ALONE_S
    appearing = "".join(
        f'[clip-path="url(#{NAME}-line-{number})"] '
        f"{{ animation: appear 1ms {time_s - first_s:.2f}s backwards }}\n"
        for number, (time_s, _) in enumerate(lines, start=1)
    )
    rules = f"@keyframes appear {{ from {{ opacity: 0 }} }}\n{appearing}"
    return FONTS_OF_OTHER_HOSTS.sub("", picture).replace(LAST_CLASS, rules + LAST_CLASS, 1)


def main(file: str, *command: str) -> None:
    """Record the command into the file."""
    Path(file).write_text(drawn(list(command), record(list(command))))
    print(f"wrote {file}")


if __name__ == "__main__":
    main(*sys.argv[1:])
