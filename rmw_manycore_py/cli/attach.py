# Copyright 2026 The rmw_manycore developers. SPDX-License-Identifier: Apache-2.0
"""`manycore attach`."""

from __future__ import annotations

import base64
import os
import selectors
import signal
import sys
import termios
import tty
from collections.abc import Iterator
from contextlib import contextmanager

import click

from rmw_manycore_py.cli.common.completion import complete_nodes_of_runs
from rmw_manycore_py.cli.common.detach_keys import DetachKeys, parse_keys
from rmw_manycore_py.cli.common.node_watch import unapplied
from rmw_manycore_py.cli.common.options import examples, platform_option
from rmw_manycore_py.cli.common.printing import echo, print_notices
from rmw_manycore_py.cli.common.runs import living_runs, nodes_by_run
from rmw_manycore_py.errors import EXIT_BAD_INPUT, EXIT_FAILURE, ManycoreError
from rmw_manycore_py.launch.events import Ended, Started, event_of
from rmw_manycore_py.launch.runs.client import Client
from rmw_manycore_py.launch.runs.directory import RunDirectory
from rmw_manycore_py.process.signals import STOP_SIGNALS, SignalInbox, signal_inbox

DEFAULT_KEYS = "ctrl-p,ctrl-q"
_STDIN, _STDOUT = 0, 1


@click.command(
    "attach", epilog=examples("manycore attach teleop", "manycore attach --restart my_node")
)
@click.argument("node", shell_complete=complete_nodes_of_runs)
@click.option("--restart", "restarts", is_flag=True, help="Restart NODE with a terminal first.")
@click.option(
    "--detach-keys",
    "keys",
    default=DEFAULT_KEYS,
    show_default=True,
    help="Keys that detach from NODE: comma-separated letters or ctrl-LETTER.",
)
@platform_option
def command(node: str, restarts: bool, keys: str, platform: str) -> None:
    """Attach to the terminal of NODE.

    The node needs `terminal: true` in its mapfile. All keys go to NODE, Ctrl-C included. The
    detach keys leave NODE running. The command ends when NODE ends; it stays attached while
    NODE is respawned.
    """
    try:
        detach_keys = DetachKeys(parse_keys(keys))
    except ValueError as error:
        raise ManycoreError(f"--detach-keys: {error}", EXIT_BAD_INPUT) from error
    ((run, (name,)),) = nodes_by_run(living_runs(platform), [node])
    if restarts:
        _restart(run, name)
    with (
        signal_inbox((*STOP_SIGNALS, signal.SIGWINCH)) as inbox,
        Client(run, "attach", node=name, **_size()) as client,
        _raw_terminal(),
    ):
        reason, is_attached = _Session(client, inbox, detach_keys).run()
    echo(f"\n{name}: {reason}", err=True)
    if not is_attached:
        sys.exit(EXIT_FAILURE)


class _Session:
    """Forwards keys to the node and its output to the terminal."""

    def __init__(self, client: Client, inbox: SignalInbox, keys: DetachKeys) -> None:
        self._client = client
        self._inbox = inbox
        self._keys = keys
        self._reason: str | None = None
        self._is_good = True

    def run(self) -> tuple[str, bool]:
        """Forward until the session ends; return the reason, and whether it is a success."""
        for message in (self._client.answer, *self._client.early()):
            self._show(message)
        with selectors.DefaultSelector() as selector:
            selector.register(self._client.socket, selectors.EVENT_READ, self._take_messages)
            selector.register(self._inbox, selectors.EVENT_READ, self._take_signals)
            # epoll refuses regular files and /dev/null, which are always readable.
            if os.isatty(_STDIN) or not _is_plain(_STDIN):
                selector.register(_STDIN, selectors.EVENT_READ, lambda: self._type(selector))
            while self._reason is None:
                for key, _ in selector.select():
                    key.data()
        return self._reason, self._is_good

    def _take_messages(self) -> None:
        messages = self._client.take()
        if messages is None:
            self._reason, self._is_good = "the run has ended", False
            return
        for message in messages:
            self._show(message)

    def _show(self, message: dict[str, object]) -> None:
        if "output" in message:
            _write(base64.b64decode(str(message["output"])))
        elif "restarting" in message:
            _write(f"\r\n[{message['restarting']}; it is started again]\r\n".encode())
        elif "ended" in message:
            self._reason = f"has ended: {message['ended']}"
        elif "error" in message:
            self._reason, self._is_good = str(message["error"]), False

    def _take_signals(self) -> None:
        for number in self._inbox.take():
            if number == signal.SIGWINCH:
                self._client.send(_size())
            else:
                self._reason = f"left running ({number.name})"

    def _type(self, selector: selectors.BaseSelector) -> None:
        data = os.read(_STDIN, 4096)
        if not data:  # end of a piped stdin; keep forwarding output
            selector.unregister(_STDIN)
            return
        typed, is_detached = self._keys.take(data)
        if typed:
            self._client.send({"input": base64.b64encode(typed).decode()})
        if is_detached:
            self._reason = "left running"


def _restart(run: RunDirectory, name: str) -> None:
    print_notices(unapplied(run))
    with Client(run, "restart", nodes=[name], terminal=True) as client:
        for message in client.messages():
            event = event_of(message)
            if isinstance(event, Started) and event.node == name:
                return
            if isinstance(event, Ended) and event.node == name and event.state == "failed":
                raise ManycoreError(f"{name} failed: {event.reason}")


@contextmanager
def _raw_terminal() -> Iterator[None]:
    """Put the terminal into raw mode, Ctrl-C included; restore its settings at the end."""
    if not os.isatty(_STDIN):
        yield
        return
    before = termios.tcgetattr(_STDIN)
    tty.setraw(_STDIN, termios.TCSADRAIN)  # keep typed-ahead input for the node
    try:
        yield
    finally:
        termios.tcsetattr(_STDIN, termios.TCSADRAIN, before)


def _size() -> dict[str, list[int]]:
    try:
        size = os.get_terminal_size(_STDOUT)
    except OSError:
        return {}
    return {"size": [size.lines, size.columns]}


def _is_plain(descriptor: int) -> bool:
    path = os.path.realpath(f"/proc/self/fd/{descriptor}")
    return os.path.isfile(path) or path == os.devnull


def _write(data: bytes) -> None:
    while data:
        data = data[os.write(_STDOUT, data) :]
